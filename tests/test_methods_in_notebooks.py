"""A method that a lesson writes out is the library's."""

import ast
import math

import nbformat
import numpy as np
import pytest

from hoverslam_lib import METHODS, Descent, course

WRITTEN = {
    "02_explicit_euler": "explicit_euler",
    "03_symplectic_euler": "symplectic_euler",
    "04_implicit_euler": "implicit_euler",
    "05_runge_kutta": "rk4",
}


def written_in(lesson, name):
    """The function of this name that a cell of the lesson defines."""
    for cell in nbformat.read(course.NOTEBOOKS / f"{lesson}.ipynb", as_version=4).cells:
        if cell.cell_type == "code" and f"def {name}(" in cell.source:
            for node in ast.parse(cell.source).body:
                if isinstance(node, ast.FunctionDef) and node.name == name:
                    scope = {"np": np, "math": math}
                    exec(compile(ast.Module([node], []), lesson, "exec"), scope)
                    return scope[name]
    raise AssertionError(f"{lesson} does not define {name}")


FORCES = {
    "booster": (Descent().acceleration(throttle=1.0), 13e3, -2300.0),
    "pendulum with friction and a push": (lambda t, h, v: -9.81 * np.sin(h) - 0.3 * v + np.cos(3 * t), 1.0, 0.5),
    "many at once": (lambda t, h, v: -h - 0.1 * abs(v) * v, np.linspace(-2, 2, 5), np.linspace(3, -1, 5)),
}


@pytest.mark.parametrize("force", FORCES)
@pytest.mark.parametrize("lesson", WRITTEN)
def test_the_method_that_a_lesson_writes_is_the_library_s(lesson, force):
    name = WRITTEN[lesson]
    f, h, v = FORCES[force]
    for dt in (1e-3, 0.1, 0.5):
        expected = METHODS[name].step(f, 0.7, h, v, dt)
        np.testing.assert_allclose(written_in(lesson, name)(f, 0.7, h, v, dt), expected, rtol=1e-13)
