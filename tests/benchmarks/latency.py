"""From the slider to the pixels, in a real browser: ``python tests/benchmarks/latency.py`` (needs the ``dev`` extra).

The same flight under a slider, drawn by `Live`, by ``interact`` with inline figures and by ipympl, and mission control
with three methods, one after the other in one JupyterLab. Beside them an echo, a label that the kernel sets to the
slider's value: nothing with a kernel is faster. Times are the browser's own: from the event of the key to the first
animation frame after the new picture has been loaded or drawn on a canvas, or the label has changed.
"""

import argparse
import statistics
import sys
import tempfile
import time
from pathlib import Path

import nbformat
import pandas as pd

sys.path.insert(0, str(Path(__file__).parent.parent / "browser"))
import driver

DRAG = 3.0
"""How long the mouse drags the slider [s]."""

FLIGHT = """
import matplotlib.pyplot as plt
from ipywidgets import FloatSlider
from hoverslam_lib import Descent, FreeFall

fall = FreeFall(Descent(), dt={dt})
slider = FloatSlider(60, min=50, max=70, step=0.01, description="ignition [s]")


def axes_of_a_flight():
    fig, axes = plt.subplots(2, 1, figsize=(7, 5), sharex=True)
    axes[0].set(ylabel="h [km]", xlim=(0, 120), ylim=(-5, 160))
    axes[1].set(xlabel="t [s]", ylabel="v [m/s]", ylim=(-2700, 500))
    return fig, axes
"""
PERSISTENT = """
fig, axes = axes_of_a_flight()
height, velocity = (ax.plot([], [], animated={animated})[0] for ax in axes)


def follow(t_ignite):
    flight = fall.fly(t_ignite)
    height.set_data(flight.t, flight.h / 1e3)
    velocity.set_data(flight.t, flight.v)
    return f"ignition at {{t_ignite:.2f}} s"
"""
LIVE = """
from hoverslam_lib.live import Live

Live(fig, follow, t_ignite=slider).show()
"""
INTERACT = """
from ipywidgets import interact


def draw(t_ignite):
    flight = fall.fly(t_ignite)
    fig, axes = axes_of_a_flight()
    axes[0].plot(flight.t, flight.h / 1e3)
    axes[1].plot(flight.t, flight.v)
    plt.show()


interact(draw, t_ignite=slider);
"""
IPYMPL = """
def redraw(change):
    follow(change.new)
    fig.canvas.draw_idle()


follow(slider.value)
slider.observe(redraw, "value")
display(slider, fig.canvas)
"""
ECHO = """
from ipywidgets import FloatSlider, Label

slider, label = FloatSlider(60, min=50, max=70, step=0.01, description="ignition [s]"), Label("60.00")
label.add_class("echo")


def say(change):
    label.value = f"{change.new:.2f}"


slider.observe(say, "value")
display(slider, label)
"""
MISSION = """
from hoverslam_lib import plotting
from hoverslam_lib.mission_control import MissionControl

plotting.use_style()
page = MissionControl()
page.live.set(methods=("symplectic_euler", "rk4", "rkn4"))
page.show()
"""
ECHOED, MISSION_CONTROL, OURS = "echo", "mission control, 3 methods", "Live, dt = 0.02 s"
CONTENDERS = {
    ECHOED: [ECHO],
    MISSION_CONTROL: [MISSION],
    "Live, dt = 0.02 s": [FLIGHT.format(dt=0.02), PERSISTENT.format(animated=True), LIVE],
    "Live, dt = 0.005 s": [FLIGHT.format(dt=0.005), PERSISTENT.format(animated=True), LIVE],
    "interact": [FLIGHT.format(dt=0.02), INTERACT],
    "ipympl": ["%matplotlib widget", FLIGHT.format(dt=0.02), PERSISTENT.format(animated=False), IPYMPL],
}

# `shown` gets the time of the first animation frame after each new picture: an image that was loaded, something drawn
# on a canvas that is on the page, or another text of the echo. `empty` counts the animation frames without a picture.
WATCH = """() => {
    const seen = window.seen = {key: null, moved: null, shown: [], latencies: [], frames: 0, empty: 0};
    let waiting = false;
    const painted = () => {
        if (waiting) return;
        waiting = true;
        requestAnimationFrame(() => {
            waiting = false;
            const now = performance.now();
            seen.shown.push(now);
            if (seen.key !== null) seen.latencies.push(now - seen.key);
            seen.key = null;
        });
    };
    const outputs = '.jp-OutputArea-output';
    document.addEventListener('load', event => event.target.closest?.(outputs) && painted(), true);
    const ink = CanvasRenderingContext2D.prototype;
    for (const name of ['drawImage', 'putImageData']) {
        const draw = ink[name];
        ink[name] = function (...what) {
            draw.apply(this, what);
            if (this.canvas.closest(outputs)) painted();
        };
    }
    const echo = document.querySelector(`${outputs} .echo`);
    if (echo) new MutationObserver(painted).observe(echo, {childList: true, characterData: true, subtree: true});
    document.addEventListener('keydown', event => { seen.key = event.timeStamp; }, true);
    for (const kind of ['mousemove', 'pointermove'])
        document.addEventListener(kind, event => { if (event.buttons) seen.moved = event.timeStamp; }, true);
    const look = () => {
        const images = [...document.querySelectorAll(`${outputs} img`)];
        const there = images.some(image => image.complete && image.naturalWidth > 0 && image.checkVisibility());
        seen.frames += 1;
        seen.empty += !there && !document.querySelector(`${outputs} :is(canvas, .echo)`);
        requestAnimationFrame(look);
    };
    look();
}"""
QUIET = "() => performance.now() - Math.max(seen.moved, seen.key, seen.shown.at(-1) ?? 0) > 600"


def press_keys(page, moves):
    """Time from each of a row of keys to the picture that it makes [ms]."""
    page.locator(".noUi-handle").first.focus()
    for n in range(moves):
        page.keyboard.press("ArrowLeft" if n % 2 else "ArrowRight")
        page.wait_for_function("n => seen.latencies.length > n", arg=n, timeout=10_000)
        page.wait_for_timeout(150)  # a hand at rest: what a contender still draws does not count for the next key
    return page.evaluate("seen.latencies")


def drag(page):
    """Pull the handle to and fro; returns pictures per second, how late the last came [ms], and empty frames."""
    box = page.locator(".noUi-handle").first.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.evaluate("() => { [seen.shown, seen.frames, seen.empty] = [[], 0, 0]; }")
    end, shift, way = time.monotonic() + DRAG, 0, 2
    while time.monotonic() < end:
        way = -way if abs(shift + way) > 60 else way
        shift += way
        page.mouse.move(x + shift, y)
        page.wait_for_timeout(8)  # as often as a mouse reports
    page.wait_for_function(QUIET, timeout=30_000)
    seen = page.evaluate("seen")
    page.mouse.up()
    during = [shown for shown in seen["shown"] if shown <= seen["moved"]]
    return len(during) / DRAG, max(0.0, seen["shown"][-1] - seen["moved"]), seen["empty"]


def measure(page, name, moves):
    driver.open_notebook(page, name)
    found = driver.run_all(page)
    if found["errors"]:
        raise RuntimeError(f"{name}: {found['errors']}")
    page.wait_for_selector(".noUi-handle")
    page.evaluate(WATCH)
    page.wait_for_function(QUIET, timeout=30_000)
    latencies = press_keys(page, moves)
    page.wait_for_function(QUIET, timeout=30_000)
    rate, late, empty = drag(page)
    return {
        "median [ms]": statistics.median(latencies),
        "95 % [ms]": statistics.quantiles(latencies, n=20, method="inclusive")[-1],
        "pictures/s": rate,
        "last after [ms]": late,
        "frames without": empty,
    }


def compare(moves, names):
    """One row for each contender named, as a DataFrame."""
    rows = {}
    with tempfile.TemporaryDirectory() as folder, driver.browser() as chromium:
        for n, cells in enumerate(map(CONTENDERS.get, names)):
            notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
            notebook.metadata.kernelspec = {"name": "python3", "display_name": "Python 3", "language": "python"}
            nbformat.write(notebook, Path(folder) / f"{n}.ipynb")
        with driver.server("lab", folder, f"{folder}/config") as address:
            for n, name in enumerate(names):
                page = chromium.new_page(viewport={"width": 1280, "height": 1000})
                driver.open_lab(page, address)
                rows[name] = measure(page, f"{n}.ipynb", moves)
                driver.close_notebook(page)
                page.close()
    return pd.DataFrame.from_dict(rows, orient="index")


def wanted(table):
    """What the figures are to hold, each with whether they do."""
    median, rate = table["median [ms]"], table["pictures/s"]
    for name, row in table.loc[[name for name in table.index if name.startswith("Live")]].iterrows():
        yield f"{name}: median at most 80 ms", row["median [ms]"] <= 80
        yield f"{name}: 95 % within 120 ms", row["95 % [ms]"] <= 120
        yield f"{name}: at least 10 pictures a second", row["pictures/s"] >= 10
        yield f"{name}: last picture at most 150 ms after the last movement", row["last after [ms]"] <= 150
        yield f"{name}: no frame without a picture", row["frames without"] == 0
    yield f"{MISSION_CONTROL}: median at most 90 ms", median[MISSION_CONTROL] <= 90
    ours = median[OURS]
    yield f"{OURS}: {ours / median[ECHOED]:.2f} times the echo's median (wanted: 1.6)", ours <= 1.6 * median[ECHOED]
    share = rate[OURS] / rate[ECHOED]
    yield f"{OURS}: {share:.2f} of the echo's pictures a second (wanted: two thirds)", share >= 2 / 3
    for name, times in {"interact": 3, "ipympl": 1}.items():
        if name in median:
            yield f"{median[name] / ours:.1f} times as fast as {name} (wanted: {times})", median[name] >= times * ours


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--moves", type=int, default=60, help="how many keys are pressed for each contender")
    parser.add_argument("--ours", action="store_true", help="without interact and ipympl, which take most of the time")
    arguments = parser.parse_args()
    names = [name for name in CONTENDERS if not arguments.ours or name not in ("interact", "ipympl")]
    table = compare(arguments.moves, names)
    print(table.round(1).to_string())
    for what, holds in wanted(table):
        print(f"{'yes' if holds else 'NO ':3}  {what}")


if __name__ == "__main__":
    main()
