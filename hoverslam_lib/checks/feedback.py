"""What a check says, and how it runs a student's answer without ever raising."""

import html
import inspect
import re
import traceback
import types
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from hoverslam_lib.checks import record
from hoverslam_lib.checks.stopping import TimeIsUp, quietly

TIME_LIMIT = 5.0
"""An answer takes no longer than this [s], as far as `stopping.limited` can stop it."""
LONGEST = 120
"""More characters of what a student's answer says are not shown."""

_tries = Counter()  # by exercise and answer: how many different ones got a general hint
_last = {}  # by exercise and answer: what was answered last


class Wrong(Exception):
    """An answer is not right.

    Parameters
    ----------
    what : str
        What was found, in words for the student: never the right answer.
    mistake : str, optional
        The name of the mistake, if its very result was recognised. If its hint stands on the page, that is told, with
        `values` for what stands in braces there; else `what` is the hint.
    nudge : bool
        Whether a general hint of the exercise should follow.
    about : str, optional
        Which of several answers this is about.
    """

    def __init__(self, what="", mistake=None, *, nudge=False, about=None, **values):
        super().__init__(what)
        self.what, self.mistake, self.nudge, self.about, self.values = what, mistake, nudge, about, values


class Open(Wrong):
    """All that is given is right, and something is not attempted yet."""


@dataclass(frozen=True)
class Feedback:
    """One line for the student, as text and as HTML.

    Attributes
    ----------
    number : str
        Of the exercise, such as "2.1".
    passed, tests : int
    hint : str
        What else there is to say: a hint, or after the last test the answer to the exercise's closing question.
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

    @property
    def text(self):
        """All of it, in one line."""
        if not self.attempted and not self.hint:
            return "○ not attempted yet"
        mark = "○" if not self.attempted else "✔" if self.done else "✘"
        return f"{mark} {self.passed} of {self.tests}" + (f" — {self.hint}" if self.hint else "")

    def __repr__(self):
        return record.readable(self.text)

    def _repr_html_(self):
        kind = "info" if not self.attempted else "success" if self.done else "error"
        border = f"border-left: 4px solid var(--jp-{kind}-color1, gray); padding: 2px 10px"
        return f'<div role="status" style="{border}">{html.escape(self.text)}</div>'


class Exercise:
    """A check that can be called with an answer.

    Parameters
    ----------
    number : str
        Lesson and place, such as "2.1".
    title : str
    name : str
        ``checks.name`` is the check.
    answers : tuple of str
        What a student calls them.
    hints : tuple of str
        General hints, the first for a first try, each more concrete than the one before. One that begins with an
        answer's name in backticks is for that answer only.
    judge : callable
        ``judge(answers, names, TIME_LIMIT)`` returns how many tests are passed, and a `Wrong` or None; ``judge.tests``
        is how many there are. An answer may be ``...`` if ``judge.takes_open`` is true.
    named : dict, optional
        The hint of every mistake.
    closing : str, optional
        What to say when it is done.
    """

    def __init__(self, number, title, name, answers, hints, judge, named=None, closing=""):
        self.number, self.title, self.answers, self.hints = number, title, answers, hints
        self.judge, self.named, self.closing = judge, named or {}, closing
        self.__name__, self.__doc__ = name, f"Check exercise {number}: {title}."

    @property
    def tests(self):
        """How many tests there are."""
        return self.judge.tests

    def __call__(self, *answers, **named):
        """Judge an answer.

        Returns
        -------
        Feedback
            Never raises, whatever the answer does; only *Interrupt* does.
        """
        if named or len(answers) != len(self.answers):
            call = f"checks.{self.__name__}({', '.join(self.answers)})"
            return Feedback(self.number, 0, self.tests, f"Please call it as in the lesson: {call}")
        missing = [name for name, answer in zip(self.answers, answers, strict=True) if _untouched(answer)]
        if len(missing) == len(answers):
            return Feedback(self.number, 0, self.tests, attempted=False)
        passed, wrong = 0, Open()
        if not missing or self.judge.takes_open:
            passed, wrong = self.judge(answers)
        if wrong is None:
            for key in [key for key in _last if key[0] == self.number]:
                del _tries[key], _last[key]
            record.add(self.number)
            return Feedback(self.number, passed, self.tests, self.closing)
        if isinstance(wrong, Open):
            hint = f"{'right so far; ' if passed else ''}{' and '.join(missing)}: not attempted yet"
            return Feedback(self.number, passed, self.tests, hint, attempted=False)
        hint = self.named[wrong.mistake].format(**wrong.values) if wrong.mistake in self.named else wrong.what
        if wrong.nudge:
            hint = f"{hint} {self._general_hint(wrong.about, answers)}"
        return Feedback(self.number, passed, self.tests, hint, wrong.mistake)

    def _general_hint(self, about, answers):
        """The next one, unless the same answer is tried again."""
        if about:
            answers = [answers[self.answers.index(about)]]
        key, told = (self.number, about), [_told_apart(answer) for answer in answers]
        if key in _last and _last[key] != told:
            _tries[key] += 1
        _last[key] = told
        own = [re.fullmatch(r"`(my_\w+)`:? (.*)", hint) for hint in self.hints]
        fitting = [
            match.group(2) if match else hint
            for match, hint in zip(own, self.hints, strict=True)
            if not match or match.group(1) == about
        ]
        return fitting[min(_tries[key], len(fitting) - 1)]


class Steps:
    """A judge in Python: ``judge(*answers)`` yields once for each of its tests, and raises `Wrong` at the first that is
    not passed.
    """

    takes_open = False

    def __init__(self, judge, tests):
        self.judge, self.tests = judge, tests

    def __call__(self, answers):
        passed = 0

        def work():
            nonlocal passed
            for _ in self.judge(*answers):
                passed += 1

        _, wrong = guarded(work, TIME_LIMIT)
        return passed, wrong


def guarded(work, seconds):
    """What ``work()`` returns and None, or None and a `Wrong` that says in words what it raises."""
    try:
        return quietly(work, seconds), None
    except Wrong as wrong:
        return None, wrong
    except KeyboardInterrupt:
        raise
    except TimeIsUp:
        return None, Wrong(f"Your answer was stopped after {TIME_LIMIT:.0f} s: does a loop never end?")
    except BaseException as error:
        return None, Wrong(raised(error))


def raised(error):
    """What a student's function raised, and in which line of its cell."""
    if isinstance(error, RecursionError):
        return "Your answer calls itself again and again, without an end."
    text = text_of(error)
    if "for ^" in text or "bitwise_xor" in text:
        return f"In Python a power is written **: there is a ^{_line(error)}."
    return f"Your answer raised {type(error).__name__}{f': {text}' if text else ''}{_line(error)}."


def text_of(thing, write=str):
    """``str`` of something that may raise when asked, in one line that is not too long."""
    try:
        text = " ".join(write(thing)[: 10 * LONGEST].split())
    except Exception:
        return ""
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"


def _line(error):
    """The last line of a cell that was at work, whatever it called in a library."""
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if not _installed(frame.filename)]
    return f" in line {frames[-1].lineno} of its cell" if frames else ""


def _installed(filename):
    """Whether this is a file of the library, of Python or of a package, and no cell."""
    return "site-packages" in filename or filename.startswith(("<__array", *_ELSEWHERE))


_ELSEWHERE = str(Path(__file__).parent.parent), inspect.getfile(inspect).removesuffix("inspect.py")


def _stub(): ...


def _described_stub():
    """A stub may say what it is to do."""


def _untouched(answer):
    """Whether an answer is still the dots: ``...`` itself, or a function that holds nothing else."""
    if type(answer) is not types.FunctionType:
        return answer is ...
    code = answer.__code__
    empty = (_stub.__code__.co_code, _described_stub.__code__.co_code)
    return code.co_code in empty and not code.co_names and code.co_consts[-1] is None


def _told_apart(answer):
    """The same for the same answer, also if it was made anew: no addresses."""
    function = answer if type(answer) is types.FunctionType else type(answer).__call__
    code = getattr(function, "__code__", None)
    shown = repr((code.co_code, code.co_consts, code.co_names)) if code else text_of(answer, repr)
    return re.sub(r"0x[0-9a-fA-F]+", "", shown)
