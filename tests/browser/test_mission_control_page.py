"""Mission control as a page without code, by Voilà, in a headless Chromium."""

import json
import re
import shutil
import tempfile
import time

import pandas as pd
import psutil
import pytest

from hoverslam_lib import course

pytest.importorskip("playwright.sync_api", reason="playwright is missing: pip install -e '.[dev]'")
import driver
from figures import (
    CHANGED,
    CUT,
    SAYS,
    SHARP,
    WIDTHS,
    axe,
    check_figure,
    check_papers_landing,
    figures,
    press,
    visible_pictures,
)


@pytest.fixture(scope="module")
def mission(chromium, folder):
    """Mission control as a page, with this computer as all of the network."""
    with driver.server("voila", folder, tempfile.mkdtemp(dir=folder.parent)) as address:
        page = chromium.new_page(viewport={"width": 1024, "height": 768})
        page.route(lambda url: not url.startswith(address), lambda route: route.abort())
        driver.open_voila(page, address, "mission_control.ipynb")
        yield page
        page.close()


def heard(page, role):
    """What the browser tells a screen reader of the controls of this role: by name, its state or value in words."""
    session = page.context.new_cdp_session(page)
    nodes = session.send("Accessibility.getFullAXTree")["nodes"]
    found = {}
    for node in nodes:
        if node.get("role", {}).get("value") == role and not node["ignored"]:
            properties = {each["name"]: each["value"].get("value") for each in node["properties"]}
            part = session.send("DOM.resolveNode", {"backendNodeId": node["backendDOMNodeId"]})["object"]["objectId"]
            words = "function () { return this.getAttribute('aria-valuetext'); }"  # which Chromium keeps to itself
            called = session.send("Runtime.callFunctionOn", {"objectId": part, "functionDeclaration": words})
            found[node["name"]["value"]] = properties.get("pressed") or called["result"].get("value")
    session.detach()
    return found


def test_papers_landing_on_one_click_as_a_page(mission):
    check_papers_landing(mission)
    mission.get_by_role("button", name="Reset").click()
    mission.locator("[role=status]").filter(has_text="Ignition at 60.200000 s").wait_for(timeout=10_000)


def test_page_without_code_flies_offline(mission):
    assert "Mission control" in mission.inner_text("body")
    for word in ("import", "MissionControl"):
        assert word not in mission.inner_text("body")
    (figure,) = figures(mission)
    assert visible_pictures(mission) == 1
    check_figure(figure, said=False)


def test_find_the_optimum_and_keep_the_trial(mission, tmp_path):
    mission.get_by_role("button", name="Find the optimum").click()
    mission.locator("[role=status]").filter(has_text="soft landing").wait_for(timeout=10_000)
    mission.get_by_role("button", name="Keep this trial").click()
    mission.locator("table").wait_for(timeout=10_000)
    with mission.expect_download() as download:
        mission.get_by_role("link", name="Download the table as CSV").click()
    download.value.save_as(tmp_path / "trials.csv")
    (kept,) = pd.read_csv(tmp_path / "trials.csv").to_dict("records")
    assert kept["verdict"].startswith("soft landing")
    assert f"{kept['t_ignite [s]']:.6f}" in mission.locator("[role=status]").text_content()
    assert kept["verdict"] in mission.locator("table").inner_text()
    for heading, cell in zip(mission.locator("th").all(), mission.locator("td").all(), strict=True):
        assert heading.get_attribute("scope") == "col"
        align = "part => getComputedStyle(part).textAlign"
        assert heading.evaluate(align) == cell.evaluate(align) != "start"
    mission.get_by_role("button", name="Clear the table").click()
    mission.locator("table").wait_for(state="detached", timeout=10_000)


def test_flight_plays_and_pauses(mission):
    (figure,) = figures(mission)
    play = mission.get_by_role("button", name="Play")
    moment = mission.locator(".widget-readout").last
    assert heard(mission, "button")["Play"] == "false"
    play.click()
    assert heard(mission, "button")["Play"] == "true"
    for _ in range(3):
        figure.wait(CHANGED, "picture", figure.state()["picture"])
    play.click()
    stopped = moment.inner_text()
    mission.wait_for_timeout(500)  # four pictures' time
    assert moment.inner_text() == stopped


SIZES = {390: (11, 18), 1024: (14, 24), 1280: (14, 24), 1920: (18, 24)}  # of labels and verdicts [px], by width


@pytest.mark.parametrize(("width", "height"), [(390, 844), (1024, 768), (1280, 720), (1920, 1080)])
def test_page_fits_every_window_with_one_method_and_with_seven(mission, width, height):
    mission.set_viewport_size({"width": width, "height": height})
    (figure,) = figures(mission)
    methods = mission.get_by_role("group", name="methods").get_by_role("button")
    label, verdict = SIZES[width]
    for chosen in (1, 7):
        for method in methods.all()[:chosen]:
            if method.get_attribute("aria-pressed") == "false":
                method.click()
        lines = mission.locator("[role=status] > div")
        figure.wait(f"([figure]) => figure.querySelectorAll('[role=status] svg').length >= {chosen}", timeout=10_000)
        figure.wait(SHARP, 1, timeout=10_000)
        assert figure.where.evaluate(CUT) == []
        assert min(figure.where.evaluate(WIDTHS)) >= 150
        assert figure.where.locator(".hoverslam-picture").evaluate(FONT) >= label
        assert lines.first.evaluate(FONT) >= verdict
        if width >= 1280:
            picture = figure.where.locator(".hoverslam-picture").bounding_box()
            for method in methods.all():
                assert inside(method.bounding_box(), width, height)
            assert inside(picture, width, height)
            assert all(line.bounding_box()["height"] < 2 * verdict for line in lines.all()), "one line a method"
            assert figure.where.bounding_box()["width"] > 0.95 * width
    mission.get_by_role("button", name="Reset").click()


FONT = "part => parseFloat(getComputedStyle(part).fontSize)"


def inside(box, width, height):
    return box["x"] >= 0 and box["y"] >= 0 and box["x"] + box["width"] <= width and box["y"] + box["height"] <= height


def test_methods_are_chosen_by_key_and_told_by_their_line(mission):
    mission.get_by_role("button", name="Reset").click()
    (figure,) = figures(mission)
    button = mission.get_by_role("button", name="Explicit Euler")
    figure.there_and_back(lambda: press(mission, button, "Space", 1), lambda: press(mission, button, "Enter", 1))
    button.click()
    figure.wait("([figure]) => figure.querySelectorAll('[role=status] svg').length === 2")
    strokes = "parts => parts.map(part => part.getAttribute('stroke'))"
    legend = mission.locator(".hoverslam-methods [aria-pressed=true] line").evaluate_all(strokes)
    assert legend == mission.locator("[role=status] line").evaluate_all(strokes) == ["#D55E00", "#009E73"]
    assert figure.state()["text"].startswith("Explicit Euler: ")
    pressed = {name for name, state in heard(mission, "button").items() if state == "true"}
    assert pressed == {"Explicit Euler", "Runge–Kutta 4"}
    button.click()


def test_values_are_heard_with_their_units_at_each_position(mission):
    mission.get_by_role("button", name="Reset").click()
    (figure,) = figures(mission)
    assert heard(mission, "slider") == {
        "ignition [s]": "60.20 s",
        "step dt [s]": "0.02 s",
        "thrust [MN]": "7.6 MN",
        "drag coefficient": "0.50",
        "moment [% of flight]": "100 % of flight",
    }
    for n, key, value in ((0, "ArrowRight", "60.21 s"), (1, "ArrowLeft", "0.015 s"), (2, "ArrowRight", "7.7 MN")):
        before = figure.state()["text"]
        press(mission, figure.slider(n), key, 1)
        figure.wait(CHANGED, "text", before)
        assert heard(mission, "slider")[figure.label(n)] == value
    mission.get_by_role("button", name="Reset").click()


def test_number_beside_the_slider_is_as_short_as_the_sliders_places(mission):
    (figure,) = figures(mission)
    number = mission.get_by_role("spinbutton", name="ignition [s]")
    for _ in range(30):
        press(mission, figure.slider(), "ArrowRight", 1)
        assert re.fullmatch(r"\d+(\.\d{1,2})?", number.input_value())
    for _ in range(5):
        press(mission, number, "ArrowUp", 1)
        assert re.fullmatch(r"\d+(\.\d{1,3})?", number.input_value())
    mission.get_by_role("button", name="Reset").click()


def test_axe_finds_nothing_in_mission_control(mission):
    mission.get_by_role("button", name="Keep this trial").click()
    mission.locator("table").wait_for(timeout=10_000)
    # that the notebook's texts are in no landmark is Voilà's
    assert [(rule, html) for rule, html in axe(mission) if not (rule == "region" and "jp-InputArea" in html)] == []
    mission.get_by_role("button", name="Clear the table").click()


def test_kernels_of_pages_that_are_gone_end(chromium, folder, tmp_path):
    culling = json.loads((course.NOTEBOOKS.parent / "voila.json").read_text())
    assert culling["MappingKernelManager"] == {"cull_idle_timeout": 120, "cull_interval": 30}
    sooner = {"MappingKernelManager": {"cull_idle_timeout": 10, "cull_interval": 1}}
    shutil.copy(folder / "mission_control.ipynb", tmp_path)
    (tmp_path / "voila.json").write_text(json.dumps(sooner))
    with driver.server("voila", tmp_path, tmp_path / "config") as address:

        def kernels():
            return {child.pid for child in psutil.Process(address.process).children()}

        page, seen = chromium.new_page(), set()
        for _ in range(4):
            driver.open_voila(page, address, "mission_control.ipynb")
            seen |= kernels()
        assert len(seen) == 4, "one for each load"
        wait_until(lambda: len(kernels()) == 1, 120)
        page.wait_for_timeout(15_000)  # a page that is looked at keeps its own
        assert len(kernels()) == 1
        (figure,) = figures(page)
        press(page, figure.slider(), "ArrowRight")
        figure.wait(SAYS, "Ignition at 60.220000 s, dt = 0.02 s.")
        page.close()
        wait_until(lambda: not kernels(), 120)


def wait_until(holds, seconds):
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.5)
