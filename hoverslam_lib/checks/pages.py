"""Reading a lesson's exercises from its page of Markdown, ``lesson_NN.md``.

Under a heading ``## 2.1 · title`` stand the call as in the notebook, hints as a list, a block of Python with the
solution, one with the ``check(…)``, a table of mistakes, and as a quotation what to say when all is right.
"""

import importlib
import math
import re
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
from markdown_it import MarkdownIt

import hoverslam_lib
from hoverslam_lib.checks.feedback import Exercise, Steps
from hoverslam_lib.checks.judging import Cases, Numbers, Value

HEADER = ["mistake", "change", "hint"]


class PageError(ValueError):
    """A page of exercises is not as it should be; says in which line."""


@dataclass
class Mistake:
    """A row of the table: what is changed in the solution, and the hint."""

    name: str
    changes: str
    hint: str
    line: int


@dataclass
class Entry:
    """One exercise as it stands on a page; lines are counted from 1."""

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

    def error(self, line, what):
        """What is wrong with the page, to be raised."""
        return PageError(f"{self.path.name}, line {line}: {what}")

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

    def exercise(self, module):
        """The check that it describes; `module` is the lesson's own Python, or None."""
        named = {mistake.name: mistake.hint for mistake in self.mistakes}
        judge = getattr(module, self.name, None) or Lazy(self, module)
        if not isinstance(judge, Lazy):
            judge = Steps(judge, judge.tests)
        return Exercise(self.number, self.title, self.name, self.answers, tuple(self.hints), judge, named, self.closing)


class Lazy:
    """A judge that is made of its page when it is first asked: flights in its cases take time."""

    def __init__(self, entry, module):
        self.entry, self.module = entry, module
        self.takes_open = len(entry.answers) > 1 or not entry.solution.count("def ")

    @property
    def tests(self):
        return self.made.tests

    def __call__(self, answers):
        return self.made(answers)

    @cached_property
    def made(self):
        entry, found = self.entry, []

        def check(*cases, where="", rtol=1e-9, atol=1e-12, names=("h", "v"), **values):
            found.append((cases, {"where": where, "rtol": rtol, "atol": atol, "names": names}, values))

        space = namespace(self.module) | {"check": check, "Value": Value}
        run(entry, entry.check, space, entry.check_line)
        if len(found) != 1:
            raise entry.error(entry.check_line or entry.line, "one call of check(…) is needed")
        cases, options, values = found[0]
        solved = run(entry, entry.solution, dict(space), entry.line)
        if not values:
            (name,) = entry.answers
            mistakes = [(m.name, run(entry, entry.changed(m), dict(space), m.line)[name]) for m in entry.mistakes]
            return Cases(solved[name], mistakes, cases, **options)
        if tuple(values) != entry.answers:
            raise entry.error(entry.check_line, f"check(…) should have {', '.join(entry.answers)}")
        values = {
            name: value if value.right is not None else Value(**(vars(value) | {"right": solved[name]}))
            for name, value in values.items()
        }
        right = solved | {name: value.right for name, value in values.items()}
        return Numbers(values, [(m.name, assigned(entry, m, right)) for m in entry.mistakes])


def assigned(entry, mistake, space):
    """What a row ``my_a = 2 * my_b; my_b = 7`` gives instead of the right numbers."""
    found = {}
    for part in mistake.changes.split(";"):
        name, equals, value = (piece.strip() for piece in part.partition("="))
        if not equals or name not in entry.answers:
            raise entry.error(mistake.line, f"{part.strip()!r}: write a value, such as `{entry.answers[0]} = 2`")
        found[name] = run(entry, f"wrong = {value}", dict(space), mistake.line)["wrong"]
    return found


def namespace(module=None):
    """The names that a solution and its cases may use: the library's, `np`, `math`, and the lesson's own module's."""
    public = {name: getattr(hoverslam_lib, name) for name in hoverslam_lib.__all__}
    return (
        public | {"np": np, "math": math} | ({k: v for k, v in vars(module).items() if k[0] != "_"} if module else {})
    )


def run(entry, source, space, line):
    """Run a piece of Python of the page; what it defines is added to `space`."""
    try:
        exec(compile(source, f"<{entry.path.name}>", "exec"), space)
    except Exception as error:
        raise entry.error(line, f"{type(error).__name__}: {error}") from error
    return space


def entries(path):
    """The exercises of a page.

    Raises
    ------
    PageError
        If it is malformed, with its line.
    """
    found, tokens = [], MarkdownIt("commonmark").enable("table").parse(path.read_text(encoding="utf-8"))
    inside, cells, line = [], [], 1
    for i, token in enumerate(tokens):
        line = token.map[0] + 1 if token.map else line
        if token.nesting == 1:
            inside.append(token.type)
        elif token.nesting == -1:
            inside.pop()
        if token.type == "heading_open" and token.tag == "h2":
            number, dot, title = tokens[i + 1].content.partition(" · ")
            if not dot or not re.fullmatch(r"\d+\.\d+", number):
                raise PageError(f"{path.name}, line {line}: a heading should be like `## 2.1 · title`")
            found.append(Entry(path, line, number, title))
        elif found:
            cells = _read(found[-1], token, inside, cells, line)
    for entry in found:
        _complete(entry)
    return found


def _read(entry, token, inside, cells, line):
    """Take up one token; returns the cells of the row of the table that is being read."""
    if token.type == "fence":
        _block(entry, token, line)
    elif token.type == "tr_open":
        return []
    elif token.type == "tr_close":
        _row(entry, cells, line)
    elif token.type == "inline" and "table_open" in inside:
        code = ";".join(child.content for child in token.children if child.type == "code_inline")
        return [*cells, code if len(cells) == 1 and code else token.content]
    elif token.type == "inline" and "list_item_open" in inside:
        entry.hints.append(" ".join(token.content.split()))
    elif token.type == "inline" and "blockquote_open" in inside:
        entry.closing = " ".join(f"{entry.closing} {token.content}".split())
    elif call := re.fullmatch(r"`checks\.(\w+)\((.*)\)`", token.content):
        entry.name, entry.answers = call.group(1), tuple(call.group(2).split(", "))
    return cells


def _block(entry, token, line):
    language, _, kind = token.info.strip().partition(" ")
    if language != "python":
        return
    if kind == "check":
        entry.check, entry.check_line = token.content, line
    elif kind:
        entry.blocks[kind] = token.content
    elif entry.solution:
        raise entry.error(
            line, "a second solution: what is this block? `python check`, or `python` and a mistake's name"
        )
    else:
        entry.solution = token.content


def _row(entry, cells, line):
    if cells == HEADER:
        return
    if len(cells) != 3 or not all(cells[::2]):
        raise entry.error(line, f"a row should hold {' | '.join(HEADER)}")
    entry.mistakes.append(Mistake(*cells, line))


def _complete(entry):
    if not entry.name:
        raise entry.error(entry.line, f"the call is missing, such as `checks.name(my_name)`, for {entry.number}")
    for part, what in ((entry.hints, "hints"), (entry.solution, "the solution")):
        if not part:
            raise entry.error(entry.line, f"{what} of {entry.number} are missing")
    names = {}
    for mistake in entry.mistakes:
        if names.setdefault(mistake.name, mistake.hint) != mistake.hint:
            raise entry.error(mistake.line, f"{mistake.name!r} has another hint above: one name, one hint")
    for name in entry.blocks:
        if name not in names:
            raise entry.error(entry.line, f"the block `python {name}` of {entry.number} has no row in the table")
    if "def " in entry.solution:
        for mistake in entry.mistakes:
            entry.changed(mistake)


def own_module(path):
    """The Python beside a page, or None."""
    if not path.with_suffix(".py").exists():
        return None
    return importlib.import_module(f"hoverslam_lib.checks.{path.stem}")
