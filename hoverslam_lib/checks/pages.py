"""Reading a lesson's exercises from its page of Markdown, ``lesson_NN.md``.

Under a heading ``## 2.1 · title`` stand the call as in the notebook, hints as a list, a block of Python with the
solution, one with the ``check(…)``, a table of mistakes, and as a quotation what to say when all is right.
"""

import importlib
import math
import re
from collections import defaultdict
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np
from markdown_it import MarkdownIt
from markdown_it.tree import SyntaxTreeNode

import hoverslam_lib
from hoverslam_lib.checks import record
from hoverslam_lib.checks.answers import Words, told_apart, untouched
from hoverslam_lib.checks.feedback import Feedback, judged
from hoverslam_lib.checks.judging import Cases, Numbers, Value

NAMES = {name: getattr(hoverslam_lib, name) for name in hoverslam_lib.__all__}
NAMES |= {"np": np, "math": math, "Value": Value, "Words": Words}
"""What the Python of every page may use."""
HEADER = ("mistake", "change", "hint")


class PageError(ValueError):
    """A page of exercises is not as it should be; says in which line."""


class Mistake(NamedTuple):
    """A row of the table: what is changed in the solution, and the hint."""

    name: str
    changes: str
    hint: str
    line: int


@dataclass(eq=False, repr=False)
class Exercise:
    """One exercise as it stands on a page, lines counted from 1; called with answers, it judges them."""

    path: Path
    line: int
    number: str
    title: str
    name: str = ""
    answers: tuple = ()
    hints: list = field(default_factory=list)
    solution: str = ""
    check: str = ""
    check_line: int = 0
    mistakes: list = field(default_factory=list)
    blocks: dict = field(default_factory=dict)
    closing: str = ""
    tries: dict = field(default_factory=lambda: defaultdict(list))

    def __call__(self, *answers, **named):
        """Judge an answer; never raises, whatever the answer does, only *Interrupt* does."""
        tests = self.judge.tests
        if named or len(answers) != len(self.answers):
            call = f"checks.{self.name}({', '.join(self.answers)})"
            return Feedback(0, tests, f"Please call it as in the lesson: {call}")
        given = dict(zip(self.answers, answers, strict=True))
        missing = [name for name, answer in given.items() if untouched(answer)]
        if len(missing) == len(answers):
            return Feedback(0, tests, attempted=False)
        passed, wrong = 0, None
        if not missing or isinstance(self.judge, Numbers):
            passed, wrong = judged(self.judge, answers)
        if wrong:
            return Feedback(passed, tests, self._hint(wrong, given), wrong.mistake)
        if missing:
            hint = f"{'right so far; ' if passed else ''}{' and '.join(missing)}: not attempted yet"
            return Feedback(passed, tests, hint, attempted=False)
        self.tries.clear()
        record.add(self.number)
        return Feedback(passed, tests, self.closing)

    def _hint(self, wrong, given):
        """That of the mistake, or what was found; if asked for, with the next general one, unless nothing is new."""
        named = {mistake.name: mistake.hint for mistake in self.mistakes}
        hint = named[wrong.mistake].format(**wrong.values) if wrong.mistake in named else wrong.what
        # one that begins with an answer's name is for that answer only
        split = [re.fullmatch(r"(?:`(my_\w+)`:? )?(.*)", general).groups() for general in self.hints]
        fitting = [general for about, general in split if about in (None, wrong.about)]
        if not wrong.nudge or not fitting:
            return hint
        told = [told_apart(answer) for name, answer in given.items() if wrong.about in (None, name)]
        tries = self.tries[wrong.about]
        if tries[-1:] != [told]:
            tries.append(told)
        return f"{hint} {fitting[min(len(tries), len(fitting)) - 1]}"

    @cached_property
    def space(self):
        """The names that the Python of the page may use: the library's, and those of the Python beside it."""
        own = self.path.with_suffix(".py").exists()
        return NAMES | (vars(importlib.import_module(f"hoverslam_lib.checks.{self.path.stem}")) if own else {})

    @cached_property
    def judge(self):
        """The function of this name beside the page, or what the page's ``check(…)`` asks for.

        Made when it is first needed: flights in the cases take time.
        """
        if not self.check and self.name in self.space:
            return self.space[self.name]
        made = []

        def check(*cases, **options):
            solved = self.run(self.solution, self.line)
            if cases:
                (name,) = self.answers
                mistakes = [(row.name, self.run(self.changed(row), row.line)[name]) for row in self.mistakes]
                made.append(Cases(solved[name], mistakes, cases, **options))
            elif tuple(options) == self.answers:
                right = solved | {name: value.right for name, value in options.items() if value.right is not None}
                made.append(Numbers(options, right, [(row.name, self.assigned(row, right)) for row in self.mistakes]))
            else:
                raise self.error(self.check_line, f"check(…) should have {', '.join(self.answers)}")

        self.space["check"] = check
        self.run(self.check, self.check_line, self.space)
        if len(made) != 1:
            raise self.error(self.check_line or self.line, "one call of check(…) is needed")
        return made[0]

    def changed(self, mistake):
        """The solution with a mistake made in it."""
        if mistake.name in self.blocks:
            return self.blocks[mistake.name]
        text = self.solution
        for change in mistake.changes.split(";"):
            old, arrow, new = (part.strip() for part in change.partition("->"))
            if not arrow or not old:
                raise self.error(mistake.line, f"{change.strip()!r} is no change: write `old -> new`")
            if text.count(old) != 1:
                raise self.error(mistake.line, f"{old!r} stands {text.count(old)} times in the solution, not once")
            text = text.replace(old, new)
        return text

    def assigned(self, mistake, right):
        """What a row ``my_a = 2 * my_b; my_b = 7`` gives instead of the right numbers."""
        found = {}
        for part in mistake.changes.split(";"):
            name, _, value = (piece.strip() for piece in part.partition("="))
            if name not in self.answers:
                raise self.error(mistake.line, f"{part.strip()!r}: write a value, such as `{self.answers[0]} = 2`")
            found[name] = self.run(f"wrong = {value}", mistake.line, dict(right))["wrong"]
        return found

    def run(self, source, line, space=None):
        """What a piece of the page's Python defines, in a namespace or in a copy of `self.space`."""
        space = dict(self.space) if space is None else space
        try:
            exec(compile(source, f"<{self.path.name}>", "exec"), space)
        except PageError:
            raise
        except Exception as error:
            raise self.error(line, f"{type(error).__name__}: {error}") from error
        return space

    def error(self, line, what):
        """What is wrong with the page, to be raised."""
        return PageError(f"{self.path.name}, line {line}: {what}")


def exercises(path):
    """The exercises of a page; raises `PageError` if it is malformed."""
    found = []
    for node in SyntaxTreeNode(MarkdownIt("commonmark").enable("table").parse(path.read_text(encoding="utf-8"))):
        line = node.map[0] + 1
        if node.type == "heading" and node.tag == "h2":
            number, dot, title = _text(node).partition(" · ")
            found.append(Exercise(path, line, number, title))
            if not dot or not re.fullmatch(r"\d+\.\d+", number):
                raise found[-1].error(line, "a heading should be like `## 2.1 · title`")
        elif found:
            _read(found[-1], node, line)
    for exercise in found:
        _complete(exercise)
    return found


def _read(exercise, node, line):
    """Take up what stands in one place of the page."""
    match [node.type, *node.info.split()]:
        case ["fence", "python", "check"]:
            exercise.check, exercise.check_line = node.content, line
        case ["fence", "python"] if exercise.solution:
            raise exercise.error(line, "a second solution: is it `python check`, or `python` and a mistake's name?")
        case ["fence", "python"]:
            exercise.solution = node.content
        case ["fence", "python", *words]:
            exercise.blocks[" ".join(words)] = node.content
        case ["table"]:
            rows = [_row(exercise, row) for row in node.walk() if row.type == "tr"]
            exercise.mistakes += [row for row in rows if row[:3] != HEADER]
        case ["bullet_list"]:
            exercise.hints += map(_text, node.children)
        case ["blockquote"]:
            exercise.closing = _text(node)
        case ["paragraph"]:
            if call := re.fullmatch(r"`checks\.(\w+)\((.*)\)`", _text(node)):
                exercise.__name__ = exercise.name = call.group(1)
                exercise.__doc__ = f"Check exercise {exercise.number}: {exercise.title}."
                exercise.answers = tuple(call.group(2).split(", "))


def _row(exercise, row):
    cells, line = [cell.children[0] for cell in row.children], row.map[0] + 1
    if len(cells) != 3 or not cells[0].content or not cells[2].content:
        raise exercise.error(line, f"a row should hold {' | '.join(HEADER)}")
    name, changes, hint = (cell.content for cell in cells)
    code = ";".join(part.content for part in cells[1].children if part.type == "code_inline")
    return Mistake(name, code or changes, hint, line)


def _complete(exercise):
    """Raise `PageError` if something is missing, or does not fit together."""
    call = "the call, such as `checks.name(my_name)`"
    for part, what in ((exercise.name, call), (exercise.hints, "hints"), (exercise.solution, "a solution")):
        if not part:
            raise exercise.error(exercise.line, f"{exercise.number} lacks {what}")
    names = {}
    for mistake in exercise.mistakes:
        if names.setdefault(mistake.name, mistake.hint) != mistake.hint:
            raise exercise.error(mistake.line, f"{mistake.name!r} has another hint above: one name, one hint")
        if "def " in exercise.solution:
            exercise.changed(mistake)
    for name in exercise.blocks:
        if name not in names:
            raise exercise.error(exercise.line, f"the block `python {name}` has no row in the table")


def _text(node):
    """All its text, in one line."""
    return " ".join(" ".join(part.content for part in node.walk() if part.type == "inline").split())
