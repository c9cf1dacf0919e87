"""Live figures in JupyterLab and Voilà, moved by keyboard and by mouse in a headless Chromium."""

import json
import re
import shutil
import tempfile
import time

import nbformat
import pandas as pd
import psutil
import pytest

from hoverslam_lib import book, course
from hoverslam_lib.live import STILL

pytest.importorskip("playwright.sync_api", reason="playwright is missing: pip install -e '.[dev]'")
import driver

LIVE = [path.stem for path in course.lessons() if "Live(" in path.read_text() or "MissionControl" in path.read_text()]
SAME_TEXT = ("moment [% of flight]",)  # labels of sliders that move only the picture
NOT_SAID = ("07_hoverslam_ode", "09_ignition_tables", "mission_control")  # whose text does not repeat every slider

DOT = """
import time
import matplotlib.pyplot as plt
from ipywidgets import FloatSlider
from hoverslam_lib.live import Live

calls, figures = [], []


def dot(name, pause=0):
    fig, ax = plt.subplots(figsize=(4, 2))
    ax.set(xlim=(0, 10), ylim=(-1, 1))
    (point,) = ax.plot([], [], "o", animated=True)

    def put(x):
        time.sleep(pause)
        calls.append(x)
        point.set_data([x], [0])
        return f"{name} is at {x:.2f}."

    made = Live(fig, put, x=FloatSlider(5, min=0, max=10, step=0.01, description=f"{name} [m]"))
    figures.append(made)
    return made
"""
SCRATCH = {
    "twice": [DOT, "dot('one').show()", "dot('two').show()\ndot('three').show()"],
    "slow": [DOT, "dot('slow', pause=0.08).show()"],
}

STATE = """figure => {
    const lines = [...figure.querySelectorAll('[role=status] > *')].map(line => line.textContent);
    return {text: lines.join('\\n'), picture: figure.querySelector('canvas').toDataURL()};
}"""
SHOWS = f"([figure, what, before]) => ({STATE})(figure)[what] === before"
CHANGED = f"([figure, what, before]) => ({STATE})(figure)[what] !== before"
SAYS = f"([figure, end]) => ({STATE})(figure).text.endsWith(end)"
AGREES = """([figure, n]) => {
    const numbers = part => part.textContent.replaceAll('−', '-').match(/-?[0-9]+([.][0-9]+)?/g).map(Number);
    const [read] = numbers(figure.querySelectorAll('.widget-slider .widget-readout')[n]);
    return numbers(figure.querySelector('[role=status]')).includes(read);
}"""
SHARP = """([figure, ratio]) => {
    const canvas = figure.querySelector('canvas'), place = canvas.parentElement.getBoundingClientRect();
    return Math.abs(canvas.width - ratio * place.width) <= 1 && Math.abs(canvas.height - ratio * place.height) <= 2;
}"""
PIXELS = """async figure => {
    const canvas = figure.querySelector('canvas'), {width, height} = canvas;
    const {data} = canvas.getContext('2d').getImageData(0, 0, width, height);
    const digest = await crypto.subtle.digest('SHA-256', data);
    return [...new Uint8Array(digest)].map(byte => byte.toString(16).padStart(2, '0')).join('');
}"""
KERNELS_PIXELS = "__import__('hashlib').sha256(figures[0].pixels().tobytes()).hexdigest()"
CUT = """figure => {
    const texts = 'label, button, input, select, th, td, .widget-readout, [role=status] > :first-child';
    const cut = part => part.scrollWidth > part.clientWidth + 1 && part.clientWidth > 0;
    const out = part => part.getBoundingClientRect().right > window.innerWidth + 1;
    const parts = [...figure.querySelectorAll('*')]
        .filter(part => part.checkVisibility() && !part.closest('.hoverslam-trials *')); // which scrolls
    const found = parts.filter(part => out(part) || part.matches(texts) && cut(part));
    return found.map(part => part.outerHTML.slice(0, 200));
}"""
WIDTHS = """figure => [...figure.querySelectorAll('.noUi-base')].map(track => track.getBoundingClientRect().width)"""
ASK = """async expression => {
    const kernel = window.jupyterapp.shell.currentWidget.sessionContext.session.kernel;
    const reply = await kernel.requestExecute({code: '', silent: true, user_expressions: {it: expression}}).done;
    return reply.content.user_expressions.it.data['text/plain'];
}"""
RUN_CELL = """async n => {
    window.jupyterapp.shell.currentWidget.content.activeCellIndex = n;
    await window.jupyterapp.commands.execute('notebook:run-cell');
}"""
SHUT_DOWN = "() => window.jupyterapp.shell.currentWidget.sessionContext.shutdown()"
NAME = "() => window.jupyterapp.shell.currentWidget.context.path.replace('.ipynb', '')"
BUSY = """seconds => {
    const kernel = window.jupyterapp.shell.currentWidget.sessionContext.session.kernel;
    kernel.requestExecute({code: `time.sleep(${seconds})`, silent: true});
}"""
RESTART = "() => window.jupyterapp.shell.currentWidget.sessionContext.restartKernel()"
VISIBLE = """selector => {
    window.controls = [...document.querySelectorAll(selector)].filter(control => control.checkVisibility());
    return window.controls.length;
}"""
FOCUS = """() => {
    const at = document.activeElement, widget = at.closest('.jupyter-widgets');
    const label = at.ariaLabel || at.textContent || widget?.querySelector('.widget-label')?.textContent || '';
    return {label: label.trim(), number: window.controls.indexOf(at)};
}"""
WIDGETS = "len(__import__('ipywidgets').widgets.widget._instances)"
CONTROLS = ", ".join(f".hoverslam-live {control}" for control in (".noUi-handle", "select", "input", "button"))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A copy of the notebooks, down to their last live figure, and the scratch ones: the checkout is not written to."""
    copy = tmp_path_factory.mktemp("browser") / "notebooks"
    shutil.copytree(course.NOTEBOOKS, copy)
    for path in course.lessons(LIVE):
        notebook = nbformat.read(path, as_version=4)
        notebook.cells = notebook.cells[: book.live_cells(path)[-1] + 1]
        nbformat.write(notebook, copy / path.name)
    for name, cells in SCRATCH.items():
        notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source) for source in cells])
        notebook.metadata.kernelspec = {"name": "python3", "display_name": "Python 3", "language": "python"}
        nbformat.write(notebook, copy / f"{name}.ipynb")
    return copy


@pytest.fixture(scope="module")
def lab(chromium, folder):
    """JupyterLab, opened once."""
    with driver.server("lab", folder, tempfile.mkdtemp(dir=folder.parent)) as address:
        page = chromium.new_page(viewport={"width": 1280, "height": 1000})
        driver.open_lab(page, address)
        yield page
        page.close()


@pytest.fixture(params=LIVE)
def lesson(lab, request):
    driver.open_notebook(lab, f"{request.param}.ipynb")
    yield lab
    driver.close_notebook(lab)


@pytest.fixture
def scratch(lab, request):
    """A notebook made for the test, with all its cells run once."""
    driver.open_notebook(lab, f"{request.param}.ipynb")
    assert driver.run_all(lab)["errors"] == []
    yield lab
    driver.close_notebook(lab)


@pytest.fixture(scope="module")
def mission(chromium, folder):
    """Mission control as a page, with this computer as all of the network."""
    with driver.server("voila", folder, tempfile.mkdtemp(dir=folder.parent)) as address:
        page = chromium.new_page(viewport={"width": 1024, "height": 768})
        page.route(lambda url: not url.startswith(address), lambda route: route.abort())
        driver.open_voila(page, address, "mission_control.ipynb")
        yield page
        page.close()


class Figure:
    """A live figure on the page: `where` holds its controls, its status text and its picture."""

    def __init__(self, where):
        self.where, self.page = where, where.page
        self.where.locator("canvas").wait_for()

    def state(self):
        return self.where.evaluate(STATE)

    def wait(self, condition, *values, timeout=3000):
        handle = self.where.element_handle()
        self.page.wait_for_function(condition, arg=[handle, *values], timeout=timeout)

    def there_and_back(self, there, back, what="text"):
        """Move a control and undo it: the text, or the picture, changes and comes back."""
        start = self.state()[what]
        there()
        self.wait(CHANGED, what, start)
        back()
        self.wait(SHOWS, what, start)

    def slider(self, n=0):
        return self.where.locator(".noUi-handle").nth(n)

    def label(self, n):
        return self.where.locator(".widget-slider .widget-label").nth(n).text_content()


def figures(page):
    """The live figures of a page, in their order."""
    page.locator(".hoverslam-live canvas").first.wait_for()
    return [Figure(place) for place in page.locator(".hoverslam-live").all()]


def check_stills(page, number):
    """What a reader sees where no widget lives: the still pictures, with their numbers and how to revive them."""
    page.locator(".hoverslam-still").first.wait_for()
    page.wait_for_timeout(1500)  # the front end's time to look for the widgets
    assert page.locator(".hoverslam-live").count() == 0
    stills = page.locator(".hoverslam-still")
    assert stills.count() == number
    for still in stills.all():
        assert still.is_visible()
        assert still.text_content().endswith(STILL)
        picture = still.locator("img")
        assert picture.evaluate("image => image.checkVisibility() && image.naturalWidth > 0")
        assert re.search(r"\d", picture.get_attribute("alt"))
        assert picture.get_attribute("alt") in still.text_content()
    for notice in page.get_by_text(re.compile("model not found|Loading widget", re.IGNORECASE)).all():
        assert not notice.is_visible()


def check_papers_landing(page):
    """One click on a fresh page shows it; then the published equation follows keys, the mouse and what is typed."""
    (figure,) = figures(page)
    page.get_by_role("button", name="The paper's landing").click()
    landing = "comes to 0 m/s 2.6 m above the ground.\nIgnition at 35.880000 s, dt = 0.02 s."
    figure.wait(SAYS, landing)
    assert page.get_by_role("spinbutton", name="ignition [s]").input_value() == "35.88"
    move_slider(figure, 0, said=False)
    figure.wait(SAYS, landing)
    for n in (2, 3):  # another thrust or drag is refused, and the paper's comes back
        figure.there_and_back(
            lambda n=n: press(page, figure.slider(n), "ArrowRight"),
            lambda n=n: press(page, figure.slider(n), "ArrowLeft"),
        )
    crash = "largest velocity -52.9 m/s.\nIgnition at 35.882000 s, dt = 0.02 s."
    for typed, end in {"35.882": crash, "35.88": landing}.items():
        number = page.get_by_role("spinbutton", name="ignition [s]")
        number.fill(typed)
        number.press("Enter")
        figure.wait(SAYS, end)
        assert number.input_value() == typed


def press(page, control, key, times=2):
    control.focus()
    for _ in range(times):
        page.keyboard.press(key)


def middle(control):
    control.scroll_into_view_if_needed()
    box = control.bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def drag(page, handle, shifts):
    """Take a handle, pull it sideways through shifts [pixels] from where it was, and let it go."""
    x, y = middle(handle)
    page.mouse.move(x, y)
    page.mouse.down()
    for shift in shifts:
        page.mouse.move(x + shift, y)
    page.mouse.up()


def inward(handle):
    """On which side of a slider there is more room: +1 for the right, -1 for the left."""
    low, now, high = (float(handle.get_attribute(f"aria-value{name}")) for name in ("min", "now", "max"))
    return 1 if now < (low + high) / 2 else -1


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


def check_names(figure):
    """Heard of a slider are its label and what is read beside it with the unit; of the picture, the sentence."""
    handles = figure.where.locator(".noUi-handle")
    for n in range(handles.count()):
        assert figure.slider(n).get_attribute("aria-label") == figure.label(n) != ""
        assert figure.slider(n).get_attribute("aria-valuetext") == shown_value(figure, n)
        box = figure.slider(n).bounding_box()
        assert min(box["width"], box["height"]) >= 24
    assert figure.where.locator("canvas").get_attribute("aria-label") == figure.state()["text"].replace("\n", " ")
    for part in figure.where.locator("[aria-label]").all():
        assert part.evaluate("part => part.role || ['BUTTON', 'INPUT', 'SELECT'].includes(part.tagName)")


def shown_value(figure, n):
    """The value beside a slider, with the unit of its label."""
    value = figure.where.locator(".widget-slider .widget-readout").nth(n).text_content()
    assert re.fullmatch(r"[−-]?\d{1,5}(\.\d{1,4})?(e[−-]\d)?", value), value
    unit = re.search(r"\[(.+)\]", figure.label(n))
    return f"{value} {unit[1]}" if unit else value


def move_slider(figure, n, said):
    page, handle, way = figure.page, figure.slider(n), inward(figure.slider(n))
    what = "picture" if figure.label(n) in SAME_TEXT else "text"
    there, back = ("ArrowRight", "ArrowLeft")[::way]
    figure.there_and_back(lambda: press(page, handle, there), lambda: press(page, handle, back), what)
    x, y = middle(handle)
    shift = 0.3 * way * figure.where.locator(".noUi-base").nth(n).bounding_box()["width"]

    def pull():
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + shift, y, steps=5)

    def let_go():
        if said:
            figure.wait(AGREES, n)
        page.mouse.move(x, y, steps=5)
        page.mouse.up()

    figure.there_and_back(pull, let_go, what)


def move_other(figure, control):
    page = figure.page
    if control.get_attribute("type") == "checkbox":
        figure.there_and_back(lambda: press(page, control, "Space", 1), control.click)
    else:
        figure.there_and_back(lambda: press(page, control, "ArrowDown", 1), lambda: press(page, control, "ArrowUp", 1))


def check_figure(figure, said):
    """Every control is reached and moved by key and by mouse, and its name and value are there all the time."""
    figure.wait("figure => [...figure[0].querySelectorAll('.noUi-handle')].every(handle => handle.ariaLabel)")
    figure.where.scroll_into_view_if_needed()
    check_names(figure)
    check_reached(figure)
    for n in range(figure.where.locator(".noUi-handle").count()):
        move_slider(figure, n, said)
        check_names(figure)
    for control in figure.where.locator("input[type=checkbox], select").all():
        move_other(figure, control)
    assert figure.where.evaluate(CUT) == []


def check_reached(figure):
    """Tab goes to every control of a figure, each with a name."""
    page = figure.page
    number = page.evaluate(VISIBLE, CONTROLS)
    figure.slider().focus()
    reached = [page.evaluate(FOCUS)]
    for _ in range(2 * number):  # readouts can be edited, and lie on the way too
        page.keyboard.press("Tab")
        reached.append(page.evaluate(FOCUS))
    assert {at["number"] for at in reached} >= set(range(number))
    assert [at for at in reached if at["number"] >= 0 and not at["label"]] == []


def test_notebook_shows_a_still_before_it_is_run_and_follows_every_control_after(lesson):
    name = lesson.evaluate(NAME)
    before = lesson.locator(".jp-OutputArea-output").filter(has_text=STILL)
    assert lesson.get_by_text(re.compile("model not found", re.IGNORECASE)).count() == 0
    assert before.locator("img").get_attribute("alt") in before.text_content()
    assert driver.run_all(lesson)["errors"] == []
    (figure,) = figures(lesson)
    assert not figure.state()["text"].startswith("Not possible")
    check_figure(figure, said=name not in NOT_SAID)
    assert lesson.evaluate(driver.OUTPUTS)["errors"] == []
    assert visible_pictures(lesson) == 1
    driver.save_notebook(lesson)
    driver.close_notebook(lesson)
    driver.open_notebook(lesson, f"{name}.ipynb")  # the next day
    check_stills(lesson, 1)


@pytest.mark.parametrize("scratch", ["twice"], indirect=True)
def test_figures_do_not_disturb_each_other_and_a_cell_run_again_leaves_nothing_behind(scratch):
    only_one_follows(scratch, 0)
    only_one_follows(scratch, 1)
    only_one_follows(scratch, 2)
    widgets = scratch.evaluate(ASK, WIDGETS)
    for cell in (1, 2):
        scratch.evaluate(RUN_CELL, cell)
    assert len(figures(scratch)) == 3
    assert visible_pictures(scratch) == 3
    assert scratch.locator(".noUi-handle").count() == 3
    assert scratch.evaluate(ASK, WIDGETS) == widgets
    only_one_follows(scratch, 0)
    only_one_follows(scratch, 2)


@pytest.mark.parametrize("scratch", ["twice"], indirect=True)
def test_figure_works_after_a_restart_and_former_ones_stay_as_they_were(scratch):
    scratch.evaluate(RESTART)
    before = [figure.state() for figure in figures(scratch)]
    press(scratch, figures(scratch)[1].slider(), "ArrowRight")
    scratch.evaluate(RUN_CELL, 0)
    scratch.evaluate(RUN_CELL, 1)
    status = figures(scratch)[1].where.locator("[role=status]")
    status.filter(has_text="The kernel is gone: run this cell again.").wait_for(timeout=4000)
    after = [figure.state() for figure in figures(scratch)]
    assert after[1]["picture"] == before[1]["picture"]
    assert after[2] == before[2]
    only_one_follows(scratch, 0)


@pytest.mark.parametrize("scratch", ["slow"], indirect=True)
def test_figure_whose_kernel_is_gone_says_so_when_it_is_moved_and_one_that_is_busy_does_not(scratch):
    (figure,) = figures(scratch)
    status = figure.where.locator("[role=status]")
    scratch.evaluate(BUSY, 4)
    press(scratch, figure.slider(), "ArrowRight")
    scratch.wait_for_timeout(3000)
    assert "gone" not in status.inner_text()
    figure.wait(AGREES, 0, timeout=5000)
    press(scratch, figure.slider(), "Home")
    figure.wait(AGREES, 0)
    press(scratch, figure.slider(), "Home")  # nothing changes, but the kernel answers
    scratch.wait_for_timeout(3000)
    assert "gone" not in status.inner_text()
    scratch.evaluate(SHUT_DOWN)
    press(scratch, figure.slider(), "ArrowRight")
    status.filter(has_text="The kernel is gone: run this cell again.").wait_for(timeout=4000)


def test_saved_notebook_shows_its_stills_the_next_day_in_a_new_server(chromium, folder):
    for application in ("lab", "notebook"):
        with driver.server("lab", folder, tempfile.mkdtemp(dir=folder.parent)) as address:
            page = chromium.new_page(viewport={"width": 1280, "height": 1000})
            driver.open_lab(page, address)
            driver.open_notebook(page, "twice.ipynb")
            assert driver.run_all(page)["errors"] == []
            assert len(figures(page)) == visible_pictures(page) == 3
            driver.save_notebook(page)
            page.close()
        with driver.server(application, folder, tempfile.mkdtemp(dir=folder.parent)) as address:
            page = chromium.new_page(viewport={"width": 1280, "height": 1000})
            path = {"lab": "lab/tree", "notebook": "notebooks"}[application]
            page.goto(f"{address}/{path}/twice.ipynb?token={driver.TOKEN}")
            page.wait_for_function(driver.IDLE, timeout=60_000)
            check_stills(page, 3)
            assert driver.run_all(page)["errors"] == []
            assert len(figures(page)) == visible_pictures(page) == 3
            figure = figures(page)[1]
            before = figure.state()["text"]
            press(page, figure.slider(), "ArrowRight")
            figure.wait(CHANGED, "text", before)
            page.close()


def visible_pictures(page):
    return page.locator(
        ".jp-OutputArea-output:has(.hoverslam-live) canvas:visible, .hoverslam-still img:visible"
    ).count()


def only_one_follows(page, n):
    """Move one figure's slider: its text and picture change and no others do."""
    shown = figures(page)
    before = [figure.state() for figure in shown]
    press(page, shown[n].slider(), "ArrowRight", 50)
    for what in ("text", "picture"):
        shown[n].wait(CHANGED, what, before[n][what])
    shown[n].wait(AGREES, 0)
    after = [figure.state() for figure in shown]
    assert [k for k, (old, new) in enumerate(zip(before, after, strict=True)) if old != new] == [n]


@pytest.mark.parametrize("scratch", ["slow"], indirect=True)
def test_newest_movement_wins(scratch):
    (figure,) = figures(scratch)
    before = int(scratch.evaluate(ASK, "len(calls)"))
    drag(scratch, figure.slider(), range(2, 122, 2))
    figure.wait(AGREES, 0, timeout=1000)
    calls, last = scratch.evaluate(ASK, "len(calls)"), figure.state()  # the kernel answers when it is done
    assert 3 <= int(calls) - before <= 30
    assert scratch.evaluate(ASK, "len(calls)") == calls
    assert figure.state() == last


@pytest.mark.parametrize("lesson", ["mission_control"], indirect=True)
def test_papers_landing_on_one_click_in_jupyterlab(lesson):
    assert driver.run_all(lesson)["errors"] == []
    check_papers_landing(lesson)


def test_papers_landing_on_one_click_as_a_page(mission):
    check_papers_landing(mission)
    mission.get_by_role("button", name="Reset").click()
    mission.locator("[role=status]").filter(has_text="Ignition at 60.200000 s").wait_for(timeout=3000)


def test_page_without_code_flies_offline(mission):
    assert "Mission control" in mission.inner_text("body")
    for word in ("import", "MissionControl"):
        assert word not in mission.inner_text("body")
    (figure,) = figures(mission)
    assert visible_pictures(mission) == 1
    check_figure(figure, said=False)


def test_find_the_optimum_and_keep_the_trial(mission, tmp_path):
    mission.get_by_role("button", name="Find the optimum").click()
    mission.locator("[role=status]").filter(has_text="soft landing").wait_for(timeout=5000)
    mission.get_by_role("button", name="Keep this trial").click()
    mission.locator("table").wait_for(timeout=3000)
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
    mission.locator("table").wait_for(state="detached", timeout=3000)


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


def axe(page, **context):
    """What axe finds wrong, or leaves for a person to review, by the name of its rule."""
    from axe_playwright_python.sync_playwright import Axe

    found = Axe().run(page, context=context or None, options={"resultTypes": ["violations", "incomplete"]}).response
    nodes = [
        (rule["id"], node["html"])
        for kind in ("violations", "incomplete")
        for rule in found[kind]
        for node in rule["nodes"]
    ]
    assert len(found["passes"]) > 5, "it looked at something"
    return nodes


def test_axe_finds_nothing_in_mission_control(mission):
    mission.get_by_role("button", name="Keep this trial").click()
    mission.locator("table").wait_for(timeout=5000)
    # that the notebook's texts are in no landmark is Voilà's
    assert [(rule, html) for rule, html in axe(mission) if not (rule == "region" and "jp-InputArea" in html)] == []
    mission.get_by_role("button", name="Clear the table").click()


@pytest.mark.parametrize("lesson", ["01_oscillator_and_error", "09_ignition_tables"], indirect=True)
def test_axe_finds_nothing_in_the_outputs_of_a_lesson(lesson):
    assert driver.run_all(lesson)["errors"] == []
    figures(lesson)
    found = axe(lesson, include=[[".jp-OutputArea-output"]])
    assert [(rule, html) for rule, html in found if rule != "empty-table-header"] == []  # that is pandas'


@pytest.mark.parametrize("name", ["11_auditing_the_paper", "mission_control"])
def test_every_control_follows_keys_in_notebook_7(chromium, folder, name):
    with driver.server("notebook", folder, tempfile.mkdtemp(dir=folder.parent)) as address:
        page = chromium.new_page(viewport={"width": 1280, "height": 1000})
        driver.open_alone(page, address, f"{name}.ipynb")
        assert driver.run_all(page)["errors"] == []
        (figure,) = figures(page)
        check_figure(figure, said=name not in NOT_SAID)
        page.close()


def test_lesson_on_a_phone_has_room_for_a_thumb_and_cuts_nothing(chromium, folder):
    with driver.server("notebook", folder, tempfile.mkdtemp(dir=folder.parent)) as address:
        context = chromium.new_context(viewport={"width": 390, "height": 844}, device_scale_factor=3)
        page = context.new_page()
        driver.open_alone(page, address, "09_ignition_tables.ipynb")
        assert driver.run_all(page)["errors"] == []
        (figure,) = figures(page)
        figure.where.scroll_into_view_if_needed()
        figure.wait(SHARP, 3, timeout=10_000)
        assert min(figure.where.evaluate(WIDTHS)) >= 150
        assert figure.where.evaluate(CUT) == []
        context.close()


def test_picture_is_the_kernels_to_the_pixel_and_sharp_on_a_dense_screen(chromium, folder):
    with driver.server("lab", folder, tempfile.mkdtemp(dir=folder.parent)) as address:
        context = chromium.new_context(viewport={"width": 1280, "height": 1000}, device_scale_factor=2)
        page = context.new_page()
        driver.open_lab(page, address)
        driver.open_notebook(page, "twice.ipynb")
        assert driver.run_all(page)["errors"] == []
        figure = figures(page)[0]
        figure.where.scroll_into_view_if_needed()
        figure.wait(SHARP, 2, timeout=10_000)
        for _ in range(3):
            before = figure.state()["text"]
            press(page, figure.slider(), "ArrowRight", 40)
            figure.wait(CHANGED, "text", before)
            figure.wait(AGREES, 0)
            wanted = page.evaluate(ASK, KERNELS_PIXELS).strip("'")
            page.wait_for_timeout(300)
            assert figure.where.evaluate(PIXELS) == wanted
        context.close()


def test_kernels_of_pages_that_are_gone_end(chromium, folder, tmp_path):
    culling = json.loads((course.NOTEBOOKS.parent / "voila.json").read_text())
    assert culling["MappingKernelManager"] == {"cull_idle_timeout": 120, "cull_interval": 30}
    sooner = {"MappingKernelManager": {"cull_idle_timeout": 20, "cull_interval": 1}}
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
        page.wait_for_timeout(30_000)  # a page that is looked at keeps its own
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
