"""Live figures in JupyterLab and Notebook 7, moved by keyboard and by mouse in a headless Chromium."""

import re
import tempfile

import pytest

from hoverslam_lib.live import STILL

pytest.importorskip("playwright.sync_api", reason="playwright is missing: pip install -e '.[dev]'")
import driver
from figures import (
    AGREES,
    CHANGED,
    CUT,
    LIVE,
    NOT_SAID,
    SHARP,
    WIDTHS,
    axe,
    check_figure,
    check_papers_landing,
    figures,
    middle,
    press,
    visible_pictures,
)

PIXELS = """async figure => {
    const canvas = figure.querySelector('canvas'), {width, height} = canvas;
    const {data} = canvas.getContext('2d').getImageData(0, 0, width, height);
    const digest = await crypto.subtle.digest('SHA-256', data);
    return [...new Uint8Array(digest)].map(byte => byte.toString(16).padStart(2, '0')).join('');
}"""
KERNELS_PIXELS = "__import__('hashlib').sha256(figures[0].pixels().tobytes()).hexdigest()"
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
WIDGETS = "len(__import__('ipywidgets').widgets.widget._instances)"


@pytest.fixture(scope="module")
def lab_server(folder):
    with driver.server("lab", folder, tempfile.mkdtemp(dir=folder.parent)) as address:
        yield address


@pytest.fixture(scope="module")
def notebook_7(folder):
    with driver.server("notebook", folder, tempfile.mkdtemp(dir=folder.parent)) as address:
        yield address


@pytest.fixture(scope="module")
def lab(chromium, lab_server):
    """JupyterLab, opened once."""
    page = chromium.new_page(viewport={"width": 1280, "height": 1000})
    driver.open_lab(page, lab_server)
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


def drag(page, handle, shifts):
    """Take a handle, pull it sideways through shifts [pixels] from where it was, and let it go."""
    x, y = middle(handle)
    page.mouse.move(x, y)
    page.mouse.down()
    for shift in shifts:
        page.mouse.move(x + shift, y)
    page.mouse.up()


def test_notebook_shows_a_still_before_it_is_run_and_follows_every_control_after(lesson):
    name = lesson.evaluate(NAME)
    before = lesson.locator(".jp-OutputArea-output").filter(has_text=STILL)
    assert lesson.get_by_text(re.compile("model not found", re.IGNORECASE)).count() == 0
    assert before.locator("img").get_attribute("alt") in before.text_content()
    assert driver.run_all(lesson)["errors"] == []
    (figure,) = figures(lesson)
    assert not figure.state()["text"].startswith("Not possible")
    if name in ("01_oscillator_and_error", "09_ignition_tables"):
        found = axe(lesson, include=[[".jp-OutputArea-output"]])
        assert [(rule, html) for rule, html in found if rule != "empty-table-header"] == []  # that is pandas'
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
    status.filter(has_text="The kernel is gone: run this cell again.").wait_for(timeout=10_000)
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
    figure.wait(AGREES, 0, timeout=10_000)
    press(scratch, figure.slider(), "Home")
    figure.wait(AGREES, 0)
    press(scratch, figure.slider(), "Home")  # nothing changes, but the kernel answers
    scratch.wait_for_timeout(3000)
    assert "gone" not in status.inner_text()
    scratch.evaluate(SHUT_DOWN)
    press(scratch, figure.slider(), "ArrowRight")
    status.filter(has_text="The kernel is gone: run this cell again.").wait_for(timeout=10_000)


def test_saved_notebook_shows_its_stills_the_next_day_in_a_new_server(chromium, folder, lab, notebook_7):
    driver.open_notebook(lab, "twice.ipynb")
    assert driver.run_all(lab)["errors"] == []
    assert len(figures(lab)) == visible_pictures(lab) == 3
    driver.save_notebook(lab)
    driver.close_notebook(lab)
    with driver.server("lab", folder, tempfile.mkdtemp(dir=folder.parent)) as another_lab:
        for address in (f"{another_lab}/lab/tree/twice.ipynb", f"{notebook_7}/notebooks/twice.ipynb"):
            page = chromium.new_page(viewport={"width": 1280, "height": 1000})
            page.goto(f"{address}?token={driver.TOKEN}")
            page.wait_for_function(driver.IDLE, timeout=60_000)
            check_stills(page, 3)
            assert driver.run_all(page)["errors"] == []
            assert len(figures(page)) == visible_pictures(page) == 3
            figure = figures(page)[1]
            before = figure.state()["text"]
            press(page, figure.slider(), "ArrowRight")
            figure.wait(CHANGED, "text", before)
            page.close()


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
    figure.wait(AGREES, 0, timeout=3000)
    calls, last = scratch.evaluate(ASK, "len(calls)"), figure.state()  # the kernel answers when it is done
    assert 3 <= int(calls) - before <= 30
    assert scratch.evaluate(ASK, "len(calls)") == calls
    assert figure.state() == last


@pytest.mark.parametrize("lesson", ["mission_control"], indirect=True)
def test_papers_landing_on_one_click_in_jupyterlab(lesson):
    assert driver.run_all(lesson)["errors"] == []
    check_papers_landing(lesson)


@pytest.mark.parametrize("name", ["11_auditing_the_paper", "mission_control"])
def test_every_control_follows_keys_in_notebook_7(chromium, notebook_7, name):
    page = chromium.new_page(viewport={"width": 1280, "height": 1000})
    driver.open_alone(page, notebook_7, f"{name}.ipynb")
    assert driver.run_all(page)["errors"] == []
    (figure,) = figures(page)
    check_figure(figure, said=name not in NOT_SAID)
    page.close()


def test_lesson_on_a_phone_has_room_for_a_thumb_and_cuts_nothing(chromium, notebook_7):
    context = chromium.new_context(viewport={"width": 390, "height": 844}, device_scale_factor=3)
    page = context.new_page()
    driver.open_alone(page, notebook_7, "06_forces_on_the_booster.ipynb")
    assert driver.run_all(page)["errors"] == []
    (figure,) = figures(page)
    figure.where.scroll_into_view_if_needed()
    figure.wait(SHARP, 3, timeout=10_000)
    assert min(figure.where.evaluate(WIDTHS)) >= 150
    assert figure.where.evaluate(CUT) == []
    context.close()


def test_picture_is_the_kernels_to_the_pixel_and_sharp_on_a_dense_screen(chromium, lab_server):
    context = chromium.new_context(viewport={"width": 1280, "height": 1000}, device_scale_factor=2)
    page = context.new_page()
    driver.open_lab(page, lab_server)
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
