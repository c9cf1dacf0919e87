"""What a live figure shows at each of its positions, for a page that has no kernel."""

import base64
import io
import json
import math
import re
from itertools import combinations, product

import numpy as np
import traitlets
from ipywidgets import Checkbox, FloatLogSlider, FloatSlider, IntSlider
from PIL import Image

from hoverslam_lib.live import on_grid, value_of

MOST_POSITIONS = 300
"""Of one figure: each costs its page some kilobytes."""

CLEAR = 31
"""The place in a layer's palette that lets the ground through."""


def positions(live):
    """The values that each control takes on a page without a kernel, see `recorded` of `Live`.

    Parameters
    ----------
    live : Live

    Returns
    -------
    dict of str to list
        By the name of the control.

    Raises
    ------
    ValueError
        If there is no such control, one has no such place, or there are more than `MOST_POSITIONS`.
    """
    wanted = _first_two(live.controls) if live.recorded is None else live.recorded
    unknown = [name for name in wanted if name not in live.controls]
    if unknown:
        raise ValueError(f"recorded: there is no control {unknown[0]!r}; there are {', '.join(live.controls)}")
    found = {
        name: _all_places(live.controls[name]) if given is None else _those_of(live.controls[name], given)
        for name, given in wanted.items()
    }
    free = sorted((name for name, given in wanted.items() if given is None), key=lambda name: len(found[name]))
    for n, name in enumerate(free, start=1):
        others = math.prod(len(found[other]) for other in wanted if other not in free[n - 1 :])
        found[name] = _thinned(live.controls[name], int((MOST_POSITIONS / others) ** (1 / (len(free) - n + 1))))
    number = math.prod(len(places) for places in found.values())
    if number > MOST_POSITIONS:
        raise ValueError(f"recorded: {number} positions in all; at most {MOST_POSITIONS} are kept")
    return {name: found[name] for name in live.controls if name in found}


def frames(live, places):
    """Put a live figure through all its positions, the last control fastest; it ends where it was.

    Parameters
    ----------
    live : Live
    places : dict of str to list
        From `positions`.

    Yields
    ------
    sentence : str
    pixels : ndarray of uint8, shape (height, width, 4)
        As `Live` shows them.
    """
    start = {name: control.value for name, control in live.controls.items()}
    try:
        for values in product(*places.values()):
            live.set(**dict(zip(places, values, strict=True)))
            yield live.text, live.pixels()
    finally:
        live.set(**start)


def record(live):
    """A live figure as a page without a kernel keeps it, ready for JSON.

    Returns
    -------
    dict
        "width", "height" [px]; "controls", a list of dicts with "name", "unit", "shown" (the positions as text),
        "start" (which of them comes first: that of the figure if it is among them) and "checkbox"; "kept", name and
        value of each control that does not move there; "landmarks", dicts with "name" and "places", the number of the
        position of each control; "ground", a PNG, and "layers", PNGs to lie on it, all as base64;
        "sentences", one a layer.
    """
    places, ground = positions(live), live.pixels(moving=False)
    sentences, layers = zip(*((said, layer(now, ground)) for said, now in frames(live, places)), strict=True)
    still = {name: value_of(control) for name, control in live.controls.items() if len(places.get(name, [0])) == 1}
    still |= {name: places[name][0] for name in places if name in still}
    moving = {name: values for name, values in places.items() if name not in still}
    height, width = ground.shape[:2]
    return {
        "width": width,
        "height": height,
        "controls": [_control(live.controls[name], values) for name, values in moving.items()],
        "kept": [_kept(live.controls[name], value) for name, value in still.items()],
        "landmarks": [_landmark(name, wanted, moving) for name, wanted in live.landmarks.items()],
        "ground": _png(Image.fromarray(ground).convert("RGB").quantize(256, dither=Image.Dither.NONE)),
        "layers": layers,
        "sentences": sentences,
    }


def layer(now, ground):
    """A PNG with what differs from the ground, in few colours, the rest transparent, as base64."""
    moves = (now.view(np.uint32) != ground.view(np.uint32))[..., 0]  # of a whole pixel at once: fifty times as fast
    colours = np.full(now.shape[:2], CLEAR, dtype=np.uint8)
    palette = np.zeros((CLEAR + 1, 3), dtype=np.uint8)
    if moves.any():
        few = Image.fromarray(now[moves][None, :, :3]).quantize(CLEAR, dither=Image.Dither.NONE)
        colours[moves] = np.asarray(few)[0]
        found = np.reshape(few.getpalette(), (-1, 3))[:CLEAR]
        palette[: len(found)] = found
    image = Image.fromarray(colours)
    image.putpalette(palette.tobytes())
    return _png(image, transparency=CLEAR)


def script(name, recorded):
    """A recording as a script that a page opened from a folder may load: ``fetch`` may not."""
    return f"hoverslam.recordings[{json.dumps(name)}] = {json.dumps(recorded, ensure_ascii=False)};\n"


def _png(image, **options):
    packed = io.BytesIO()
    image.save(packed, format="png", optimize=True, **options)
    return base64.b64encode(packed.getvalue()).decode("ascii")


def _first_two(controls):
    names = list(controls)[:2]
    if "dt" in controls and "dt" not in names:
        names[-1] = "dt"
    return dict.fromkeys(names)


def _places(control):
    """All places that a control has of its own, or None: it takes any number."""
    if hasattr(control, "options"):
        values = [option[1] if isinstance(option, tuple) else option for option in control.options]
        several = isinstance(control.value, tuple)
        return [chosen for n in range(len(values) + 1) for chosen in combinations(values, n)] if several else values
    if isinstance(control, Checkbox):
        return [False, True]
    if isinstance(control, IntSlider):
        return list(range(control.min, control.max + 1, control.step))
    if isinstance(control, (FloatSlider, FloatLogSlider)) and control.step:
        steps = range(int((control.max - control.min) / control.step + 1e-9) + 1)
        places = [on_grid(control.min + n * control.step, control) for n in steps]
        return [control.base**place for place in places] if isinstance(control, FloatLogSlider) else places
    return None


def _all_places(control):
    places = _places(control)
    if places is None:
        raise ValueError(f"recorded: name the positions of {control.description!r}, which has no steps of its own")
    return places


def _those_of(control, values):
    """The places of a control that are equal to values. It is not put there: its figure would follow."""
    places = _places(control)
    return [_place(control, value, places) for value in values]


def _place(control, value, places):
    if places is None:
        try:
            return control.traits()["value"].validate(control, value)
        except traitlets.TraitError as error:
            raise ValueError(f"recorded: {control.description!r} cannot be {value!r}: {error}") from None
    if value in places:
        return places[places.index(value)]
    numbers = all(isinstance(number, (int, float)) for number in (value, *places))
    nearest = f"; the nearest is {min(places, key=lambda place: abs(place - value))!r}" if numbers else ""
    raise ValueError(f"recorded: {control.description!r} has no place {value!r}{nearest}")


def _thinned(control, most):
    """At most so many places of a control, spread evenly, with the present one among them."""
    places, present = _all_places(control), value_of(control)
    if len(places) > most:
        places = [places[round(n)] for n in np.linspace(0, len(places) - 1, max(most, 2))]
    if present not in places:
        places[min(range(len(places)), key=lambda n: abs(places[n] - present))] = present
    return places


def _control(control, places):
    shown = [_shown(control, place) for place in places]
    name, unit = _name(control)
    return {
        "name": name,
        "unit": unit,
        "shown": shown,
        "start": places.index(value_of(control)) if value_of(control) in places else 0,
        "checkbox": isinstance(control, Checkbox),
    }


def _landmark(name, wanted, moving):
    for control, value in (dict.fromkeys(moving) | wanted).items():
        if value not in moving.get(control, []):
            raise ValueError(f"landmarks: {name!r} has {control} = {value!r}, which is not recorded")
    return {"name": name, "places": [places.index(wanted[control]) for control, places in moving.items()]}


def _kept(control, value):
    name, unit = _name(control)
    return f"{name} {_shown(control, value)} {unit}".strip()


def _name(control):
    """What a label says, and the unit that it has in brackets."""
    return re.fullmatch(r"(.*?)\s*(?:\[(.+)\])?", control.description or control.tooltip or "").groups(default="")


def _shown(control, value):
    """A value as its control shows it."""
    if hasattr(control, "options"):
        labels = [option if isinstance(option, tuple) else (option, option) for option in control.options]
        wanted = value if isinstance(value, tuple) else (value,)
        return ", ".join(str(label) for label, known in labels if known in wanted)
    if isinstance(value, bool):
        return "on" if value else "off"
    shown = format(value, getattr(control, "readout_format", "") or "g")
    return re.sub(r"e([+-])0", r"e\1", shown)  # browsers write 1e-6
