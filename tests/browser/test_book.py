"""The book, opened from its folder in a headless Chromium without a network."""

import json
import re
import shutil

import nbformat
import pytest

from hoverslam_lib import book, course

pytest.importorskip("playwright.sync_api", reason="playwright is missing: pip install -e '.[dev]'")
pytest.importorskip("sphinx", reason="sphinx is missing: pip install -e '.[book]'")
import driver
from axe_playwright_python.sync_playwright import Axe

WIDTHS = (390, 1280)
OTHERS = {"empty-table-header", "region", "label-content-name-mismatch"}  # of pandas and of the theme
CUT = """() => [...document.querySelectorAll("article pre, article table, article img, article p, article .picture")]
    .filter(e => e.checkVisibility())
    .filter(e => {
        const beside = e.getBoundingClientRect().right > innerWidth + 1;
        return beside || (e.tagName === "PRE" && e.scrollWidth > e.clientWidth + 1);
    })
    .map(e => `${e.tagName} ${e.textContent.slice(0, 60)}`)"""
RECTANGLES = """pictures => pictures.map(e => {
    const {x, y, width, height} = e.getBoundingClientRect();
    return [x, y, width, height];
})"""
SEEN_THROUGH = """layer => {
    const style = getComputedStyle(layer);
    return style.backgroundColor === "rgba(0, 0, 0, 0)" && style.filter === "none" && style.opacity === "1";
}"""
SHOWN = "figure => figure.querySelector('.picture img:last-child').src"


@pytest.fixture(scope="module")
def chromium():
    try:
        with driver.browser() as browser:
            yield browser
    except driver.NoBrowser as missing:
        pytest.skip(str(missing))


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pages") / "the book"
    book.build(course.lessons(), folder)
    return folder


@pytest.fixture(scope="module")
def recordings(made):
    """What was recorded, by the name of the figure."""
    found = {}
    for path in sorted((made / "recordings").glob("*.js")):
        name, record = re.fullmatch(r'hoverslam\.recordings\["(.+?)"\] = (.*);\n', path.read_text("utf-8")).groups()
        found[name] = json.loads(record)
    return found


@pytest.fixture(params=WIDTHS)
def page(chromium, request):
    context = chromium.new_context(
        viewport={"width": request.param, "height": 900},
        has_touch=request.param == 390,
        color_scheme="dark" if request.param == 390 else "light",
        offline=True,
    )
    page, page.said = context.new_page(), []
    page.on("console", lambda message: page.said.append(message.text) if message.type in ("error", "warning") else None)
    page.on("pageerror", lambda error: page.said.append(str(error)))
    local = re.compile("file:|data:|blob:")
    page.on("request", lambda request: None if local.match(request.url) else page.said.append(request.url))
    yield page
    context.close()


def figure_of(page, made, name):
    """Open a page at one of its figures, with everything unfolded."""
    page.goto((made / f"{name.rpartition('-')[0]}.html").as_uri())
    page.evaluate("document.querySelectorAll('details').forEach(part => part.open = true)")
    figure = page.locator(f"[data-recording='{name}']")
    figure.scroll_into_view_if_needed()
    figure.locator("input").first.wait_for()
    return figure


def number_of(record, places):
    n = 0
    for place, control in zip(places, record["controls"], strict=True):
        n = n * len(control["shown"]) + place
    return n


def check_position(figure, record, places):
    """Sentence, picture, and the value of each control are those recorded."""
    n = number_of(record, places)
    assert figure.locator("[role=status]").inner_text() == record["sentences"][n]
    assert figure.evaluate(SHOWN) == f"data:image/png;base64,{record['layers'][n]}"
    assert figure.locator(".picture img").last.get_attribute("alt") == record["sentences"][n]
    for k, control in enumerate(record["controls"]):
        value = f"{control['shown'][places[k]]} {control['unit']}".strip()
        assert figure.locator("output").nth(k).inner_text() == value
        if not control["checkbox"]:
            assert figure.locator("input").nth(k).get_attribute("aria-valuetext") == value


def test_every_page_opens_and_asks_nothing_of_anybody(page, made, recordings):
    pages = sorted(made.glob("*.html"))
    assert len(pages) > len(course.lessons())
    for path in pages:
        page.goto(path.as_uri())
        page.wait_for_load_state("load")
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), path.name
        assert path.stat().st_size <= 1_000_000
    page.wait_for_timeout(500)
    assert page.said == []
    live = [path.stem for path in course.lessons() if book._live_cells(path)]
    assert sorted({name.rpartition("-")[0] for name in recordings}) == sorted(live)
    assert max(path.stat().st_size for path in (made / "recordings").iterdir()) <= 2_500_000
    assert sum(path.stat().st_size for path in made.rglob("*") if path.is_file()) <= 60_000_000


def test_every_figure_follows_keys_and_finger_to_what_was_recorded(page, made, recordings):
    for name, record in recordings.items():
        figure = figure_of(page, made, name)
        places = [control["start"] for control in record["controls"]]
        check_position(figure, record, places)
        room = figure.locator(".room").bounding_box()["height"]
        for k, control in enumerate(record["controls"]):
            field = figure.locator("input").nth(k)
            if control["checkbox"]:
                field.press("Space")
                places[k] = 1 - places[k]
                check_position(figure, record, places)
                continue
            for key, place in (("End", len(control["shown"]) - 1), ("ArrowLeft", -1), ("Home", 0), ("ArrowRight", 1)):
                field.press(key)
                places[k] = place if key != "ArrowLeft" else places[k] - 1
                check_position(figure, record, places)
            box = field.bounding_box()
            tap = page.touchscreen.tap if page.viewport_size["width"] == 390 else page.mouse.click
            field.scroll_into_view_if_needed()
            box = field.bounding_box()
            tap(box["x"] + 0.7 * box["width"], box["y"] + box["height"] / 2)
            places[k] = int(field.input_value())
            assert 0.6 < places[k] / (len(control["shown"]) - 1) < 0.8 or len(control["shown"]) < 6
            check_position(figure, record, places)
        assert figure.locator(".room").bounding_box()["height"] == room  # the picture has not moved
        ground, layer = figure.locator(".picture img").evaluate_all(RECTANGLES)
        assert ground == layer
        assert figure.locator(".picture img").last.evaluate(SEEN_THROUGH)
        assert ground[2] >= min(record["width"], 0.72 * record["width"]) - 1
        assert ground[2] / ground[3] == pytest.approx(record["width"] / record["height"], rel=0.01)
    assert page.said == []


def test_first_sentence_is_that_of_the_stored_still(recordings):
    for path in course.lessons():
        if path.stem == "mission_control":  # its page shows the paper's own method
            continue
        cells = nbformat.read(path, as_version=4).cells
        for n, cell in enumerate(book._live_cells(path)):
            record = recordings[f"{path.stem}-{n}"]
            first = number_of(record, [control["start"] for control in record["controls"]])
            assert record["sentences"][first] in [output.data["text/plain"] for output in cells[cell].outputs]


def test_answers_are_folded_until_asked_for_and_open_when_printed(page, made):
    for path in course.lessons():
        tagged = [cell for cell in nbformat.read(path, as_version=4).cells if "answer" in cell.metadata.get("tags", [])]
        page.goto((made / f"{path.stem}.html").as_uri())
        assert page.locator("article details:not([open])").count() == len(tagged)
        if tagged:
            page.locator("article details summary").first.click()
            assert page.locator("article details[open]").count() == 1
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert page.locator("article details:not([open])").count() == 0


def test_no_line_is_cut_in_print(chromium, made):
    page = chromium.new_page(viewport={"width": 718, "height": 1000})  # A4 within its margins
    page.emulate_media(media="print")
    for path in sorted(made.glob("*.html")):
        page.goto(path.as_uri())
        page.evaluate("dispatchEvent(new Event('beforeprint'))")
        page.wait_for_timeout(200)
        assert page.evaluate(CUT) == [], path.name
    page.close()


def test_prediction_sheet_prints_a_lesson_a_page(chromium, made):
    page = chromium.new_page()
    page.goto((made / "prediction_sheet.html").as_uri())
    page.wait_for_selector("mjx-container")
    rooms, lessons = page.locator(".write"), page.locator("section section")
    printed = page.pdf(format="A4")
    assert len(re.findall(rb"/Type /Page\b", printed)) == 1 + lessons.count() > 10
    page.emulate_media(media="print")
    assert rooms.count() > 30
    assert min(room.bounding_box()["height"] for room in rooms.all()) > 38, "a centimetre to write in"
    page.close()


def test_menu_and_contents_open_on_a_phone(page, made):
    page.goto((made / "03_symplectic_euler.html").as_uri())
    if page.viewport_size["width"] != 390:
        pytest.skip("they stand beside the text there")
    for kind, entry in (("primary", "4 · A step that has to be solved"), ("secondary", "The phase plane")):
        page.locator(f"button.{kind}-toggle:visible").click()
        link = page.locator("dialog[open]").get_by_role("link", name=entry)
        link.wait_for(state="visible", timeout=3000)
        page.keyboard.press("Escape")


def test_films_can_be_paused_and_played_again(page, made):
    page.goto((made / "10_animations.html").as_uri())
    films = page.locator("img[src^='data:image/gif']")
    assert films.count() >= 3
    buttons = page.locator("button.pause")
    buttons.first.click()
    assert not films.first.is_visible()
    still = page.locator("canvas[role=img]").first
    assert still.is_visible()
    assert re.search(r"\d", still.get_attribute("aria-label"))
    assert buttons.first.inner_text() == "Play again"
    buttons.first.click()
    assert films.first.is_visible()


@pytest.mark.parametrize("name", ["01_oscillator_and_error-0", "mission_control-0"])
def test_axe_finds_nothing_of_ours(page, made, name):
    figure_of(page, made, name)
    found = {violation["id"] for violation in Axe().run(page).response["violations"]}
    assert found <= OTHERS


def test_for_students_and_unfolded(made, tmp_path):
    paths = course.lessons()
    book.build(paths, tmp_path / "book", for_students=True, unfold=True)
    pages = {path.name for path in (tmp_path / "book").glob("*.html")}
    assert {"index.html", "00_start_here.html", "glossary.html"} <= pages
    assert "mission_control.html" in pages
    assert "instructor_guide.html" not in pages
    assert "<details" not in (tmp_path / "book" / "00_start_here.html").read_text("utf-8")
    book.build(paths, tmp_path / "book")  # in its place
    assert (tmp_path / "book" / "instructor_guide.html").exists()
    shutil.rmtree(tmp_path / "book" / "_static")
    with pytest.raises(ValueError, match="holds other files and no book"):
        book.build(paths, tmp_path / "book")
