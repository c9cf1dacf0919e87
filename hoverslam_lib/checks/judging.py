"""How an answer is judged by the solution: both do the same cases, and so do the mistakes if the answer is wrong."""

import inspect
import re
from dataclasses import dataclass
from functools import cache, partial
from operator import itemgetter

import numpy as np

from hoverslam_lib.checks.answers import Words, array, digits, distance, number, numeric, pair, repeatable, takes
from hoverslam_lib.checks.feedback import Wrong, each, raised


@dataclass(frozen=True)
class Value:
    """One of the numbers that an exercise asks for, and how near an answer has to be."""

    where: str  # what is asked, for the student: "for the longest step"
    rtol: float = 0.0
    atol: float = 1e-9
    right: float | None = None  # if it is not the number in the solution, because that one is read off a figure
    near: float = 0.2  # a mistake is recognised within this share of the tolerance; 1 suits what is read off a figure


class Numbers:
    """Judge numbers: the `Value` and what is right by the name of the answer, the mistakes as (name, {answer: what it
    leads to}). An answer may be ``...``.
    """

    def __init__(self, values, right, mistakes):
        self.values, self.right, self.mistakes, self.tests = values, right, mistakes, len(values)

    def __call__(self, *answers):
        given = {name: answer for name, answer in zip(self.values, answers, strict=True) if answer is not ...}
        made = {name: numeric(answer) for name, answer in given.items()}
        got = {name: one.item() for name, one in made.items() if one is not None and one.size == 1}
        yield from each(partial(self._test, name, given[name], got) for name in given)

    def _test(self, name, answer, got):
        off = self._off(name, number(answer, name), self.right[name])
        if off > 1:
            raise self._wrong(name, got, off)

    def _off(self, name, a, b):
        return distance(a, b, self.values[name].rtol, self.values[name].atol)

    def _share(self, name, got, wrong):
        """At most 1 if that is what the mistake leads to, as it comes or as people round it."""
        figures = len(re.sub(r"e.*|\D", "", f"{got:.15g}").strip("0")) if got % 1 else len(f"{abs(got):.0f}")
        share = self._off(name, got, wrong) / self.values[name].near
        return min(share, 1.0) if figures > 1 and float(f"{wrong:.{figures}g}") == got else share

    def _wrong(self, name, got, off):
        found, value = [], self.values[name]
        for mistake, leads_to in self.mistakes:
            if name in leads_to and set(leads_to) <= set(got) and self._off(name, leads_to[name], self.right[name]) > 1:
                found.append((max(self._share(other, got[other], wrong) for other, wrong in leads_to.items()), mistake))
        share, mistake = min(found, key=itemgetter(0), default=(np.inf, None))
        if share <= 1:
            return Wrong(mistake=mistake, about=name)
        what = f"Not right {value.where}: you have {digits(got[name])}."
        if value.rtol and off <= min(5, 0.3 / value.rtol):  # 60 % off is not near
            what = f"Not right {value.where}: {digits(got[name])} is close, but not within {100 * value.rtol:g} %. "
            what += "Read or compute it more exactly."
        return Wrong(what, nudge=True, about=name)


class Cases:
    """Judge a function by what it makes of some cases.

    A case is the arguments of a call, told the student by `where` with their names in braces ("for dt = {dt:g} s"), or
    a function ``probe(answer)`` that makes of the answer what is to be compared; its docstring says where. If there
    are two results, `names` are theirs.
    """

    def __init__(self, solution, mistakes, cases, where="", *, rtol=1e-9, atol=1e-12, names=("h", "v")):
        self.cases, self.where, self.rtol, self.atol, self.names = cases, where, rtol, atol, names
        self.parameters, self.tests, self.mistakes = list(inspect.signature(solution).parameters), len(cases), mistakes
        self.near = 1 if rtol <= 1e-6 else 0.2
        self.right = [_outcome(solution, case) for case in cases]
        self.leads_to = cache(lambda mistake, i: _outcome(mistakes[mistake][1], cases[i]))

    def __call__(self, answer):
        takes(answer, *self.parameters)
        found = []
        for case, right in zip(self.cases, self.right, strict=True):
            got = _outcome(answer, case)
            found.append(got)
            if not self._fits(got, right):
                yield unlike(got, right, self.place(case), self.names, self.atol)
                self._recognise(answer, found)
                return
            yield

    def _fits(self, got, right):
        if isinstance(right, Exception):
            return isinstance(got, type(right))
        return distance(got, right, self.rtol, self.atol) <= 1

    def _recognise(self, answer, found):
        """Raise `Wrong` with the mistake that does just the same: in the last of the cases found, which it spoils, and
        in all others that it spoils.
        """

        def off(mistake, i):
            if self._fits(self.leads_to(mistake, i), self.right[i]):
                return 0.0  # here it cannot be told from the right one
            while len(found) <= i:
                found.append(_outcome(answer, self.cases[len(found)]))
            return distance(found[i], self.leads_to(mistake, i), self.rtol, self.atol)

        last, rows = len(found) - 1, range(len(self.mistakes))
        spoiling = [row for row in rows if not self._fits(self.leads_to(row, last), self.right[last])]
        for share, row in sorted((off(row, last), row) for row in spoiling):
            if share <= self.near and all(off(row, i) <= self.near for i in range(self.tests)):
                raise Wrong(mistake=self.mistakes[row][0])

    def place(self, case):
        """Which case that is, for the student."""
        if callable(case):
            return " ".join((case.__doc__ or "").split())
        return self.where.format(**dict(zip(self.parameters, case, strict=True)))


def _outcome(function, case):
    """What comes out: a result, or the Exception that is raised."""
    try:
        return case(function) if callable(case) else repeatable(function, *case)
    except Exception as error:
        return error


def unlike(got, right, where, names=("h", "v"), atol=0.0):
    """How a result that is not right differs from the right one, as a `Wrong`."""
    if isinstance(got, Wrong):
        raise got
    if isinstance(got, Exception):
        return Wrong(raised(got))
    if isinstance(right, Exception):
        return Wrong(f"Not right {where}: it should raise {type(right).__name__}, and gives {digits(got)}.", nudge=True)
    told = isinstance(got, Words)
    two = isinstance(right, tuple) and np.shape(right) == (2,) and not told
    try:  # of the kind of the right one
        if two:
            pair(got, names)
        elif numeric(right) is not None and not told:
            array(got, np.shape(right))
    except Wrong as wrong:
        return Wrong(f"{wrong.what} That is {where}.", nudge=wrong.nudge)
    if distance(got, right, 1e-4, atol) <= 1:
        return Wrong(f"Near {where}, but not to nine digits: is something approximated there, or rounded?", nudge=True)
    fitting = [distance(*both, 1e-8, atol) <= 1 for both in zip(got, right, strict=True)] if two else []
    half = "" if len({*fitting}) < 2 else f"; only the {'first' if fitting[0] else 'second'} of the two is right"
    return Wrong(f"Not right {where}: it gives {digits(got)}{half}.", nudge=True)
