"""Films: what is in the file, and that a frame shows the flight at its time."""

import io
import re
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text
from PIL import Image

from hoverslam_lib import Descent, animation, best_ignition, fly, plotting

BODY = np.array([0x00, 0x72, 0xB2])


@pytest.fixture(scope="module")
def landed():
    return fly(Descent(), best_ignition(Descent()).t_ignite)


@pytest.fixture(scope="module")
def times(landed):
    return landed.touchdown[0] - 0.025 * np.arange(30)[::-1]


@pytest.fixture(scope="module")
def landing(landed, times):
    return animation.landing_film(landed, times, alt="a booster lands at 0 m", duration=100)


def decoded(gif):
    """Frames as RGB arrays and their durations [ms], by Pillow."""
    image = Image.open(io.BytesIO(gif))
    frames = []
    for n in range(image.n_frames):
        image.seek(n)
        frames.append((np.asarray(image.convert("RGB"), dtype=int), image.info["duration"]))
    return frames


def shown(film):
    """What is on the screen in each frame of a film, as long as it was asked for; equal frames are stored as one."""
    frames = []
    for picture, ms in decoded(film.gif):
        while ms > 0:
            ms -= film.durations[len(frames)]
            frames.append(picture)
        assert ms == 0
    return frames


def local_palettes(gif):
    """For each picture of a GIF, whether it has a palette of its own; read from the bytes."""
    found, at = [], 13 + 3 * 2 ** ((gif[10] & 7) + 1)
    while gif[at] != 0x3B:
        if gif[at] == 0x21:
            at += 2
        else:
            assert gif[at] == 0x2C
            found.append(bool(gif[at + 9] & 0x80))
            at += 11
        while gif[at]:
            at += gif[at] + 1
        at += 1
    return found


def spot_film(times, **options):
    """A film of a black square at (t, t) on axes that fill the figure, 0 to 10 both ways."""
    fig = Figure(figsize=(2, 2), dpi=100)
    ax = fig.add_axes((0, 0, 1, 1))
    ax.set(xlim=(0, 10), ylim=(0, 10))
    ax.axis("off")
    (spot,) = ax.plot([], [], "s", color="black", markersize=6)

    def move(t):
        spot.set_data([t], [t])
        return [spot]

    return animation.film(fig, move, times, alt="a spot from 1 to 9", **options)


def test_film_has_the_frames_and_durations_that_were_asked_for(landing, times):
    assert len(shown(landing)) == len(times)
    assert landing.frames == tuple(times)
    assert list(landing.durations) == [100] * (len(times) - 1) + [2000]
    assert Image.open(io.BytesIO(landing.gif)).info["loop"] == 2  # times more


def test_numbers_stand_long_enough_to_be_read_and_the_last_ones_are_those_of_the_last_frame(landing):
    right = [frame[:, 230:] for frame in shown(landing)]
    changed = [np.any(a != b) for a, b in zip(right, right[1:], strict=False)]
    assert landing.durations[0] == animation.LEGIBLE / 2
    assert changed == [n % 2 == len(changed) % 2 for n in range(1, len(changed) + 1)]


@pytest.mark.parametrize("n", range(1, 9))
def test_instruments_begin_with_the_first_time_and_end_with_the_last(landed, monkeypatch, n):
    films = []
    monkeypatch.setattr(animation, "film", lambda fig, move, times, **options: films.append((move, times)))
    animation.landing_film(landed, landed.t[-1] - 0.5 * np.arange(n)[::-1], alt="a landing", duration=50)
    move, times = films[0]
    for t in (times[0], times[-1]):
        assert f"{t:.2f} s" in [part.get_text() for part in move(t) if isinstance(part, Text)]


def test_film_has_one_palette_and_few_colours(landing):
    assert landing.gif[10] & 0x80
    assert not any(local_palettes(landing.gif))
    as_number = 256 ** np.arange(3)  # of a colour: numbers are sorted in a tenth of the time
    colours = {colour for frame, _ in decoded(landing.gif) for colour in np.unique(frame @ as_number)}
    assert np.array([255, 255, 255]) @ as_number in colours
    assert BODY @ as_number in colours
    assert len(colours) < animation.COLOURS <= 32


def test_film_is_small(landed):
    last = landed.touchdown[0] - 0.0125 * np.arange(80)[::-1]
    assert len(animation.landing_film(landed, last, alt="1 s", duration=100).gif) < 70_000


def test_same_film_has_the_same_bytes(landing, landed, times):
    again = animation.landing_film(landed, times, alt="a booster lands at 0 m", duration=100)
    assert again == landing


def test_spot_is_where_it_belongs_in_every_frame():
    times = np.linspace(1, 9, 9)
    for t, frame in zip(times, shown(spot_film(times)), strict=True):
        rows, columns = np.nonzero(frame.sum(axis=2) < 200)
        assert columns.mean() == pytest.approx(20 * t - 0.5, abs=1)
        assert rows.mean() == pytest.approx(199.5 - 20 * t, abs=1)


def test_frame_without_a_change_is_kept():
    times = np.array([5.0, 5.0001, 5.0002])
    assert len(shown(spot_film(times, duration=50, hold=500))) == 3


def test_tip_of_the_booster_follows_the_height_of_the_flight(landing, landed, times):
    left = [abs(frame[:, :200] - BODY).sum(axis=2) < 60 for frame in shown(landing)]
    tip = np.array([np.flatnonzero(blue.any(axis=1))[0] for blue in left])
    height = np.interp(times, landed.t, landed.h)
    slope, ground = np.polyfit(height, tip, 1)
    assert slope < -1  # pixels a metre, downward
    assert np.max(np.abs(slope * height + ground - tip)) < 1


def test_instruments_show_the_flight(landed):
    ax = Figure().add_subplot()
    move = animation.instruments(ax, landed)
    for row in (3100, 3300, -1):
        frame = landed.to_frame().iloc[row]
        shown = [text.get_text() for text in move(landed.t[row])]
        numbers = [float(re.match(r"-?[\d.]+", text)[0]) for text in shown]
        kilometres = shown[1].endswith("km")
        propellant = (frame["mass [kg]"] - 27_200) / 1e3
        expected = [
            frame["t [s]"],
            frame["h [m]"] / (1e3 if kilometres else 1),
            frame["v [m/s]"],
            propellant,
            7.6,
            frame["felt acceleration [m/s²]"] / 9.81,
        ]
        np.testing.assert_array_less(np.abs(np.subtract(numbers, expected)), [0.006, 0.06, 0.6, 0.06, 1e-9, 0.06])
        assert kilometres == (frame["h [m]"] >= 1000)
        assert not any(text.startswith("-0.0") or text.startswith("-0 ") for text in shown)


def test_scene_stands_on_the_height_and_fades_after_a_hover():
    too_high = fly(Descent(), 59.5)
    t_hover, h_hover = too_high.hover
    move = animation.booster_scene(Figure().add_subplot(), too_high, top=2 * h_hover)
    for t, alpha in ((t_hover - 1, 1.0), (t_hover + 1, 0.3)):
        plume, legs, body = move(t)
        h = np.interp(t, too_high.t, too_high.h)
        assert body.get_ydata()[0] == legs.get_ydata()[0] == plume.get_ydata()[0] == pytest.approx(h, abs=0.1)
        assert body.get_alpha() == alpha


def test_a_soft_landing_with_the_engine_cut_does_not_fade():
    flight = fly(Descent(), 60.211)
    assert flight.outcome == "soft landing"
    t_hover, h_hover = flight.hover
    move = animation.booster_scene(Figure().add_subplot(), flight, top=2 * h_hover)
    *_, body = move(flight.t[-1])
    assert body.get_alpha() == 1
    assert body.get_ydata()[0] == 0
    # half-way through the fall it has lost a quarter of the height, with the engine off
    half = animation.resample(flight, [(t_hover + flight.t[-1]) / 2])
    assert half.h[0] == pytest.approx(0.75 * h_hover, rel=1e-3)
    assert half.throttle[0] == 0


def test_plume_follows_the_throttle(landed):
    move = animation.booster_scene(Figure().add_subplot(), landed, top=20e3)
    half = fly(Descent(), 59.0, controller=lambda t, h, v, mass: 0.5)
    move_half = animation.booster_scene(Figure().add_subplot(), half, top=20e3)
    tips = [scene(t)[0].get_marker().vertices[:, 1].min() for scene, t in ((move, 58), (move_half, 65), (move, 65))]
    nozzle = tips[0]
    assert tips[2] - nozzle == pytest.approx(2 * (tips[1] - nozzle))
    assert tips[2] < nozzle


@pytest.mark.parametrize(
    ("times", "duration", "word"),
    [
        ([0, 0.1, 0.2], 100, "real time"),
        ([0, 0.0125, 0.025], 100, "slowed 8 times"),
        ([0, 1, 2], 100, "10 times faster"),
        ([5], 100, "still"),
    ],
)
def test_pace_is_read_off_the_times(times, duration, word):
    assert animation.pace(times, duration) == [word] * len(times)


def test_resampled_flight_is_the_flight(landed):
    again = animation.resample(landed, landed.t)
    for name in ("t", "h", "v", "mass", "throttle", "felt_acceleration"):
        np.testing.assert_allclose(getattr(again, name), getattr(landed, name), rtol=1e-12, atol=1e-9)
    assert again.touchdown == landed.touchdown


def test_resampling_is_of_fourth_order_in_height_and_velocity(landed):
    times = np.linspace(61, 71.9, 200)
    exact = animation.resample(fly(Descent(), landed.t_ignite, dt=0.005, method="dop8"), times)
    errors = []
    for dt in (0.8, 0.4, 0.2):
        got = animation.resample(fly(Descent(), landed.t_ignite, dt=dt, method="dop8"), times)
        errors.append([np.max(np.abs(got.h - exact.h)), np.max(np.abs(got.v - exact.v))])
        np.testing.assert_allclose(got.mass, exact.mass, rtol=1e-12)
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > 3.5)


def test_stills_show_the_flight_at_their_times(landed):
    key = landed.touchdown[0] - np.array([1.0, 0.5, 0.0])
    fig = animation.landing_stills(landed, key)
    assert len(fig.axes) == 3
    assert fig.get_size_inches().tolist() == pytest.approx([3 * 1.85, 3.4])
    for n, (ax, t) in enumerate(zip(fig.axes, key, strict=True)):
        now = animation.readings(landed, t)
        title = (ax.get_title(loc="left") + ax.get_title()).splitlines()
        assert title == [f"{t:.2f} s", now["height"], now["velocity"], now["felt"]]
        assert ax.get_ylabel() == ("" if n else "h [m]")
        assert bool([tick for tick in ax.get_yticklabels() if tick.get_text()]) == (n == 0)
        assert ax.lines[-1].get_ydata()[0] == pytest.approx(animation.resample(landed, [t]).h[0])
    highest = animation.resample(landed, key[:1]).h[0]
    assert [ax.get_ylim() for ax in fig.axes] == [pytest.approx((-0.1 * highest, 1.65 * highest))] * 3
    higher = animation.landing_stills(landed, key[-1:], top=3000.0)
    assert higher.axes[0].get_ylim() == pytest.approx((-0.3, 4.95))
    assert higher.axes[0].get_ylabel() == "h [km]"


def test_html_carries_the_text_and_a_gif(landing):
    html = landing._repr_html_()
    assert 'alt="a booster lands at 0 m"' in html
    assert 'src="data:image/gif;base64,R0lGODlh' in html
    assert repr(landing) == "a booster lands at 0 m"
    patterns = re.findall(r"^regex: (.*)$", Path(__file__).with_name("nbval_sanitize.cfg").read_text("utf-8"), re.M)
    for pattern in patterns:
        html = re.sub(pattern, "FILM", html)
    assert html.endswith('src="FILM">')


def test_no_figure_is_left_behind(landed, times):
    before = plt.get_fignums()
    animation.landing_film(landed, times[:3], alt="1")
    animation.landing_stills(landed, times[:2])
    assert plt.get_fignums() == before


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"alt": "  "}, "alt must say"),
        ({"duration": 45}, "duration must be a whole number of hundredths"),
        ({"duration": 10}, "duration must be"),
        ({"hold": 0}, "hold must be"),
        ({"times": [1.0, 1.0]}, "increasing"),
        ({"times": []}, "one or more"),
        ({"times": [np.nan]}, "finite"),
        ({"times": [-1.0, 2.0]}, "times must lie within the flight, 0 to 72"),
        ({"times": [70.0, 80.0]}, "times must lie within the flight"),
    ],
)
def test_bad_input_is_refused(landed, times, changes, message):
    options = {"times": times[:2], "alt": "1 m"} | changes
    with pytest.raises(ValueError, match=message):
        animation.landing_film(landed, options.pop("times"), **options)


def test_times_must_be_numbers(landed):
    with pytest.raises(TypeError, match="times must be .* numbers"):
        animation.resample(landed, ["soon"])


def test_film_of_the_readme_is_the_one_that_the_library_makes():
    root = Path(__file__).parent.parent
    with plt.style.context(plotting.STYLE_SHEET):
        made = animation.whole_burn()
    stored = (root / "notebooks" / "images" / "landing.gif").read_bytes()
    assert len(stored) < 100_000
    pairs = list(zip(decoded(stored), decoded(made.gif), strict=True))
    assert all(ms == other for (_, ms), (_, other) in pairs)
    # versions of matplotlib write and place text a little differently; the booster must be at its height in each
    heights = [
        [np.flatnonzero((np.abs(frame - BODY).sum(axis=2) < 60).sum(axis=1) > 3).max() for frame, _ in pair]
        for pair in pairs
    ]
    assert np.max(np.abs(np.diff(heights, axis=1))) <= 4
    assert np.ptp(heights, axis=0).min() > 100
    assert f'alt="{made.alt}"' in (root / "README.md").read_text(encoding="utf-8")
