"""The book, opened from its folder in a headless Chromium without a network."""

import base64
import io
import json
import re

import nbformat
import numpy as np
import pytest
from PIL import Image

from hoverslam_lib import book, checks, course

pytest.importorskip("playwright.sync_api", reason="playwright is missing: pip install -e '.[dev]'")
pytest.importorskip("sphinx", reason="sphinx is missing: pip install -e '.[book]'")
from axe_playwright_python.sync_playwright import Axe

LESSONS = {path.stem: path for path in course.lessons()}
NAMES = [*LESSONS, "genindex", "glossary", "index", "instructor_guide", "prediction_sheet"]  # and search, a form
WIDTHS = (390, 1280)
WALL = {"width": 1920, "height": 1080}
OTHERS = {"empty-table-header", "region", "label-content-name-mismatch"}  # of pandas and of the theme
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


def open_page(page, made, name):
    """Open a page and wait until its formulas are set."""
    page.goto((made / f"{name}.html").as_uri())
    page.evaluate("async () => await window.MathJax?.startup?.promise")


def unfold(page):
    page.evaluate("document.querySelectorAll('details').forEach(part => part.open = true)")


def figure_of(page, made, name):
    """Open a page at one of its figures, with everything unfolded."""
    open_page(page, made, name.rpartition("-")[0])
    unfold(page)
    return find_figure(page, name)


def find_figure(page, name):
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


def test_first_sentence_is_that_of_the_stored_still(recordings):
    for path in course.lessons():
        if path.stem == "mission_control":  # its page shows the paper's own method
            continue
        cells = nbformat.read(path, as_version=4).cells
        for n, cell in enumerate(book.live_cells(path)):
            record = recordings[f"{path.stem}-{n}"]
            first = number_of(record, [control["start"] for control in record["controls"]])
            assert record["sentences"][first] in [output.data["text/plain"] for output in cells[cell].outputs]


def test_every_recorded_sentence_says_numbers(recordings):
    said = [sentence for record in recordings.values() for sentence in record["sentences"]]
    assert len(said) > 3000
    for sentence in said:
        assert re.search(r"\d", sentence) or sentence.startswith("Not possible: ")
        assert "nan" not in sentence.split()


# ---- every page, opened once in each way of looking at it, because to set its formulas takes a page a second

ANSWER = """cells => cells.flatMap(answer => {
    const shown = [answer];
    for (let next = answer.nextElementSibling; next; next = next.nextElementSibling) {
        if (next.matches("section") || /^(Predict|Further reading|Next)/.test(next.innerText)) break;
        shown.push(next);
        if (!next.matches(".cell")) break;
    }
    return shown;
}).flatMap(part => part.matches(".cell") ? [...part.querySelectorAll(".cell_output")] : [part])
    .filter(part => part.checkVisibility() && !part.matches("details:not([open])"))
    .map(part => part.innerText)"""
TORN = r"""() => {
    const torn = [], top = range => range.getClientRects()[0].top;
    const part = (text, from, to) => {
        const range = document.createRange();
        range.setStart(text, from);
        range.setEnd(text, to);
        return range;
    };
    const texts = document.createTreeWalker(document.querySelector("article"), NodeFilter.SHOW_TEXT);
    while (texts.nextNode()) {
        const text = texts.currentNode;
        const own = text.parentElement;
        if (!own.checkVisibility() || own.closest("pre, code, mjx-container, .room")) continue;
        const numbers = /\d[ \u00a0](?:%|k?m|m?s|kg|t|m\/s²?)(?![\w\/])|\de-\d+/g;
        for (const found of text.textContent.matchAll(numbers)) {
            const [first, last] = [found.index, found.index + found[0].length - 1];
            if (top(part(text, last, last + 1)) > top(part(text, first, first + 1)) + 6) torn.push(found[0]);
        }
        const formula = text.previousSibling?.querySelector?.("mjx-container:not([display])");
        if (!formula || !/^[).,;:?!]/.test(text.textContent)) continue;
        if (top(part(text, 0, 1)) > formula.getBoundingClientRect().bottom) torn.push(formula.textContent);
    }
    return torn;
}"""
OFF_ITS_VALUES = """() => {
    const right = cell => {
        const text = document.createRange();
        text.selectNodeContents(cell);
        return cell.textContent.trim() ? text.getBoundingClientRect().right : null;
    };
    const found = [];
    for (const table of document.querySelectorAll("table.dataframe")) {
        const heading = table.tHead.rows[0].cells;
        if ([...heading].some(cell => cell.colSpan > 1)) continue;
        for (const row of table.tBodies[0].rows)
            for (const [k, cell] of [...row.cells].reverse().entries()) { // labels may span rows
                const over = heading[heading.length - 1 - k];
                const [above, below] = [right(over), right(cell)];
                if (cell.tagName === "TD" && above && below && Math.abs(above - below) > 1)
                    found.push(`${over.textContent}: ${cell.textContent} ends ${below - above} px beside it`);
            }
    }
    return found;
}"""
CUT = """() => [...document.querySelectorAll("article pre, article table, article img, article p, article .picture")]
    .filter(e => e.checkVisibility())
    .filter(e => {
        const beside = e.getBoundingClientRect().right > innerWidth + 1;
        return beside || (e.tagName === "PRE" && e.scrollWidth > e.clientWidth + 1);
    })
    .map(e => `${e.tagName} ${e.textContent.slice(0, 60)}`)"""
FAINT = """() => {
    const light = colour => {
        const [red, green, blue] = colour.match(/[0-9.]+/g).map(Number);
        return 0.3 * red + 0.59 * green + 0.11 * blue;
    };
    const parts = [...document.querySelectorAll("article :is(p, li, h1, h2, pre, td, th, a, summary)")];
    const style = part => getComputedStyle(part);
    const ground = [document.documentElement, document.body, document.querySelector(".bd-main")].map(style);
    return [
        ...parts.filter(e => e.checkVisibility() && light(style(e).color) > 140).map(e => e.outerHTML.slice(0, 80)),
        ...ground.map(e => e.backgroundColor).filter(c => !/rgba\\(.*, 0\\)/.test(c) && light(c) < 250),
    ];
}"""
UNSEEN = """() => [...document.querySelectorAll("article details *")].filter(part => {
    const style = getComputedStyle(part);
    return Number(style.opacity) < 1 || part.getAnimations().length;
}).map(part => part.outerHTML.slice(0, 80))"""
PALE = """() => {
    const light = part => { part /= 255; return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4; };
    const found = new Set();
    for (const e of document.querySelectorAll("article :is(p, li, td, th, a, code, pre, pre span, summary, h1, h2)")) {
        if (!e.checkVisibility() || !e.textContent.trim()) continue;
        const [r, g, b] = getComputedStyle(e).color.match(/[\\d.]+/g).map(Number);
        const contrast = 1.05 / (0.2126 * light(r) + 0.7152 * light(g) + 0.0722 * light(b) + 0.05);
        if (contrast < 4.5) found.add(`${e.tagName}.${e.className} ${r} ${g} ${b}`);
    }
    return [...found];
}"""
UNDERLINED = "links => links.map(e => getComputedStyle(e).textDecorationLine === 'underline')"
STYLES = """selector => [...document.querySelectorAll(selector)].map(e => {
    const {backgroundColor, filter, padding} = getComputedStyle(e);
    return {ground: backgroundColor, filter, padding};
})"""
HIDDEN_SIDES = """() => [...document.querySelectorAll(".output, .cell_input pre, .hoverslam-recorded .scroll")]
    .filter(e => e.checkVisibility())
    .map(e => ({scrolls: e.scrollWidth > e.clientWidth, faded: getComputedStyle(e).getPropertyValue("--right")}))"""


def test_pages_are_those_that_are_looked_at_and_small(made, recordings):
    pages = sorted(made.glob("*.html"))
    assert [path.stem for path in pages] == sorted([*NAMES, "search"])
    assert max(path.stat().st_size for path in pages) <= 1_000_000
    assert not any("Author name not set" in path.read_text("utf-8") for path in pages)
    live = [path.stem for path in course.lessons() if book.live_cells(path)]
    assert sorted({name.rpartition("-")[0] for name in recordings}) == sorted(live)
    assert max(path.stat().st_size for path in (made / "recordings").iterdir()) <= 2_500_000
    assert sum(path.stat().st_size for path in made.rglob("*") if path.is_file()) <= 60_000_000


@pytest.mark.parametrize("name", NAMES)
def test_page_asks_nothing_of_anybody_folds_answers_and_help_and_its_figures_follow(page, made, recordings, name):
    open_page(page, made, name)
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    if name in LESSONS:
        check_answers_are_folded_with_the_text_that_takes_them_up(page, name)
        check_exercises_have_hints_and_solution_folded(page, name)
    unfold(page)
    assert page.evaluate(TORN) == [], "a line ends inside a number, or before what belongs to it"
    assert page.evaluate(OFF_ITS_VALUES) == [], "a heading does not stand over its values"
    for figure_name, record in recordings.items():
        if figure_name.rpartition("-")[0] == name:
            check_figure_follows(page, find_figure(page, figure_name), record)
    assert page.said == []


def check_answers_are_folded_with_the_text_that_takes_them_up(page, name):
    cells = nbformat.read(LESSONS[name], as_version=4).cells
    tagged = [cell.cell_type for cell in cells if "answer" in cell.metadata.get("tags", [])]
    answers = page.locator("article .cell.tag_answer")
    assert answers.count() == tagged.count("code")
    assert page.get_by_text("Show the answer", exact=True).count() == tagged.count("markdown")
    assert answers.evaluate_all(ANSWER) == []


def check_exercises_have_hints_and_solution_folded(page, name):
    number = re.match(r"0?(\d+)_", name)
    own = [e for e in checks.EXERCISES.values() if number and e.number.startswith(f"{number[1]}.")]
    for summary in ("Hints", "Solution"):
        folded = page.locator("article details", has=page.get_by_text(summary, exact=True))
        assert folded.count() == len(own)
        assert not any(part.get_attribute("open") for part in folded.all())
    assert page.get_by_text("Without Python:").count() == (number is not None)


def check_figure_follows(page, figure, record):
    """Keys and finger lead to what was recorded, and a picture that is wider than the page says so."""
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
        tap = page.touchscreen.tap if page.viewport_size["width"] == 390 else page.mouse.click
        field.scroll_into_view_if_needed()
        box = field.bounding_box()
        tap(box["x"] + 0.7 * box["width"], box["y"] + box["height"] / 2)
        places[k] = int(field.input_value())
        last = len(control["shown"]) - 1
        assert abs(places[k] / last - 0.7) < max(0.1, 0.6 / last), "not the place under the finger"
        check_position(figure, record, places)
    assert figure.locator(".room").bounding_box()["height"] == room  # the picture has not moved
    ground, layer = figure.locator(".picture img").evaluate_all(RECTANGLES)
    assert ground == layer
    assert figure.locator(".picture img").last.evaluate(SEEN_THROUGH)
    assert ground[2] >= book.SMALLEST * record["width"] - 1
    assert ground[2] / ground[3] == pytest.approx(record["width"] / record["height"], rel=0.01)
    scrolls, width = figure.locator(".scroll").evaluate(
        "part => [part.scrollWidth > part.clientWidth, part.clientWidth]"
    )
    assert scrolls == (book.SMALLEST * record["width"] > width + 1)
    hint = figure.get_by_text("swipe it for the rest")
    hint.wait_for(state="visible" if scrolls else "hidden", timeout=10_000)  # it is measured after the first drawing


@pytest.fixture
def desk(chromium, request):
    """A page on a large screen, light or dark."""
    context = chromium.new_context(viewport=WALL, color_scheme=request.param, offline=True)
    yield context.new_page()
    context.close()


@pytest.mark.parametrize(
    ("desk", "name"),
    [
        *(("dark", name) for name in NAMES),
        *(("light", name) for name in ("index", "05_runge_kutta", "mission_control")),
    ],
    indirect=["desk"],
)
def test_page_is_whole_on_every_screen_and_on_paper(desk, made, name):
    open_page(desk, made, name)
    for picture in desk.evaluate(STYLES, ".cell_output .output img:not(.picture img)"):
        assert picture == {"ground": "rgb(255, 255, 255)", "filter": "none", "padding": "0px"}
    assert all(picture["filter"] == "none" for picture in desk.evaluate(STYLES, "article img"))
    for around in desk.evaluate(STYLES, ".cell_output .text_html:has(img)"):
        assert around["ground"] == "rgba(0, 0, 0, 0)"
    for width in (390, 1024, 1920):
        desk.set_viewport_size({"width": width, "height": 900})
        assert desk.evaluate("document.documentElement.scrollWidth <= innerWidth"), width
        assert desk.locator(".search-button__button:visible, input[type=search]:visible").count() == 1
    check_paper(desk)
    unfold(desk)
    desk.set_viewport_size(WALL)
    assert not any(part["scrolls"] for part in desk.evaluate(HIDDEN_SIDES)), "code is hidden at the side of a wall"
    desk.set_viewport_size({"width": 390, "height": 844})
    desk.wait_for_timeout(100)
    for part in desk.evaluate(HIDDEN_SIDES):
        assert (part["faded"] != "0px") == part["scrolls"]


def check_paper(page):
    """A4 within its margins: no line is cut, and letters are dark on white whatever the screen has."""
    page.set_viewport_size({"width": 718, "height": 1000})
    theme = page.evaluate("document.documentElement.dataset.theme")
    page.emulate_media(media="print")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    # at once: nobody waits for what fades in
    assert page.locator("article details:not([open])").count() == 0
    assert page.evaluate(UNSEEN) == []
    page.wait_for_timeout(200)
    assert page.evaluate(CUT) == []
    assert page.evaluate(FAINT) == []
    assert page.evaluate(PALE) == []
    assert page.locator("article summary:visible").count() == 0
    assert all(page.locator("article a:visible").evaluate_all(UNDERLINED))
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert page.evaluate("document.documentElement.dataset.theme") == theme
    page.emulate_media(media="screen")


# ---- what a reader does


def test_search_finds_a_lesson_without_a_network(page, made):
    page.goto(f"{(made / 'search.html').as_uri()}?q=hoverslam")
    found = page.get_by_role("link", name="7 · The hoverslam, flown twice").last
    found.wait_for(timeout=10_000)
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert page.said == []
    found.click()
    page.wait_for_url("**/07_hoverslam_ode.html*")


def test_answer_is_shown_to_who_asks_for_it(page, made):
    open_page(page, made, "03_symplectic_euler")
    away = page.get_by_text("explicit Euler has spiralled far out")
    assert not away.is_visible()
    assert page.get_by_role("heading", name="Area", exact=True).is_visible()
    away.locator("xpath=ancestor::details").locator("summary").click()
    assert away.is_visible()
    assert page.locator("article details[open]").count() == 1


def test_hint_and_solution_are_shown_to_who_asks_for_them(page, made):
    open_page(page, made, "02_explicit_euler")
    hint = page.get_by_text("Which operation repeats a multiplication", exact=False)
    assert not hint.is_visible()
    page.get_by_text("Hints", exact=True).first.click()
    assert hint.is_visible()
    page.get_by_text("Solution", exact=True).first.click()
    assert page.locator("details[open] pre", has_text="def my_energy_factor").is_visible()


def test_code_that_scrolls_to_its_end_fades_there_no_more(chromium, made):
    page = chromium.new_page(viewport={"width": 390, "height": 844})
    open_page(page, made, "01_oscillator_and_error")
    code = page.locator(".cell_input pre").first
    assert code.evaluate("e => getComputedStyle(e).getPropertyValue('--right')") != "0px"
    code.evaluate("e => { e.scrollLeft = e.scrollWidth; }")
    page.wait_for_timeout(100)
    assert code.evaluate("e => getComputedStyle(e).getPropertyValue('--right')") == "0px"
    page.close()


def test_mission_control_is_seen_whole_on_a_wall(chromium, made):
    page = chromium.new_page(viewport=WALL)
    figure = figure_of(page, made, "mission_control-0")
    page.evaluate("scrollTo(0, 0)")
    picture = figure.locator(".picture").bounding_box()
    assert picture["y"] + picture["height"] <= WALL["height"]
    assert picture["width"] > 1100
    assert figure.locator("input").first.bounding_box()["y"] < picture["y"]
    page.close()


@pytest.mark.parametrize("desk", ["light", "dark"], indirect=True)
def test_a_film_is_printed_as_the_picture_on_which_it_stands_still(desk, made):
    open_page(desk, made, "10_animations")
    desk.emulate_media(media="print")
    desk.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert [still.is_visible() for still in desk.locator("img.still").all()] == [True] * 3
    assert not desk.locator("img[src^='data:image/gif']").first.is_visible()


def phone(page):
    if page.viewport_size["width"] != 390:
        pytest.skip("that is for phones")


def test_menu_and_contents_open_on_a_phone_and_close_when_an_entry_is_chosen(page, made):
    phone(page)
    page.goto((made / "03_symplectic_euler.html").as_uri())
    page.locator("button.secondary-toggle:visible").tap()
    page.locator("dialog[open]").get_by_role("link", name="The phase plane").tap()
    page.locator("dialog[open]").wait_for(state="detached", timeout=10_000)
    there = (
        "id => { const {top} = document.getElementById(id).getBoundingClientRect(); return top >= -1 && top < 200; }"
    )
    page.wait_for_function(there, arg="the-phase-plane", timeout=10_000)  # the page glides
    page.locator("button.primary-toggle:visible").tap()
    page.locator("dialog[open]").get_by_role("link", name="4 · A step that has to be solved").tap()
    page.wait_for_url("**/04_implicit_euler.html")


def test_no_tooltip_stays_on_a_phone(page, made):
    phone(page)
    page.goto((made / "03_symplectic_euler.html").as_uri())
    page.locator("button.search-button__button:visible").first.tap()
    page.locator(".tooltip").wait_for(state="attached", timeout=10_000)
    page.wait_for_timeout(500)
    assert not page.locator(".tooltip").is_visible()


def swipe(page, start, by):
    """A finger that comes down, moves in twelve steps, and leaves."""
    session = page.context.new_cdp_session(page)
    for n in range(13):
        point = {"x": start[0] + by[0] * n / 12, "y": start[1] + by[1] * n / 12}
        kind = "touchMove" if n else "touchStart"
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [point]})
        page.wait_for_timeout(16)
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    page.wait_for_timeout(300)


def test_a_thumb_that_scrolls_past_a_slider_leaves_it_and_one_that_drags_moves_it(page, made, recordings):
    phone(page)
    record = recordings["03_symplectic_euler-0"]
    figure = figure_of(page, made, "03_symplectic_euler-0")
    page.evaluate("document.documentElement.style.scrollBehavior = 'auto'")
    field = figure.locator("input[type=range]").first
    field.evaluate("field => field.scrollIntoView({block: 'center'})")
    places, box = [control["start"] for control in record["controls"]], field.bounding_box()
    before = page.evaluate("scrollY")
    at = box["x"] + 0.85 * box["width"], box["y"] + box["height"] / 2
    swipe(page, at, (0, -200))
    assert page.evaluate("scrollY") > before + 100
    check_position(figure, record, places)
    field.evaluate("field => field.scrollIntoView({block: 'center'})")
    box = field.bounding_box()
    swipe(page, (box["x"] + 0.2 * box["width"], box["y"] + box["height"] / 2), (0.6 * box["width"], 0))
    places[0] = int(field.input_value())
    assert 0.7 < places[0] / (len(record["controls"][0]["shown"]) - 1) < 0.9
    check_position(figure, record, places)


def test_buttons_move_a_slider_by_one_place_and_stop_at_its_ends(page, made, recordings):
    record = recordings["09_ignition_tables-0"]
    figure = figure_of(page, made, "09_ignition_tables-0")
    touch = page.viewport_size["width"] == 390
    places = [control["start"] for control in record["controls"]]
    for k, control in enumerate(record["controls"]):
        down, up = (
            figure.get_by_role("button", name=f"{control['name']}: one place {where}", exact=True)
            for where in ("down", "up")
        )
        for button in (down, up):
            box = button.bounding_box()
            assert min(box["width"], box["height"]) >= (44 if touch else 24)
        last = len(control["shown"]) - 1
        for place in (*range(places[k] + 1, last + 1), *range(last - 1, -1, -1)):
            (button,) = (up,) if place > places[k] else (down,)
            (button.tap if touch else button.click)()
            places[k] = place
            check_position(figure, record, places)
            assert (down.is_disabled(), up.is_disabled()) == (place == 0, place == last)
    start = [control["start"] for control in record["controls"]]
    name = record["controls"][0]["name"]
    figure_of(page, made, "09_ignition_tables-0")
    figure.get_by_role("button", name=f"{name}: one place down", exact=True).click()
    assert record["controls"][0]["shown"][start[0] - 1] == "35.878"
    assert "largest velocity -67.0 m/s" in figure.locator("[role=status]").inner_text()


def test_mission_control_has_a_button_for_each_landing_and_fills_a_wall(page, made, recordings):
    record = recordings["mission_control-0"]
    figure = figure_of(page, made, "mission_control-0")
    for name, said, value in (
        ("The paper's landing", "comes to 0 m/s 2.6 m above the ground.\nIgnition at 35.880000 s, dt = 0.02 s", "on"),
        ("Find the optimum", "soft landing", "off"),
    ):
        button = figure.get_by_role("button", name=name)
        button.click()
        assert said in figure.locator("[role=status]").inner_text()
        assert value in figure.locator("output").all_inner_texts()
        check_position(figure, record, next(mark["places"] for mark in record["landmarks"] if mark["name"] == name))
        assert name in page.locator("article").inner_text()
    page.set_viewport_size({"width": 1920, "height": 1080})
    assert figure.locator(".picture").bounding_box()["width"] > 1200
    assert figure.bounding_box()["height"] < 1080 - 60  # below the page's own bar
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


def test_what_a_control_changes_comes_into_view_on_a_phone(page, made):
    phone(page)
    figure = figure_of(page, made, "09_ignition_tables-0")
    page.evaluate("scrollTo({top: 0, behavior: 'instant'})")
    scroll = figure.locator(".scroll")
    ends = {"ignition, ledger": "part => part.scrollLeft > 100", "ignition as printed": "part => part.scrollLeft < 60"}
    for name, shows in ends.items():  # its panel stands at the right, and at the left
        figure.get_by_role("button", name=f"{name}: one place up", exact=True).tap()
        page.wait_for_function(shows, arg=scroll.element_handle(), timeout=10_000)


NEAREST = 2.0
"""A film that was begun anew shows no later moment [s] when its first picture is taken."""


def test_films_are_stopped_at_their_last_picture_and_played_again_from_the_first(chromium, made):
    page = chromium.new_page(color_scheme="light")  # a dark page dims its pictures
    page.goto((made / "10_animations.html").as_uri())
    films = page.locator("img[src^='data:image/gif']")
    assert films.count() == 3
    film, still = films.first, page.locator("img.still").first
    with Image.open(packed(film)) as frames:
        times, pictures, t = [], [], 0
        for n in range(frames.n_frames):
            frames.seek(n)
            times.append(t)
            pictures.append(np.array(frames.convert("RGB"), dtype=int))
            t += frames.info["duration"] / 1000
    with Image.open(packed(still)) as last:
        assert np.array_equal(np.array(last.convert("RGB")), pictures[-1])
    assert still.get_attribute("alt") == film.get_attribute("alt")
    assert re.search(r"\d", still.get_attribute("alt"))

    small = [picture[::2, ::2].astype(np.int16) for picture in pictures]

    def moment():
        """What the film shows [s]."""
        seen = Image.open(io.BytesIO(film.screenshot())).convert("RGB").resize(pictures[0].shape[1::-1])
        seen = np.array(seen, dtype=np.int16)[::2, ::2]
        return times[int(np.argmin([np.abs(picture - seen).mean() for picture in small]))]

    film.scroll_into_view_if_needed()
    shown = [moment()]
    while len(shown) < 20 and shown[-2:] != [times[-1]] * 2:
        page.wait_for_timeout(4000)  # longer than it rests before it begins anew
        shown.append(moment())
    assert shown[-2:] == [times[-1]] * 2  # it has played its three times
    page.get_by_role("button", name="Play again", exact=True).first.click()
    assert moment() < NEAREST
    page.get_by_role("button", name="Stop", exact=True).first.click()
    assert still.is_visible()
    assert not film.is_visible()
    page.get_by_role("button", name="Play again", exact=True).first.click()
    assert film.is_visible()
    assert not still.is_visible()
    assert moment() < NEAREST
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


def packed(image):
    return io.BytesIO(base64.b64decode(image.get_attribute("src").partition(",")[2].partition("#")[0]))


def test_films_stand_still_for_who_wants_less_motion(chromium, made):
    page = chromium.new_page(reduced_motion="reduce")
    for name in ("index", "00_start_here", "10_animations"):
        page.goto((made / f"{name}.html").as_uri())
        page.evaluate("document.querySelectorAll('details').forEach(part => part.open = true)")
        assert page.locator("img.still").count() >= 1
        assert all(still.is_visible() for still in page.locator("img.still").all())
        assert not any(film.is_visible() for film in page.locator("img:has(+ .still)").all())
    page.close()


@pytest.mark.parametrize("name", ["01_oscillator_and_error-0", "mission_control-0"])
def test_axe_finds_nothing_of_ours(page, made, name):
    figure_of(page, made, name)
    found = {violation["id"] for violation in Axe().run(page).response["violations"]}
    assert found <= OTHERS


def test_for_students_unfolded_and_with_solutions_withheld(made, tmp_path):
    target = tmp_path / "book"
    assert course.main(["book", str(target), "--for-students", "--open", "--withhold-solutions"]) == 0
    pages = {path.name: path.read_text("utf-8") for path in target.glob("*.html")}
    assert {"index.html", "00_start_here.html", "glossary.html", "mission_control.html"} <= pages.keys()
    assert "instructor_guide.html" not in pages
    assert not any("Show the answer" in text or "what to make of it" in text for text in pages.values())
    assert not any("<summary>Solution" in text for text in pages.values())
    assert pages["02_explicit_euler.html"].count("<summary>Hints") == 3
