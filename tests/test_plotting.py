"""Figures: their style, and the alternative text that they carry."""

import io
import math
import re
from pathlib import Path

import matplotlib.pyplot as plt
import pytest
from PIL import Image

from hoverslam_lib import METHODS, plotting


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
    with pytest.raises(ValueError, match="shorter"), plotting.figure(y=("h [m]",), alt="2 lines", ncols=2):
        pass
    assert plt.get_fignums() == []


def test_figure_that_fails_is_not_shown_and_not_kept(shown):
    with pytest.raises(OverflowError), plotting.figure(alt="a line of 1 m"):
        math.exp(1000)
    assert shown == []
    assert plt.get_fignums() == []
