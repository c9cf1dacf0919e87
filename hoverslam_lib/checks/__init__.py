"""Feedback on exercises: ``checks.name(my_answer)`` under a stub answers in one line, and never raises.

``checks.progress()`` says what is done, ``checks.show_solution("2.1")`` shows a solution if there is one.
"""

import importlib
import pkgutil

from hoverslam_lib.checks.feedback import Exercise
from hoverslam_lib.checks.record import Page, done
from hoverslam_lib.checks.record import solution as show_solution

__all__ = ["EXERCISES", "progress", "show_solution"]

EXERCISES = {}
for _module in sorted(module.name for module in pkgutil.iter_modules(__path__) if module.name.startswith("lesson_")):
    for _check in vars(importlib.import_module(f"{__name__}.{_module}")).values():
        if isinstance(_check, Exercise):
            EXERCISES[_check.number] = globals()[_check.__name__] = _check
            __all__.append(_check.__name__)


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
