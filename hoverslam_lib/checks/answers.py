"""Reading a student's answer, and comparing it."""

import numpy as np

from hoverslam_lib.checks.feedback import Wrong


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


def choice(value, options):
    """One of a few words; capitals and spaces do not count."""
    if not isinstance(value, str) or value.strip().lower() not in options:
        raise Wrong(f"Answer with one of {', '.join(map(repr, options))}; it is {_shown(value)}.")
    return value.strip().lower()


def compare(got, right, where, mistakes=None, *, rtol=1e-9, atol=1e-12):
    """Raise `Wrong` unless the answer is right.

    Parameters
    ----------
    got, right : float, str or array_like
    where : str
        What was asked, for the student: "for dt = 0.1 s".
    mistakes : dict, optional
        Name of a mistake: (what it leads to, the hint that belongs to it). One is named only if the answer is its
        result, and if its result can be told from the right one.
    """
    if _same(got, right, rtol, atol):
        return
    for mistake, (wrong, hint) in (mistakes or {}).items():
        if _same(got, wrong, rtol, atol) and not _same(wrong, right, rtol, atol):
            raise Wrong(hint, mistake)
    raise Wrong(f"Not right {where}: it gives {_digits(got)}.", nudge=True)


def _same(a, b, rtol, atol):
    if isinstance(a, str) or isinstance(b, str):
        return a == b
    a, b = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    return a.shape == b.shape and np.allclose(a, b, rtol=rtol, atol=atol)


def repeatable(function, *arguments):
    """Call a function twice with copies of the same arguments; return the first result.

    Raises `Wrong` if it changes its arguments, or gives another result the second time.
    """
    copies = [a.copy() if isinstance(a, np.ndarray) else a for a in arguments]
    first = function(*copies)
    for before, after in zip(arguments, copies, strict=True):
        if isinstance(before, np.ndarray) and not np.array_equal(before, after):
            raise Wrong("Your function changes the arrays that it is given: work on a copy.", "changes its arguments")
    again = function(*(a.copy() if isinstance(a, np.ndarray) else a for a in arguments))
    try:
        same = np.array_equal(np.asarray(first, dtype=float), np.asarray(again, dtype=float), equal_nan=True)
    except (TypeError, ValueError):
        same = True  # not numbers at all: that is for another test to say
    if not same:
        raise Wrong("Called twice with the same arguments, it gives two results.", "remembers its last call")
    return first


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
    text = " ".join(repr(value).split())
    return text if len(text) <= 40 else f"{text[:37]}…"


def _digits(got):
    if isinstance(got, str):
        return repr(got)
    values = np.atleast_1d(np.asarray(got, dtype=float)).ravel()
    listed = ", ".join(f"{x:.6g}" for x in values[:4])
    return f"{listed}, …" if values.size > 4 else listed
