"""Break the library on purpose, one place at a time, and list the breaks that no test notices.

``python tests/mutants.py MODULE… [--number N] [--seed S] [--workers W] [--strings]``, for example ``metrics
checks.pages``; all modules if none is named. For each module the tests of `TESTS` run once on a clone of what is
committed, to see which lines they reach. Of these N are drawn at random; each gets one random change, in a clone of
its own, and is killed if a test fails or if the tests take too long. Needs pytest-cov; not a part of `.ci/run`.

Why not a library: mutmut leaves out what is decorated or stands at the top of a module, which here is much (cached
properties, context managers, tables), and cosmic-ray changes files in place; neither takes a sample, knows which tests
concern a module, or remembers which changes make no difference.
"""

import argparse
import ast
import contextlib
import copy
import difflib
import importlib
import json
import multiprocessing
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

TESTS = {  # the files test_….py in the order in which they are tried, and after | which of their tests: see pytest's -k
    "_columns": "ensemble oscillator_planet_booster | columns or row or index or bad or equal",
    "_dop853": "integrators",
    "_roots": "roots",
    "_validate": "trajectory oscillator_planet_booster ensemble ignition descent | bad or refused or digits or at_once",
    "animation": "animation",
    "book": "book_pages guide",
    "booster": "oscillator_planet_booster ensemble | oscillator or columns",
    "collect": "collect",
    "course": "course notebooks lesson_shape live | not real and not handed and not pytest",
    "data": "data",
    "descent": "descent properties ensemble ignition careless",
    "ensemble": "ensemble properties",
    "ignition": "ignition properties ensemble",
    "integrators": "integrators",
    "live": "live recording careless",
    "metrics": "metrics",
    "mission_control": "mission_control",
    "oscillator": "oscillator_planet_booster",
    "planet": "oscillator_planet_booster ensemble | oscillator or columns",
    "plotting": "plotting careless | not pixel",
    "published": "published",
    "recording": "recording",
    "trajectory": "trajectory integrators careless",
    **{
        f"checks.{part}": "answers checks" for part in ("answers", "feedback", "judging", "pages", "record", "stopping")
    },
    **{f"checks.lesson_{lesson}": "answers checks" for lesson in ("01", "04", "09", "11", "13")},
}

# (module, a line, what it became): why no test can tell
EQUIVALENT = {
    ("_roots", "same = (gx < 0) == (ga < 0)", "same = (gx <= 0) == (ga < 0)"): "where gx is 0 that is the answer",
    ("_roots", "nearer = abs(ga) < abs(gb)", "nearer = abs(ga) <= abs(gb)"): "of two that are as near either will do",
    ("book", "key = digest.hexdigest()[:16]", "key = digest.hexdigest()[:17]"): "longer than it need be, either way",
    (
        "checks.record",
        "places.insert(0, Path.cwd() / FOLDER)",
        "places.insert(-1, Path.cwd() / FOLDER)",
    ): "there is one place before, so both are in front of it",
    ("checks.pages", "return made[0]", "return made[-1]"): "there is one, or an error before that",
    ("mission_control", "@lru_cache(maxsize=16)", "@lru_cache(maxsize=17)"): "a few more trials are remembered",
    ("recording", 'names[-1] = "dt"', 'names[+1] = "dt"'): "there are two names where a third control is dt",
    ("descent", "for _ in range(6):", "for _ in range(5):"): "a safe search takes over",
    ("ensemble", "BLOCK = 16_384", "BLOCK = 16383"): "the numbers do not depend on it, and the time hardly",
    (
        "ensemble",
        "ends = _March(*phase, solver, stops=True, ground=False).run()",
        "ends = _March(*phase, solver, stops=True, ground=True).run()",
    ): "a touchdown is looked for, too, for which nobody asks",
    (
        "ensemble",
        "stop, turned = (v < 0) & (self._v >= 0), (v > 0) & (self._v <= 0)",
        "stop, turned = (v < 0) & (self._v >= 0), (v > 0) & (self._v < 0)",
    ): "a step that ends on the apex itself goes on to the same fall",
    (
        "checks.lesson_13",
        "whole = Descent(booster, planet, PLAN.height + dh, PLAN.velocity + dv)",
        "whole = Descent(booster, planet, PLAN.height + dh, PLAN.velocity - dv)",
    ): "errors of either sign are equally frequent",
    (
        "checks.lesson_13",
        'said = number(law(h + dh, v + dv, mass, memory), "the throttle")',
        'said = number(law(h - dh, v + dv, mass, memory), "the throttle")',
    ): "errors of either sign are equally frequent",
    ("ignition", "super().__init__(reason, amount, message)", "pass"): "an exception has its arguments before that",
    ("ignition", "before = max(i - 1, 0)", "before = max(i - 2, 0)"): "one more step is taken anew, to the same node",
}

SWAPS = {
    **{ast.Add: [ast.Sub], ast.Sub: [ast.Add], ast.Mult: [ast.Div], ast.Div: [ast.Mult], ast.Pow: [ast.Mult]},
    **{ast.FloorDiv: [ast.Div], ast.Mod: [ast.Mult], ast.BitAnd: [ast.BitOr], ast.BitOr: [ast.BitAnd]},
    **{ast.And: [ast.Or], ast.Or: [ast.And], ast.USub: [ast.UAdd]},
    **{ast.Lt: [ast.LtE, ast.GtE], ast.LtE: [ast.Lt, ast.Gt], ast.Gt: [ast.GtE, ast.LtE], ast.GtE: [ast.Gt, ast.Lt]},
    **{ast.Eq: [ast.NotEq], ast.NotEq: [ast.Eq], ast.Is: [ast.IsNot], ast.IsNot: [ast.Is]},
    **{ast.In: [ast.NotIn], ast.NotIn: [ast.In]},
}
NAMES = {"min": "max", "max": "min", "any": "all", "all": "any", "minimum": "maximum", "maximum": "minimum"}


def with_field(node, field, value):
    changed = copy.copy(node)
    setattr(changed, field, value)
    return changed


def changes(node, strings):
    """The nodes that may stand in a node's place."""
    match node:
        case ast.BinOp(op=op) | ast.BoolOp(op=op) | ast.AugAssign(op=op):
            yield from (with_field(node, "op", other()) for other in SWAPS.get(type(op), ()))
        case ast.Compare(ops=[op, *rest]):
            yield from (with_field(node, "ops", [other(), *rest]) for other in SWAPS[type(op)])
        case ast.UnaryOp(op=ast.Not()):
            yield node.operand
        case ast.UnaryOp(op=ast.USub()):
            yield with_field(node, "op", ast.UAdd())
        case ast.Constant(value=bool(value)):
            yield ast.Constant(not value)
        case ast.Constant(value=int(value) | float(value)):
            yield ast.Constant(value + 1)
            yield ast.Constant(value / 2 if isinstance(value, float) else value - 1)
        case ast.Constant(value=str(value)) if strings:
            yield ast.Constant(f"X{value}")
        case ast.Name(id=name) if name in NAMES:
            yield ast.Name(NAMES[name])
        case ast.Attribute(attr=name) if name in NAMES:
            yield with_field(node, "attr", NAMES[name])
        case ast.If(test=test) | ast.IfExp(test=test) | ast.While(test=test):
            yield with_field(node, "test", ast.UnaryOp(ast.Not(), test))
        case ast.Return(value=ast.expr()):
            yield ast.Return(ast.Constant(None))
        case ast.Expr(value=ast.Call() | ast.Yield() | ast.YieldFrom()) | ast.Raise() | ast.AugAssign():
            yield ast.Pass()
        case ast.Break():
            yield ast.Continue()
        case ast.Continue():
            yield ast.Pass()


def walk(node):
    """All nodes but docstrings, annotations, `strict` of zip (a guard, behind which lengths are the same) and what is
    inside f-strings, whose places Python 3.11 does not know.
    """
    yield node
    for name, field in ast.iter_fields(node):
        if name in ("annotation", "returns") or isinstance(node, ast.JoinedStr):
            continue
        for child in field if isinstance(field, list) else [field]:
            docstring = isinstance(child, ast.Expr) and isinstance(child.value, ast.Constant)
            guard = isinstance(child, ast.keyword) and child.arg == "strict"
            if isinstance(child, ast.AST) and not docstring and not guard:
                yield from walk(child)


def mutants(source, lines, strings=False):
    """By line, the ways to change it: (its text, what that becomes, the whole text then)."""
    starts = [0]
    for text in source.encode().splitlines(keepends=True):
        starts.append(starts[-1] + len(text))
    found = {}
    for node in walk(ast.parse(source)):
        for changed in changes(node, strings):
            # of what has a body, only the condition is written anew
            old, new = (node.test, changed.test) if isinstance(node, (ast.If, ast.While)) else (node, changed)
            start = starts[old.lineno - 1] + old.col_offset
            end = starts[old.end_lineno - 1] + old.end_col_offset
            first, last, raw = starts[old.lineno - 1], starts[old.end_lineno], source.encode()
            lines_now = raw[first:start] + ast.unparse(new).encode() + raw[end:last]
            text = (raw[:first] + lines_now + raw[last:]).decode()
            was, now = (" ".join(part.decode().split()) for part in (raw[first:last], lines_now))
            if old.lineno in lines and ast.dump(ast.parse(text)) != ast.dump(ast.parse(source)):
                found.setdefault(old.lineno, []).append((was, now, text))
    return found


def clone(folder):
    """The committed state of the project, in which a test may do what it likes."""
    subprocess.run(["git", "clone", "--quiet", "--shared", ROOT, folder], check=True)
    return Path(folder)


def run_tests(folder, module, limit, *options):
    """Exit status of the tests of a module, or None if they took too long."""
    process = multiprocessing.get_context("fork").Process(target=be_tested, args=(folder, module, options))
    process.start()
    process.join(limit)
    status = process.exitcode
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)  # and what its tests have started
    process.join()
    return status


def be_tested(folder, module, options):
    """In a process of its own, which need not import again what is imported here already."""
    os.setsid()
    os.chdir(folder)
    sys.path.insert(0, str(folder))
    sys.dont_write_bytecode = True
    os.environ |= {"PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
    said = os.open("said.txt", os.O_CREAT | os.O_WRONLY)
    os.dup2(said, 1)
    os.dup2(said, 2)
    names, _, chosen = TESTS[module].partition(" | ")
    paths = [f"tests/{name}.py" if "/" in name else f"tests/test_{name}.py" for name in names.split()]
    plugins = ["-p", "no:nbval", "-p", "no:cacheprovider", "-o", "addopts="]
    status = pytest.main(
        ["-x", "-q", *plugins, "-W", "ignore::pytest.PytestAssertRewriteWarning", *options, "-k", chosen, *paths]
    )
    os._exit(status)


def path_of(module):
    path = Path("hoverslam_lib", *module.split("."))
    return path / "__init__.py" if (ROOT / path).is_dir() else path.with_suffix(".py")


def survey(module):
    """Lines that the tests of a module reach, and how long they take [s]."""
    with tempfile.TemporaryDirectory() as folder:
        start = time.monotonic()
        here = clone(folder)
        if run_tests(here, module, None, "--cov", "--cov-report=json:covered.json", "--cov-fail-under=0"):
            sys.exit(f"the tests of {module} fail without any change:\n{(here / 'said.txt').read_text()[-2000:]}")
        files = json.loads((here / "covered.json").read_text())["files"]
        return set(files[path_of(module).as_posix()]["executed_lines"]), time.monotonic() - start


def survives(module, text, limit):
    with tempfile.TemporaryDirectory() as folder:
        here = clone(folder)
        (here / path_of(module)).write_text(text)
        return run_tests(here, module, limit) == 0


def try_module(module, number, seed, workers, strings):
    """A row of the table, and the differences that no test noticed."""
    source = (ROOT / path_of(module)).read_text()
    lines, seconds = survey(module)
    ways, rng = mutants(source, lines, strings), random.Random(f"{seed} {module}")
    drawn = [rng.choice(ways[line]) for line in sorted(rng.sample(sorted(ways), min(number, len(ways))))]
    tried = [(was, now, text) for was, now, text in drawn if (module, was, now) not in EQUIVALENT]
    survivors = []
    with ThreadPoolExecutor(workers) as pool:
        for n, alive in enumerate(pool.map(lambda way: survives(module, way[2], 10 + 3 * seconds), tried), start=1):
            if alive:
                survivors.append(tried[n - 1])
            print(f"\r{module}: {n} of {len(tried)}, {len(survivors)} survive", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    for was, now, text in survivors:
        print(f"\n({module!r}, {was!r}, {now!r})")
        difference = difflib.unified_diff(source.splitlines(), text.splitlines(), lineterm="", n=1)
        print("\n".join(list(difference)[2:]), flush=True)
    return module, len(drawn), len(tried) - len(survivors), len(survivors), len(drawn) - len(tried)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("modules", nargs="*", metavar="MODULE", help=", ".join(TESTS))
    parser.add_argument("--number", type=int, default=12, help="of mutants of each module")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--strings", action="store_true", help="change texts, too")
    given = parser.parse_args()
    for name in ("anywidget", "hypothesis", "ipywidgets", "matplotlib.pyplot", "nbclient", "pandas", "scipy.integrate"):
        importlib.import_module(name)
    rows = []
    for module in given.modules or TESTS:
        rows.append(try_module(module, given.number, given.seed, given.workers, given.strings))
    total = ("all", *(sum(column) for column in list(zip(*rows, strict=True))[1:]))
    print(f"\n{'module':20}{'made':>8}{'killed':>8}{'survived':>10}{'equivalent':>12}")
    for module, made, killed, survived, equivalent in [*rows, total]:
        print(f"{module:20}{made:8}{killed:8}{survived:10}{equivalent:12}")


if __name__ == "__main__":
    main()
