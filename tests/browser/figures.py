"""Live figures on a page: what they show, and their controls moved by key and by mouse."""

import re

from hoverslam_lib import course

LIVE = [path.stem for path in course.lessons() if "Live(" in path.read_text() or "MissionControl" in path.read_text()]
SAME_TEXT = ("moment [% of flight]",)  # labels of sliders that move only the picture
NOT_SAID = ("07_hoverslam_ode", "09_ignition_tables", "mission_control")  # whose text does not repeat every slider
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
VISIBLE = """selector => {
    window.controls = [...document.querySelectorAll(selector)].filter(control => control.checkVisibility());
    return window.controls.length;
}"""
FOCUS = """() => {
    const at = document.activeElement, widget = at.closest('.jupyter-widgets');
    const label = at.ariaLabel || at.textContent || widget?.querySelector('.widget-label')?.textContent || '';
    return {label: label.trim(), number: window.controls.indexOf(at)};
}"""
CONTROLS = ", ".join(f".hoverslam-live {control}" for control in (".noUi-handle", "select", "input", "button"))


class Figure:
    """A live figure on the page: `where` holds its controls, its status text and its picture."""

    def __init__(self, where):
        self.where, self.page = where, where.page
        self.where.locator("canvas").wait_for()

    def state(self):
        return self.where.evaluate(STATE)

    def wait(self, condition, *values, timeout=10_000):
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


def inward(handle):
    """On which side of a slider there is more room: +1 for the right, -1 for the left."""
    low, now, high = (float(handle.get_attribute(f"aria-value{name}")) for name in ("min", "now", "max"))
    return 1 if now < (low + high) / 2 else -1


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


def visible_pictures(page):
    return page.locator(
        ".jp-OutputArea-output:has(.hoverslam-live) canvas:visible, .hoverslam-still img:visible"
    ).count()


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
