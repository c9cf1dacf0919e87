"""The course's way of drawing: one style, one colour and line for each method, figures that carry alternative text."""

import base64
import io
import sys
from contextlib import contextmanager
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from PIL import Image

from hoverslam_lib import _validate
from hoverslam_lib.descent import Flight
from hoverslam_lib.integrators import METHODS
from hoverslam_lib.trajectory import Trajectory

STYLE_SHEET = Path(__file__).with_name("hoverslam.mplstyle")

EXACT = {"color": "0.72", "linewidth": 6, "linestyle": "-", "label": "exact"}
"""The exact solution: a broad grey band on which the others lie or do not."""

# as its documentation gives them: there is no call for it
_NUMPY_PRINTS = {
    "edgeitems": 3,
    "floatmode": "maxprec",
    "formatter": None,
    "infstr": "inf",
    "legacy": False,
    "linewidth": 75,
    "nanstr": "nan",
    "override_repr": None,
    "precision": 8,
    "sign": "-",
    "suppress": False,
    "threshold": 1000,
}

_LINES = {
    "explicit_euler": ("#D55E00", "--"),
    "symplectic_euler": ("#0072B2", (0, (6, 1.5, 1.5, 1.5))),
    "implicit_euler": ("#E69F00", (0, (1.2, 1))),
    "rk4": ("#009E73", "-"),
    "rkn4": ("#CC79A7", (0, (8, 2))),
    "gauss4": ("#56B4E9", (0, (3, 1, 1, 1, 1, 1))),
    "dop8": ("#000000", (0, (1, 2.5))),
}


def use_style():
    """Draw in the course's style from here on, and print numbers as NumPy and pandas do by default.

    Whatever a matplotlibrc or a start-up file of the user's own has set before is undone, but for matplotlib's backend,
    so that the same page comes out everywhere.
    """
    matplotlib.rcdefaults()
    plt.style.use(STYLE_SHEET)
    np.set_printoptions(**_NUMPY_PRINTS)
    if "pandas" in sys.modules:  # else there is nothing to undo
        sys.modules["pandas"].reset_option("^display")


def line(method, **changes):
    """Colour, line style and label of a method, the same in every lesson: ``ax.plot(t, h, **line("rk4"))``."""
    if not isinstance(method, str) or method not in _LINES:
        raise ValueError(f"there is no method {method!r}; choose from {', '.join(_LINES)}")
    color, linestyle = _LINES[method]
    return {"color": color, "linestyle": linestyle, "label": METHODS[method].title, **changes}


class Picture:
    """A figure as a PNG, or a film as a GIF, with alternative text, which `show` displays.

    It stands in HTML because notebooks carry no alternative text on a plain image; so the text, numbers included, is
    read out by a screen reader and compared by the tests.
    """

    def __init__(self, data, alt, width, kind="png"):
        self.data, self.alt, self.width, self.kind = data, alt, width, kind

    def __repr__(self):
        return self.alt

    def _repr_html_(self):
        src = f"data:image/{self.kind};base64,{base64.b64encode(self.data).decode('ascii')}"
        alt = self.alt.replace("&", "&amp;").replace('"', "&quot;").replace("<", "&lt;").replace(">", "&gt;")
        return f'<img alt="{alt}" width="{self.width}" style="max-width:100%" src="{src}">'


def show(fig, *, alt):
    """Show a figure under the cell and close it.

    Parameters
    ----------
    fig : matplotlib.figure.Figure
    alt : str
        What the figure shows, in words, with its numbers: for those who do not see it, and for the tests.

    Raises
    ------
    ValueError, TypeError
        If `alt` is empty, or `fig` is no figure.
    """
    from IPython.display import display

    _validate.instance("fig", fig, Figure)
    alt = _validate.alternative_text(alt, "figure")
    display(Picture(_png(fig), alt, round(fig.get_figwidth() * fig.dpi)))
    plt.close(fig)


@contextmanager
def figure(title="", *, x="", y="", alt, **subplots):
    """Make a figure, label it, and show it when the ``with`` block, in which it is drawn, ends.

    Parameters
    ----------
    title, x, y : str or sequence of str
        Title, and the quantities on the axes with their units: one text for all axes, or one for each of them.
    alt : str
        As for `show`.
    **subplots
        For ``plt.subplots``: nrows, ncols, sharex, figsize, …

    Yields
    ------
    matplotlib Axes or ndarray of Axes
        As ``plt.subplots`` returns them.

    Raises
    ------
    ValueError, TypeError
        If `alt` is empty, or if there is not one text for each of the axes.
    """
    alt, others = _validate.alternative_text(alt, "figure"), plt.get_fignums()
    try:
        fig, axes = plt.subplots(**subplots)
    except Exception:  # it leaves a figure without axes
        for number in set(plt.get_fignums()).difference(others):
            plt.close(number)
        raise
    try:
        each = np.ravel(axes)
        texts = [_one_each(*given, len(each)) for given in (("title", title), ("x", x), ("y", y))]
        for ax, of_title, of_x, of_y in zip(each, *texts, strict=True):
            ax.set(title=of_title, xlabel=of_x, ylabel=of_y)
        yield axes
        show(fig, alt=alt)
    finally:
        plt.close(fig)


def _one_each(name, texts, n):
    """A text for each of n axes."""
    texts = [texts] * n if isinstance(texts, str) else texts
    if not (isinstance(texts, list | tuple) and len(texts) == n and all(isinstance(text, str) for text in texts)):
        raise ValueError(f"{name} must be one text, or a list of {n}, one for each of the axes; got {texts!r}")
    return texts


def _png(fig):
    """Twice the resolution that is shown, in a palette of 64 colours: sharp on a projector, small in the file."""
    drawn = io.BytesIO()
    fig.savefig(drawn, format="png", dpi=2 * fig.dpi)
    drawn.seek(0)
    packed = io.BytesIO()
    Image.open(drawn).convert("RGB").quantize(64, dither=Image.Dither.NONE).save(packed, format="png", optimize=True)
    return packed.getvalue()


def label(ax, x, y, text, *, color, dx=6, dy=0, ha="left"):
    """Write a name beside a line, at the point (x, y) of the data, moved by (dx, dy) points."""
    ax.annotate(text, (x, y), (dx, dy), textcoords="offset points", color=color, ha=ha, va="center", fontweight="bold")


def moment(ax, t, text, *, color="0.35", top=0.97, side="right"):
    """Mark a moment with a thin upright line and its name on one side, `top` being the share of the axis' height."""
    ax.axvline(t, color=color, linewidth=1, linestyle=":")
    ha, dx = ("left", 4) if side == "right" else ("right", -4)
    where = {"xycoords": ("data", "axes fraction"), "textcoords": "offset points"}
    ax.annotate(text, (t, top), (dx, 0), color=color, ha=ha, va="top", **where)


def flight(axes, flown, *, color="#009E73", name=None):
    """Draw height and velocity against time on two axes; what comes after a hover is faint.

    Parameters
    ----------
    axes : sequence of two matplotlib Axes
        For the height [km] and the velocity [m/s].
    flown : Flight or Trajectory
    """
    _validate.instance("flown", flown, Flight, Trajectory)
    if np.shape(axes) != (2,):
        raise ValueError(f"axes must be two, for the height and for the velocity; got {axes!r}")
    end = hover_end(flown)
    for ax, values, name_of_axis in zip(axes, (flown.h / 1e3, flown.v), ("h [km]", "v [m/s]"), strict=True):
        ax.plot(flown.t[:end], values[:end], color=color, label=name)
        ax.plot(flown.t[end - 1 :], values[end - 1 :], color=color, alpha=0.3)
        ax.set(xlabel="t [s]", ylabel=name_of_axis)


def hover_end(flown):
    """How many samples of a flight come before the end of its hover: all, if it has none."""
    hover = getattr(flown, "hover", None)
    return len(flown.t) if hover is None else int(np.searchsorted(flown.t, hover[0])) + 1
