"""Reading a student's answer, and comparing it."""

import copy

import numpy as np

from hoverslam_lib.checks.feedback import Wrong, text_of


def number(value, name="the result"):
    """A finite float, or `Wrong` with what it is instead."""
    made = _floats(value, name, "a number")
    if made.size != 1:
        raise Wrong(f"{_start(name)} should be one number; it holds {_amount(made.shape)}.")
    if not np.isfinite(made).all():
        raise Wrong(f"{_start(name)} is {made.item()}, which is not a finite number.")
    return float(made.item())


def pair(value, names=("h", "v")):
    """Two finite floats, such as the (h, v) of a step."""
    _require_something(value, "the result")
    try:
        first, second = value
    except (TypeError, ValueError):
        raise Wrong(f"The result should be the two numbers {names[0]}, {names[1]}; it is {_shown(value)}.") from None
    return number(first, f"{names[0]} of the result"), number(second, f"{names[1]} of the result")


def array(value, shape, name="the result"):
    """An array of finite floats of a given shape."""
    made = _floats(value, name, "an array of numbers")
    if made.shape != tuple(shape):
        raise Wrong(f"{_start(name)} should hold {_amount(shape)}; it holds {_amount(made.shape)}.")
    if not np.isfinite(made).all():
        raise Wrong(f"{_start(name)} holds nan or inf, which are not finite numbers.")
    return made


def distance(a, b, rtol, atol):
    """How far a is from b, in units of the tolerance: at most 1 is near enough, inf is nothing alike."""
    if isinstance(a, Exception) or isinstance(b, Exception):
        return 0.0 if type(a) is type(b) and text_of(a) == text_of(b) else np.inf
    if _numeric(a) is None or _numeric(b) is None:
        if isinstance(a, tuple | list) and isinstance(b, tuple | list) and len(a) == len(b):
            return max((distance(*both, rtol, atol) for both in zip(a, b, strict=True)), default=0.0)
        return 0.0 if type(a) is type(b) and np.array_equal(a, b) else np.inf
    a, b = _numeric(a), _numeric(b)
    if a.size == b.size == 1:
        a, b = a.reshape(()), b.reshape(())
    if a.shape != b.shape:
        return np.inf
    with np.errstate(all="ignore"):
        off = np.where((a == b) | (np.isnan(a) & np.isnan(b)), 0.0, np.abs(a - b) / (atol + rtol * np.abs(b)))
    return float(np.max(np.where(np.isnan(off), np.inf, off), initial=0.0))


def _numeric(value):
    """An array of floats, or None if it is anything else."""
    if isinstance(value, str | bytes | dict | set | bool | np.bool_) or value is None:
        return None
    try:
        made = np.asarray(value)
        return None if made.dtype.kind in "USbc" else made.astype(float)
    except (TypeError, ValueError):
        return None


def shaped_like(got, right, names):
    """Raise `Wrong` unless the answer is of the kind of the right one: a number, a pair, an array of its shape."""
    shape = np.shape(right)
    if _numeric(right) is None:
        return
    if shape == ():
        number(got)
    elif isinstance(right, tuple) and shape == (2,):
        pair(got, names)
    else:
        array(got, shape)


def repeatable(function, *arguments):
    """Call a function twice with copies of the same arguments; return the first result.

    Raises `Wrong` if it changes its arguments, or gives another result the second time.
    """
    copies = copy.deepcopy(arguments)
    first = function(*copies)
    if not all(map(_unchanged, arguments, copies)):
        raise Wrong("Your function changes what it is given: work on a copy.", "changes its arguments")
    again = function(*copy.deepcopy(arguments))
    try:
        same = np.array_equal(np.asarray(first, dtype=float), np.asarray(again, dtype=float), equal_nan=True)
    except (TypeError, ValueError):
        same = True  # not numbers at all: that is for another test to say
    if not same:
        raise Wrong("Called twice with the same arguments, it gives two results.", "remembers its last call")
    return first


def _unchanged(before, after):
    if isinstance(before, np.ndarray):
        return np.array_equal(before, after, equal_nan=before.dtype.kind == "f")
    if hasattr(before, "__dataclass_fields__"):
        return all(map(_unchanged, vars(before).values(), vars(after).values()))
    return True


def takes(function, *names):
    """Raise `Wrong` unless the answer is something that can be called."""
    if not callable(function):
        raise Wrong(f"The answer should be a function of ({', '.join(names)}); it is {_shown(function)}.")
    return function


def _floats(value, name, wanted):
    _require_something(value, name)
    try:
        if isinstance(value, bool | dict | set) or np.asarray(value).dtype.kind in "USb":
            raise TypeError
        return np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise Wrong(f"{_start(name)} should be {wanted}; it is {_shown(value)}.") from None


def _require_something(value, name):
    if value is None:
        raise Wrong(f"{_start(name)} is None{'.' if name.startswith('my_') else ': is a `return` missing?'}")


def _amount(shape):
    if len(shape) < 2:
        return "one number" if shape in ((), (1,)) else f"{shape[0]} numbers"
    return " × ".join(str(n) for n in shape) + " numbers"


def _start(name):
    return name if name.startswith("my_") else name[0].upper() + name[1:]


def _shown(value):
    text = text_of(value, repr)
    return text if len(text) <= 40 else f"{text[:37]}…"


def digits(got):
    """An answer as the student is shown it."""
    if _numeric(got) is None and not isinstance(got, str):
        return _shown(got)
    if isinstance(got, str):
        return repr(got)
    values = np.atleast_1d(np.asarray(got, dtype=float)).ravel()
    listed = ", ".join(f"{x:.6g}" for x in values[:4])
    return f"{listed}, …" if values.size > 4 else listed
