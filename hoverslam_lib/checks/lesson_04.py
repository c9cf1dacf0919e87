"""Beside the page of lesson 4: what is done where there is no solution."""

from hoverslam_lib.checks.answers import Words
from hoverslam_lib.checks.feedback import Wrong, raised


def without_solution(*arguments):
    """A probe for the arguments of a call: what is done there, in words."""

    def probe(solve):
        "where there is no solution"
        try:
            got = solve(*arguments)
        except ArithmeticError:
            return Words("an ArithmeticError")
        except Exception as error:
            raise Wrong(f"Where there is no solution, asked is an ArithmeticError. {raised(error)}") from error
        handed_back = isinstance(got, Exception) or (isinstance(got, type) and issubclass(got, Exception))
        return Words("an error that is handed back" if handed_back else "no word")

    return probe
