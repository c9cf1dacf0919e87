"""Figures that follow the hand: what stays is drawn once, and at each movement of a slider only what moves."""

import html
import io
import math
import zlib

import anywidget
import matplotlib.pyplot as plt
import numpy as np
import traitlets
from IPython import get_ipython
from IPython.display import display
from ipywidgets import Image, Layout, VBox
from matplotlib.backends.backend_agg import FigureCanvasAgg
from PIL import Image as Pixels

from hoverslam_lib.descent import OUT_OF_PROPELLANT, SOFT_LANDING, SOFT_SPEED, STOPPED_TOO_HIGH, speed_after_fall
from hoverslam_lib.plotting import Picture, _png

STILL = "Run this cell to make it live."

LOW = 100.0
"""From hovers up to here [m] the fall is told: from much higher, the air would have its say."""

_SHOWN = {}  # by cell and run: so that a cell run again takes its former figure out of memory


class Message(anywidget.AnyWidget):
    """The sentence above the picture, which screen readers speak when it changes.

    It also gives the picture its alternative text and every slider the name that its label shows, because ipywidgets
    gives neither.
    """

    _esm = """
    function name(el, text) {
        const figure = el.closest(".hoverslam-live");
        figure?.querySelector("img.widget-image")?.setAttribute("alt", text);
        for (const control of figure?.querySelectorAll(".widget-slider") ?? []) {
            const label = control.querySelector(".widget-label").innerText;
            for (const part of control.querySelectorAll("[role=slider], .widget-readout"))
                part.setAttribute("aria-label", label);
        }
    }
    export default {
        render({ model, el }) {
            el.setAttribute("role", "status");
            const say = () => {
                el.textContent = model.get("text");
                name(el, el.textContent);
            };
            model.on("change:text", say);
            say();
            // the controls come onto the page one by one
            for (const wait of [0, 200, 1000, 3000]) setTimeout(say, wait);
        },
    };
    """
    text = traitlets.Unicode().tag(sync=True)


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
        ``update(**values)`` gets the value of every control by its name, moves the artists, and returns a sentence
        that says with numbers what the picture shows. If it raises, the message is shown in place of the sentence,
        and nothing that moves is drawn.
    **controls : ipywidgets.Widget
        Any with a value; ``description`` is its label and should have the unit.
    """

    def __init__(self, fig, update, **controls):
        plt.close(fig)
        self.fig, self.update, self.controls = fig, update, controls
        self._canvas = FigureCanvasAgg(fig)
        self._canvas.draw()
        fig.set_layout_engine("none")
        self._background = self._canvas.copy_from_bbox(fig.bbox)
        self._moving = sorted(fig.findobj(lambda artist: artist.get_animated()), key=lambda artist: artist.zorder)
        self.text, self.message = "", Message()
        self.picture = Image(format="png", layout=Layout(width=f"{fig.bbox.width:.0f}px", max_width="100%"))
        for control in controls.values():
            control.layout.width = control.layout.width or "34em"
            control.style.description_width = "11em"
            control.tooltip = control.description
            control.observe(self._follow, "value")
        self.widget = VBox([*controls.values(), self.message, self.picture])
        self.widget.add_class("hoverslam-live")
        self._follow()

    def set(self, **values):
        """Give controls new values and draw once."""
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
        """Show the controls and the figure; what a notebook stores of them is a still picture."""
        _close_former_run(self)
        still = Picture(_png(self.fig), self.text, round(self.fig.bbox.width))
        page = f"{still._repr_html_()}<p>{html.escape(self.text)} <em>{STILL}</em></p>"
        view = self.widget._repr_mimebundle_()
        display({**view, "text/html": page, "text/plain": self.text}, raw=True)

    def close(self):
        """Take the controls and the picture out of the page and of memory."""
        _close(self.widget)

    def _follow(self, change=None):
        try:
            said = self.update(**{name: control.value for name, control in self.controls.items()})
            if not isinstance(said, str):
                raise TypeError(f"update must return a sentence that says what the picture shows; it returned {said!r}")
        except Exception as error:  # whatever a student's own function raises is shown, and the controls stay usable
            self.text = f"Not possible: {str(error) or type(error).__name__}"
            moving = ()
        else:
            self.text, moving = said, self._moving
        self._canvas.restore_region(self._background)
        for artist in moving:
            self.fig.draw_artist(artist)
        self.picture.value = _encoded(np.asarray(self._canvas.buffer_rgba()))
        self.say(self.text)

    def say(self, text):
        """Put a sentence above the picture."""
        self.message.text = text


def verdict(flight, height):
    """Say what became of a flight, led by the signed hover height.

    Parameters
    ----------
    flight : Flight
    height : float
        [m], from `hover_height`; nan if it has none.

    Returns
    -------
    str
    """
    if flight.outcome == SOFT_LANDING:
        said = f"{SOFT_LANDING} with {abs(flight.touchdown[1]):.2f} m/s"
        if flight.hover and flight.hover[0] == flight.t[-2]:
            return f"{said}, engine cut at hover height {flight.hover[1]:+.3f} m"
        if flight.mass[-1] == flight.descent.booster.dry_mass:
            said += ", tank empty"
        return f"{said}, hover height {height:+.3f} m" if math.isfinite(height) else said
    if flight.outcome == STOPPED_TOO_HIGH:
        h = flight.hover[1]
        if h > LOW:
            return f"stopped {_length(h)} too high"
        speed = speed_after_fall(flight.descent.planet, h)
        return f"stopped {_length(h)} too high, and with the engine cut there, a crash with {speed:.1f} m/s"
    if flight.outcome == OUT_OF_PROPELLANT:
        v = round(flight.v[-1], 1) + 0.0  # no -0.0
        return f"tank empty {_length(flight.h[-1])} above the ground, at {v:.{0 if abs(v) >= 10 else 1}f} m/s"
    braked = f"hover height −{_length(-height)}, " if -math.inf < height else ""
    excess = -flight.touchdown[1] - SOFT_SPEED
    return f"{braked}{f'{excess:.1f}' if excess >= 0.95 else f'{excess:.2g}'} m/s too fast at the ground"


def _length(metres):
    return f"{metres / 1e3:.2f} km" if metres >= 999.5 else f"{metres:.3g} m"


def _encoded(pixels):
    """A PNG, packed as fast as may be: time counts here, not size."""
    packed = io.BytesIO()
    Pixels.fromarray(pixels).convert("RGB").save(packed, format="png", compress_level=1, compress_type=zlib.Z_RLE)
    return packed.getvalue()


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
