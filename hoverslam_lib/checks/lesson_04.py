"""Beside the page of lesson 4: what is done where there is no solution."""


def without_solution(*arguments):
    """A probe for the arguments of a call: what is done there, in words."""

    def probe(solve):
        "where there is no solution"
        try:
            got = solve(*arguments)
        except Exception as error:
            return "an ArithmeticError" if isinstance(error, ArithmeticError) else f"a {type(error).__name__}"
        handed_back = isinstance(got, Exception) or (isinstance(got, type) and issubclass(got, Exception))
        return "an error that is handed back" if handed_back else "no word"

    return probe
