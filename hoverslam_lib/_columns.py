"""Frozen dataclasses whose numbers may be columns: how they compare, show themselves and give their rows."""

from dataclasses import fields

import numpy as np

from hoverslam_lib._validate import is_column


def columns(record):
    """Name → column, of those fields that are columns."""
    values = ((field.name, getattr(record, field.name)) for field in fields(record))
    return {name: value for name, value in values if is_column(value)}


def rows(record, which, **parts):
    """The same record with some rows of its columns as arrays, or of one row, given its number, as floats."""
    made = object.__new__(type(record))  # its numbers are checked already
    vars(made).update({field.name: getattr(record, field.name) for field in fields(record)}, **parts)
    for name, column in columns(record).items():
        numbers = np.asarray(column, dtype=float)[which]
        vars(made)[name] = numbers if isinstance(numbers, np.ndarray) else float(numbers)
    return made


def equal(record, other):
    """Compare two records field by field, and columns element by element, to one bool."""
    if other.__class__ is not record.__class__:
        return NotImplemented
    pairs = ((getattr(record, field.name), getattr(other, field.name)) for field in fields(record))
    return all(np.array_equal(a, b) if is_column(a) or is_column(b) else a == b for a, b in pairs)


def shown(record):
    """What a dataclass shows, with the shape of a column in place of its numbers."""
    values = ((field.name, getattr(record, field.name)) for field in fields(record))
    shown = (f"{name}=<column, shape {x.shape}>" if is_column(x) else f"{name}={x!r}" for name, x in values)
    return f"{type(record).__name__}({', '.join(shown)})"
