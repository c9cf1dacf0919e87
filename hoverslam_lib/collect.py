"""Returned copies, judged anew: ``python -m hoverslam_lib.course collect FOLDER`` makes two tables of them.

Each notebook runs from its top, cell by cell, in a process of its own, with so much time and memory and no more; there
our own checks judge whatever bears the names of the answers. What a returned notebook says of itself, by its stored
outputs or its own calls of checks, is not asked. This runs the students' code.
"""

import contextlib
import csv
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import unicodedata
import zipfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from hoverslam_lib import checks
from hoverslam_lib.checks.stopping import TimeIsUp, limited

TABLES = ("exercises.csv", "predictions.csv")
CELL_LIMIT = 60.0
"""A cell may take so long [s]; those after it run all the same."""
NOTEBOOK_LIMIT = 300.0
"""A notebook may take so long [s]; what was judged by then counts."""
MEMORY_LIMIT = 4 * 1024**3
"""A notebook may have so much memory [bytes], where the system knows how to say so."""
LARGEST = 50_000_000
"""A file of more bytes is not read."""
AT_ONCE = 2
"""So many students are judged at the same time."""
RANK = "–○✘✔"
"""Marks: could not be judged, not attempted, wrong, right. Of several answers to an exercise the best one counts."""


class Cell(NamedTuple):
    """A cell of a notebook, as far as it is asked here."""

    kind: str
    source: str
    tags: tuple


@dataclass(frozen=True)
class Lesson:
    """What a returned notebook is held against: `stubs` are the cells of the exercises as they were handed out."""

    number: int
    stem: str
    title: str
    exercises: tuple
    stubs: frozenset
    questions: tuple


@dataclass
class Returned:
    """What came out for a student: marks by number of the exercise, texts by (lesson, question), remarks."""

    student: str
    marks: dict = field(default_factory=dict)
    predictions: dict = field(default_factory=dict)
    remarks: list = field(default_factory=list)

    def add(self, number, mark):
        """Take a mark, such as "✘ 1 of 4", unless there is a better one."""
        if RANK.index(mark[0]) >= RANK.index(self.marks.get(number, "–")[0]):
            self.marks[number] = mark

    def count(self, mark):
        return sum(found[0] == mark for found in self.marks.values())


def returned(folder):
    """What was returned, a folder or a zip a student, by the students' names: all but what is hidden and our tables.

    Raises
    ------
    ValueError
        If there is nothing.
    """
    there = folder.iterdir() if folder.is_dir() else ()
    entries = [entry for entry in there if _shown(entry.name) and entry.name not in TABLES]
    if not entries:
        raise ValueError(f"{folder} holds no returned copies: name a folder that has a folder or a zip a student")
    return sorted(entries, key=lambda entry: student_of(entry).casefold())


def collect(folder, paths, asked=None, *, cell_limit=CELL_LIMIT, notebook_limit=NOTEBOOK_LIMIT):
    """Judge what was `returned` in a folder, and write the `TABLES` into it, anew after each student.

    Parameters
    ----------
    folder : Path
    paths : list of Path
        The lessons of the course.
    asked : list of Path, optional
        Those of them that are judged; all if left out.
    cell_limit, notebook_limit : float, optional
        See `CELL_LIMIT` and `NOTEBOOK_LIMIT` [s].

    Yields
    ------
    Returned
        One a student, in the order of `returned`.

    Raises
    ------
    ValueError
        If nothing was returned.
    OSError
        If the tables cannot be written.
    """
    lessons = {path: read_lesson(path) for path in paths}
    wanted = [lessons[path] for path in asked or paths]
    done, pool = [], ThreadPoolExecutor(AT_ONCE)

    def judge_one(entry):
        return judge(entry, lessons.values(), wanted, cell_limit, notebook_limit)

    try:
        for result in pool.map(judge_one, returned(folder)):
            done.append(result)
            _write(folder / TABLES[0], _exercise_rows(done, wanted))
            _write(folder / TABLES[1], _prediction_rows(done, wanted))
            yield result
    finally:
        pool.shutdown(cancel_futures=True)


# ---- reading


def read_lesson(path):
    """The `Lesson` at a path."""
    cells = _cells(path.read_text(encoding="utf-8"))
    number = int(path.name[:2])
    own = tuple(e for e in checks.EXERCISES.values() if e.number.startswith(f"{number}."))
    stubs = frozenset(cell.source for cell in cells if cell.kind == "code" and _named(own, cell.source))
    asking = (cell.source for cell in cells if _asks(cell))
    questions = tuple(" ".join(source.strip().split("\n\n")[-1].split()) for source in asking)
    return Lesson(number, path.stem, _title(cells), own, stubs, questions)


def _cells(text):
    cells = [(cell["cell_type"], cell["source"], cell.get("metadata", {})) for cell in json.loads(text)["cells"]]
    return [Cell(kind, "".join(source), tuple(about.get("tags", ()))) for kind, source, about in cells]


def _asks(cell):
    return cell.kind == "markdown" and "**Predict" in cell.source


def _title(cells):
    return cells[0].source.partition("\n")[0].strip() if cells else ""


def _named(exercises, source):
    """Numbers of the exercises one of whose answers is named in a piece of code."""
    return {e.number for e in exercises if re.search(rf"\b({'|'.join(e.answers)})\b", source)}


def student_of(entry):
    """The name of a folder, or of a zip without its ending; the same letters from every system."""
    return unicodedata.normalize("NFC", entry.name if entry.is_dir() else re.sub(r"(?i)\.zip$", "", entry.name))


def _shown(*names):
    return not any(name.startswith((".", "__MACOSX")) for name in names)


def _files(entry):
    """Path, size and function that reads of each notebook in a folder or a zip, but for what is hidden."""
    if entry.is_dir():
        found = {path.relative_to(entry): path for path in sorted(entry.rglob("*.ipynb"))}
        return [(place, path.stat().st_size, path.read_bytes) for place, path in found.items() if path.is_file()]
    if not zipfile.is_zipfile(entry):
        raise ValueError("a zip that cannot be read" if entry.suffix.lower() == ".zip" else "no folder and no zip")
    packed = zipfile.ZipFile(entry)
    found = {Path(member.filename): member for member in packed.infolist() if member.filename.endswith(".ipynb")}
    return [
        (place, member.file_size, lambda member=member: packed.read(member)) for place, member in sorted(found.items())
    ]


def _lesson_of(place, cells, lessons):
    """The lesson that a notebook is, by its title, or by its name if one of the exercises is in it; else None."""
    code = "\n".join(cell.source for cell in cells if cell.kind == "code")
    for lesson in lessons:
        if _title(cells) == lesson.title or (lesson.stem in place.name and _named(lesson.exercises, code)):
            return lesson
    return None


def predictions(cells):
    """What is written in the cells tagged `prediction`, by the number of the question, counted from 0."""
    asked, found = -1, {}
    for cell in cells:
        if "prediction" in cell.tags:
            text = re.sub(r"^\*?I expect:", "", cell.source.strip()).strip(" *…\n")
            found[asked] = f"{found.get(asked, '')}\n{text}".strip()
        elif _asks(cell):
            asked += 1
    return found


# ---- judging


def judge(entry, lessons, asked, cell_limit=CELL_LIMIT, notebook_limit=NOTEBOOK_LIMIT):
    """What came out for one student, a `Returned`, whatever the folder or the zip at `entry` holds."""
    result, seen = Returned(student_of(entry)), set()
    try:
        files = [file for file in _files(entry) if _shown(*file[0].parts)]
    except Exception as error:  # a file can be broken in every way
        files, said = [], str(error) if type(error) is ValueError else type(error).__name__
        result.remarks.append(f"cannot be read: {said}")
    for place, size, read in files:
        try:
            if size > LARGEST:
                raise ValueError(f"{size:,} bytes")
            cells = _cells(read().decode("utf-8-sig"))
        except Exception as error:
            result.remarks.append(f"{place.name} cannot be read ({type(error).__name__})")
            continue
        lesson = _lesson_of(place, cells, lessons)
        if lesson is None:
            result.remarks.append(f"{place.name} is no lesson of the course")
        elif lesson in asked:
            seen.add(lesson)
            _judge_notebook(result, lesson, cells, cell_limit, notebook_limit)
    missing = [str(lesson.number) for lesson in asked if lesson not in seen]
    if missing:
        result.remarks.append(f"no notebook of lesson {', '.join(missing)}")
    return result


def _judge_notebook(result, lesson, cells, cell_limit, notebook_limit):
    for n, text in predictions(cells).items():
        result.predictions[lesson.number, n] = result.predictions.get((lesson.number, n)) or text
    code = [cell.source for cell in cells if cell.kind == "code"]
    touched = [n for n, source in enumerate(code) if source not in lesson.stubs and _named(lesson.exercises, source)]
    attempted = set().union(*(_named(lesson.exercises, code[n]) for n in touched))
    for exercise in lesson.exercises:
        result.add(exercise.number, "–" if exercise.number in attempted else "○")
    if not touched:
        return
    work = {"lesson": lesson.number, "code": code[: touched[-1] + 1], "cell_limit": cell_limit}
    told, end = _apart(work, notebook_limit)
    for number, mark, remark in told:
        result.add(number, mark)
        if remark:
            result.remarks.append(f"{number} {remark}")
    if end:
        result.remarks.append(f"lesson {lesson.number}: {end}")
    else:  # named, but never given anything
        for number in attempted:
            result.add(number, "○")


def _apart(work, seconds):
    """What `_work` tells in a process of its own, and why it ended before its time, or None."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as scratch:
        settings = {"MPLBACKEND": "agg", "OPENBLAS_NUM_THREADS": "1", "IPYTHONDIR": scratch, "PYTHONUTF8": "1"}
        settings["PYTHONPATH"] = str(Path(__file__).parent.parent)  # ours, and none that was returned
        process = subprocess.Popen(
            [sys.executable, "-m", "hoverslam_lib.collect"],
            cwd=scratch,
            env=os.environ | settings,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            encoding="utf-8",
            start_new_session=True,
        )
        end = None
        try:
            out, _ = process.communicate(json.dumps(work), timeout=seconds)
        except subprocess.TimeoutExpired:
            end = f"stopped after {seconds:g} s"
            _kill(process)
            out, _ = process.communicate()
        _kill(process)  # what it may have started
    told = [json.loads(line) for line in out.splitlines()]
    if told[-1:] != [END]:
        return told, end or f"its Python ended with status {process.returncode}"
    return told[:-1], None


def _kill(process):
    with contextlib.suppress(OSError):  # it has ended
        if os.name == "posix":
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()


END = ["end"]
"""The last that a process tells."""


def _work():
    """In a process of its own: run the code on standard input cell by cell, and tell the verdicts line by line."""
    from IPython.core.interactiveshell import InteractiveShell
    from traitlets.config import Config

    work = json.load(sys.stdin)
    told = os.fdopen(os.dup(1), "w", encoding="utf-8", buffering=1)
    nowhere = os.open(os.devnull, os.O_RDWR)
    for stream in range(3):  # a notebook is not heard, and hears nothing
        os.dup2(nowhere, stream)
    _limit_memory()
    exercises = [e for e in checks.EXERCISES.values() if e.number.startswith(f"{work['lesson']}.")]
    for exercise in exercises:
        exercise.judge  # noqa: B018 - made before anybody else's code has run
        setattr(checks, exercise.name, lambda *answers, **named: None)  # the notebook's own calls say nothing
    shell = InteractiveShell.instance(config=Config(HistoryManager={"enabled": False}))
    with shell.builtin_trap:
        for source in work["code"]:
            for verdict in _after(source, shell, exercises, work["cell_limit"]):
                print(json.dumps(verdict), file=told)
    print(json.dumps(END), file=told, flush=True)
    os._exit(0)  # whatever threads there are


def _limit_memory():
    with contextlib.suppress(ImportError, ValueError, OSError):  # Windows and macOS know no such limit
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY_LIMIT, MEMORY_LIMIT))


def _after(source, shell, exercises, cell_limit):
    """Run a cell, and yield number, mark and remark of the exercises to which it gives an answer."""
    names = shell.user_ns
    before = [[names.get(name, ...) for name in exercise.answers] for exercise in exercises]
    raised = None
    try:
        code = shell.transform_cell(source)
        compiled = compile(code, shell.compile.cache(code), "exec")
        limited(lambda: exec(compiled, names), cell_limit)
    except TimeIsUp:
        raised = f"stopped after {cell_limit:g} s"
    except BaseException as error:
        raised = f"raised {type(error).__name__}"
    for exercise, was in zip(exercises, before, strict=True):
        now = [names.get(name, ...) for name in exercise.answers]
        if any(one is not other for one, other in zip(was, now, strict=True)):
            said = exercise(*now)
            mark = said.text.partition(" — ")[0]
            told = "○" if mark.startswith("○ n") else "✔" if said.done else mark
            yield exercise.number, told, f"“{said.mistake}”" if said.mistake else ""
        elif raised and exercise.number in _named([exercise], source):
            yield exercise.number, "✘", raised


# ---- tables


def _exercise_rows(done, asked):
    numbers = [exercise.number for lesson in asked for exercise in lesson.exercises]
    yield ["student", "✔", "✘", "○", *numbers, "remarks, and mistakes that were recognised"]
    for result in done:
        marks = [result.marks.get(number, "–") for number in numbers]
        yield [result.student, *map(result.count, "✔✘○"), *marks, "; ".join(dict.fromkeys(result.remarks))]
    right = [sum(result.marks.get(number) == "✔" for result in done) for number in numbers]
    yield [f"✔ among {len(done)}", sum(right), "", "", *right, ""]


def _prediction_rows(done, asked):
    places = [(lesson.number, n) for lesson in asked for n in range(len(lesson.questions))]
    questions = [f"lesson {lesson.number}: {question}" for lesson in asked for question in lesson.questions]
    yield ["student", *questions]
    for result in done:
        yield [result.student, *(result.predictions.get(place, "") for place in places)]


def _write(path, rows):
    """As UTF-8 with its mark, which spreadsheets look for; no text is taken for a formula there."""
    with path.open("w", encoding="utf-8-sig", newline="", errors="backslashreplace") as file:
        for row in rows:
            csv.writer(file).writerow([f"'{cell}" if re.match(r"[=+@-]", str(cell)) else cell for cell in row])


if __name__ == "__main__":
    _work()
