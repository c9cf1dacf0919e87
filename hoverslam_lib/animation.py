"""A flight as a moving picture: a GIF of some hundred kilobytes with one palette, which plays without a kernel.

A film is made of *scenes*. A scene is a function that draws on axes what stays and returns ``move(t)``, which puts
what moves where it belongs at the time t [s] and returns those artists. The same scene makes the film and its stills.
"""

import io
import math
import sys
import time
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.path import Path as Outline
from PIL import Image

from hoverslam_lib import _validate
from hoverslam_lib.descent import SOFT_LANDING, Descent, Flight, fly
from hoverslam_lib.ignition import best_ignition
from hoverslam_lib.plotting import Picture, use_style

COLOURS = 16
"""Colours of a film, shared by all its frames."""

PLAYS = 3
"""How often a film plays before it stands still on its last frame: what moves for ever takes the eye off the text."""

LEGIBLE = 200
"""How long a number stands in a film of a landing [ms], because nobody reads faster."""

FREE_FALL = 9.81
"""One g [m/s²]."""

# outlines around the point between the feet; every one reaches to 1, because matplotlib scales markers by that
_BODY = Outline([(-0.07, 0.12), (-0.07, 0.95), (0, 1), (0.07, 0.95), (0.07, 0.12), (-0.07, 0.12)])
_LEGS = Outline(
    [(-0.2, 0), (-0.06, 0.34), (-0.06, 0.2), (-0.2, 0), (0.2, 0), (0.06, 0.34), (0.06, 0.2), (0.2, 0), (0, 1)],
    [1, 2, 2, 2, 1, 2, 2, 2, 1],
)


def _plume(throttle):
    tip = 0.12 - 0.8 * throttle
    return Outline([(-0.06, 0.12), (0.06, 0.12), (0, tip), (-0.06, 0.12), (0, 1)], [1, 2, 2, 2, 1])


@dataclass(frozen=True, repr=False)
class Animation:
    """A film with alternative text.

    Attributes
    ----------
    gif : bytes
    alt : str
        What the film shows, in words, with its numbers.
    frames : tuple of float
        The time of flight that each frame shows [s].
    durations : tuple of int
        How long each frame is shown [ms].
    width : int
        [pixels].
    """

    gif: bytes
    alt: str
    frames: tuple
    durations: tuple
    width: int

    def __repr__(self):
        return self.alt

    def _repr_html_(self):
        shown = Picture(self.gif, self.alt, self.width, kind="gif")._repr_html_()
        # a browser that has played a film plays it again only from an address that is new to it
        return shown.removesuffix('">') + f'#{time.time_ns()}">'


def film(fig, move, times, *, alt, duration=40, hold=2000):
    """Make a film of a figure.

    The figure is drawn once; in each frame only what moves is drawn over it.

    Parameters
    ----------
    fig : matplotlib.figure.Figure
    move : callable
        ``move(t)`` puts what moves where it belongs at t [s] and returns those artists, the hindmost first.
    times : array_like, shape (n,)
        The time of flight that each frame shows [s], increasing. Equal spaces make an even film.
    alt : str
        What the film shows, in words, with its numbers.
    duration : int
        How long a frame is shown [ms], in whole hundredths of a second: a GIF has no others. At least 20 ms, because
        browsers slow down what is faster.
    hold : int
        How long the last frame is shown [ms].

    Returns
    -------
    Animation

    Raises
    ------
    ValueError, TypeError
        If an argument is not allowed.
    """
    times = _frame_times(times)
    durations = [_hundredths("duration", duration)] * (len(times) - 1) + [_hundredths("hold", hold)]
    alt = _validate.alternative_text(alt, "film")
    frames = _render(fig, move, times)
    palette = _palette(frames[:: max(1, len(frames) // 8)] + frames[-1:])
    gif = _gif(_indexed(frames, palette), palette, durations)
    return Animation(gif, alt, tuple(times.tolist()), tuple(durations), frames[0].shape[1])


def _palette(frames):
    """The colours that matter, shape (n, 3): the most frequent one, then each time the one that is missed most."""
    packed, count = np.unique(_packed(np.concatenate(frames)), return_counts=True)
    colours = np.stack([packed >> 16, packed >> 8 & 255, packed & 255], axis=1).astype(int)
    missed = np.full(len(colours), np.inf)
    chosen = [int(np.argmax(count))]
    for _ in range(min(COLOURS - 1, len(colours)) - 1):
        missed = np.minimum(missed, np.sum((colours - colours[chosen[-1]]) ** 2, axis=1))
        chosen.append(int(np.argmax(missed * np.sqrt(count))))
    return colours[chosen]


def _packed(frame):
    red, green, blue = np.moveaxis(frame.astype(np.uint32), -1, 0)
    return red << 16 | green << 8 | blue


def _indexed(frames, palette):
    """Each frame with the number of the nearest colour for each pixel; only pixels that change are looked at."""
    indexed, before = [], None
    for frame in frames:
        packed = _packed(frame)
        new = np.ones(packed.shape, dtype=bool) if before is None else packed != before
        colours, which = np.unique(packed[new], return_inverse=True)
        parts = np.stack([colours >> 16, colours >> 8 & 255, colours & 255], axis=1).astype(int)
        nearest = np.argmin(np.sum((parts[:, np.newaxis] - palette) ** 2, axis=2), axis=1)
        indexed.append(indexed[-1].copy() if indexed else np.empty(packed.shape, dtype=np.uint8))
        indexed[-1][new] = nearest[which]
        before = packed
    return indexed


def _gif(frames, palette, durations):
    """A GIF that plays `PLAYS` times, all its frames with one palette; Pillow stores of each what has changed."""
    colours = palette.astype(np.uint8).tobytes()
    images = [Image.fromarray(frame) for frame in frames]
    for image in images:
        image.putpalette(colours)
    kept = io.BytesIO()
    timing = {"duration": durations, "loop": PLAYS - 1, "disposal": 1}
    images[0].save(kept, "gif", save_all=True, append_images=images[1:], palette=colours, optimize=True, **timing)
    return kept.getvalue()


def _render(fig, move, times):
    """One RGB array a frame: the still background once, and over it what moves."""
    canvas = FigureCanvasAgg(fig)
    moving = move(times[0])
    for artist in moving:
        artist.set_animated(True)
    canvas.draw()
    fig.set_layout_engine("none")
    background = canvas.copy_from_bbox(fig.bbox)
    frames = []
    for t in times:
        canvas.restore_region(background)
        for artist in move(t):
            artist.draw(canvas.get_renderer())
        frames.append(np.asarray(canvas.buffer_rgba())[..., :3].copy())
    for artist in moving:
        artist.set_animated(False)
    return frames


def resample(flight, times):
    """The same flight with rows at other times.

    Height and velocity come from the cubic through the values and slopes at both ends of a step (cubic Hermite),
    which within a step is of order 4. Mass is a straight line within a step, because the throttle is held there.

    Parameters
    ----------
    flight : Flight
    times : array_like, shape (n,)
        [s], increasing, within the flight.

    Returns
    -------
    Flight

    Raises
    ------
    ValueError
        If a time lies outside the flight.
    """
    _validate.instance("flight", flight, Flight)
    times, start, end = _frame_times(times), flight.t[0], flight.t[-1]
    if times[0] < start or times[-1] > end:
        in_ms = (
            f" (did you mean {times[0]:g} to {times[-1]:g} ms?)"
            if start <= times[0] / 1e3 <= times[-1] / 1e3 <= end
            else ""
        )
        raise ValueError(
            f"times must lie within the flight, {start:g} to {end:g} s; got {times[0]:g} to {times[-1]:g} s{in_ms}"
        )
    i = np.clip(np.searchsorted(flight.t, times, side="right") - 1, 0, len(flight.t) - 2)
    length = flight.t[i + 1] - flight.t[i]
    s = (times - flight.t[i]) / length
    throttle = flight.throttle[i]
    slopes = [_acceleration(flight, end, throttle) * length for end in (i, i + 1)]
    v = _cubic(s, flight.v[i], flight.v[i + 1], *slopes)
    h = _cubic(s, flight.h[i], flight.h[i + 1], flight.v[i] * length, flight.v[i + 1] * length)
    mass = flight.mass[i] + s * (flight.mass[i + 1] - flight.mass[i])
    return replace(flight, t=times, h=h, v=v, mass=mass, throttle=throttle)


def _acceleration(flight, at, throttle):
    descent, h, mass = flight.descent, flight.h[at], flight.mass[at]
    forces = throttle * descent.booster.thrust + descent.drag(h, flight.v[at]) - descent.weight(h, mass)
    return forces / mass


def _cubic(s, start, end, slope_start, slope_end):
    """The cubic on 0 <= s <= 1 with these values and slopes (with respect to s) at its ends."""
    rise = end - start
    return start + s * (
        slope_start + s * (3 * rise - 2 * slope_start - slope_end + s * (slope_start + slope_end - 2 * rise))
    )


def booster_scene(ax, flight, *, top):
    """A booster over the ground, its feet at the height of the flight; its size is not to scale.

    The length of the plume follows the throttle. What comes after a hover is faint, unless it is a soft landing.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
    flight : Flight
    top : float
        The largest height to be shown [m].

    Returns
    -------
    callable
        ``move(t)``, see `film`.
    """
    top = top or 1.0  # if it stands on the ground all the time
    unit, name = (1e3, "km") if top > 2e3 else (1.0, "m")
    ax.set(xlim=(-1, 1), ylim=(-0.1 * top / unit, 1.65 * top / unit), xticks=[], ylabel=f"h [{name}]")
    ax.grid(visible=False)
    ax.spines["bottom"].set_visible(False)
    ax.locator_params(axis="y", nbins=9)
    ax.set_yticks([tick for tick in ax.get_yticks() if 0 <= tick <= 1.05 * top / unit])
    style = {"linestyle": "none", "markeredgewidth": 0}
    plume, legs, body = (
        ax.plot([0], [0], marker=marker, markersize=120, color=color, **style)[0]
        for marker, color in ((_plume(1), "#E69F00"), (_LEGS, "black"), (_BODY, "#0072B2"))
    )
    plume.set_clip_path(Rectangle((-1, 0), 2, 2 * top / unit, transform=ax.transData))
    ax.axhspan(-0.1 * top / unit, 0, color="0.8", linewidth=0)

    def move(t):
        now = resample(flight, [t])
        after = flight.outcome != SOFT_LANDING and flight.hover is not None and t > flight.hover[0]
        for part in (plume, legs, body):
            part.set_data([0], [now.h[0] / unit])
            part.set_alpha(0.3 if after else 1.0)
        plume.set_marker(_plume(now.throttle[0]))
        return [plume, legs, body]

    return move


_QUANTITIES = {
    "height": ("m", 1, lambda flight: flight.h),
    "velocity": ("m/s", 0, lambda flight: flight.v),
    "propellant": ("t", 1, lambda flight: (flight.mass - flight.descent.booster.dry_mass) / 1e3),
    "thrust": ("MN", 1, lambda flight: flight.throttle * flight.descent.booster.thrust / 1e6),
    "felt": ("g", 1, lambda flight: flight.felt_acceleration / FREE_FALL),
}


def readings(flight, t):
    """What the instruments show at the time t [s]: for each name a str, a number with its unit."""
    now = resample(flight, [t])
    shown = {"time": f"{t:.2f} s"}
    for name, (unit, digits, value) in _QUANTITIES.items():
        number = float(value(now)[0])
        if name == "height" and number >= 1000:
            number, unit = number / 1e3, "km"
        shown[name] = f"{round(number, digits) + 0.0:.{digits}f} {unit}"
    return shown


def instruments(ax, flight):
    """The numbers of `readings` one below the other.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
    flight : Flight

    Returns
    -------
    callable
        ``move(t)``, see `film`.
    """
    ax.axis("off")
    ax.set(xlim=(0, 1), ylim=(-0.6, 6.4))
    numbers = {}
    for n, name in enumerate(["time", *_QUANTITIES]):
        ax.text(0, 5 - n, name, color="0.35", va="center", fontsize=12)
        text = {"ha": "right", "va": "center", "fontweight": "bold", "fontsize": 12, "antialiased": False}
        numbers[name] = ax.text(0.95, 5 - n, "", **text)  # changing numbers fill the file: two colours are enough

    def move(t):
        for name, shown in readings(flight, t).items():
            numbers[name].set_text(shown)
        return list(numbers.values())

    return move


def pace(times, duration):
    """How fast a film runs, for each frame, in words: from its own times [s] and the time a frame is shown [ms]."""
    times, duration = _frame_times(times), _hundredths("duration", duration)
    if len(times) < 2:
        return ["still"] * len(times)
    ratios = np.diff(times) * 1e3 / duration
    words = []
    for ratio in (*ratios, ratios[-1]):
        if abs(ratio - 1) < 1e-3:
            words.append("real time")
        else:
            words.append(f"{ratio:.3g} times faster" if ratio > 1 else f"slowed {1 / ratio:.3g} times")
    return words


def landing_film(flight, times, *, alt, duration=40, hold=2000):
    """Make a film of a flight: the booster on the left, its instruments on the right, and how fast the film runs.

    The booster moves with every frame. The instruments stand for at least `LEGIBLE`; they belong to the time that they
    show, and in the last frame that is its own.

    Parameters
    ----------
    flight : Flight
    times : array_like, shape (n,)
        The time of flight that each frame shows [s], increasing, within the flight.
    alt, duration, hold
        See `film`.

    Returns
    -------
    Animation
    """
    times = _frame_times(times)
    fig = Figure(figsize=(5.2, 3.4))
    left, right = fig.subplots(1, 2, width_ratios=(0.6, 1))
    scene = booster_scene(left, flight, top=float(np.max(resample(flight, times).h)))
    read = instruments(right, flight)
    speed = right.text(0, 6, "", va="center", fontweight="bold", color="#0072B2", fontsize=12)
    frames = np.arange(len(times))
    late = (frames - frames[-1]) % math.ceil(LEGIBLE / _hundredths("duration", duration))
    read_at = times[np.maximum(frames - late, 0)]
    shown = dict(zip(times.tolist(), zip(read_at, pace(times, duration), strict=True), strict=True))

    def move(t):
        at, words = shown[float(t)]
        speed.set_text(words)
        return [*scene(t), *read(at), speed]

    return film(fig, move, times, alt=alt, duration=duration, hold=hold)


def whole_burn():
    """Make the film of the README: the paper's booster from 2 s before the best ignition on, at double speed."""
    descent = Descent()
    best = best_ignition(descent)
    flight = fly(descent, best.t_ignite)
    times = np.arange(flight.t[-1], best.t_ignite - 2, -0.08)[::-1]
    alt = (
        f"A booster falls towards the ground at {-best.v_ignite:.0f} m/s, lights its engines "
        f"{best.h_ignite / 1e3:.1f} km above it and stops on it {flight.t[-1] - best.t_ignite:.1f} s later"
    )
    return landing_film(flight, times, alt=alt, duration=40)


def landing_stills(flight, times, *, top=None):
    """Return a figure with the booster at a few times side by side, for `plotting.show`.

    Parameters
    ----------
    flight : Flight
    times : array_like, shape (n,)
        [s], increasing, within the flight.
    top : float, optional
        The largest height to be shown [m]; that of the first picture if it is left out.
    """
    times = _frame_times(times)
    top = float(resample(flight, times[:1]).h[0]) if top is None else _validate.number("top", top, "m", above=0)
    fig = Figure(figsize=(1.85 * len(times), 3.4))
    for n, (ax, t) in enumerate(zip(fig.subplots(1, len(times), squeeze=False)[0], times, strict=True)):
        booster_scene(ax, flight, top=top)(t)
        shown = readings(flight, t)
        ax.set_title("\n".join([shown["time"], shown["height"], shown["velocity"], shown["felt"]]), fontsize=10)
        if n:
            ax.set(ylabel="", yticklabels=[])
    return fig


def _frame_times(times):
    times = _validate.array("times", times, "s")
    if times.ndim != 1 or not len(times) or not np.all(np.isfinite(times)) or np.any(np.diff(times) <= 0):
        raise ValueError(f"times must be one or more finite numbers [s], increasing; got {times!r}")
    return times


def _hundredths(name, duration):
    milliseconds = _validate.number(name, duration, "ms", least=20)
    if milliseconds % 10:
        raise ValueError(f"{name} must be a whole number of hundredths of a second, as in a GIF; got {duration!r} ms")
    return int(milliseconds)


if __name__ == "__main__":  # python -m hoverslam_lib.animation notebooks/images/landing.gif
    use_style()
    with open(sys.argv[1], "wb") as file:
        file.write(whole_burn().gif)
