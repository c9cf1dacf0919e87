"""Live figures in JupyterLab and Voilà, moved by keyboard and by mouse in a headless Chromium."""

import re
import shutil
import tempfile

import nbformat
import pandas as pd
import pytest

from hoverslam_lib import course
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

calls = []


def dot(name, pause=0):
    fig, ax = plt.subplots(figsize=(4, 2))
    ax.set(xlim=(0, 10), ylim=(-1, 1))
    (point,) = ax.plot([], [], "o", animated=True)

    def put(x):
        time.sleep(pause)
        calls.append(x)
        point.set_data([x], [0])
        return f"{name} is at {x:.2f}."

    return Live(fig, put, x=FloatSlider(5, min=0, max=10, step=0.01, description=f"{name} [m]"))
"""
SCRATCH = {
    "twice": [DOT, "dot('one').show()", "dot('two').show()\ndot('three').show()"],
    "slow": [DOT, "dot('slow', pause=0.08).show()"],
}

STATE = """figure => {
    const picture = figure.querySelector('img');
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [picture.naturalWidth, picture.naturalHeight];
    canvas.getContext('2d').drawImage(picture, 0, 0);
    return {text: figure.querySelector('[role=status]').innerText, picture: canvas.toDataURL()};
}"""
SHOWS = f"([figure, what, before]) => ({STATE})(figure)[what] === before"
CHANGED = f"([figure, what, before]) => figure.querySelector('img').complete && ({STATE})(figure)[what] !== before"
AGREES = """([figure, n]) => {
    const numbers = part => part.innerText.replaceAll('−', '-').match(/-?[0-9]+([.][0-9]+)?/g).map(Number);
    const [read] = numbers(figure.querySelectorAll('.widget-slider .widget-readout')[n]);
    return numbers(figure.querySelector('[role=status]')).includes(read);
}"""
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
    const label = widget?.querySelector('.widget-label')?.innerText || at.ariaLabel || at.innerText || '';
    return {label: label.trim(), number: window.controls.indexOf(at)};
}"""
WIDGETS = "len(__import__('ipywidgets').widgets.widget._instances)"
CONTROLS = ".noUi-handle, .jupyter-widgets select, .jupyter-widgets input, .jupyter-widgets button"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A copy of the notebooks, and the scratch ones: nothing in the checkout is written to."""
    copy = tmp_path_factory.mktemp("browser") / "notebooks"
    shutil.copytree(course.NOTEBOOKS, copy)
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
        page.goto(f"{address}/voila/render/mission_control.ipynb?token={driver.TOKEN}")
        page.wait_for_selector(".noUi-handle", timeout=60_000)
        yield page
        page.close()


class Figure:
    """A live figure on the page: `where` holds its controls, its status text and its picture."""

    def __init__(self, where):
        self.where, self.page = where, where.page
        self.where.locator("img").wait_for()

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
        return self.where.locator(".widget-slider .widget-label").nth(n).inner_text()


def figures(page):
    """The live figures of a page, in their order."""
    page.locator(".widget-image").first.wait_for()
    places = page.locator(".jp-OutputArea-output").filter(has=page.locator(".widget-image"))
    return [Figure(place) for place in places.all()]


def check_stills(page, number):
    """What a reader sees where no widget lives: the still pictures, with their numbers and how to revive them."""
    page.locator(".hoverslam-still").first.wait_for()
    page.wait_for_timeout(1500)  # the front end's time to look for the widgets
    assert page.locator(".hoverslam-live").count() == 0
    stills = page.locator(".hoverslam-still")
    assert stills.count() == number
    for still in stills.all():
        assert still.is_visible()
        assert still.inner_text().endswith(STILL)
        picture = still.locator("img")
        assert picture.evaluate("image => image.checkVisibility() && image.naturalWidth > 0")
        assert re.search(r"\d", picture.get_attribute("alt"))
        assert picture.get_attribute("alt") in still.inner_text()
    for notice in page.get_by_text(re.compile("model not found|Loading widget", re.IGNORECASE)).all():
        assert not notice.is_visible()


def check_papers_landing(page):
    """One click on a fresh page shows it; then the published equation follows keys, the mouse and what is typed."""
    (figure,) = figures(page)
    page.get_by_role("button", name="The paper's landing").click()
    landing = "comes to 0 m/s 2.6 m above the ground. Ignition at 35.880000 s, dt = 0.02 s."
    said = "([figure, text]) => figure.querySelector('[role=status]').innerText.endsWith(text)"
    figure.wait(said, landing)
    assert page.get_by_role("spinbutton", name="ignition [s]").input_value() == "35.88"
    move_slider(figure, 0, said=False)
    figure.wait(said, landing)
    for n in (2, 3):  # another thrust or drag is refused, and the paper's comes back
        figure.there_and_back(
            lambda n=n: press(page, figure.slider(n), "ArrowRight"),
            lambda n=n: press(page, figure.slider(n), "ArrowLeft"),
        )
    crash = "largest velocity -52.9 m/s. Ignition at 35.882000 s, dt = 0.02 s."
    for typed, end in {"35.882": crash, "35.88": landing}.items():
        number = page.get_by_role("spinbutton", name="ignition [s]")
        number.fill(typed)
        number.press("Enter")
        figure.wait(said, end)
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


def check_names(figure):
    """What a screen reader says of a slider is its label, and of the picture the sentence above it."""
    for n in range(figure.where.locator(".noUi-handle").count()):
        figure.wait("([figure, n]) => figure.querySelectorAll('.noUi-handle')[n].ariaLabel", n)
        assert figure.slider(n).get_attribute("aria-label") == figure.label(n) != ""
    assert figure.where.locator("img").get_attribute("alt") == figure.state()["text"]


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
    else:  # not by arrow keys: JupyterLab takes them for its own, to go from cell to cell
        chosen = control.evaluate("select => [...select.selectedOptions].map(option => option.value)")
        figure.there_and_back(lambda: control.select_option(index=1), lambda: control.select_option(chosen))


def test_notebook_shows_a_still_before_it_is_run_and_follows_every_control_after(lesson):
    name = lesson.evaluate(NAME)
    before = lesson.locator(".jp-OutputArea-output").filter(has_text=STILL)
    assert lesson.get_by_text(re.compile("model not found", re.IGNORECASE)).count() == 0
    assert before.locator("img").get_attribute("alt") in before.inner_text()
    assert driver.run_all(lesson)["errors"] == []
    (figure,) = figures(lesson)
    assert not figure.state()["text"].startswith("Not possible")
    check_names(figure)
    for n in range(figure.where.locator(".noUi-handle").count()):
        move_slider(figure, n, said=name not in NOT_SAID)
    for control in figure.where.locator("input[type=checkbox], select").all():
        move_other(figure, control)
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
            drag(page, figure.slider(), range(2, 42, 2))  # Notebook 7 takes arrow keys for its own
            figure.wait(CHANGED, "text", before)
            page.close()


def visible_pictures(page):
    return page.locator(".jp-OutputArea-output:has(.hoverslam-live) img:visible, .hoverslam-still img:visible").count()


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
    check_names(figure)
    for n in range(mission.locator(".noUi-handle").count()):
        move_slider(figure, n, said=False)
    check_names(figure)
    for control in mission.locator("input[type=checkbox], select").all():
        move_other(figure, control)


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
    assert f"{kept['t_ignite [s]']:.6f}" in mission.locator("[role=status]").inner_text()
    assert kept["verdict"] in mission.locator("table").inner_text()
    mission.get_by_role("button", name="Clear the table").click()
    mission.locator("table").wait_for(state="detached", timeout=3000)


def test_flight_plays_and_pauses(mission):
    (figure,) = figures(mission)
    play = mission.get_by_role("button", name="Play")
    moment = mission.locator(".widget-readout").last
    play.click()
    for _ in range(3):
        figure.wait(CHANGED, "picture", figure.state()["picture"])
    play.click()
    stopped = moment.inner_text()
    mission.wait_for_timeout(500)  # four pictures' time
    assert moment.inner_text() == stopped


def test_nothing_is_cut_off_at_1024_pixels(mission):
    width = mission.evaluate("window.innerWidth")
    assert mission.evaluate("document.documentElement.scrollWidth") <= width
    for part in mission.locator(f"{CONTROLS}, .widget-readout, [role=status], .widget-image").all():
        if not part.is_visible():
            continue
        box = part.bounding_box()
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= width, part.evaluate("part => part.outerHTML")


def test_keyboard_reaches_every_control_and_each_has_a_label(mission):
    number = mission.evaluate(VISIBLE, CONTROLS)
    mission.locator(".noUi-handle").first.focus()
    reached = [mission.evaluate(FOCUS)]
    for _ in range(2 * number):  # readouts can be edited, and lie on the way too
        mission.keyboard.press("Tab")
        reached.append(mission.evaluate(FOCUS))
    assert {at["number"] for at in reached} >= set(range(number))
    assert [at for at in reached if at["number"] >= 0 and not at["label"]] == []
