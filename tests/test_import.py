import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

import hoverslam_lib

FOLDER = Path(hoverslam_lib.__file__).parent
PRIVATE = ["_validate", "_columns", "_roots", "_dop853"]
ORDER = [
    *PRIVATE,
    "metrics",
    "integrators",
    "trajectory",
    "oscillator",
    "planet",
    "booster",
    "descent",
    "ignition",
    "ensemble",
    "data",
    "published",
    "plotting",
    "animation",
    "live",
    "recording",
    "mission_control",
    "checks",
    "book",
    "collect",
    "course",
]
MODULES = {path.stem: path for path in FOLDER.glob("*.py") if path.stem != "__init__"}
MODULES |= {f"{folder}.{path.stem}": path for folder in ("book", "checks") for path in FOLDER.glob(f"{folder}/*.py")}


def imported_from_the_library(path):
    """Modules of the library that a file imports anywhere, also within functions."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path.name}: a relative import"
            # "from hoverslam_lib import x" names a module or something that the package exports
            names = [node.module] + [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        for name in names:
            package, _, rest = name.partition(".")
            module = rest.partition(".")[0]
            if package == "hoverslam_lib" and module in ORDER:
                yield module


def test_every_module_has_its_place():
    assert {name.partition(".")[0] for name in MODULES} <= set(ORDER)


@pytest.mark.parametrize("name", MODULES)
def test_a_module_imports_only_from_those_above_it(name):
    place = ORDER.index(name.partition(".")[0])
    above = set(ORDER[:place]) | ({"checks"} if name.startswith("checks.") else set())
    assert set(imported_from_the_library(MODULES[name])) <= above


def test_the_package_exports_no_module_below_ensemble():
    exported = {
        getattr(hoverslam_lib, name).__module__
        for name in hoverslam_lib.__all__
        if callable(getattr(hoverslam_lib, name))
    }
    assert {module.rpartition(".")[2] for module in exported} <= set(ORDER[: ORDER.index("ensemble") + 1])
    assert all(hasattr(hoverslam_lib, name) for name in hoverslam_lib.__all__)
    assert hoverslam_lib.__all__ == sorted(
        hoverslam_lib.__all__, key=lambda name: (not name.isupper(), name[0].islower(), name)
    )


def run(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout


def test_importing_the_package_is_light():
    loaded = set(run("import sys, hoverslam_lib; print(*sys.modules)").split())
    assert "hoverslam_lib.ignition" in loaded
    assert not loaded & {"matplotlib", "ipywidgets", "pandas", "scipy", "IPython", "hoverslam_lib.published"}


def test_a_flight_needs_numpy_alone():
    code = (
        "import sys; from hoverslam_lib import *; d = Descent(); fly(d, best_ignition(d).t_ignite); print(*sys.modules)"
    )
    assert not set(run(code).split()) & {"matplotlib", "ipywidgets", "pandas", "scipy"}


def test_version_is_the_one_that_is_cited_and_the_newest_in_the_changelog():
    version = hoverslam_lib.__version__
    assert f"\nversion: {version}\n" in FOLDER.parent.joinpath("CITATION.cff").read_text(encoding="utf-8")
    changes = FOLDER.parent.joinpath("CHANGELOG.md").read_text(encoding="utf-8")
    assert re.search(r"^## (.+)$", changes, re.MULTILINE)[1] == version
