"""What pytest says when a notebook fails: which lesson, and how to run it alone."""


def pytest_terminal_summary(terminalreporter):
    failed = terminalreporter.stats.get("failed", []) + terminalreporter.stats.get("error", [])
    lessons = sorted({report.nodeid.split("::")[0] for report in failed if ".ipynb" in report.nodeid})
    for lesson in lessons:
        terminalreporter.section(f"a cell of {lesson} fails")
        terminalreporter.line(f"this lesson alone:      pytest {lesson}")
        terminalreporter.line("look at it:             jupyter lab " + lesson)
        terminalreporter.line(f"if the new output is right, store it: python -m hoverslam_lib.course refresh {lesson}")
