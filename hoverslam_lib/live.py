"""Figures that follow the hand: what stays is drawn once, and at each movement of a slider only what moves."""

import html
import math
import zlib
from decimal import Decimal
from pathlib import Path

import anywidget
import matplotlib.pyplot as plt
import numpy as np
import traitlets
from IPython import get_ipython
from IPython.display import display
from ipywidgets import HTML, FloatLogSlider, FloatRangeSlider, FloatSlider, IntSlider, VBox
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from hoverslam_lib import _validate
from hoverslam_lib.descent import (
    OUT_OF_PROPELLANT,
    SOFT_LANDING,
    SOFT_SPEED,
    STOPPED_TOO_HIGH,
    Flight,
    speed_after_fall,
)
from hoverslam_lib.plotting import Picture, _png

STILL = "Run this cell to make it live."
_VIEW = "application/vnd.jupyter.widget-view+json"
# The widget cannot be shown once its kernel is gone. So the still has an output of its own before the widget's, and of
# the two one is seen: the widget where it lives, else the still. A dead widget is bare text, "model not found".
_ONE_OF_TWO = """<style>
.jp-OutputArea-child:has(.hoverslam-still):has(+ .jp-OutputArea-child .hoverslam-live),
.jp-OutputArea-child:has(.hoverslam-still) + .jp-OutputArea-child > .jp-OutputArea-output:not(:has(*))
{ display: none; }
</style>"""

LOW = 100.0
"""From hovers up to here [m] the fall is told: from much higher, the air would have its say."""

MOST_PIXELS = 8_000_000
"""Of a picture: beyond that, sharpness costs more time than it is worth."""

_SHOWN = {}  # by cell and run: so that a cell run again takes its former figure out of memory


class Screen(anywidget.AnyWidget):
    """What a live figure shows: its sentence, which screen readers speak when it changes, and under it the picture.

    The browser gets the ground of the picture once, and at each movement only the pixels that differ from it: exact,
    and so few that the picture is drawn in the very pixels of the screen, however dense. `live.js` puts them on a
    canvas, tells how much room there is, gives the controls the names and values that ipywidgets does not, and says
    so when a control was moved and the kernel does not answer.
    """

    _esm = Path(__file__).with_name("live.js")
    _css = Path(__file__).with_name("live.css")
    text = traitlets.Unicode().tag(sync=True)
    marks = traitlets.List().tag(sync=True)
    size = traitlets.List([1, 1]).tag(sync=True)
    ground = traitlets.Bytes().tag(sync=True)
    moving = traitlets.Bytes().tag(sync=True)

    def lay(self, ground):
        """Take what stays: uint8, shape (height, width, 4)."""
        self._ground = _whole(ground).copy()
        height, width = ground.shape[:2]
        self.size, self.ground = [width, height], _packed(self._ground)

    def put(self, pixels):
        """Show a picture over that ground."""
        now = _whole(pixels)
        at = np.flatnonzero(now != self._ground)
        self.moving = _packed(np.diff(at, prepend=0).astype("<u4"), now[at])


class Live:
    """A figure and the controls that it follows.

    Only artists made with ``animated=True`` are drawn anew, over a background that is drawn once: set the limits of
    the axes before. While a picture is being made the browser holds movements back and then sends the newest only, so
    that none queue up.

    Parameters
    ----------
    fig : matplotlib.figure.Figure
        Made by ``plt.subplots`` as always; it is taken out of pyplot's hands.
    update : callable
        ``update(**values)`` gets the value of every control by its name, see `values`, moves the artists, and returns
        a sentence that says with numbers what the picture shows. If it raises, the message is shown in place of the
        sentence, and nothing that moves is drawn.
    recorded : dict, optional
        What also moves on a page without a kernel, see `recording`: by the name of a control the list of its
        positions, or None for places spread evenly over it. Left out: the first two controls, dt among them.
    landmarks : dict of str to dict, optional
        Positions that such a page has a button for, by what the button says: for each control that moves, its value.
    **controls : ipywidgets.Widget
        Any with a value; ``description`` is its label and should have the unit.
    """

    def __init__(self, fig, update, *, recorded=None, landmarks=None, **controls):
        _validate.instance("fig", fig, Figure)
        _validate.function("update", update, *controls)
        for name, control in controls.items():
            if not hasattr(control, "observe"):
                raise TypeError(f"{name} must be a control of ipywidgets, such as a FloatSlider; got {control!r}")
        plt.close(fig)
        self.fig, self.update, self.controls = fig, update, controls
        self.recorded, self.landmarks = recorded, landmarks or {}
        self.text, self.screen = "", Screen()
        self._canvas = FigureCanvasAgg(fig)
        self._width, self._dpi = round(fig.bbox.width), fig.dpi
        self._moving = sorted(fig.findobj(lambda artist: artist.get_animated()), key=lambda artist: artist.zorder)
        for control in controls.values():
            control.tooltip = control.tooltip or control.description  # else a hand over its label is told "null"
            control.observe(self._follow, "value")
        self.widget = VBox([*controls.values(), *_hint(controls.values(), self._width), self.screen])
        self.widget.layout.max_width = f"{self._width}px"
        self.widget.add_class("hoverslam-live")
        self.screen.on_msg(self._hear)
        self._draw()

    def values(self):
        """The value of every control by its name; a slider's is the decimal number it stands for.

        Browsers count a slider's steps in binary: 7.6 comes back from there as 7.6000000000000005, and one such bit
        changes the first decimal of a published run. So a float slider's value is its place `on_grid`; of a
        logarithmic slider that holds for the exponent.
        """
        return {name: value_of(control) for name, control in self.controls.items()}

    def pixels(self, moving=True):
        """The picture as it stands, or the ground alone on which things move: uint8, shape (height, width, 4)."""
        if moving:
            return np.array(self._canvas.buffer_rgba())
        self._canvas.restore_region(self._background)
        ground = np.array(self._canvas.buffer_rgba())
        self._follow()
        return ground

    def set(self, **values):
        """Give controls new values and draw once."""
        for name in values:
            if name not in self.controls:
                raise ValueError(f"there is no control {name!r}; there are {', '.join(self.controls)}")
        for name in values:
            self.controls[name].unobserve(self._follow, "value")
        try:
            for name, value in values.items():
                self.controls[name].value = value
        finally:
            for name in values:
                self.controls[name].observe(self._follow, "value")
            self._follow()

    def show(self):
        """Show the controls and the figure; where they cannot live, a still picture of them shows instead."""
        _close_former_run(self)
        said = " ".join(self.text.split())
        still = Picture(_png(self.fig), said, self._width)._repr_html_()
        page = f'<div class="hoverslam-still">{still}<p>{html.escape(said)} <em>{STILL}</em></p></div>'
        display({"text/html": _ONE_OF_TWO + page, "text/plain": said}, raw=True)
        display({_VIEW: self.widget._repr_mimebundle_()[_VIEW]}, raw=True)

    def close(self):
        """Take the controls and the picture out of the page and of memory."""
        _close(self.widget)

    def fit(self, width, height, font, ratio):
        """Draw in the pixels of a browser.

        A figure keeps its shape and its proportions; a page that fills a window has more to arrange.

        Parameters
        ----------
        width, height, font : float
            Of the place that the picture has, and of its letters [CSS px].
        ratio : float
            Pixels of the screen per CSS px.
        """
        self.fig.set_dpi(self._dpi * width / self._width * ratio)

    def _hear(self, screen, content, buffers):
        """Answer a browser that asks whether the kernel is there, or tells what room it has."""
        if "room" not in content:
            screen.send(content)
            return
        room = content["room"]
        most = math.sqrt(MOST_PIXELS / (room["width"] * room["height"]))
        before = self.fig.dpi, *self.fig.get_size_inches()
        self.fit(**room | {"ratio": min(room["ratio"], most)})
        if (self.fig.dpi, *self.fig.get_size_inches()) != before:
            self._draw()

    def _draw(self):
        """Draw what stays, and what moves over it."""
        self._canvas.draw()
        self.fig.set_layout_engine("none")
        self._background = self._canvas.copy_from_bbox(self.fig.bbox)
        with self.screen.hold_sync():
            self.screen.lay(np.asarray(self._canvas.buffer_rgba()))
            self._follow()

    def _follow(self, change=None):
        try:
            said = self.update(**self.values())
            if not isinstance(said, str):
                raise TypeError(f"update must return a sentence that says what the picture shows; it returned {said!r}")
        except Exception as error:  # whatever a student's own function raises is shown, and the controls stay usable
            self.text = f"Not possible: {str(error) or type(error).__name__}"
            moving = ()
        else:
            self.text, moving = said, self._moving
        self._canvas.restore_region(self._background)
        for artist in moving:
            if artist.get_visible():
                self.fig.draw_artist(artist)
        with self.screen.hold_sync():
            self.screen.put(np.asarray(self._canvas.buffer_rgba()))
            self.say(self.text)

    def say(self, text):
        """Put a sentence above the picture."""
        self.screen.text = text


def on_grid(value, slider):
    """The place of a slider that is nearest to a value, as a decimal number.

    Parameters
    ----------
    value : float
    slider : ipywidgets.FloatSlider
        Or any with `min`, `max` and `step`.

    Returns
    -------
    float
        min + k·step, rounded to as many decimals as these have, or max; the value itself if there is no step, and nan.
    """
    if not slider.step or math.isnan(value):
        return value
    value = min(max(value, slider.min), slider.max)
    decimals = max(-Decimal(repr(number)).as_tuple().exponent for number in (slider.min, slider.step))
    steps = round((value - slider.min) / slider.step)
    place = round(slider.min + steps * slider.step, max(decimals, 0)) + 0.0  # no −0.0
    return min(place, slider.max, key=lambda place: abs(place - value))


def verdict(flight, height, brief=False):
    """Say what became of a flight, led by the signed hover height.

    Parameters
    ----------
    flight : Flight
    height : float
        [m], from `hover_height`; nan if it has none.
    brief : bool
        In fewer words, to be read from afar.

    Returns
    -------
    str
    """
    _validate.instance("flight", flight, Flight)
    if flight.outcome == SOFT_LANDING:
        said = f"{SOFT_LANDING} with {abs(flight.touchdown[1]):.2f} m/s"
        if flight.hover and flight.hover[0] == flight.t[-2]:
            return f"{said}, {'' if brief else 'engine '}cut at hover height {flight.hover[1]:+.3f} m"
        if flight.mass[-1] == flight.descent.booster.dry_mass:
            said += ", tank empty"
        return f"{said}, hover height {height:+.3f} m" if math.isfinite(height) else said
    if flight.outcome == STOPPED_TOO_HIGH:
        h = flight.hover[1]
        if h > LOW:
            return f"stopped {_length(h)} too high"
        speed = speed_after_fall(flight.descent.planet, h)
        cut = "; cut there" if brief else ", and with the engine cut there"
        return f"stopped {_length(h)} too high{cut}, a crash with {speed:.1f} m/s"
    if flight.outcome == OUT_OF_PROPELLANT:
        v = round(flight.v[-1], 1) + 0.0  # no -0.0
        return f"tank empty {_length(flight.h[-1])} above the ground, at {v:.{0 if abs(v) >= 10 else 1}f} m/s"
    braked = f"hover height −{_length(-height)}, " if -math.inf < height else ""
    excess = -flight.touchdown[1] - SOFT_SPEED
    return f"{braked}{f'{excess:.1f}' if excess >= 0.95 else f'{excess:.2g}'} m/s too fast at the ground"


def _length(metres):
    return f"{metres / 1e3:.2f} km" if metres >= 999.5 else f"{metres:.3g} m"


def value_of(control):
    """The value of a control as the decimal number it stands for, see `Live.values`."""
    if isinstance(control, FloatLogSlider):
        return control.base ** on_grid(math.log(control.value, control.base), control)
    if isinstance(control, FloatSlider):
        return on_grid(control.value, control)
    if isinstance(control, FloatRangeSlider):
        return tuple(on_grid(end, control) for end in control.value)
    return control.value


def _whole(pixels):
    """Each pixel as one number."""
    return np.ascontiguousarray(pixels).view("<u4").ravel()


def _packed(*arrays):
    """Packed as fast as may be: time counts here, not size."""
    return zlib.compress(b"".join(array.tobytes() for array in arrays), 1)


def _hint(controls, width):
    """What arrow keys do, if under some slider of a figure a pixel is more than a step."""
    sliders = [control for control in controls if isinstance(control, (FloatSlider, IntSlider)) and control.step]
    fine = [slider for slider in sliders if (slider.max - slider.min) / slider.step > width / 2]
    if not fine:
        return []
    hint = HTML(f"Arrow keys step by {', '.join(map(_single_step, fine))}.")
    hint.add_class("hoverslam-hint")
    return [hint]


def _single_step(slider):
    name, _, unit = slider.description.removesuffix("]").partition(" [")
    return f"{slider.step:g} {unit} ({name})" if unit else f"{slider.step:g} ({name})"


def _close(widget):
    for child in getattr(widget, "children", ()):
        _close(child)
    for part in (widget.layout, getattr(widget, "style", None), widget):
        if part is not None:
            part.close()


def _close_former_run(live):
    shell = get_ipython()
    parent = shell.get_parent() if hasattr(shell, "get_parent") else {}
    cell = parent.get("metadata", {}).get("cellId")
    if cell is None:
        return
    run = parent["header"]["msg_id"]
    for former in [key for key in _SHOWN if key[0] == cell and key[1] != run]:
        for shown in _SHOWN.pop(former):
            shown.close()
    _SHOWN.setdefault((cell, run), []).append(live)
