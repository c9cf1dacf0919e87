"""How long a check of a right answer takes, for every exercise, the first time and at best; and whether Python runs as
fast after checks as before.

``python tests/benchmarks/checks.py``
"""

import contextlib
import io
import os
import re
import sys
import tempfile
import time
from pathlib import Path

import matplotlib as mpl
import nbformat

mpl.use("agg")

from hoverslam_lib import checks, course, live  # noqa: E402

LIMIT = 0.2


def solved(path):
    """The checks of a notebook called with their solutions, the cells before them run: (number, first, best) [s]."""
    live.Live.show = lambda self: None
    names = {check.__name__: check.number for check in checks.EXERCISES.values()}
    blocks = {number: checks.show_solution(number).text for number in checks.EXERCISES}
    space = {"display": print, "__name__": "__main__"}
    for cell in nbformat.read(path, as_version=4).cells:
        if cell.cell_type != "code" or "raises-exception" in cell.metadata.get("tags", []):
            continue
        call = re.search(r"^checks\.(\w+)\((.*)\)", cell.source, re.MULTILINE)
        if not call or call.group(1) not in names:
            exec(cell.source, space)
            continue
        number = names[call.group(1)]
        exec(blocks[number], space)
        times = []
        for _ in range(3):
            start = time.perf_counter()
            said = eval(call.group(0), space)
            times.append(time.perf_counter() - start)
            assert said.done, (number, said)
        yield number, times[0], min(times)


def count():
    """How long Python takes to count [s], at best."""
    times = []
    for _ in range(5):
        start, n = time.perf_counter(), 0
        while n < 1_000_000:
            n += 1
        times.append(time.perf_counter() - start)
    return min(times)


def main():
    os.chdir(tempfile.mkdtemp())
    slow, before = 0, count()
    for path in course.lessons():
        if not Path(path).name[0].isdigit():
            continue
        with contextlib.redirect_stdout(io.StringIO()):
            found = list(solved(path))
        for number, first, best in found:
            slow += first > LIMIT
            print(
                f"{number:5} {1e3 * first:7.1f} {1e3 * best:7.1f} ms {f'more than {LIMIT} s' if first > LIMIT else ''}"
            )
    after = count() / before
    print(f"Python counts in {after:.2f} times as long as before the checks (limit 1.2)")
    return slow + (after > 1.2)


if __name__ == "__main__":
    sys.exit(main() > 0)
