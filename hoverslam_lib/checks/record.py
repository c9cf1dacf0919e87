"""Which exercises are done, and where their solutions are."""

import html
import json
import os
import re
import tempfile
from pathlib import Path

import platformdirs

FILE = ".hoverslam_progress.json"
SOLUTIONS = Path(__file__).resolve().parents[2] / "notebooks" / "solutions"


class Page:
    """Text that looks the same in a terminal and in a notebook."""

    def __init__(self, text):
        self.text = text

    def __repr__(self):
        return self.text

    def _repr_html_(self):
        return f'<pre role="status">{html.escape(self.text)}</pre>'


def _places():
    """Where the record may be: in the student's folder, or where the system keeps a user's data."""
    return [Path.cwd() / FILE, Path(platformdirs.user_data_dir("hoverslam")) / FILE]


def done():
    """Numbers of the exercises that are done, as a set of str; a record that cannot be read counts as empty."""
    found = set()
    for place in _places():
        try:
            numbers = json.loads(place.read_text(encoding="utf-8"))["done"]
            found |= {number for number in numbers if isinstance(number, str)}
        except (OSError, ValueError, TypeError, KeyError):
            continue
    return found


def add(number):
    """Keep that an exercise is done; where nothing can be written, nothing is."""
    numbers = done()
    if number in numbers:
        return
    text = json.dumps({"done": sorted(numbers | {number})})
    for place in _places():
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            handle, name = tempfile.mkstemp(dir=place.parent, prefix=FILE)
            with os.fdopen(handle, "w", encoding="utf-8") as file:
                file.write(text)
            os.replace(name, place)  # at once or not at all: a cut connection leaves no half a file
        except OSError:
            continue
        return


def solution(number):
    """Show the solution of an exercise.

    Parameters
    ----------
    number : str
        Such as "2.1".

    Returns
    -------
    Page
    """
    lesson, _, _ = str(number).partition(".")
    path = SOLUTIONS / f"lesson_{lesson.zfill(2)}.py"
    if not path.exists():
        return Page(f"There is no solution to exercise {number} here: ask your instructor.")
    parts = blocks(path.read_text(encoding="utf-8"))
    if str(number) not in parts:
        return Page(f"There is no exercise {number}; lesson {lesson} has {', '.join(parts)}.")
    return Page(parts[str(number)])


def blocks(source):
    """The solutions in a module by the number of their exercise; each begins with a line like ``# %% 2.1 · title``."""
    parts = re.split(r"(?m)^# %% (\d+\.\d+)[^\n]*\n", source)
    return {number: text.strip() for number, text in zip(parts[1::2], parts[2::2], strict=True)}
