"""What a check says, and how it runs a student's answer without ever raising."""

import contextlib
import ctypes
import html
import io
import threading
import traceback
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from hoverslam_lib.checks import record

TIME_LIMIT = 5.0
"""A check takes no longer than this [s]."""

_tries = Counter()  # by exercise: how many different answers got a general hint
_last = {}  # by exercise: what was answered last


class Wrong(Exception):
    """An answer is not right.

    Parameters
    ----------
    what : str
        What was found, in words for the student: never the right answer.
    mistake : str, optional
        The name of the mistake, if its very result was recognised; then `what` is the hint that belongs to it.
    nudge : bool
        Whether a general hint of the exercise should follow.
    """

    def __init__(self, what, mistake=None, *, nudge=False):
        super().__init__(what)
        self.what, self.mistake, self.nudge = what, mistake, nudge


class _TimeIsUp(BaseException):
    """Thrown into an answer that does not end; not an Exception, so that few answers catch it."""


@dataclass(frozen=True)
class Feedback:
    """One line for the student, as text and as HTML.

    Attributes
    ----------
    number : str
        Of the exercise, such as "2.1".
    passed, tests : int
    hint : str
        Empty if there is nothing to say.
    mistake : str or None
        The name of the mistake that was recognised.
    """

    number: str
    passed: int
    tests: int
    hint: str = ""
    mistake: str | None = None
    attempted: bool = True

    @property
    def done(self):
        """Whether every test was passed."""
        return self.attempted and self.passed == self.tests

    def __repr__(self):
        if not self.attempted:
            return "○ not attempted yet"
        line = f"{'✔' if self.done else '✘'} {self.passed} of {self.tests}"
        return f"{line} — {self.hint}" if self.hint else line

    def _repr_html_(self):
        kind = "info" if not self.attempted else "success" if self.done else "error"
        border = f"border-left: 4px solid var(--jp-{kind}-color1, gray); padding: 2px 10px"
        return f'<div role="status" style="{border}">{html.escape(repr(self))}</div>'


class Exercise:
    """A check that can be called with an answer.

    Parameters
    ----------
    number : str
        Lesson and place, such as "2.1".
    title : str
    tests : int
        How often `judge` yields for a right answer.
    hints : tuple of str
        General hints, the first for a first try, each more concrete than the one before.
    judge : generator function
        ``judge(*answers)`` yields once for each test passed, and raises `Wrong` at the first that is not.
    """

    def __init__(self, number, title, tests, hints, judge):
        self.number, self.title, self.tests, self.hints, self.judge = number, title, tests, hints, judge
        self.__name__, self.__doc__ = judge.__name__, f"Check exercise {number}: {title}."

    def __call__(self, *answers):
        """Judge an answer.

        Returns
        -------
        Feedback
            Never raises, whatever the answer does.
        """
        if any(_untouched(answer) for answer in answers):
            return Feedback(self.number, 0, self.tests, attempted=False)
        passed, wrong = _judged(self.judge, answers)
        if wrong is None and passed == self.tests:
            _tries[self.number] = 0
            _last.pop(self.number, None)
            record.add(self.number)
            return Feedback(self.number, passed, self.tests)
        hint = wrong.what
        if wrong.nudge:
            hint = f"{hint} {self._general_hint(answers)}"
        return Feedback(self.number, passed, self.tests, hint, wrong.mistake)

    def _general_hint(self, answers):
        """The next one, unless the same answer is tried again."""
        told = [_told_apart(answer) for answer in answers]
        if self.number in _last and _last[self.number] != told:
            _tries[self.number] += 1
        _last[self.number] = told
        return self.hints[min(_tries[self.number], len(self.hints) - 1)]


def exercise(number, title, *, tests, hints):
    """Make a check of a generator function: see `Exercise`."""
    return lambda judge: Exercise(number, title, tests, hints, judge)


def _stub(): ...


def _described_stub():
    """A stub may say what it is to do."""


def _untouched(answer):
    """Whether an answer is still the dots: ``...`` itself, or a function that holds nothing else."""
    code = getattr(answer, "__code__", None)
    if code is None:
        return answer is ...
    empty = (_stub.__code__.co_code, _described_stub.__code__.co_code)
    return code.co_code in empty and not code.co_names and code.co_consts[-1] is None


def _told_apart(answer):
    code = getattr(answer, "__code__", None)
    return (code.co_code, repr(code.co_consts), code.co_names) if code else repr(answer)


def _judged(judge, answers):
    """How many tests are passed, and what was wrong or None; in a thread of its own, which is stopped if need be."""
    found = {"passed": 0, "wrong": None}

    def work():
        try:
            for _ in judge(*answers):
                found["passed"] += 1
        except Wrong as wrong:
            found["wrong"] = wrong
        except _TimeIsUp:
            found["wrong"] = Wrong(_too_long())
        except RecursionError:
            found["wrong"] = Wrong("Your answer calls itself again and again, without an end.")
        except BaseException as error:
            found["wrong"] = Wrong(_raised(error))

    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        thread = threading.Thread(target=work, daemon=True)
        thread.start()
        thread.join(TIME_LIMIT)
        for _ in range(20):
            if not thread.is_alive():
                return found["passed"], found["wrong"]
            # works on every system, at the next line of Python that the thread executes
            ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread.ident), ctypes.py_object(_TimeIsUp))
            thread.join(0.05)
    return found["passed"], Wrong(_too_long())


def _too_long():
    return f"Your answer was stopped after {TIME_LIMIT:.0f} s: does a loop never end?"


def _raised(error):
    """What a student's function raised, and in which line of it; nothing of the check's own lines."""
    library = str(Path(__file__).parent.parent)
    own = [frame for frame in traceback.extract_tb(error.__traceback__) if not frame.filename.startswith(library)]
    where = f" in line {own[-1].lineno} of its cell" if own else ""
    what = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    return f"Your answer raised {what}{where}."
