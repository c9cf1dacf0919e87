"""How an answer is judged by the solution: both do the same cases, and so do the mistakes if the answer is wrong."""

import inspect
import re
import time
from dataclasses import dataclass

import numpy as np

from hoverslam_lib.checks.answers import digits, distance, number, repeatable, shaped_like, takes
from hoverslam_lib.checks.feedback import TIME_LIMIT, Open, Wrong, guarded


@dataclass(frozen=True)
class Value:
    """One of the numbers that an exercise asks for.

    Parameters
    ----------
    where : str
        What is asked, for the student: "for the longest step".
    rtol, atol : float
        An answer is right that is so near.
    right : float, optional
        If it is not the number in the solution, because that one is read off a figure.
    near : float
        A mistake is recognised within this share of the tolerance; the nearest is named. 1 suits what is read off a
        figure.
    """

    where: str
    rtol: float = 0.0
    atol: float = 1e-9
    right: float | None = None
    near: float = 0.2


class Numbers:
    """Judge numbers: ``values`` by the name of the answer, ``mistakes`` as (name, {answer: what it leads to})."""

    takes_open = True

    def __init__(self, values, mistakes):
        self.values, self.mistakes, self.tests = values, mistakes, len(values)

    def __call__(self, answers):
        given = dict(zip(self.values, answers, strict=True))
        passed = 0

        def work():
            nonlocal passed
            got = {name: number(answer, name) for name, answer in given.items() if answer is not ...}
            for name in got:
                self._judge(name, got)
                passed += 1
            if len(got) < len(given):
                raise Open()

        _, wrong = guarded(work, TIME_LIMIT)
        return passed, wrong

    def _off(self, name, a, b):
        return distance(a, b, self.values[name].rtol, self.values[name].atol)

    def _share(self, name, got, wrong):
        """At most 1 if that is what the mistake leads to, as it comes or as people round it."""
        figures = len(re.sub(r"e.*|\D", "", f"{got:.15g}").strip("0")) if got % 1 else len(f"{abs(got):.0f}")
        share = self._off(name, got, wrong) / self.values[name].near
        return min(share, 1.0) if figures > 1 and float(f"{wrong:.{figures}g}") == got else share

    def _judge(self, name, got):
        value, off = self.values[name], self._off(name, got[name], self.values[name].right)
        if off <= 1:
            return
        found = []
        for mistake, leads_to in self.mistakes:
            if name in leads_to and set(leads_to) <= set(got) and self._off(name, leads_to[name], value.right) > 1:
                found.append((max(self._share(other, got[other], wrong) for other, wrong in leads_to.items()), mistake))
        share, mistake = min(found, key=lambda pair: pair[0], default=(np.inf, None))
        if share <= 1:
            raise Wrong(mistake=mistake, about=name)
        if value.rtol and off <= min(5, 0.3 / value.rtol):  # 60 % off is not near
            raise Wrong(
                f"Near {value.where}, but more than {100 * value.rtol:g} % off: have you rounded on the way?",
                nudge=True,
                about=name,
            )
        raise Wrong(f"Not right {value.where}: you have {digits(got[name])}.", nudge=True, about=name)


class Cases:
    """Judge a function by what it makes of some cases.

    Parameters
    ----------
    solution : function
    mistakes : list of (str, function)
    cases : sequence
        Each the arguments of a call, or a function ``probe(answer)`` that makes of the answer what is to be compared;
        its docstring says ``where``.
    where : str
        For the student, with the arguments in braces: "for dt = {dt:g} s".
    names : tuple of str
        Of the two results, if there are two.
    """

    takes_open = False

    def __init__(self, solution, mistakes, cases, where="", *, rtol=1e-9, atol=1e-12, names=("h", "v")):
        self.cases, self.where, self.rtol, self.atol, self.names = cases, where, rtol, atol, names
        self.parameters, self.tests = list(inspect.signature(solution).parameters), len(cases)
        self.near = 1 if rtol <= 1e-6 else 0.2
        self.right = [self._outcome(solution, case) for case in cases]
        self.mistakes = [(name, function, {}) for name, function in mistakes]

    def __call__(self, answers):
        (answer,) = answers
        start, found = time.monotonic(), []

        def work():
            takes(answer, *self.parameters)
            for case, right in zip(self.cases, self.right, strict=True):
                found.append(self._outcome(answer, case))
                if not self._fits(found[-1], right):
                    return

        _, wrong = guarded(work, TIME_LIMIT)
        if wrong is None and self._fits(found[-1], self.right[len(found) - 1]):
            return len(found), None
        passed = max(len(found) - (wrong is None), 0)
        if wrong is None:
            name, _ = guarded(
                lambda: self._mistake(answer, passed, found[-1]), max(start + TIME_LIMIT - time.monotonic(), 0.1)
            )
            _, wrong = (None, Wrong(mistake=name)) if name else guarded(lambda: self._say(found), TIME_LIMIT)
        return passed, wrong

    def _outcome(self, function, case):
        """What comes out: a result, or the Exception that is raised."""
        try:
            return case(function) if callable(case) else repeatable(function, *case)
        except Wrong:
            raise
        except Exception as error:
            return error

    def _fits(self, got, right):
        if isinstance(right, Exception):
            return isinstance(got, type(right))
        return distance(got, right, self.rtol, self.atol) <= 1

    def _mistake(self, answer, first, got):
        """The name of the mistake that does just the same, from the `first` case on that is not right."""
        found, near = {first: got}, []
        for mistake in self.mistakes:
            wrong = self._by(mistake, first)
            off = distance(found[first], wrong, self.rtol, self.atol)
            if off <= self.near and not self._fits(wrong, self.right[first]):
                near.append((off, mistake))
        for _, mistake in sorted(near, key=lambda pair: pair[0]):
            if all(self._alike(answer, found, mistake, i) for i in range(len(self.cases))):
                return mistake[0]
        return None

    def _alike(self, answer, found, mistake, i):
        wrong = self._by(mistake, i)
        if self._fits(wrong, self.right[i]):
            return True  # here it cannot be told from the right one
        if i not in found:
            found[i] = self._outcome(answer, self.cases[i])
        return distance(found[i], wrong, self.rtol, self.atol) <= self.near

    def _by(self, mistake, i):
        _, function, known = mistake
        if i not in known:
            try:
                known[i] = self._outcome(function, self.cases[i])
            except Wrong as wrong:
                known[i] = wrong
        return known[i]

    def _say(self, found):
        got, right, case = found[-1], self.right[len(found) - 1], self.cases[len(found) - 1]
        if isinstance(got, Exception):
            raise got
        if callable(case):
            where = " ".join((case.__doc__ or "").split())
        else:
            where = self.where.format(**dict(zip(self.parameters, case, strict=True)))
        if isinstance(right, Exception):
            raise Wrong(
                f"Not right {where}: it should raise {type(right).__name__}, and gives {digits(got)}.", nudge=True
            )
        try:
            shaped_like(got, right, self.names)
        except Wrong as wrong:
            raise Wrong(f"{wrong.what} That is {where}.") from None
        if distance(got, right, 1e-4, self.atol) <= 1:
            raise Wrong(
                f"Near {where}, but not to nine digits: is something approximated there, or rounded?", nudge=True
            )
        raise Wrong(f"Not right {where}: it gives {digits(got)}.", nudge=True)
