"""A method that a lesson writes out is the library's."""

import ast
import math

import nbformat
import numpy as np
import pytest
from scipy.integrate import RK23, solve_ivp

from hoverslam_lib import METHODS, Descent, course, integrate

WRITTEN = {
    "02_explicit_euler": "explicit_euler",
    "03_symplectic_euler": "symplectic_euler",
    "04_implicit_euler": "implicit_euler",
    "05_runge_kutta": "rk4",
}


def written_in(lesson, name, **known):
    """The function of this name that a cell of the lesson defines; it knows NumPy, `math` and what is `known`."""
    for cell in nbformat.read(course.NOTEBOOKS / f"{lesson}.ipynb", as_version=4).cells:
        if cell.cell_type == "code" and f"def {name}(" in cell.source:
            for node in ast.parse(cell.source).body:
                if isinstance(node, ast.FunctionDef) and node.name == name:
                    scope = {"np": np, "math": math} | known
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


def slopes_of(f):
    return lambda t, y: np.array([y[1], f(t, y[0], y[1])])


@pytest.mark.parametrize("force", ["booster", "pendulum with friction and a push"])
def test_the_pair_that_lesson_15_writes_is_scipy_s(force):
    f, h, v = FORCES[force]
    for dt in (1e-3, 0.1, 0.5):
        solver = RK23(slopes_of(f), 0.7, [h, v], 2.0, first_step=dt, rtol=1.0, atol=1e9)
        solver.step()
        y_new, _ = written_in("15_adaptive_steps", "pair_step")(slopes_of(f), 0.7, np.array([h, v]), dt)
        np.testing.assert_allclose(y_new, solver.y, rtol=1e-13)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-5, 1e-6, 1e-7, 1e-8])
def test_the_integrator_that_lesson_15_writes_is_scipy_s(tolerance):
    """The same pair, norm and tolerance, on the fall; only the first step and the step after a refused one differ."""
    lesson, start, fall = "15_adaptive_steps", [150e3, -2000.0], Descent().acceleration()
    adaptive = written_in(lesson, "adaptive", pair_step=written_in(lesson, "pair_step"))
    t, y, _ = adaptive(slopes_of(fall), 0.0, start, 60.0, tolerance, tolerance)
    run = solve_ivp(slopes_of(fall), (0.0, 60.0), start, method="RK23", rtol=tolerance, atol=tolerance)
    exact = integrate(fall, *start, dt=1.0, t_end=60.0, method="dop8")
    assert t[-1] == pytest.approx(60.0, abs=1e-9)
    assert len(t) - 1 == pytest.approx(len(run.t) - 1, rel=0.2)
    ratios = (y[:, -1] - [exact.h[-1], exact.v[-1]]) / (run.y[:, -1] - [exact.h[-1], exact.v[-1]])
    assert np.all((ratios > 1 / 3) & (ratios < 3)), ratios
