"""Figures: their style, and the alternative text that they carry."""

import io
import math
import os
import re
import subprocess
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure
from PIL import Image

from hoverslam_lib import METHODS, Descent, book, course, fly, integrate, plotting


@pytest.fixture
def shown(monkeypatch):
    """What plotting.show displays."""
    pictures = []
    monkeypatch.setattr("IPython.display.display", pictures.append)
    return pictures


def test_every_method_has_a_colour_and_a_line_style_of_its_own():
    lines = [plotting.line(name) for name in METHODS]
    assert len({line["color"] for line in lines}) == len(METHODS)
    assert len({str(line["linestyle"]) for line in lines}) == len(METHODS)
    assert plotting.line("rk4", label=None)["label"] is None


def test_picture_carries_its_text_at_twice_the_resolution_shown(shown):
    fig, ax = plt.subplots(figsize=(5, 3), dpi=100)
    ax.plot([0, 1])
    plotting.show(fig, alt='v < 3 & "h"\n = 2.6 m')
    html = shown[0]._repr_html_()
    assert 'alt="v &lt; 3 &amp; &quot;h&quot; = 2.6 m"' in html
    assert 'width="500"' in html
    image = Image.open(io.BytesIO(shown[0].data))
    assert image.size == (1000, 600)
    assert image.mode == "P"
    assert image.convert("RGB").getpixel((0, 0)) == (255, 255, 255)
    assert not plt.fignum_exists(fig.number)


def test_the_tests_compare_the_text_of_a_picture_and_not_its_bytes(shown):
    with (Path(__file__).with_name("nbval_sanitize.cfg")).open(encoding="utf-8") as file:
        pattern = re.search(r"^regex: (.*)$", file.read(), re.MULTILINE).group(1)
    fig, _ = plt.subplots()
    plotting.show(fig, alt="a landing at 2.6 m")
    assert re.sub(pattern, "PICTURE", shown[0]._repr_html_()).endswith('src="PICTURE">')
    assert "2.6 m" in re.sub(pattern, "PICTURE", shown[0]._repr_html_())


def test_figure_without_text_is_refused(shown):
    fig, _ = plt.subplots()
    with pytest.raises(ValueError, match="alt must say what the figure shows"):
        plotting.show(fig, alt="  ")
    plt.close(fig)


def test_figure_is_labelled_and_shown_when_its_block_ends(shown):
    with plotting.figure("Fall", x="t [s]", y="h [m]", alt="a fall from 3 m", figsize=(5, 3)) as ax:
        ax.plot([0, 1], [3, 0])
        assert (ax.get_title(), ax.get_xlabel(), ax.get_ylabel()) == ("Fall", "t [s]", "h [m]")
        assert shown == []
    assert [repr(picture) for picture in shown] == ["a fall from 3 m"]
    assert plt.get_fignums() == []


def test_figure_takes_a_text_for_each_of_several_axes(shown):
    with plotting.figure(("a", "b"), x="t [s]", y=("h [m]", "v [m/s]"), alt="2 lines", ncols=2) as axes:
        assert [(ax.get_title(), ax.get_xlabel(), ax.get_ylabel()) for ax in axes] == [
            ("a", "t [s]", "h [m]"),
            ("b", "t [s]", "v [m/s]"),
        ]
    with (
        pytest.raises(ValueError, match="y must be .* a list of 2"),
        plotting.figure(y=("h [m]",), alt="2 lines", ncols=2),
    ):
        pass
    assert plt.get_fignums() == []


def test_figure_that_fails_is_not_shown_and_not_kept(shown):
    with pytest.raises(OverflowError), plotting.figure(alt="a line of 1 m"):
        math.exp(1000)
    assert shown == []
    assert plt.get_fignums() == []


# ---- primitives -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("t_ignite", [59.5, None])
def test_flight_is_drawn_in_its_colour_and_faint_from_its_hover_on(t_ignite):
    flown = fly(Descent(), t_ignite, dt=0.5)
    axes = Figure().subplots(2)
    plotting.flight(axes, flown, color="#D55E00", name="too early")
    for ax, values, name in zip(axes, (flown.h / 1000, flown.v), ("h [km]", "v [m/s]"), strict=True):
        assert (ax.get_xlabel(), ax.get_ylabel()) == ("t [s]", name)
        before, after = ax.lines
        assert [line.get_color() for line in ax.lines] == ["#D55E00"] * 2
        assert [line.get_alpha() for line in ax.lines] == [None, 0.3]
        assert (before.get_label(), after.get_label()[0]) == ("too early", "_")  # the second is not in a legend
        # the two meet at the hover, or at the end, and are the flight together
        t = before.get_xdata()
        assert t[-1] == after.get_xdata()[0] == (flown.hover[0] if flown.hover else flown.t[-1])
        np.testing.assert_array_equal([*t, *after.get_xdata()[1:]], flown.t)
        np.testing.assert_array_equal([*before.get_ydata(), *after.get_ydata()[1:]], values)
    assert bool(flown.hover) == (t_ignite is not None)


def test_flight_is_green_and_nameless_if_nothing_else_is_said_and_a_trajectory_is_one_too():
    axes = Figure().subplots(2)
    plotting.flight(axes, integrate(lambda t, h, v: -9.81, 100.0, 0.0, dt=0.5, t_end=2.0))
    first, rest = axes[0].lines
    assert first.get_color() == plotting.line("rk4")["color"]
    assert first.get_label().startswith("_")
    assert len(first.get_xdata()) == 5
    assert len(rest.get_xdata()) == 1


def test_name_stands_beside_its_line():
    ax = Figure().subplots()
    plotting.label(ax, 2.0, 3.0, "Euler", color="#D55E00")
    plotting.label(ax, 2.0, 3.0, "exact", color="black", dx=-4, dy=7, ha="right")
    first, second = ax.texts
    assert (first.get_text(), first.xy, first.get_color()) == ("Euler", (2.0, 3.0), "#D55E00")
    assert (first.get_position(), first.get_ha(), first.get_va()) == ((6, 0), "left", "center")
    assert (second.get_text(), second.get_position(), second.get_ha()) == ("exact", (-4, 7), "right")
    assert first.anncoords == second.anncoords == "offset points"


def test_moment_is_an_upright_line_with_its_name_on_the_side_asked_for():
    ax = Figure().subplots()
    plotting.moment(ax, 60.2, "ignition")
    plotting.moment(ax, 71.7, "touchdown", color="red", top=0.5, side="left")
    assert [line.get_xdata()[0] for line in ax.lines] == [60.2, 71.7]
    assert [line.get_color() for line in ax.lines] == [text.get_color() for text in ax.texts] == ["0.35", "red"]
    first, second = ax.texts
    assert (first.xy, first.xycoords, first.get_ha()) == ((60.2, 0.97), ("data", "axes fraction"), "left")
    assert (second.xy, second.get_text(), second.get_ha()) == ((71.7, 0.5), "touchdown", "right")
    assert first.get_position()[0] > 0 > second.get_position()[0]  # away from the line
    assert first.get_va() == "top"


# ---- the user's own settings ----------------------------------------------------------------------------------------

HOSTILE = """
text.usetex: True
figure.autolayout: True
figure.dpi: 40
savefig.dpi: 30
savefig.bbox: tight
savefig.transparent: True
savefig.facecolor: black
font.family: serif
font.size: 20
axes.facecolor: yellow
axes.formatter.use_locale: True
axes.xmargin: 0.4
lines.linewidth: 7
lines.antialiased: False
path.simplify: False
xtick.direction: in
"""
START_UP = """
import numpy as np, pandas as pd
np.set_printoptions(precision=2, suppress=True, sign="+", linewidth=20)
pd.set_option("display.precision", 2, "display.max_rows", 3, "display.max_columns", 2)
"""
PAGE = """
import base64, sys, nbformat
import IPython.display
from hoverslam_lib import live

def show(*what, raw=False):
    for each in what:
        if raw:
            print(each.get("text/html"))
        else:
            print(each._repr_html_() if hasattr(each, "_repr_html_") else repr(each))

IPython.display.display = live.display = show
live.Live.show = lambda self, show=live.Live.show: (show(self), print(base64.b64encode(self.pixels())))
namespace = {"display": show, "__name__": "__main__"}
for cell in nbformat.read(sys.argv[1], as_version=4).cells[: int(sys.argv[2]) + 1]:
    if cell.cell_type == "code":
        exec(compile(cell.source, "cell", "exec"), namespace)
"""


def page(lesson, start_up, folder, **settings):
    """All that the cells of a lesson show and print down to its last live figure, pictures included."""
    (path,) = course.lessons([lesson])
    last = book.live_cells(path)[-1]
    ran = subprocess.run(
        [sys.executable, "-c", start_up + PAGE, path, str(last)],
        env=os.environ | {"MPLBACKEND": "agg"} | settings,
        cwd=folder,
        capture_output=True,
        text=True,
    )
    assert ran.returncode == 0, ran.stderr
    return ran.stdout


def test_lesson_is_the_same_to_the_pixel_whatever_the_users_own_settings(tmp_path):
    hostile = tmp_path / "matplotlibrc"
    hostile.write_text(HOSTILE, encoding="utf-8")
    ours = page("03", "", tmp_path)
    assert ours.count("data:image/png;base64,") > 2
    theirs = page("03", START_UP, tmp_path, MATPLOTLIBRC=str(hostile))
    assert [a for a, b in zip(ours.splitlines(), theirs.splitlines(), strict=True) if a != b] == []


def test_style_leaves_the_backend_alone_and_undoes_what_changes_printed_numbers():
    before, printing = plt.get_backend(), np.get_printoptions()
    with plt.rc_context({"font.size": 30, "figure.autolayout": True}), pd.option_context("display.precision", 2):
        np.set_printoptions(precision=2, suppress=True)
        plotting.use_style()
        assert plt.get_backend() == before
        assert plt.rcParams["font.size"] == 11
        assert not plt.rcParams["figure.autolayout"]
        assert np.get_printoptions() == printing
        assert pd.get_option("display.precision") == 6
