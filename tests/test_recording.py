"""What a page without a kernel has of a live figure."""

import base64
import io
import json

import matplotlib.pyplot as plt
import numpy as np
import pytest
from ipywidgets import Checkbox, FloatLogSlider, FloatSlider, FloatText, IntSlider, SelectionSlider, SelectMultiple
from PIL import Image
from screen import shown

from hoverslam_lib import recording
from hoverslam_lib.live import Live
from hoverslam_lib.mission_control import MissionControl


def made(recorded=None, landmarks=None, **controls):
    """A dot that follows x, on a figure with the controls given."""
    fig, ax = plt.subplots(figsize=(3, 2))
    ax.set(xlim=(-1, 12), ylim=(-1, 1))
    (dot,) = ax.plot([], [], "o", animated=True)

    def put(x, **others):
        if x > 9:
            raise ValueError("too far")
        dot.set_data([x], [0])
        return f"the dot is at {x!r}, the others at {others}"

    controls = {"x": FloatSlider(5, min=0, max=10, step=0.1, description="place [m]"), **controls}
    return Live(fig, put, recorded=recorded, landmarks=landmarks, **controls)


def opened(png):
    return np.array(Image.open(io.BytesIO(base64.b64decode(png))).convert("RGBA"))


def test_positions_are_those_named_or_places_spread_evenly_with_the_present_one_among_them():
    assert recording.positions(made({"x": [0, 0.3, 5]})) == {"x": [0, 0.3, 5]}
    assert recording.positions(made()) == {"x": [round(0.1 * n, 1) for n in range(101)]}
    fine = made(x=FloatSlider(3.337, min=0, max=10, step=0.001, description="x"))
    (places,) = recording.positions(fine).values()
    assert len(places) == recording.MOST_POSITIONS
    assert 3.337 in places
    assert places == sorted(places)
    assert (places[0], places[-1]) == (0, 10)
    assert max(np.diff(places)) < 0.07


def test_without_a_choice_the_first_two_controls_move_and_dt_among_them():
    dt = SelectionSlider(value=0.02, options=[0.1, 0.05, 0.02], description="dt [s]")
    flag, z = Checkbox(True, description="flag"), FloatLogSlider(0.1, min=-2, max=0, step=0.5, description="z")
    found = recording.positions(made(flag=flag, z=z, dt=dt))
    assert list(found) == ["x", "dt"]
    assert found["dt"] == [0.1, 0.05, 0.02]
    assert 50 < len(found["x"]) <= 100
    found = recording.positions(made(flag=flag, z=z))
    assert found["flag"] == [False, True]
    assert recording.positions(made({"z": None}, z=z))["z"] == pytest.approx(10.0 ** np.arange(-2, 0.1, 0.5))


def test_finding_the_positions_moves_nothing_and_recording_draws_each_once():
    live = made({"x": [0, 0.3], "n": None}, n=IntSlider(3, min=1, max=7, step=2, description="n"))
    drawn, update = [], live.update
    live.update = lambda **values: drawn.append(values) or update(**values)
    places = recording.positions(live)
    assert places == {"x": [0, 0.3], "n": [1, 3, 5, 7]}
    assert {type(n) for n in places["n"]} == {int}  # 5.0 is refused by the control
    assert drawn == []
    list(recording.frames(live, places))
    assert drawn == [{"x": x, "n": n} for x in (0, 0.3) for n in (1, 3, 5, 7)] + [{"x": 5, "n": 3}]


@pytest.mark.parametrize(
    ("recorded", "message"),
    [
        ({"y": None}, "no control 'y'; there are x, free, names"),
        ({"x": [0.25]}, "'place [m]' has no place 0.25; the nearest is 0.2"),
        ({"x": ["far"]}, "'place [m]' has no place 'far'"),
        ({"x": [11]}, "'place [m]' has no place 11; the nearest is 10.0"),
        ({"free": ["far"]}, "'free' cannot be 'far'"),
        ({"names": [("a", "c")]}, "'names' has no place ('a', 'c')"),
        ({"x": None, "free": list(range(4))}, None),
        ({"x": [1], "free": range(301)}, "301 positions in all; at most 300 are kept"),
        ({"free": None}, "name the positions of 'free', which has no steps of its own"),
    ],
)
def test_what_cannot_be_recorded_is_said(recorded, message):
    names = SelectMultiple(options=["a", "b"], description="names")
    live = made(recorded, free=FloatText(0, description="free"), names=names)
    if message is None:
        assert len(recording.positions(live)["x"]) == 75
        return
    with pytest.raises(ValueError, match="recorded: ") as raised:
        recording.positions(live)
    assert message in str(raised.value)


def test_each_frame_is_what_the_kernel_shows_there_to_the_word_and_the_pixel():
    live = made({"x": [0, 2.5, 9.5], "flag": [True, False]}, flag=Checkbox(True, description="flag"))
    before = live.text, live.pixels()
    frames = list(recording.frames(live, recording.positions(live)))
    assert live.text == before[0]
    assert np.array_equal(live.pixels(), before[1])
    places = [(x, flag) for x in (0, 2.5, 9.5) for flag in (True, False)]
    for (x, flag), (sentence, pixels) in zip(places, frames, strict=True):
        live.set(x=x, flag=flag)
        assert sentence == live.text
        assert np.array_equal(pixels[..., :3], shown(live.screen))
    assert frames[-1][0] == "Not possible: too far"


def test_layers_cover_what_moves_and_nothing_else():
    live = made({"x": [0, 2.5, 9.5]})
    recorded, ground = recording.record(live), live.pixels(moving=False)
    assert np.abs(opened(recorded["ground"]).astype(int) - ground).max() <= 8  # 256 colours
    for layer, (_, pixels) in zip(recorded["layers"], recording.frames(live, recording.positions(live)), strict=True):
        layer = opened(layer)
        covers = layer[..., 3] > 0
        assert np.array_equal(covers, np.any(pixels != ground, axis=-1))
        if covers.any():
            assert np.abs(layer[covers].astype(int) - pixels[covers]).mean() < 8  # 31 colours
    assert not opened(recorded["layers"][-1])[..., 3].any()  # it raised there: nothing moves


def test_a_record_says_what_its_controls_show_and_what_stays():
    dt = SelectionSlider(value=0.02, options=[0.1, 0.02], description="dt [s]")
    flag, z = Checkbox(True, description="flag"), FloatLogSlider(0.1, min=-2, max=0, step=0.5, description="z [s]")
    recorded = recording.record(made({"x": [1, 5], "flag": None, "dt": [0.1]}, flag=flag, z=z, dt=dt))
    assert recorded["controls"] == [
        {"name": "place", "unit": "m", "shown": ["1.00", "5.00"], "start": 1, "checkbox": False},
        {"name": "flag", "unit": "", "shown": ["off", "on"], "start": 1, "checkbox": True},
    ]
    assert sorted(recorded["kept"]) == ["dt 0.1 s", "z 0.1 s"]
    assert recorded["sentences"][3] == "the dot is at 5.0, the others at {'flag': True, 'z': 0.1, 'dt': 0.1}"
    script = recording.script("page-0", recorded)
    assert json.loads(script.removeprefix('hoverslam.recordings["page-0"] = ').removesuffix(";\n")) == json.loads(
        json.dumps(recorded)
    )


def test_landmarks_are_positions_among_those_recorded():
    flag = Checkbox(False, description="flag")
    recorded = recording.record(made({"flag": None, "x": [1, 5]}, {"there": {"x": 5.0, "flag": True}}, flag=flag))
    assert recorded["landmarks"] == [{"name": "there", "places": [1, 1]}]
    assert recorded["sentences"][3].startswith("the dot is at 5.0, the others at {'flag': True")
    for elsewhere, what in (
        ({"x": 4, "flag": True}, "x = 4"),
        ({"x": 5, "flag": True, "y": 1}, "y = 1"),
        ({"x": 5}, "flag = None"),
    ):
        with pytest.raises(ValueError, match=f"landmarks: 'there' has {what}, which is not recorded"):
            recording.record(made({"x": [1, 5], "flag": None}, {"there": elsewhere}, flag=flag))


def test_mission_control_records_the_papers_landing_and_the_right_one():
    live = MissionControl().live
    said = {}
    places = recording.positions(live)
    wanted = {(35.88, 0.02, True), (35.88, 0.01, True), (60.211, 0.02, False)}
    assert all(t in places["t_ignite"] and dt in places["dt"] for t, dt, _ in wanted)
    for t_ignite, dt, faults in wanted:
        live.set(t_ignite=t_ignite, dt=dt, faults=faults, methods=places["methods"][0])
        said[t_ignite, dt] = live.text
    assert "comes to 0 m/s 2.6 m above the ground" in said[35.88, 0.02]
    assert "largest velocity -76.5 m/s" in said[35.88, 0.01]
    assert "soft landing" in said[60.211, 0.02]
