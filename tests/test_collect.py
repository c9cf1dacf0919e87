"""Returned copies: twelve students, and what becomes of each in the two tables."""

import contextlib
import csv
import os
import re
import time
import unicodedata
import zipfile
from pathlib import Path

import nbformat
import psutil
import pytest

from hoverslam_lib import checks, collect, course

LESSONS = [path for path in course.lessons() if re.match(r"\d", path.name)]
FIRST, SECOND = LESSONS[0], LESSONS[2]
ADDED_UP = "def my_energy_factor(omega, dt, n):\n    return 1 + n * omega**2 * dt**2"
NEVER_ENDS = """
checks.energy_factor(lambda omega, dt, n: 1)
while True:
    try:
        import time
        time.sleep(0.01)
    except BaseException:
        pass
my_energy_factor = 0
"""
PRINTS = """
print("x" * 1_000_000)
def my_energy_factor(omega, dt, n):
    print("x" * 1_000_000)
    return (1 + omega**2 * dt**2) ** n
"""
FORGES = """
from hoverslam_lib.checks.feedback import Feedback
checks.energy_factor = lambda answer: Feedback(4, 4)
def my_energy_factor(omega, dt, n):
    return 1.0
checks.energy_factor(my_energy_factor)
"""
LIBRARY = "raise RuntimeError('the library that a student returned')"


def notebook(path, answers=(), predictions=()):
    """A lesson with answers by number in place of its stubs; lesson 2 is cut to its title and what is asked."""
    lesson, answers, predictions = collect.read_lesson(path), dict(answers), dict(predictions)
    made, asked = nbformat.read(path, as_version=4), -1
    made.cells = [cell for n, cell in enumerate(made.cells) if path == FIRST or n == 0 or needed(cell, lesson)]
    made.cells.insert(1, nbformat.v4.new_code_cell("from hoverslam_lib import checks"))
    for cell in made.cells:
        if cell.source in lesson.stubs:
            (exercise,) = (e for e in lesson.exercises if f"checks.{e.name}(" in cell.source)
            cell.source = answers.get(exercise.number, cell.source)
        if "prediction" in cell.metadata.get("tags", []):
            asked += 1
            cell.source = predictions.get(asked, cell.source)
        if cell.cell_type == "code":
            cell.outputs = []
    return made


def needed(cell, lesson):
    return (
        "from hoverslam_lib import" in cell.source
        or cell.source in lesson.stubs
        or "**Predict" in cell.source
        or cell.metadata.get("tags") == ["prediction"]
    )


def right(number):
    return checks.EXERCISES[number].solution


def put(folder, *notebooks):
    folder.mkdir(parents=True)
    for path, made in zip((FIRST, SECOND), notebooks, strict=False):
        nbformat.write(made, folder / path.name)


ALL_RIGHT = {"2.1": right("2.1"), "2.2": right("2.2"), "2.3": right("2.3")}
FIRST_RIGHT = {"0.1": right("0.1")}


@pytest.fixture(scope="module")
def tables(tmp_path_factory):
    """The rows of both tables by student."""
    folder = tmp_path_factory.mktemp("returned")
    put(folder / "Ada", notebook(FIRST, FIRST_RIGHT), notebook(SECOND, ALL_RIGHT))
    written = {1: "*I expect: every step,\nthe same percentage*", 3: "=1+1", 6: "*I expect:*"}
    name = unicodedata.normalize("NFD", "Béla Groß")
    put(folder / name, notebook(FIRST), notebook(SECOND, {"2.1": ADDED_UP}, written))
    put(folder / "Never ends", notebook(FIRST), notebook(SECOND, ALL_RIGHT | {"2.1": NEVER_ENDS}))
    put(folder / "One missing", notebook(FIRST, FIRST_RIGHT))
    another = nbformat.v4.new_notebook(cells=[nbformat.v4.new_markdown_cell("# Biology")])
    put(folder / "Other course", another, another)
    put(folder / "Prints", notebook(FIRST), notebook(SECOND, ALL_RIGHT | {"2.1": PRINTS}))
    put(folder / "Untouched", notebook(FIRST), notebook(SECOND))
    with zipfile.ZipFile(folder / "Packed.zip", "w") as packed:
        packed.writestr(f"my_course/{SECOND.name}", nbformat.writes(notebook(SECOND, ALL_RIGHT)))
        packed.writestr(f"__MACOSX/my_course/._{SECOND.name}", b"\0\1")
        packed.writestr(f"my_course/.ipynb_checkpoints/{FIRST.name}", "torn")
    (folder / "Cut.zip").write_bytes((folder / "Packed.zip").read_bytes()[:3000])
    put(folder / "Torn", notebook(FIRST, FIRST_RIGHT), another)
    (folder / "Torn" / SECOND.name).write_text(nbformat.writes(notebook(SECOND))[:3000])
    forged = notebook(SECOND, {"2.1": FORGES, "2.2": "", "2.3": right("2.3")})
    forged.cells.insert(3, nbformat.v4.new_code_cell(right("2.2")))  # and its check is gone
    said = nbformat.v4.new_output("stream", text="✔ 4 of 4")
    next(cell for cell in forged.cells if cell.source == FORGES)["outputs"] = [said]
    put(folder / "Forger", notebook(FIRST), forged)
    for module in ("__init__", "checks", "collect"):
        (folder / "Forger" / "hoverslam_lib").mkdir(exist_ok=True)
        (folder / "Forger" / "hoverslam_lib" / f"{module}.py").write_text(LIBRARY)
    raising = notebook(SECOND, {"2.1": ADDED_UP, "2.2": right("2.2"), "2.3": "my_extrapolation = no_such_name"})
    raising.cells.insert(1, nbformat.v4.new_code_cell("import no_such_module"))
    put(folder / "Raises", notebook(FIRST), raising)
    ending = {"0.1": right("0.1") + "\nmy_energy_factor = 1\nimport os\nos._exit(3)"}
    put(folder / "Ends Python", notebook(FIRST, ending), notebook(SECOND))
    (folder / "Rar.rar").write_bytes(b"Rar!")
    done = list(collect.collect(folder, LESSONS, [FIRST, SECOND], cell_limit=5, notebook_limit=120))
    assert [result.student for result in done] == sorted((r.student for r in done), key=str.casefold)
    return [{row.pop("student"): row for row in read(folder / name)} for name in collect.TABLES]


def read(path):
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


BOTH = "no notebook of lesson 0, 2"
EXPECTED = {
    "Ada": ("✔ ✔ ✔ ✔", ""),
    "Béla Groß": ("○ ✘ 0 of 4 ○ ○", "2.1 “added up”"),
    "Never ends": ("○ ✘ ✔ ✔", "2.1 stopped after 5 s"),
    "One missing": ("✔ – – –", "no notebook of lesson 2"),
    "Other course": ("– – – –", f"{{}} is no lesson of the course; {{}} is no lesson of the course; {BOTH}"),
    "Prints": ("○ ✔ ✔ ✔", ""),
    "Untouched": ("○ ○ ○ ○", ""),
    "Packed": ("– ✔ ✔ ✔", "no notebook of lesson 0"),
    "Cut": ("– – – –", f"cannot be read: a zip that cannot be read; {BOTH}"),
    "Torn": ("✔ – – –", "{1} cannot be read (JSONDecodeError); no notebook of lesson 2"),
    "Forger": ("○ ✘ 0 of 4 ✔ ✔", ""),
    "Raises": ("○ ✘ 0 of 4 ✔ ✘", "2.1 “added up”; 2.3 raised NameError"),
    "Ends Python": ("– ○ ○ ○", "lesson 0: its Python ended with status 3"),
    "Rar.rar": ("– – – –", f"cannot be read: no folder and no zip; {BOTH}"),
}


def test_every_copy_has_a_row_and_none_stops_the_others(tables):
    assert list(tables[0])[:-1] == sorted(EXPECTED, key=str.casefold)
    assert list(tables[1]) == sorted(EXPECTED, key=str.casefold)


@pytest.mark.parametrize("student", EXPECTED)
def test_answers_are_judged_anew(tables, student):
    row = dict(tables[0][student])
    marks, remarks = EXPECTED[student]
    found = " ".join(row[number] for number in ("0.1", "2.1", "2.2", "2.3"))
    assert (found, row.popitem()[1]) == (marks, remarks.format(FIRST.name, SECOND.name))
    assert [int(row[mark]) for mark in "✔✘○"] == [marks.count(mark) for mark in "✔✘○"]


def test_last_row_counts_right_answers(tables):
    row = tables[0][f"✔ among {len(EXPECTED)}"]
    columns = zip(*(re.findall("[✔✘○–]", marks) for marks, _ in EXPECTED.values()), strict=True)
    assert [int(row[number]) for number in ("0.1", "2.1", "2.2", "2.3")] == [column.count("✔") for column in columns]
    assert int(row["✔"]) == sum(marks.count("✔") for marks, _ in EXPECTED.values())


def test_predictions_stand_side_by_side_as_they_were_written(tables):
    asked = collect.read_lesson(SECOND).questions
    assert len(asked) == 7
    row = tables[1]["Béla Groß"]
    assert row[f"lesson 2: {asked[1]}"] == "every step,\nthe same percentage"
    assert row[f"lesson 2: {asked[3]}"] == "'=1+1", "a spreadsheet is not to take it for a formula"
    assert [text for text in row.values() if text] == [row[f"lesson 2: {asked[n]}"] for n in (1, 3)]
    assert set(tables[1]["Ada"].values()) == {""}


def test_notebook_that_stops_at_nothing_is_stopped_and_what_was_judged_before_counts():
    deaf = "import signal, time\nsignal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGALRM})\nwhile True: time.sleep(1)"
    work = {"lesson": 2, "code": [right("2.1"), deaf, right("2.2")], "cell_limit": 60}
    assert collect._apart(work, 12) == ([["2.1", "✔", ""]], "stopped after 12 s")


def test_better_of_two_answers_counts_wherever_it_stands(tmp_path):
    put(tmp_path / "Ada", notebook(FIRST), notebook(SECOND, {"2.1": ADDED_UP}))
    fresh = notebook(SECOND, {"2.1": right("2.1")}, {0: "*I expect: h_0*"})
    fresh.cells.append(nbformat.v4.new_code_cell("my_energy_factor = 1"))
    nbformat.write(fresh, tmp_path / "Ada" / f"{SECOND.stem}_fresh_2.ipynb")
    result = collect.judge(tmp_path / "Ada", *[[collect.read_lesson(SECOND)]] * 2)
    assert result.marks["2.1"] == "✔"
    assert result.predictions[2, 0] == "h_0"


@pytest.mark.parametrize("text", ["", "{}", "[]", '{"cells": 3}', '{"cells": [{}]}', "[" * 100_000, "\0"])
def test_notebook_broken_in_any_way_is_a_remark(tmp_path, text):
    (tmp_path / "Ada").mkdir()
    (tmp_path / "Ada" / SECOND.name).write_text(text)
    result = collect.judge(tmp_path / "Ada", *[[collect.read_lesson(SECOND)]] * 2)
    assert result.marks == {}
    assert re.fullmatch(rf"{SECOND.name} cannot be read \(\w+\)", result.remarks[0])


def test_command_tells_how_far_it_is_and_where_the_tables_are(tmp_path, capsys):
    put(tmp_path / "Ada", notebook(FIRST, {"0.1": right("0.1")}))
    (tmp_path / ".DS_Store").write_text("")
    for name in collect.TABLES:  # of an earlier time
        (tmp_path / name).write_text("")
    assert course.main(["collect", str(tmp_path), "0"]) == 0
    said = capsys.readouterr().out
    assert re.match(r"\[1/1\] Ada: 1 ✔, 0 ✘, 0 ○ \(\d+ s\)\n", said)
    assert said.splitlines()[-1] == f"wrote {tmp_path / 'exercises.csv'} and {tmp_path / 'predictions.csv'}"


@pytest.mark.parametrize("where", ["", "nowhere", "file"])
def test_folder_without_copies_is_a_sentence(tmp_path, capsys, where):
    (tmp_path / "file").write_text("")
    folder = tmp_path / where if where else tmp_path / "empty"
    (tmp_path / "empty").mkdir()
    assert course.main(["collect", str(folder)]) == 2
    assert re.fullmatch(r".* holds no returned copies: name .*\n", capsys.readouterr().err)


def test_lesson_is_known_by_its_title_or_by_its_name_if_one_of_its_exercises_is_in_it():
    lessons = [collect.read_lesson(path) for path in (FIRST, SECOND)]

    def lesson_of(name, *cells):
        return collect._lesson_of(Path(name), [collect.Cell(kind, source, ()) for kind, source in cells], lessons)

    renamed, answer = ("markdown", "# My own title"), "def my_energy_factor(omega, dt, n): ..."
    assert lesson_of("mine.ipynb", ("markdown", f"{lessons[1].title}\n\nwhat follows")) == lessons[1]
    assert lesson_of(f"{SECOND.stem} (1).ipynb", renamed, ("code", answer)) == lessons[1]
    assert lesson_of(f"{SECOND.stem} (1).ipynb", renamed, ("markdown", answer)) is None
    assert lesson_of("mine.ipynb", renamed, ("code", answer)) is None


@pytest.mark.skipif(os.name != "posix", reason="no groups of processes")
def test_what_a_notebook_has_started_ends_with_it(tmp_path):
    started = tmp_path / "started.txt"
    code = f"""import pathlib, subprocess
child = subprocess.Popen(["sleep", "600"])
pathlib.Path({str(started)!r}).write_text(str(child.pid))"""
    assert collect._apart({"lesson": 2, "code": [code], "cell_limit": 60}, 120) == ([], None)
    pid, end = int(started.read_text()), time.monotonic() + 10
    while time.monotonic() < end and running(pid):
        time.sleep(0.05)
    assert not running(pid)


def running(pid):
    """Whether a process is there, and no zombie."""
    with contextlib.suppress(psutil.NoSuchProcess):
        return psutil.Process(pid).status() != psutil.STATUS_ZOMBIE
    return False
