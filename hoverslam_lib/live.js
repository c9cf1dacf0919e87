// What a live figure shows in the browser: its sentence, its picture, and what ipywidgets does not say of its controls.

const WAIT = 1000; // [ms] until a kernel that does not answer is asked
const CALM = 100; // [ms] after which a size has settled
const CONTROLS = ".widget-slider, .widget-text";
const KEYS = /^(Arrow|Home|End|Page)/;

const unpack = async packed => {
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint32Array(await new Response(stream).arrayBuffer());
};

const put = (part, name, value) => part.getAttribute(name) === value || part.setAttribute(name, value);

// names, values with their units and states, for those who hear the page
function describe(figure) {
    for (const control of figure.querySelectorAll(CONTROLS)) {
        const [label, readout] = [".widget-label", ".widget-readout"].map(part => control.querySelector(part));
        const name = label.textContent || label.title;
        const unit = /\[(.+)\]/.exec(name)?.[1] ?? "";
        const handles = [...control.querySelectorAll("[role=slider]")];
        const values = readout?.textContent.split(" – ") ?? [];
        handles.forEach((handle, n) => {
            put(handle, "aria-label", name);
            put(handle, "aria-valuetext", `${values[n] ?? ""} ${unit}`.trim());
        });
        for (const part of control.querySelectorAll("input, [contenteditable=true]")) {
            if (part === readout) put(part, "role", "textbox");
            put(part, "aria-label", name);
        }
    }
    for (const button of figure.querySelectorAll(".widget-toggle-button"))
        put(button, "aria-pressed", String(button.classList.contains("mod-active")));
}

// one line of what is said, behind the piece of the picture's line that it is about
function sentence(text, mark) {
    const line = document.createElement("div");
    line.innerHTML = mark ?? "";
    line.append(text);
    return line;
}

// JupyterLab and Notebook go from cell to cell by the keys that move a control: not while one has them
function keep(event) {
    if (!event.target.matches?.(".hoverslam-live :is([role=slider], select)")) return;
    event.target.toggleAttribute("data-lm-suppress-shortcuts", KEYS.test(event.key) && !event.ctrlKey && !event.metaKey);
}

// after a movement without an answer the kernel is asked for one; a busy one is waited for
function watch(model, figure, say) {
    let timer = null;
    const gone = () => {
        const kernel = model.widget_manager.kernel;
        if (kernel?.connectionStatus === "connected" && kernel.status === "busy") {
            timer = setTimeout(gone, WAIT);
            return;
        }
        timer = null;
        say(`The kernel is gone: ${document.body.dataset.voila ? "reload this page" : "run this cell again"}.`);
    };
    const ask = () => {
        timer = setTimeout(gone, WAIT);
        model.send("are you there?");
    };
    const moved = event => {
        if (timer === null && figure.contains(event.target)) timer = setTimeout(ask, WAIT);
    };
    const answered = () => {
        clearTimeout(timer);
        timer = null;
        say(model.get("text"));
    };
    model.on("change", answered);
    model.on("msg:custom", answered);
    const events = ["keydown", "pointerdown", "change"];
    for (const event of events) document.addEventListener(event, moved, true);
    return () => {
        clearTimeout(timer);
        for (const event of events) document.removeEventListener(event, moved, true);
    };
}

// the kernel draws in the pixels of the screen, so it has to know how many there are
function measure(model, place) {
    let timer = null, sent = "";
    const tell = () => {
        const { width, height } = place.getBoundingClientRect();
        const room = { width, height, font: parseFloat(getComputedStyle(place).fontSize), ratio: devicePixelRatio };
        if (width < 1 || sent === JSON.stringify(room)) return;
        sent = JSON.stringify(room);
        model.send({ room });
    };
    const soon = () => {
        clearTimeout(timer);
        timer = setTimeout(tell, CALM);
    };
    const observer = new ResizeObserver(soon);
    observer.observe(place);
    addEventListener("resize", soon); // a zoom, too
    return () => {
        clearTimeout(timer);
        observer.disconnect();
        removeEventListener("resize", soon);
    };
}

// a page for a whole window gets the height that is in view under what stands above it, or all of it
function fill(figure) {
    const page = figure.querySelector(".hoverslam-window");
    const view = figure.closest(".jp-WindowedPanel-outer, .lm-BoxPanel-child") ?? document.documentElement;
    if (!page) return () => {};
    put(figure, "role", "region");
    put(figure, "aria-label", "controls, verdict and picture");
    const observer = new ResizeObserver(() => {
        const whole = view.clientHeight;
        const above = page.getBoundingClientRect().top - view.getBoundingClientRect().top + view.scrollTop;
        page.style.setProperty("--hoverslam-room", `${Math.floor(above < whole / 4 ? whole - above : whole) - 16}px`);
    });
    observer.observe(view);
    return () => observer.disconnect();
}

// over the ground, which came once, lie the pixels that differ from it now
function paint(model, canvas) {
    const ink = canvas.getContext("2d");
    let packed = null, ground = null, picture = null, turn = Promise.resolve();
    const draw = async () => {
        if (packed !== model.get("ground")) {
            packed = model.get("ground");
            ground = await unpack(packed);
        }
        const [width, height] = model.get("size");
        const moving = await unpack(model.get("moving"));
        if (packed !== model.get("ground")) return; // another picture is on its way
        if (canvas.width !== width || canvas.height !== height || !picture) {
            [canvas.width, canvas.height] = [width, height];
            picture = ink.createImageData(width, height);
        }
        const pixels = new Uint32Array(picture.data.buffer);
        pixels.set(ground);
        const number = moving.length / 2;
        for (let n = 0, at = 0; n < number; n++) {
            at += moving[n];
            pixels[at] = moving[number + n];
        }
        ink.putImageData(picture, 0, 0);
    };
    return () => { turn = turn.then(draw); };
}

export default {
    render({ model, el }) {
        const [status, place, canvas] = ["div", "div", "canvas"].map(kind => document.createElement(kind));
        el.classList.add("hoverslam-screen");
        status.setAttribute("role", "status");
        canvas.setAttribute("role", "img");
        place.className = "hoverslam-picture";
        place.append(canvas);
        el.append(status, place);
        const say = text => {
            const marks = model.get("marks");
            status.replaceChildren(...text.split("\n").map((line, n) => sentence(line, marks[n])));
            put(canvas, "aria-label", text.replaceAll("\n", " "));
        };
        const draw = paint(model, canvas);
        say(model.get("text"));
        draw();
        model.on("change:ground change:moving", draw);

        let ends = [], frame = null;
        const begin = () => {
            const figure = el.isConnected && el.closest(".hoverslam-live");
            if (!figure) {
                frame = requestAnimationFrame(begin);
                return;
            }
            const observer = new MutationObserver(() => describe(figure));
            const attributeFilter = ["aria-valuetext", "class"];
            observer.observe(figure, { subtree: true, childList: true, characterData: true, attributeFilter });
            describe(figure);
            window.addEventListener("keydown", keep, true); // before JupyterLab sees it; added once, however often
            ends = [() => observer.disconnect(), watch(model, figure, say), fill(figure), measure(model, place)];
        };
        begin();
        return () => {
            cancelAnimationFrame(frame);
            for (const end of ends) end();
        };
    },
};
