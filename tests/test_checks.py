"""The exercises: right answers pass, wrong ones do not, and a hint names a mistake only if it was made."""

import ast
import contextlib
import importlib
import math
import os
import re
import shutil
import string
import subprocess
import sys
import threading
import time

import nbformat
import numpy as np
import pytest
from scipy.stats import binomtest

from hoverslam_lib import checks, course
from hoverslam_lib.checks import feedback, judging, lesson_13, pages, record, stopping
from hoverslam_lib.checks.answers import number as as_number
from hoverslam_lib.checks.answers import repeatable

OPEN = "○ not attempted yet"
LESSONS = [path for path in course.lessons() if re.match(r"\d", path.name)]
NUMBERS = list(checks.EXERCISES)


def answers(kind):
    """Every lesson's answers of a kind, each with the number of its exercise."""
    found = []
    for lesson in sorted({int(number.split(".")[0]) for number in NUMBERS} - {0}):
        listed = getattr(importlib.import_module(f"answers.lesson_{lesson:02}"), kind)
        for number, given in listed.items():
            for n, answer in enumerate(given):
                found.append(pytest.param(number, answer, id=f"{number}-{n}"))
    return found


def rows():
    """Every mistake of every table."""
    return [
        pytest.param(number, i, id=f"{number}-{mistake.name}")
        for number, exercise in checks.EXERCISES.items()
        for i, mistake in enumerate(exercise.mistakes)
    ]


def as_solved(number, row=None):
    """The answers of the solution, or with the mistake of a row of the table made in it."""
    exercise = checks.EXERCISES[number]
    judge, given = exercise.judge, exercise.run(exercise.solution, exercise.line)
    if row is not None:
        mistake = exercise.mistakes[row]
        if "->" in mistake.changes or mistake.name in exercise.blocks:
            given = exercise.run(exercise.changed(mistake), mistake.line)
        else:
            right = given | (judge.right if isinstance(judge, judging.Numbers) else {})
            given = right | exercise.assigned(mistake, right)
    return tuple(given[name] for name in exercise.answers)


def cells_of(path):
    """Number and source of every exercise cell, in order."""
    names = {check.name: number for number, check in checks.EXERCISES.items()}
    for cell in nbformat.read(path, as_version=4).cells:
        called = re.search(r"^checks\.(\w+)\(", cell.source, re.MULTILINE) if cell.cell_type == "code" else None
        if called and called.group(1) in names:
            yield names[called.group(1)], cell


def solutions(lesson):
    return {number: checks.show_solution(number).text for number in NUMBERS if number.split(".")[0] == str(lesson)}


@pytest.fixture(autouse=True)
def _folder(tmp_path, monkeypatch):
    """A student's folder, and no other; and time enough: how long a check takes is measured in a benchmark."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(feedback, "TIME_LIMIT", 60.0)
    monkeypatch.setattr(lesson_13.pilot_project, "seconds", 600.0)
    monkeypatch.setattr(record.platformdirs, "user_data_dir", lambda name: str(tmp_path / "user"))
    for exercise in [*checks.EXERCISES.values(), doubled]:
        exercise.tries.clear()


def given(answer):
    """An exercise may ask for several things."""
    return answer if isinstance(answer, tuple) else (answer,)


@pytest.mark.parametrize(("number", "case"), answers("WRONG"))
def test_wrong_answer_does_not_pass_and_only_its_own_mistake_is_named(number, case):
    answer, mistake = case
    said = checks.EXERCISES[number](*given(answer))
    assert not said.done
    assert said.mistake == mistake, said
    assert said.hint or not said.attempted
    assert record.done() == set()


@pytest.mark.parametrize(("number", "answer"), answers("RIGHT"))
def test_right_answer_written_differently_passes(number, answer):
    said = checks.EXERCISES[number](*given(answer))
    assert said.text.startswith(f"✔ {said.tests} of {said.tests}"), said
    assert record.done() == {number}


@pytest.mark.parametrize(("number", "row"), rows())
def test_mistake_of_the_table_is_recognised_as_itself(number, row):
    mistake = checks.EXERCISES[number].mistakes[row]
    said = checks.EXERCISES[number](*as_solved(number, row))
    assert not said.done
    assert said.mistake == mistake.name, said
    assert "{" not in said.hint


@pytest.mark.parametrize("number", NUMBERS)
def test_solution_of_the_page_passes(number):
    said = checks.EXERCISES[number](*as_solved(number))
    assert said.done, said
    assert said.text == f"✔ {said.tests} of {said.tests}" + f" — {checks.EXERCISES[number].closing}".removesuffix(" — ")


def test_every_exercise_has_mistakes_and_a_right_answer_of_another_kind():
    wrong = {number: len(exercise.mistakes) for number, exercise in checks.EXERCISES.items()}
    right = dict.fromkeys([number for number in NUMBERS if number != "0.1"], 0)
    for param in answers("WRONG"):
        wrong[param.values[0]] = wrong.get(param.values[0], 0) + 1
    for param in answers("RIGHT"):
        right[param.values[0]] += 1
    assert [number for number in NUMBERS if wrong.get(number, 0) < 4] == []
    assert [number for number, count in right.items() if count < 1] == []


PAGE = """# A lesson

## 2.1 · a trial

`checks.trial(my_trial)`

- one
- two

```python
def my_trial(x):
    return 2 * x
```

```python check
check((1.0,), (3.0,), where="for {x:g}")
```

| mistake | change | hint |
|---|---|---|
| tripled | `2 * -> 3 *` | You triple. |

> Done.
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("`2 * -> 3 *`", "`2 -> 3; x -> y`", r"line 21: 'x' stands 2 times in the solution"),
        ("`2 * -> 3 *`", "`4 * -> 3 *`", r"line 21: '4 \*' stands 0 times"),
        ("`2 * -> 3 *`", "`3`", r"line 21: '3' is no change"),
        ("| You triple. |", "|", r"line 21: a row should hold"),
        ("## 2.1 · a trial", "## a trial", r"line 3: a heading"),
        ("`checks.trial(my_trial)`", "", r"line 3: 2.1 lacks the call"),
        (
            "| You triple. |",
            "| You triple. |\n| tripled | `x -> 3 * x` | Other. |",
            r"line 22: 'tripled' has another hint",
        ),
        ("- one\n- two", "", r"line 3: 2.1 lacks hints"),
        ("```python check", "```python", r"line 15: a second solution"),
        ("> Done.", "```python doubled twice\nx\n```", r"line 3: the block `python doubled twice`"),
    ],
)
def test_malformed_page_says_in_which_line(tmp_path, old, new, expected):
    path = tmp_path / "lesson_02.md"
    assert old in PAGE
    path.write_text(PAGE.replace(old, new), encoding="utf-8")
    with pytest.raises(pages.PageError, match=f"lesson_02.md, {expected}"):
        pages.exercises(path)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("return 2 * x", "return 2 * x)", "line 3: SyntaxError"),
        ("check((1.0,)", "chek((1.0,)", "line 15: NameError"),
        ('check((1.0,), (3.0,), where="for {x:g}")', "", "line 15: one call of check"),
    ],
)
def test_page_whose_python_fails_says_in_which_line(tmp_path, old, new, expected):
    path = tmp_path / "lesson_02.md"
    path.write_text(PAGE.replace(old, new), encoding="utf-8")
    (exercise,) = pages.exercises(path)
    with pytest.raises(pages.PageError, match=f"lesson_02.md, {expected}"):
        exercise(lambda x: x)


def test_escaped_bar_and_a_change_that_takes_away_are_read(tmp_path):
    path = tmp_path / "lesson_02.md"
    page = PAGE.replace("return 2 * x", "return (2 | 2) * x").replace("`2 * -> 3 *`", r"`2 \| 2 -> 1 \| 2`; `* x ->`")
    path.write_text(page, encoding="utf-8")
    (exercise,) = pages.exercises(path)
    assert "return (1 | 2)\n" in exercise.changed(exercise.mistakes[0]).replace(" \n", "\n")
    assert exercise(lambda x: 3).mistake == "tripled"


def named(node):
    """Patterns of the names that ``mistake=…`` may be; none where it is no text but a name of Python."""
    if isinstance(node, ast.IfExp):
        return named(node.body) + named(node.orelse)
    parts = node.values if isinstance(node, ast.JoinedStr) else [node] if isinstance(node, ast.Constant) else []
    return (
        ["".join(re.escape(part.value) if isinstance(part, ast.Constant) else ".+" for part in parts)] if parts else []
    )


def named_beside(exercise):
    """The mistakes that the Python beside the page may name for this exercise: a pattern, and the values given."""
    path, asked = exercise.path.with_suffix(".py"), [exercise.name, *re.findall(r"\w+", exercise.check)]
    body = ast.parse(path.read_text(encoding="utf-8")).body if path.exists() else []
    functions = {node.name: node for node in body if isinstance(node, ast.FunctionDef)}
    while asked:
        for node in ast.walk(functions.pop(asked.pop(), ast.Pass())):
            if isinstance(node, ast.Name):
                asked.append(node.id)
            elif isinstance(node, ast.Call):
                keywords = {keyword.arg: keyword.value for keyword in node.keywords}
                yield from ((pattern, set(keywords)) for pattern in named(keywords.get("mistake")))


def test_mistake_that_a_judge_names_stands_in_the_table_and_gets_what_its_hint_tells():
    found = 0
    for number, exercise in checks.EXERCISES.items():
        for pattern, values in named_beside(exercise):
            hints = [mistake.hint for mistake in exercise.mistakes if re.fullmatch(pattern, mistake.name)]
            assert hints, f"{number}: no row for {pattern!r}"
            fields = {field for hint in hints for _, field, _, _ in string.Formatter().parse(hint) if field}
            assert fields <= values or None in values, f"{number}: {fields} of the hint for {pattern!r}"
            found += 1
    assert found, "nothing was read"


@pytest.mark.parametrize("number", NUMBERS)
def test_hint_and_place_of_every_case_can_be_told(number):
    exercise, judge = checks.EXERCISES[number], checks.EXERCISES[number].judge
    if isinstance(judge, judging.Cases | judging.Numbers):
        assert [mistake.hint.format() for mistake in exercise.mistakes] == [m.hint for m in exercise.mistakes]
    if isinstance(judge, judging.Cases):
        for case, right in zip(judge.cases, judge.right, strict=True):
            what = judging.unlike("nothing alike", right, judge.place(case)).what
            assert re.search(r"(That is|Not right) [^:.]", what), what
            assert "{" not in what


def test_every_lesson_after_the_first_has_three_exercises():
    expected = [f"{int(path.name[:2])}.{place}" for path in LESSONS[1:] for place in (1, 2, 3)]
    assert {"0.1", *expected} <= set(NUMBERS)
    assert sorted(NUMBERS, key=lambda number: tuple(map(int, number.split(".")))) == NUMBERS


@pytest.mark.parametrize("path", LESSONS, ids=lambda path: path.stem)
def test_stored_exercises_are_open_and_in_order(path):
    lesson = int(path.name[:2])
    found = list(cells_of(path))
    assert [number for number, _ in found] == [number for number in NUMBERS if number.split(".")[0] == str(lesson)]
    for number, cell in found:
        assert "your code here" in cell.source or "your answer here" in cell.source, number
        assert cell.outputs[-1].data["text/plain"] == OPEN
        assert OPEN in cell.outputs[-1].data["text/html"]


@pytest.mark.parametrize("path", LESSONS, ids=lambda path: path.stem)
def test_exercise_names_are_not_used_by_the_lesson(path):
    cells = [cell for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "code"]
    own = {cell.source for _, cell in cells_of(path)}
    rest = "\n".join(cell.source for cell in cells if cell.source not in own)
    for number, cell in cells_of(path):
        for name in re.findall(r"^(?:def )?(my_\w+)", cell.source, re.MULTILINE):
            assert not re.search(rf"\b{name}\b", rest), (number, name)


@pytest.mark.parametrize("number", NUMBERS)
def test_solutions_do_not_stand_in_a_check(number):
    """Neither its documentation nor anything it says shows a line of the solution."""
    check = checks.EXERCISES[number]
    lesson = int(number.split(".")[0])
    code = [line.split("#")[0].strip() for line in solutions(lesson)[number].splitlines()]
    telling = {line.removeprefix("return ") for line in code if len(line.removeprefix("return ")) > 12}
    said = [check.__doc__, repr(check), *check.hints, *(mistake.hint for mistake in check.mistakes)]
    said += [
        repr(check(*given(answer))) for _, (answer, _) in (p.values for p in answers("WRONG") if p.values[0] == number)
    ]
    for line in telling - {line for line in telling if line.startswith(("def ", "import ", "from "))}:
        assert not [text for text in said if line in text], line


# ---- whatever an answer does ----------------------------------------------------------------------------------------


HINTS = ["general", "more concrete", "most concrete"]


def check_of(judge):
    exercise = pages.Exercise(pages.Path("lesson_02.md"), 1, "2.1", "a trial", "trial", ("my_answer",), HINTS)
    exercise.judge, judge.tests = judge, 2
    return exercise


@check_of
def doubled(function):
    for x in (1.0, 3.0):
        got = as_number(repeatable(function, x))
        if got == x**2:
            raise feedback.Wrong("You square; you should double.", "squared")
        if got != 2 * x:
            raise feedback.Wrong(f"Not right for {x:g}: it gives {got:g}.", nudge=True)
        yield


def raises(x):
    raise ValueError("the message of the student")


def calls_itself(x):
    return calls_itself(x)


def never_ends(x):
    while True:
        pass


def never_ends_and_catches(x):
    while True:
        with contextlib.suppress(BaseException):
            x += 1


BEHAVIOUR = {
    "raises": (raises, r"raised ValueError: the message of the student in line \d+ of its cell"),
    "calls itself": (calls_itself, "calls itself"),
    "asks an array": (lambda x: x if np.array([x, 0.0]) > 0 else 0, r"one True or False, .* in line \d+ of its"),
    "leaves": (lambda x: sys.exit(3), "raised SystemExit"),
    "None": (lambda x: print(x), "return"),
    "a string": (lambda x: "2.0 m", "should be one number; it is '2.0 m'"),
    "a list": (lambda x: [x, x], "it holds 2 numbers"),
    "nan": (lambda x: math.nan, "nan"),
    "inf": (lambda x: math.inf, "inf"),
    "a complex number": (lambda x: 2j * x, "should be one number"),
    "itself": (lambda x: raises, "should be one number"),
    "too many arguments": (lambda x, y: x, "raised TypeError"),
    "not a function": (3.0, "raised TypeError"),
}


@pytest.mark.parametrize("behaviour", BEHAVIOUR)
def test_answer_may_do_what_it_likes(behaviour, capsys):
    function, expected = BEHAVIOUR[behaviour]
    said = doubled(function)
    assert re.search(expected, repr(said)), said
    assert repr(said).startswith("✘ 0 of 2 — ")
    assert "\n" not in repr(said)
    assert capsys.readouterr() == ("", "")


def catches_in_two_loops(x):
    while True:
        try:
            while True:
                try:
                    x += 1
                except BaseException:
                    continue
        except BaseException:
            continue


def sleeps_and_catches(x):
    while True:
        with contextlib.suppress(BaseException):
            time.sleep(60)


def computes_a_huge_power(x):
    return 9**9**8


ENDLESS = [never_ends, never_ends_and_catches, catches_in_two_loops, sleeps_and_catches, computes_a_huge_power]


@pytest.mark.skipif(not hasattr(stopping.signal, "setitimer"), reason="no timer of signals")
@pytest.mark.parametrize("function", ENDLESS)
def test_answer_that_never_ends_is_stopped(function, monkeypatch):
    _is_stopped(function, monkeypatch)


@pytest.mark.skipif(not hasattr(stopping.signal, "setitimer"), reason="no timer of signals")
def test_judge_may_have_a_time_limit_of_its_own():
    @check_of
    def patient(function):
        yield function(1.0)
        yield

    patient.judge.seconds = 0.3
    start = time.perf_counter()
    assert "was stopped after 0 s" in repr(patient(never_ends))
    assert time.perf_counter() - start < 3


def test_interval_of_a_count_is_that_of_scipy():
    for successes, n in ((0, 30), (1, 1), (49, 50), (189, 200)):
        interval = binomtest(successes, n).proportion_ci(method="wilson")
        assert lesson_13.wilson(successes, n) == pytest.approx(interval, abs=1e-12)
    assert lesson_13.ASKED == 189


@pytest.mark.parametrize("function", ENDLESS[:3])
def test_answer_that_never_ends_is_stopped_without_a_timer_of_signals(function, monkeypatch):
    monkeypatch.delattr(stopping.signal, "setitimer", raising=False)
    _is_stopped(function, monkeypatch)


def test_answer_that_ends_in_time_has_nothing_thrown_at_it(monkeypatch):
    """Nor taken back: after that, Python 3.12 runs by half slower (see tests/benchmarks/checks.py)."""
    thrown = []
    monkeypatch.setattr(stopping, "_throw", lambda *what: thrown.append(what))
    assert stopping.limited(lambda: 3.0, 60.0) == 3.0
    assert thrown == []


def _is_stopped(function, monkeypatch):
    monkeypatch.setattr(feedback, "TIME_LIMIT", 0.3)
    before = [stopping.signal.getsignal(number) for number in (stopping.signal.SIGINT, stopping.signal.SIGTERM)]
    threads, tracing, start = threading.active_count(), sys.gettrace(), time.perf_counter()
    assert "was stopped after" in repr(doubled(function))
    assert time.perf_counter() - start < 3
    time.sleep(3 * stopping.PAUSE)
    assert sys.gettrace() is tracing
    assert threading.active_count() == threads, "nothing goes on in the background"
    assert before == [stopping.signal.getsignal(number) for number in (stopping.signal.SIGINT, stopping.signal.SIGTERM)]
    assert doubled(lambda x: 2 * x).done


@pytest.mark.skipif(not hasattr(stopping.signal, "setitimer"), reason="needs a signal from outside")
def test_interrupt_stops_the_answer(tmp_path):
    code = (
        "import os, signal, threading, time\n"
        "from hoverslam_lib import checks\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"  # where a shell has it ignored
        "def endless(omega, dt, n):\n"
        "    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()\n"
        "    while True: pass\n"
        "try:\n    checks.energy_factor(endless)\n"
        "except KeyboardInterrupt:\n"
        "    start = time.process_time(); time.sleep(0.5)\n"
        "    print('stopped', time.process_time() - start < 0.1, threading.active_count())\n"
    )
    made = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert made.stdout == "stopped True 1\n", made.stderr


class Hostile:
    """Raises whatever it is asked."""

    def __getattr__(self, name):
        raise RuntimeError("no attributes here")

    def __repr__(self):
        raise RuntimeError("nothing to show")

    def __bool__(self):
        raise RuntimeError("neither true nor false")

    __eq__ = __len__ = __float__ = __array__ = __bool__


class Unspeakable(Exception):
    def __str__(self):
        raise RuntimeError("no text")


def raises_what_has_no_text(x):
    raise Unspeakable


def test_hostile_objects_leak_nothing(monkeypatch):
    def raises_a_long_text(x):
        raise ValueError("long\n" * 20_000)

    for number, check in checks.EXERCISES.items():
        answers = [Hostile() for _ in check.answers]
        assert check(*answers).text.startswith("✘"), number
    for answer in (Hostile(), lambda x: Hostile(), raises_what_has_no_text, raises_a_long_text):
        said = doubled(answer).text
        assert said.startswith("✘ 0 of 2 — ")
        assert "\n" not in said
        assert len(said) < 250
    assert "Unspeakable in line" in doubled(raises_what_has_no_text).text


@pytest.mark.parametrize("of_library", [lambda x: np.linalg.inv(np.zeros((2, 2))), lambda x: os.makedirs(x)])
def test_line_of_an_error_is_the_students_own(of_library):
    assert f"in line {of_library.__code__.co_firstlineno} of its cell" in doubled(of_library).text


def test_line_of_a_page_is_not_the_students(tmp_path):
    path = tmp_path / "lesson_02.md"
    page = PAGE.replace('check((1.0,), (3.0,), where="for {x:g}")', "check(lambda my_trial: my_trial(1.0))")
    path.write_text(page, encoding="utf-8")
    (exercise,) = pages.exercises(path)
    assert re.search(r"raised TypeError: .* given\.$", exercise(lambda: 1).text)


def test_call_that_does_not_fit_says_how():
    for said in (checks.energy_factor(), checks.energy_factor(my_energy_factor=3), checks.mist(1.0)):
        assert "Please call it as in the lesson: checks." in said.text


def test_object_of_ones_own_counts_once():
    class Doubler:
        def __call__(self, x):
            return 7.0

    said = [doubled(Doubler()).text for _ in range(3)]
    assert [("general" in text) for text in said] == [True] * 3


def test_one_answer_of_several_is_judged_while_others_are_open():
    said = checks.mist(0.5, ...)
    assert said.text == "○ 1 of 2 — right so far; my_steps: not attempted yet"
    assert not said.done
    assert checks.mist(..., 6).mistake == "one step short"
    assert checks.mist(100.0, ...).mistake == "slowest droplet"
    assert checks.mist(..., ...).text == OPEN


def test_one_answer_of_several_does_not_spoil_the_score_of_the_others():
    for wrong in (None, "668", math.nan, 300.0):
        assert checks.terminal_predictions(wrong, 667.7, 11.64).passed == 2, wrong
        assert checks.terminal_predictions(279.3, wrong, 11.64).passed == 2, wrong
    assert checks.forged(None, 0.014).passed == checks.forged(0.016, "0.014").passed == 1
    assert "should be one number; it is None." in checks.forged(0.016, None).text
    assert checks.braking(15.9, 17).text.startswith(
        "✘ 1 of 2 — Not right by our ledger: 17 is close, but not within 15 %."
    )


def test_words_of_a_probe_are_not_called_a_wrong_number():
    for right, got in ((0.5, "None, no crash"), ((1.0, 2.0), "no end")):
        what = judging.unlike(judging.Words(got), right, "here").what
        assert what == f"Not right here: it gives {got}."
    assert "it is 'no end'" in judging.unlike("no end", 0.5, "here").what


def test_half_of_a_pair_that_is_right_is_told():
    assert "only the second of the two is right" in judging.unlike((3.0, 2.0), (1.0, 2.0), "here").what
    assert "only" not in judging.unlike((3.0, 3.0), (1.0, 2.0), "here").what


def test_mistake_that_never_ends_only_costs_its_time(tmp_path, monkeypatch):
    monkeypatch.setattr(feedback, "TIME_LIMIT", 0.3)
    path = tmp_path / "lesson_02.md"
    solution = "n = 0\n    while n < x:\n        n += 1\n    return 2 * n"
    page = PAGE.replace("return 2 * x", solution).replace("`2 * -> 3 *`", "`n += 1 -> n += 0`")
    path.write_text(page, encoding="utf-8")
    (exercise,) = pages.exercises(path)
    said = exercise(lambda x: 3 * x)
    assert said.mistake is None
    assert "Not right for 1: it gives 3. one" in said.text


def test_printing_answer_passes_without_a_word(capsys):
    assert doubled(lambda x: (print("debugging"), 2 * x)[1]).done
    assert capsys.readouterr().out == ""


def test_answer_that_changes_its_arguments_or_remembers_is_told():
    calls = []

    def grows(x):
        calls.append(x)
        return 2 * x + len(calls) - 1

    assert doubled(grows).mistake == "remembers its last call"

    @check_of
    def summed(function):
        assert repeatable(function, np.ones(3)) == 3.0
        yield
        yield

    def spoils(x):
        x[0] = 5
        return 3.0

    assert summed(spoils).mistake == "changes its arguments"


def test_hints_get_more_concrete_and_begin_again_after_success():
    said = [repr(doubled(answer)) for answer in (lambda x: 7.0, lambda x: 7.5, lambda x: 8.0, lambda x: 8.5)]
    assert [
        "general" in said[0],
        "more concrete" in said[1],
        "most concrete" in said[2],
        "most concrete" in said[3],
    ] == [True] * 4
    assert doubled(lambda x: 2 * x).done
    assert "general" in repr(doubled(lambda x: 7.0))
    assert "general" in repr(doubled(lambda x: 7.0)), "the same answer again earns no better hint"
    assert doubled(lambda x: x**2).mistake == "squared"
    assert "more concrete" in repr(doubled(lambda x: 9.0)), "a named mistake is not counted"


def test_named_mistake_gets_its_hint_and_no_other():
    said = doubled(lambda x: x**2)
    assert said.mistake == "squared"
    assert repr(said) == "✘ 0 of 2 — You square; you should double."
    assert doubled(lambda x: 2.0 if x == 1 else 9.0).passed == 1


def test_untouched_stubs_are_open():
    def dots(x): ...

    def described(x):
        """What to do."""
        ...  # your code here

    for answer in (dots, described, ...):
        assert repr(doubled(answer)) == OPEN

    def gives_none(x):
        y = 2 * x  # noqa: F841

    assert "return" in repr(doubled(gives_none))


def test_feedback_is_escaped_and_readable_without_colour():
    said = feedback.Feedback(0, 2, "is 1 < 2?")
    assert "1 &lt; 2" in said._repr_html_()
    assert "✘ 0 of 2" in said._repr_html_()
    assert "--jp-error-color1" in said._repr_html_()


# ---- the record ----------------------------------------------------------------------------------------------------


def test_progress_survives_a_restart_and_a_deleted_or_broken_record(tmp_path):
    record.add("2.1")
    record.add("2.3")
    assert record.done() == {"2.1", "2.3"}
    assert "✔ 2.1" in repr(checks.progress())
    assert "○ 2.2" in repr(checks.progress())
    shutil.rmtree(tmp_path / record.FOLDER)
    assert repr(checks.progress()).startswith("0 of ")
    (tmp_path / record.FOLDER).write_text("a file where the folder should be")
    record.add("2.2")
    assert record.done() == {"2.2"}, "kept where the system keeps a user's data"
    assert {path.name for path in tmp_path.iterdir()} == {record.FOLDER, "user"}, "nothing else is left behind"


OLD_RECORDS = {
    '{"done": ["2.1", "2.3"]}': {"2.1", "2.3"},
    '\ufeff{"done": ["2.1"]}': {"2.1"},
    '{"done": "1.1"}': set(),
    '{"done": [1, null, "2.2"]}': {"2.2"},
    **dict.fromkeys(("", "{", "[1, 2]", '{"done": 3}', "\x00"), set()),
}


@pytest.mark.parametrize("text", OLD_RECORDS)
def test_record_of_an_earlier_version_is_read_and_left_alone(text, tmp_path):
    path = (tmp_path / record.FOLDER).with_suffix(".json")
    path.write_text(text, encoding="utf-8")
    record.add("2.2")
    assert record.done() == OLD_RECORDS[text] | {"2.2"}
    assert path.read_text(encoding="utf-8") == text


def test_record_in_a_deleted_folder_raises_nothing(tmp_path, monkeypatch):
    (tmp_path / "gone").mkdir()
    monkeypatch.chdir(tmp_path / "gone")
    (tmp_path / "gone").rmdir()
    record.add("2.1")
    assert "✔ 2.1" in checks.progress().text
    assert "2.1" in checks.show_solution("2.9").text


def test_two_notebooks_at_once_lose_nothing(tmp_path):
    code = "import sys; from hoverslam_lib.checks import record; [record.add(f'{sys.argv[1]}.{i}') for i in range(200)]"
    both = [subprocess.Popen([sys.executable, "-c", code, name], cwd=tmp_path) for name in ("1", "2")]
    assert [process.wait() for process in both] == [0, 0]
    assert len(record.done()) == 400


def test_old_terminal_shows_what_it_can():
    code = (
        "from hoverslam_lib import checks; print(checks.progress(), checks.show_solution('2.1'), checks.mist(1, ...))"
    )
    made = subprocess.run(
        [sys.executable, "-X", "utf8=0", "-c", code],
        capture_output=True,
        env={**os.environ, "PYTHONIOENCODING": "cp1252"},
    )
    assert made.returncode == 0, made.stderr
    assert "o 2.1" in made.stdout.decode("cp1252")


def test_progress_is_kept_for_the_user_where_the_folder_cannot_be_written(tmp_path, monkeypatch):
    (tmp_path / "no").write_text("a file, so nothing can be made in it")
    monkeypatch.setattr(record, "_places", lambda: [tmp_path / "no" / "x", tmp_path / "user" / record.FOLDER])
    record.add("2.1")
    assert record.done() == {"2.1"}
    monkeypatch.setattr(record, "_places", lambda: [tmp_path / "no" / "x"])
    record.add("2.2")  # nowhere to write: nothing happens
    assert record.done() == set()


def test_solutions_can_be_shown_or_withheld(tmp_path):
    for number in NUMBERS:
        assert "my_" in repr(checks.show_solution(number)), number
    assert "there are 3.1, 3.2, 3.3." in repr(checks.show_solution("3.7"))
    assert "there are 0.1, 1.1" in repr(checks.show_solution(99))
    (tmp_path / checks.WITHHELD).touch()
    assert "ask your instructor" in repr(checks.show_solution("2.1"))
    assert "my_" not in repr(checks.show_solution("2.1"))
