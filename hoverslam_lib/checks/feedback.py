"""What a check says, and how it runs a student's answer without ever raising."""

import contextlib
import html
import io
import sys
import sysconfig
import traceback
from dataclasses import dataclass
from pathlib import Path

from hoverslam_lib.checks.stopping import TimeIsUp, limited

TIME_LIMIT = 5.0
"""An answer takes no longer than this [s], as far as `stopping.limited` can stop it."""
LONGEST = 120
"""More characters of what a student's answer says are not shown."""
MARKS = str.maketrans("✔✘○—", "+-o-")
"""For a terminal that does not know them."""
ELSEWHERE = str(Path(__file__).parent.parent), sysconfig.get_path("stdlib"), "<frozen", "-packages", ".md>"
"""What stands in the name of a file that is no cell: of the library, of Python, of a package, of a page."""


class Wrong(Exception):
    """An answer is not right: `what` was found, in words for the student, and never the right answer.

    If the very result of a mistake was recognised, `mistake` is its name, and its hint on the page is told in place of
    `what`, with `values` for what stands in braces there. With `nudge`, a general hint of the exercise follows; `about`
    is the one of several answers that all this is about.
    """

    def __init__(self, what="", mistake=None, *, nudge=False, about=None, **values):
        super().__init__(what)
        self.what, self.mistake, self.nudge, self.about, self.values = what, mistake, nudge, about, values


class Page:
    """Text that looks the same in a terminal, as far as that can write it, and in a notebook."""

    def __init__(self, text):
        self.text = text

    def __repr__(self):
        encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
        try:
            return self.text.encode(encoding).decode(encoding)
        except UnicodeEncodeError:
            return self.text.translate(MARKS).encode(encoding, "replace").decode(encoding)

    def _repr_html_(self):
        return f'<pre role="status">{html.escape(self.text)}</pre>'


@dataclass(frozen=True, repr=False)
class Feedback(Page):
    """One line for the student.

    The hint is what else there is to say, or after the last test the answer to the exercise's closing question;
    `mistake` is the name of the mistake that was recognised, if one was.
    """

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

    def _repr_html_(self):
        kind = "info" if not self.attempted else "success" if self.done else "error"
        border = f"border-left: 4px solid var(--jp-{kind}-color1, gray); padding: 2px 10px"
        return f'<div role="status" style="{border}">{html.escape(self.text)}</div>'


def each(tests):
    """Yield for each of the tests that passes, then raise the first `Wrong`: one answer does not hide the others."""
    wrong = []
    for test in tests:
        try:
            test()
        except Wrong as found:
            wrong.append(found)
        else:
            yield
    if wrong:
        raise wrong[0]


def judged(judge, answers):
    """How many tests are passed, and a `Wrong` or None, whatever the answers do; only *Interrupt* gets through.

    ``judge(*answers)`` yields None for each test that is passed, and raises `Wrong` at the first that is not. It may
    yield a `Wrong` before: what to say if a search for something better takes too long, or fails. A judge that flies
    much has more ``seconds`` than `TIME_LIMIT`.
    """
    passed, wrong, seconds = 0, None, getattr(judge, "seconds", TIME_LIMIT)

    def work():
        nonlocal passed, wrong
        for wrong in judge(*answers):
            passed += wrong is None

    try:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            limited(work, seconds)
    except Wrong as better:
        wrong = better
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        wrong = wrong or Wrong(raised(error, seconds))
    return passed, wrong


def raised(error, seconds=TIME_LIMIT):
    """What a student's function raised, and in which line of its cell."""
    if isinstance(error, TimeIsUp):
        return f"Your answer was stopped after {seconds:.0f} s: does a loop never end?"
    if isinstance(error, RecursionError):
        return "Your answer calls itself again and again, without an end."
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame.lineno for frame in frames if not any(part in frame.filename for part in ELSEWHERE)]
    line, text = f" in line {own[-1]} of its cell" if own else "", text_of(error)
    if "for ^" in text or "bitwise_xor" in text:
        return f"In Python a power is written **: there is a ^{line}."
    if "truth value of an array" in text:
        return f"An array is asked for one True or False, as by an `if`{line}. Many of them pick rows: t[t > 0]."
    return f"Your answer raised {type(error).__name__}{f': {text}' if text else ''}{line}."


def text_of(thing, write=str, longest=LONGEST):
    """``str`` of something that may raise when asked, in one line that is not too long."""
    try:
        text = " ".join(write(thing)[: 10 * LONGEST].split())
    except Exception:
        return ""
    return text if len(text) <= longest else f"{text[: longest - 1]}…"
