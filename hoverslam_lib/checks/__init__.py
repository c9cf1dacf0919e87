"""Feedback on exercises: ``checks.name(my_answer)`` under a stub answers in one line, and never raises.

``checks.progress()`` says what is done, ``checks.show_solution("2.1")`` shows a solution if there is one. The exercises
stand on pages of Markdown, one a lesson: ``lesson_02.md``.
"""

from itertools import groupby
from pathlib import Path

from hoverslam_lib.checks import pages
from hoverslam_lib.checks.feedback import Page
from hoverslam_lib.checks.record import done

__all__ = ["EXERCISES", "progress", "show_solution"]

EXERCISES = {}
WITHHELD = ".solutions_withheld"
"""A file of this name in a student's folder keeps solutions from being shown."""

for _path in sorted(Path(__file__).parent.glob("lesson_*.md")):
    for _exercise in pages.exercises(_path):
        EXERCISES[_exercise.number] = globals()[_exercise.name] = _exercise
        __all__.append(_exercise.name)


def progress():
    """Say which exercises of the course are done."""
    finished = done()
    lines = [f"{len(finished & set(EXERCISES))} of {len(EXERCISES)} exercises done"]
    for lesson, numbers in groupby(EXERCISES, key=lambda number: number.partition(".")[0]):
        marks = "  ".join(f"{'✔' if number in finished else '○'} {number}" for number in numbers)
        lines.append(f"lesson {lesson:>2}:  {marks}")
    return Page("\n".join(lines))


def show_solution(number):
    """Show the solution of an exercise, such as "2.1", unless the instructor withholds them."""
    number = str(number)
    if Path(WITHHELD).exists():
        return Page(f"The solution to exercise {number} is withheld here: ask your instructor.")
    if number not in EXERCISES:
        lesson = number.partition(".")[0] + "."
        there = [known for known in EXERCISES if known.startswith(lesson)] or EXERCISES
        return Page(f"There is no exercise {number}; there are {', '.join(there)}.")
    return Page(EXERCISES[number].solution.strip())
