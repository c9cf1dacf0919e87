"""The warm-up of lesson 0."""

from hoverslam_lib.checks.answers import compare, number, takes
from hoverslam_lib.checks.feedback import exercise


@exercise("0.1", "metres per second", tests=3, hints=("How many metres has a kilometre?", "Seconds in an hour: 3600."))
def metres_per_second(convert):
    takes(convert, "kilometres_per_hour")
    for speed in (36.0, 90.0, 7200.0):
        mistakes = {
            "multiplied": (speed * 3.6, "You multiply by 3.6: which of the two numbers should be the larger one?"),
            "minutes": (speed * 1000 / 60, "An hour has 3600 seconds; yours has 60."),
        }
        compare(number(convert(speed)), speed / 3.6, f"for {speed:g} km/h", mistakes)
        yield
