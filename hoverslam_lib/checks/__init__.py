"""Feedback on exercises: ``checks.name(my_answer)`` under a stub answers in one line, and never raises.

``checks.progress()`` says what is done, ``checks.show_solution("2.1")`` shows a solution if there is one. The exercises
stand on pages of Markdown, one a lesson: ``lesson_02.md``.
"""

from pathlib import Path

from hoverslam_lib.checks import pages
from hoverslam_lib.checks.record import Page, done

__all__ = ["ENTRIES", "EXERCISES", "progress", "show_solution"]

ENTRIES = {}  # the pages' text, by the number of the exercise
EXERCISES = {}
WITHHELD = ".solutions_withheld"
"""A file of this name in a student's folder keeps solutions from being shown."""

for _path in sorted(Path(__file__).parent.glob("lesson_*.md")):
    for _entry in pages.entries(_path):
        ENTRIES[_entry.number] = _entry
        EXERCISES[_entry.number] = globals()[_entry.name] = _entry.exercise(pages.own_module(_path))
        __all__.append(_entry.name)


def progress():
    """Say which exercises of the course are done.

    Returns
    -------
    Page
    """
    finished = done()
    lines = [f"{len(finished & set(EXERCISES))} of {len(EXERCISES)} exercises done"]
    for lesson in sorted({int(number.partition(".")[0]) for number in EXERCISES}):
        numbers = [number for number in EXERCISES if number.startswith(f"{lesson}.")]
        marks = "  ".join(f"{'✔' if number in finished else '○'} {number}" for number in numbers)
        lines.append(f"lesson {lesson:2}:  {marks}")
    return Page("\n".join(lines))


def show_solution(number):
    """Show the solution of an exercise, unless the instructor withholds them.

    Parameters
    ----------
    number : str
        Such as "2.1".

    Returns
    -------
    Page
    """
    number = str(number)
    if Path(WITHHELD).exists():
        return Page(f"The solution to exercise {number} is withheld here: ask your instructor.")
    if number not in ENTRIES:
        lesson = number.partition(".")[0] + "."
        there = [known for known in ENTRIES if known.startswith(lesson)] or list(ENTRIES)
        return Page(f"There is no exercise {number}; there are {', '.join(there)}.")
    return Page(ENTRIES[number].solution.strip())
