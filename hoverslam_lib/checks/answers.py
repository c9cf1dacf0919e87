"""Reading a student's answer, and comparing it."""

import contextlib
import copy
import math
import re
import types
from dataclasses import is_dataclass

import numpy as np

from hoverslam_lib.checks.feedback import Wrong, text_of


class Words(str):
    """What a probe says of an answer, in words: shown as they are, and never asked to be a number."""


def number(value, name="the result"):
    """A finite float, or `Wrong` with what it is instead."""
    if isinstance(value, float) and math.isfinite(value):  # as nearly always: a flight asks 300 times
        return float(value)
    return array(value, (), name).item()


def pair(value, names=("h", "v")):
    """Two finite floats, such as the (h, v) of a step."""
    return tuple(array(value, (2,), wanted=f"the two numbers {', '.join(names)}").tolist())


def array(value, shape, name="the result", wanted=None):
    """An array of finite floats of a given shape, or `Wrong` with what it is instead."""
    made = numeric(value)
    fits = made is not None and (made.shape == tuple(shape) or (made.size == 1 and shape == ()))
    if fits and np.isfinite(made).all():
        return made
    about = name if name.startswith("my_") else None
    start = about or name[0].upper() + name[1:]
    if fits:
        bad = made[~np.isfinite(made)][0]
        said = f"{start} {'holds' if shape else 'is'} {bad}, which is not a finite number."
        raise Wrong(said, nudge=True, about=about)
    it = f"is {text_of(value, repr, 40)}" if made is None else f"holds {_amount(made.shape)}"
    end = ": is a `return` missing?" if value is None and start != name else "."
    if isinstance(value, types.FunctionType):
        it, end = "is a function", ": are the brackets of a call missing?"
    other = made is not None and not wanted and 0 < made.ndim == len(shape)  # numbers, but so many more or fewer
    raise Wrong(f"{start} should be {wanted or _amount(shape)}; it {it}{end}", nudge=other)


def _amount(shape):
    return "one number" if math.prod(shape) == 1 else " × ".join(map(str, shape)) + " numbers"


def numeric(value):
    """An array of floats, or None if it is anything else."""
    try:
        made = np.asarray(value)
        strange = made.dtype.kind in "USbc" or (made.dtype.kind == "O" and None in made)
        return None if strange else made.astype(float)
    except (TypeError, ValueError, OverflowError):
        return None


def distance(a, b, rtol, atol):
    """How far a is from b, in units of the tolerance: at most 1 is near enough, inf is nothing alike."""
    if isinstance(a, Exception) or isinstance(b, Exception):
        return 0.0 if type(a) is type(b) and text_of(a) == text_of(b) else np.inf
    x, y = numeric(a), numeric(b)
    if x is None or y is None:
        if isinstance(a, tuple | list) and isinstance(b, tuple | list) and len(a) == len(b):
            return max((distance(*both, rtol, atol) for both in zip(a, b, strict=True)), default=0.0)
        return 0.0 if type(a) is type(b) and np.array_equal(a, b) else np.inf
    if x.size == y.size == 1:
        x, y = x.ravel(), y.ravel()
    if x.shape != y.shape:
        return np.inf
    with np.errstate(all="ignore"):
        off = np.where((x == y) | (np.isnan(x) & np.isnan(y)), 0.0, np.abs(x - y) / (atol + rtol * np.abs(y)))
    return float(np.max(np.where(np.isnan(off), np.inf, off), initial=0.0))


def digits(got):
    """An answer as the student is shown it."""
    if isinstance(got, Words):
        return str(got)
    values = numeric(got)
    if values is None or not values.size:
        return text_of(got, repr, 40)
    return ", ".join(f"{x:.6g}" for x in values.flat[:4]) + (", …" if values.size > 4 else "")


def takes(function, *names):
    """Raise `Wrong` unless the answer is something that can be called."""
    if not callable(function):
        raise Wrong(f"The answer should be a function of ({', '.join(names)}); it is {text_of(function, repr, 40)}.")
    return function


def repeatable(function, *arguments):
    """The result of a function, called with copies of the arguments.

    Raises `Wrong` if it changes its arguments, or gives another result when it is called again.
    """
    copies = copy.deepcopy(arguments)
    first = function(*copies)
    if not all(map(_unchanged, arguments, copies)):
        raise Wrong("Your function changes what it is given: work on a copy.", "changes its arguments")
    again = function(*copy.deepcopy(arguments))
    with contextlib.suppress(TypeError, ValueError, OverflowError):  # what is not a number is for another test to say
        if not np.array_equal(np.asarray(first, dtype=float), np.asarray(again, dtype=float), equal_nan=True):
            raise Wrong("Called twice with the same arguments, it gives two results.", "remembers its last call")
    return first


def _unchanged(before, after):
    if isinstance(before, np.ndarray):
        return np.array_equal(before, after, equal_nan=before.dtype.kind == "f")
    return not is_dataclass(before) or all(map(_unchanged, vars(before).values(), vars(after).values()))


def _described_stub():
    """A stub may say what it is to do."""


_EMPTY = [(lambda: None).__code__.co_code, _described_stub.__code__.co_code]


def untouched(answer):
    """Whether an answer is still the dots: ``...`` itself, or a function that holds nothing else."""
    if type(answer) is not types.FunctionType:
        return answer is ...
    code = answer.__code__
    return code.co_code in _EMPTY and not code.co_names and code.co_consts[-1] is None


def told_apart(answer):
    """The same for the same answer, also if it was made anew: no addresses."""
    function = answer if type(answer) is types.FunctionType else type(answer).__call__
    code = getattr(function, "__code__", None)
    shown = repr((code.co_code, code.co_consts, code.co_names)) if code else text_of(answer, repr)
    return re.sub(r"0x[0-9a-fA-F]+", "", shown)
