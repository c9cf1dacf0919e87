"""One page of live controls over the whole problem, for those who teach: ``MissionControl().show()``."""

import base64
import math
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import anywidget
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import traitlets
from ipywidgets import (
    HTML,
    Button,
    Checkbox,
    Dropdown,
    FloatSlider,
    FloatText,
    HBox,
    IntSlider,
    Layout,
    Play,
    SelectionSlider,
    ToggleButton,
    VBox,
    jslink,
)
from matplotlib.gridspec import GridSpec
from matplotlib.text import Text

from hoverslam_lib import plotting, published
from hoverslam_lib.animation import FREE_FALL
from hoverslam_lib.booster import FALCON_9
from hoverslam_lib.descent import Descent
from hoverslam_lib.ignition import FreeFall, NoSoftLanding, best_ignition
from hoverslam_lib.integrators import METHODS
from hoverslam_lib.live import Live, on_grid, verdict
from hoverslam_lib.planet import EARTH, MARS, MOON

PLANETS = {"Earth": EARTH, "Mars": MARS, "Moon": MOON}
KEPT = 12
"""How many trials the table remembers."""

STEPS = [round(k * 10.0**n, 6) for n in (-3, -2, -1) for k in (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8)][7:] + [1.0]
"""Step sizes [s], about evenly spaced on a logarithmic scale; round, because the published numbers depend on it."""

START = {
    "t_ignite": 60.2,
    "dt": 0.02,
    "methods": ("rk4",),
    "thrust": FALCON_9.thrust / 1e6,
    "drag": FALCON_9.drag_coefficient,
    "planet": "Earth",
    "faults": False,
    "moment": 100,
}

# what moves in the book: from the fall to the crash, dense where the two landings are, with both equations
RECORDED = {
    "t_ignite": [
        *(0.0, 10.0, 20.0, 25.0, 30.0, 33.0, 35.0, 35.5, 35.8, 35.84, 35.86, 35.87, 35.88, 35.89, 35.9, 35.92, 36.0),
        *(36.5, 38.0, 40.0, 45.0, 50.0, 55.0, 57.0, 58.0, 59.0, 59.5, 60.0, 60.1, 60.15, 60.19, 60.2, 60.21, 60.211),
        *(60.22, 60.25, 60.3, 60.4, 60.6, 61.0, 61.5, 62.0, 63.0, 64.0, 65.0, 66.0, 67.0, 70.0, 80.0),
    ],
    "dt": [0.1, 0.02, 0.01],
    "faults": [False, True],
    "methods": [("rkn4",)],  # the paper's own
}
LANDINGS = {  # named as the buttons that lead there
    "The paper's landing": {"t_ignite": 35.88, "dt": 0.02, "faults": True},
    "Find the optimum": {"t_ignite": 60.211, "dt": 0.02, "faults": False},
}

# name of the axis, its limits, and what of a trial is drawn on it
PANELS = (
    ("height [km]", (-5, 160), lambda trial: trial["h"] / 1e3),
    ("velocity [m/s]", (-2700, 500), lambda trial: trial["v"]),
    ("velocity [m/s]", (-2700, 500), lambda trial: trial["v"]),
    ("mass [t]", (-10, 62), lambda trial: trial["mass"] / 1e3),
    ("thrust [MN]", (-0.5, 16), lambda trial: trial["thrust"] / 1e6),
    ("felt [g]", (-5, 45), lambda trial: trial["felt"] / FREE_FALL),
)
OVER_HEIGHT = 2
SIZE, DPI = (980, 470), 100
"""Of the figure [CSS px], and in an inch of it, before a browser says what room it has."""


@lru_cache(maxsize=16)
def _fall(descent, dt, method):
    return FreeFall(descent, dt=dt, method=method)


@lru_cache(maxsize=16)
def try_out(descent, t_ignite, dt, method, faults=False):
    """Fly once.

    Parameters
    ----------
    descent : Descent
    t_ignite, dt : float
        [s]
    method : str
        A key of `METHODS`.
    faults : bool
        Fly the published equation, which knows the paper's descent only, with all its faults.

    Returns
    -------
    dict
        "t", "h", "v", "mass", "thrust" and "felt", arrays in SI units; "end", how many samples come before the end
        of a hover; "height", the signed hover height [m], nan if there is none; and "verdict", a str.

    Raises
    ------
    ValueError
        If the published equation is asked for another descent than the paper's.
    """
    if faults:
        return _try_published(descent, t_ignite, dt, method)
    fall = _fall(descent, dt, method)
    flight = fall.fly(t_ignite)
    try:
        height = flight.hover[1] if flight.hover else fall.hover_height(t_ignite)  # the same, if it hovered
    except NoSoftLanding:
        height = math.nan
    return {
        "t": flight.t,
        "h": flight.h,
        "v": flight.v,
        "mass": flight.mass,
        "thrust": flight.throttle * descent.booster.thrust,
        "felt": flight.felt_acceleration,
        "end": plotting.hover_end(flight),
        "height": height,
        "verdict": verdict(flight, height, brief=True),
    }


def _try_published(descent, t_ignite, dt, method):
    if descent != Descent():
        raise ValueError("the published equation knows the paper's booster on the Earth only: press Reset")
    run = published.fly(t_ignite, dt=dt, method=method)
    lit = run.t > t_ignite
    f = published.acceleration(t_ignite)
    h, v = published.listed(run, at_rest=bool(np.any(run.v >= 0)))
    return {
        "t": run.t,
        "h": run.h,
        "v": run.v,
        "mass": run.mass,
        "thrust": np.where(lit, -7.6e3, 0.0),
        "felt": np.array([f(*row) for row in zip(run.t, run.h, run.v, strict=True)]) + EARTH.gravity(run.h),
        "end": len(run.t),
        "height": math.nan,
        "verdict": f"comes to 0 m/s {h:.1f} m above the ground" if v == 0 else f"largest velocity {v:.1f} m/s",
    }


def stroke(method, length=44, width=3):
    """A piece of a method's line, to stand before its name, as SVG; length and width [px]."""
    look = plotting.line(method)
    named = {"-": (), "--": plt.rcParams["lines.dashed_pattern"]}
    dashes = named[look["linestyle"]] if look["linestyle"] in named else look["linestyle"][1]
    pattern = " ".join(f"{width * dash:g}" for dash in dashes)
    drawn = f'stroke="{look["color"]}" stroke-width="{width}" stroke-dasharray="{pattern}"'
    return f'<svg width="{length}" height="10" aria-hidden="true"><line x2="{length}" y1="5" y2="5" {drawn}/></svg>'


class Methods(anywidget.AnyWidget):
    """A button for each method, in its colour and line: pressed, it is flown; and together they are the legend."""

    _esm = Path(__file__).with_name("mission_control.js")
    _css = Path(__file__).with_name("mission_control.css")
    description = traitlets.Unicode("methods").tag(sync=True)
    options = tuple((method.title.partition(" (")[0], key) for key, method in METHODS.items())
    value = traitlets.Tuple().tag(sync=True)
    looks = traitlets.List([{"key": key, "title": title, "mark": stroke(key, 30, 2.5)} for title, key in options]).tag(
        sync=True
    )

    @traitlets.validate("value")
    def _known(self, proposal):
        unknown = [key for key in proposal.value if key not in METHODS]
        if unknown:
            raise traitlets.TraitError(f"methods are {', '.join(METHODS)}; got {unknown[0]!r}")
        return tuple(key for key in METHODS if key in proposal.value)


class _Panels(Live):
    """A figure that fills the room it is given."""

    def fit(self, width, height, font, ratio):
        self.fig.set_size_inches(width / DPI, height / DPI)
        self.fig.set_dpi(DPI * ratio)
        columns = 3 if width > 600 else 2
        grid = _grid(self.fig, len(PANELS) // columns, columns, width / font, height / font)
        for ax, place in zip(self.fig.axes, grid, strict=True):
            ax.set_subplotspec(place)
            ax.tick_params(labelsize=font * 72 / DPI)
        for text in self.fig.findobj(Text):
            text.set_fontsize(font * 72 / DPI)

    def say(self, text):
        verdicts = text.split("\n")[:-1]
        chosen = self.controls["methods"].value if verdicts else ()
        with self.screen.hold_sync():
            self.screen.marks = [stroke(method) for method in chosen]
            super().say(text)


def _grid(fig, rows, columns, width, height):
    """Places for panels with room for their labels, in a figure of width and height [in the size of its letters]."""
    left, right, below, above = 5.7, 1.3, 3.4, 0.7
    wide, high = width / columns - left - right, height / rows - below - above
    edges = {"left": left / width, "right": 1 - right / width, "bottom": below / height, "top": 1 - above / height}
    return GridSpec(rows, columns, fig, wspace=(left + right) / wide, hspace=(below + above) / high, **edges)


class MissionControl:
    """The controls, the figure that follows them, and the table of the trials that were kept."""

    def __init__(self):
        self.trials = []
        controls = {
            "t_ignite": FloatText(step=0.001, description="ignition [s]"),
            "dt": SelectionSlider(options=STEPS, description="step dt [s]"),
            "thrust": FloatSlider(min=0.2, max=15, step=0.1, description="thrust [MN]", readout_format=".1f"),
            "drag": FloatSlider(min=0, max=2, step=0.05, description="drag coefficient"),
            "planet": Dropdown(options=list(PLANETS), description="planet"),
            "methods": Methods(),
            "faults": Checkbox(description="the published equation, faults included", indent=False),
            "moment": IntSlider(min=0, max=100, description="moment [% of flight]"),
        }
        for name, control in controls.items():
            control.value = START[name]
        self.slider = self._slider(controls["t_ignite"])
        self.live = _Panels(self._figure(), self._fly, recorded=RECORDED, landmarks=LANDINGS, **controls)
        self.table, self.play = HTML(), Play(100, min=0, max=100, step=2, interval=120, layout=Layout(display="none"))
        jslink((self.play, "value"), (controls["moment"], "value"))
        self.live.widget = self._layout(controls)

    def show(self):
        """Show the page; a notebook stores a still picture of it."""
        self.live.show()

    def reset(self, _=None):
        """Put every control where it began."""
        self.live.set(**START)

    def papers_landing(self, _=None):
        """Set all that the paper's landing was computed with: its equation, its booster, its method and its numbers."""
        self.live.set(**START | {"methods": ("rkn4",)} | LANDINGS["The paper's landing"])

    def find(self, _=None):
        """Set the ignition to the optimum of the descent that is set, to the microsecond."""
        try:
            best = best_ignition(self._descent(**self.live.values()))
        except (ValueError, ArithmeticError) as error:
            self.live.say(f"No soft landing: {error}")
            return
        self.live.set(t_ignite=round(best.t_ignite, 6), faults=False)

    def keep(self, _=None):
        """Add what is shown to the table of trials; nothing where the page says why it is not possible."""
        values = self.live.values()
        how = values["t_ignite"], values["dt"]
        try:
            trials = {m: try_out(self._descent(**values), *how, m, values["faults"]) for m in values["methods"]}
        except (ValueError, ArithmeticError):
            return
        for method, trial in trials.items():
            row = {"t_ignite [s]": values["t_ignite"], "dt [s]": values["dt"], "method": method}
            row |= {"thrust [MN]": values["thrust"], "drag coefficient": values["drag"], "planet": values["planet"]}
            row |= {"equation": "published" if values["faults"] else "right"}
            row |= {"hover height [m]": round(trial["height"], 4), "verdict": trial["verdict"]}
            self.trials = [*self.trials, row][-KEPT:]
        self._list()

    def clear(self, _=None):
        """Empty the table of trials."""
        self.trials = []
        self._list()

    def to_frame(self):
        """The trials that were kept, as a pandas DataFrame, the newest last."""
        return pd.DataFrame(self.trials)

    def _slider(self, number):
        """For dragging; the number beside it takes what is typed, as it is typed."""
        slider = FloatSlider(number.value, min=0, max=90, step=0.01, description=number.description, readout=False)
        number.description, number.tooltip = "", number.description

        # each follows the other to another place only: browsers send places back, a bit beside
        def apart():
            return not math.isnan(number.value) and on_grid(slider.value, slider) != on_grid(number.value, slider)

        def typed(change):
            if apart():
                slider.value = on_grid(number.value, slider)

        def dragged(change):
            if apart():
                number.value = on_grid(slider.value, slider)

        number.observe(typed, "value")
        slider.observe(dragged, "value")
        return slider

    def _descent(self, thrust, drag, planet, **_):
        booster = replace(FALCON_9, thrust=1e6 * thrust, drag_coefficient=drag)
        return Descent(booster, PLANETS[planet])

    def _figure(self):
        fig, axes = plt.subplots(2, 3, figsize=[side / DPI for side in SIZE], dpi=DPI)
        self.lines = {name: [] for name in METHODS}
        for n, (ax, (name, limits, _)) in enumerate(zip(axes.flat, PANELS, strict=True)):
            ax.set(ylabel=name, ylim=limits, xlabel="t [s]", xlim=(0, 100))
            if n == OVER_HEIGHT:
                ax.set(xlabel="height [m]", xscale="log", xlim=(2e5, 1e-3))
            for method, lines in self.lines.items():
                look = plotting.line(method, label=None) | {"animated": True, "linewidth": 1.6}
                before, after, now = (ax.plot([], [], **look)[0] for _ in range(3))
                after.set_alpha(0.3)
                now.set(marker="o", markersize=7)
                lines.append((before, after, now))
        return fig

    def _fly(self, t_ignite, methods, dt, moment, faults, **values):
        if not methods:
            raise ValueError("choose at least one method")
        descent = self._descent(**values)
        said = []
        for method, lines in self.lines.items():
            trial = try_out(descent, t_ignite, dt, method, faults) if method in methods else None
            _draw(lines, trial, moment / 100)
            if trial:
                said.append(f"{METHODS[method].title.partition(' (')[0]}: {trial['verdict']}.")
        return "\n".join([*said, f"Ignition at {t_ignite:.6f} s, dt = {dt:.3g} s."])

    def _layout(self, controls):
        buttons = []
        for name, what, act in (
            ("Reset", "every control to where it began", self.reset),
            ("The paper's landing", "set the published equation and the numbers of its landing", self.papers_landing),
            ("Find the optimum", "set the best ignition time", self.find),
            ("Keep this trial", "add it to the table", self.keep),
            ("Clear the table", "forget all trials", self.clear),
        ):
            button = Button(description=name, tooltip=what)
            button.on_click(act)
            buttons.append(button)
        play = ToggleButton(description="Play", tooltip="play or pause the flight")
        jslink((play, "value"), (self.play, "playing"))  # Play's own buttons have no names
        side = VBox(
            [
                *(controls[name] for name in ("thrust", "drag", "planet", "faults", "moment")),
                HBox([play, *buttons, self.play]),
            ]
        )
        ignition = HBox([self.slider, controls["t_ignite"]])
        page = VBox([ignition, controls["dt"], controls["methods"], self.live.screen, side])
        whole = VBox([page, self.table])
        parts = {"ignition": ignition, "side": side, "window": page, "trials": self.table, "live": whole}
        for name, part in parts.items():
            part.add_class(f"hoverslam-{name}")
        return whole

    def _list(self):
        if not self.trials:
            self.table.value = ""
            return
        frame = self.to_frame()
        data = base64.b64encode(frame.to_csv(index=False).encode("utf-8")).decode("ascii")
        table = frame.to_html(index=False, border=0, justify="unset", na_rep="–").replace("<th>", '<th scope="col">')
        link = f'<a download="trials.csv" href="data:text/csv;base64,{data}">Download the table as CSV</a>'
        self.table.value = f"{table}<p>{link}</p>"


def _draw(lines, trial, share):
    """Put one trial on the six panels, with a dot at a share of its time; nothing if there is no trial."""
    for n, (parts, (_, _, value)) in enumerate(zip(lines, PANELS, strict=True)):
        for part in parts:
            part.set_visible(trial is not None)
        if trial is None:
            continue
        x, y, end = np.maximum(trial["h"], 1e-3) if n == OVER_HEIGHT else trial["t"], value(trial), trial["end"]
        now = int(np.searchsorted(trial["t"], share * trial["t"][-1]))
        before, after, dot = parts
        before.set_data(x[:end], y[:end])
        after.set_data(x[end - 1 :], y[end - 1 :])
        dot.set_data(x[now : now + 1], y[now : now + 1])
