"""What lets a novice follow a lesson: short cells, a place for each prediction, true times, known letters."""

import re
import statistics

import nbformat
import pytest

from hoverslam_lib import course

LESSONS = [path for path in course.lessons() if re.match(r"\d", path.name)]
each_lesson = pytest.mark.parametrize("path", LESSONS, ids=lambda path: path.stem)
TIME = r"\*\*Time\*\* (\d+) minutes(?:, (\d+) more for the exercises)?(?:, and (\d+) for the optional end)?\."


def cells(path, kind):
    return [cell for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == kind]


def lines(cell):
    return [line for line in cell.source.splitlines() if line.strip()]


def tags(cell):
    return cell.metadata.get("tags", [])


def time_of(path):
    """As the tables of the README and of lesson 0 give it: lesson + exercises (+ optional end)."""
    text = re.sub(r"\s+", " ", "\n".join(cell.source for cell in cells(path, "markdown")))
    lesson, exercises, optional = re.search(TIME, text).groups()
    return lesson + (f" + {exercises}" if exercises else "") + (f" (+ {optional})" if optional else "")


@each_lesson
def test_no_line_is_cut_on_a_projector_or_a_printed_page(path):
    assert [line for cell in cells(path, "code") for line in lines(cell) if len(line) > 100] == []


@each_lesson
def test_cells_hold_one_idea(path):
    code = cells(path, "code")
    assert statistics.median(len(lines(cell)) for cell in code) <= 8
    assert [cell.source for cell in code if len(lines(cell)) > 15] == []
    drawing = [cell for cell in code if re.search(r"plotting\.(show|figure)\(|\bLive\(", cell.source)]
    assert [cell.source for cell in drawing if len(lines(cell)) > 12] == []
    importing = [cell for cell in code if re.match(r"(import|from) ", lines(cell)[0])]
    assert [cell.source for cell in importing if sum("import " in line for line in lines(cell)) > 8] == []


@each_lesson
def test_every_prediction_has_a_place_to_write_it_and_a_later_answer(path):
    expects_answer = False
    wanted = 0
    for cell in nbformat.read(path, as_version=4).cells:
        if wanted:
            assert "prediction" in tags(cell), f"no cell for the prediction, but: {cell.source[:80]}"
            assert cell.cell_type == "markdown"
            assert cell.source.startswith("*I expect:"), cell.source
            assert not expects_answer, f"not answered before the next prediction: {cell.source[:80]}"
            expects_answer, wanted = True, 0
            continue
        assert "prediction" not in tags(cell), "a place for a prediction that nobody asks for"
        if "answer" in tags(cell):
            expects_answer = False
        if cell.cell_type == "markdown" and "**Predict" in cell.source:
            wanted = 1
            assert "**Predict" in cell.source.strip().split("\n\n")[-1], f"text after a prediction: {cell.source[-80:]}"
    assert not wanted
    assert not expects_answer


@each_lesson
def test_stated_times_are_the_same_everywhere(path):
    time = re.escape(time_of(path))
    readme = (course.NOTEBOOKS.parent / "README.md").read_text(encoding="utf-8")
    assert re.search(rf"\(notebooks/{path.name}\).*\| {time} \|", readme)
    guide = (course.NOTEBOOKS / "instructor_guide.md").read_text(encoding="utf-8")
    assert re.search(rf"^## {int(path.name[:2])} · .* \({time} minutes\)$", guide, re.MULTILINE)
    way_through = "\n".join(cell.source for cell in cells(LESSONS[0], "markdown"))
    if path != LESSONS[0]:
        assert re.search(rf"\({path.name}\).*\| {time} \|", way_through)


@each_lesson
def test_every_letter_of_its_tables_is_in_the_glossary(path):
    glossary = (course.NOTEBOOKS / "glossary.md").read_text(encoding="utf-8")
    known = letters(glossary.split("## Symbols")[1].split("## Words")[0])
    used = set()
    for cell in cells(path, "markdown"):
        for table in re.findall(r"^\| symbol \|.*\n(?:\|.*\n?)+", cell.source, re.MULTILINE):
            used |= letters(table)
    assert used - known == set()


def test_words_of_the_glossary_stand_in_the_lessons_that_it_names_for_them():
    words = (course.NOTEBOOKS / "glossary.md").read_text(encoding="utf-8").split("## Words")[1]
    entries = re.findall(r"^\*\*.+?(?=\n\n|\Z)", words, re.MULTILINE | re.DOTALL)
    assert len(entries) > 80
    text = {
        int(path.name[:2]): "\n".join(cell.source for kind in ("markdown", "code") for cell in cells(path, kind))
        for path in LESSONS
    }
    for entry in entries:
        lessons = [int(number) for found in re.findall(r"\((\d[\d, ]*)[;)]", entry) for number in found.split(",")]
        names = [name for bold in re.findall(r"\*+([^*]+)\*+", entry) for name in re.split("[,(]", bold)]
        # in any form: "methods" and "axes, logarithmic" too
        stems = [[word[: max(4, len(word) - 2)] for word in re.findall(r"\w+", name)] for name in names]
        assert lessons, entry
        for number in lessons:
            assert any(stem and all(re.search(rf"(?i)\b{part}", text[number]) for part in stem) for stem in stems), (
                entry
            )


def letters(table):
    """What stands between dollars in the first column, of `v = …` the v."""
    first = "\n".join(line.split("|")[1] for line in table.splitlines() if line.startswith("|"))
    return {symbol.split("=")[0].strip() for symbol in re.findall(r"\$([^$]+)\$", first)}
