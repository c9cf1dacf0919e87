"""The instructor's guide: what its score of 90 minutes sends the class to is there, and says what it is said to say."""

import re
from collections import defaultdict
from html import unescape
from typing import NamedTuple

import nbformat
import pytest

from hoverslam_lib import book, course

GUIDE = (course.NOTEBOOKS / "instructor_guide.md").read_text(encoding="utf-8")
MISSION_CONTROL = "mission_control"


class Row(NamedTuple):
    """A row of the score."""

    minute: int
    show: str
    ask: str
    answer: str


def score():
    """The rows by the name of the notebook, in order."""
    part = GUIDE.split("## The course in one class of 90 minutes")[1].split("\n## ")[0]
    rows = defaultdict(list)
    for heading, body in re.findall(r"^### (.*)\n((?:(?!^###).*\n)*)", part, re.MULTILINE):
        lesson = re.search(r"Lesson (\d+)", heading)
        name = course.lessons([lesson[1]])[0].stem if lesson else MISSION_CONTROL
        for line in re.findall(r"^\| (\d+ \|.*) \|$", body, re.MULTILINE):
            minute, *cells = (cell.strip() for cell in line.split(" | "))
            rows[name].append(Row(int(minute.strip("| ")), *cells))
    return rows


def settings(name):
    """What the score does with the sliders of a notebook, in order: (control, position, the sentences it quotes)."""
    found = []
    control = None
    for row in score()[name]:
        for named, position, quoted in re.findall(r"`([^`]+)`|\*\*([\d.]+|on)\*\*|“([^”]+)”", row.show):
            control = named or control
            if position:
                found.append((control, position, []))
            elif quoted:
                found[-1][2].append(quoted)
    return found


def text_of(path):
    """All that a notebook says, stored outputs included, with plain minus signs."""
    said = []
    for cell in nbformat.read(path, as_version=4).cells:
        said.append(cell.source)
        for output in cell.get("outputs", []):
            said += [output.get("text", ""), *(text for kind, text in output.get("data", {}).items() if "text" in kind)]
    return re.sub('base64,[^"]*', "", unescape("\n".join(said))).replace("−", "-")


def test_minutes_go_on_and_add_up():
    minutes = [row.minute for rows in score().values() for row in rows]
    assert minutes == sorted(set(minutes))
    assert (minutes[0], len(minutes)) == (0, len(re.findall(r"^\| \d+ \|", GUIDE, re.MULTILINE)))
    ends = [tuple(map(int, pair)) for pair in re.findall(r"^### (\d+)–(\d+) ·", GUIDE, re.MULTILINE)]
    starts = [rows[0].minute for rows in score().values()]
    assert ends == list(zip(starts, [*starts[1:], 90], strict=True))


@pytest.mark.parametrize("name", [name for name in score() if name != MISSION_CONTROL])
def test_score_leads_to_what_is_there_and_quotes_what_is_printed(name):
    (path,) = course.lessons([name])
    text = text_of(path)
    headings = {heading.strip() for heading in re.findall(r"^#+ (.*)", text, re.MULTILINE)}
    for row in score()[name]:
        for place in re.findall(r"^\*([^*]+)\*", row.show):
            assert place in headings, row
        said = re.sub(r"\*\*[\d.]+\*\*|“[^”]*”|\"[^\"]*\"", "", f"{row.show} {row.ask} {row.answer}").replace("−", "-")
        for number in re.findall(r"-?\d+[.,]\d+(?:e-\d+)?|-?\d{3,}", said):
            assert number in text or number.replace(",", "") in text, (number, row)


def test_prediction_sheet_has_room_for_each_prediction_of_the_lessons():
    sheet = book.prediction_sheet(course.lessons())
    lessons = re.findall(r"^## (\d+) · ((?:.|\n)*?)(?=^## |\Z)", sheet, re.MULTILINE)
    assert [int(number) for number, _ in lessons] == list(range(len(lessons)))
    for number, page in lessons:
        cells = nbformat.read(course.lessons([number])[0], as_version=4).cells
        asked = [cell.source.strip().split("\n\n")[-1] for cell in cells if "**Predict" in cell.source]
        *questions, end = page.split('<div class="write"></div>')
        assert [question.split("\n\n", 1)[1].strip() for question in questions] == asked != []
        assert end.strip() == ""
