// Figures that move without a kernel: each position of their controls was recorded as a layer over one ground.
window.hoverslam = { recordings: {} };

(() => {
    const png = data => `data:image/png;base64,${data}`;
    const make = (tag, attributes, ...children) => {
        const element = document.createElement(tag);
        for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
        element.append(...children);
        return element;
    };

    // a script, because a page that is opened from a folder may not fetch
    function load(figure) {
        const name = figure.dataset.recording;
        const here = document.querySelector("script[src*='recorded.js']").src;
        const script = make("script", { src: new URL(`../recordings/${name}.js`, here).href });
        script.onload = () => start(figure, window.hoverslam.recordings[name]);
        document.head.append(script);
    }

    function start(figure, recorded) {
        const still = figure.querySelector("img");
        const status = figure.querySelector("[role=status]");
        const ground = make("img", { src: png(recorded.ground), alt: "" });
        const layer = make("img", { alt: "" });
        const picture = make("div", { class: "picture" }, ground, layer); // it sizes both, so that they never part
        picture.style.width = `min(${recorded.width}px, max(100%, ${still.style.minWidth}))`;
        picture.style.aspectRatio = `${recorded.width} / ${recorded.height}`;
        // room for the longest sentence, so that the picture stays where it is
        const longest = recorded.sentences.reduce((one, other) => (other.length > one.length ? other : one));
        const room = make("div", { class: "room" }, make("p", { "aria-hidden": "true" }, longest));
        status.replaceWith(room);
        room.append(status);
        const places = recorded.controls.map(control => control.start);
        const show = () => {
            const n = places.reduce((sum, place, k) => sum * recorded.controls[k].shown.length + place, 0);
            layer.src = png(recorded.layers[n]);
            layer.alt = status.textContent = recorded.sentences[n];
        };
        const controls = recorded.controls.map((control, k) =>
            row(`${figure.dataset.recording}-${k}`, control, place => {
                const before = layer.src;
                places[k] = place;
                show();
                if (layer.src !== before) reveal(scroll, before, layer.src);
            }));
        const landmarks = recorded.landmarks.map(landmark => {
            const button = make("button", { type: "button" }, landmark.name);
            button.addEventListener("click", () => landmark.places.forEach((place, k) => controls[k].put(place)));
            return button;
        });
        const parts = controls.map(control => control.element);
        if (landmarks.length) parts.push(make("div", { class: "landmarks" }, ...landmarks));
        const kept = recorded.kept.length ? [`Kept here: ${recorded.kept.join(", ")}.`] : [];
        kept.push("Here only some places are recorded; the notebook has all, and every control that is named and not here.");
        figure.querySelector(".hoverslam-controls").replaceChildren(...parts);

        const scroll = make("div", { class: "scroll", tabindex: "0", role: "group", "aria-label": "figure" }, picture);
        const hint = make("p", { class: "hint" }, "← The picture is wider than the page: swipe it for the rest. →");
        still.replaceWith(scroll, hint, make("p", { class: "kept" }, kept.join(" ")));
        new ResizeObserver(() => { hint.hidden = scroll.scrollWidth <= scroll.clientWidth; }).observe(scroll);
        show();
    }

    // where a picture is wider than the page, its part that has just changed comes into view
    async function reveal(scroll, ...layers) {
        const room = scroll.clientWidth;
        if (scroll.scrollWidth <= room) return;
        const [before, now] = await Promise.all(layers.map(pixels));
        const changed = [];
        for (let n = 3; n < now.data.length; n += 4)
            if ([0, 1, 2, 3].some(k => Math.abs(before.data[n - k] - now.data[n - k]) > 64)) changed.push(((n >> 2) % now.width) / now.width);
        if (!changed.length) return;
        changed.sort((one, other) => one - other);
        // a few pixels far off have only got another of the layer's few colours
        const [left, right] = [0.05, 0.95].map(share => changed[Math.round(share * (changed.length - 1))] * scroll.scrollWidth);
        if (right - left > room) return;
        if (left < scroll.scrollLeft || right > scroll.scrollLeft + room) scroll.scrollLeft = (left + right - room) / 2;
    }

    async function pixels(source) {
        const image = make("img", { src: source });
        await image.decode();
        const canvas = make("canvas", { width: image.naturalWidth, height: image.naturalHeight });
        const drawing = canvas.getContext("2d");
        drawing.drawImage(image, 0, 0);
        return drawing.getImageData(0, 0, canvas.width, canvas.height);
    }

    // a control's name, its field and its value; for fingers a button beside each end, because a place may be narrow
    function row(id, control, moved) {
        const text = place => `${control.shown[place]}${control.unit ? ` ${control.unit}` : ""}`;
        const last = control.shown.length - 1;
        const value = make("output", { for: id }, text(control.start));
        const field = control.checkbox
            ? make("input", { id, type: "checkbox" })
            : make("input", { id, type: "range", min: 0, max: last, step: 1 });
        const now = () => (control.checkbox ? Number(field.checked) : Number(field.value));
        const put = place => {
            if (control.checkbox) field.checked = Boolean(place);
            else field.value = place;
            tell();
        };
        const step = (sign, by, where) => {
            const button = make("button", { type: "button", "aria-label": `${control.name}: one place ${where}` }, sign);
            button.addEventListener("click", () => put(now() + by));
            return button;
        };
        const down = step("−", -1, "down");
        const up = step("+", 1, "up");
        const mark = () => {
            value.textContent = text(now());
            if (!control.checkbox) field.setAttribute("aria-valuetext", text(now()));
            down.disabled = now() === 0;
            up.disabled = now() === last;
        };
        const tell = () => { mark(); moved(now()); };
        field.addEventListener("input", tell);
        // a thumb that scrolls past has moved nothing
        let before = control.start;
        field.addEventListener("pointerdown", () => { before = now(); });
        field.addEventListener("pointercancel", () => put(before));
        if (control.checkbox) field.checked = Boolean(control.start);
        else field.value = control.start;
        mark();
        const beside = control.checkbox ? [field] : [down, field, up];
        const element = make("div", { class: "control" }, make("label", { for: id }, control.name), ...beside, value);
        return { element, put };
    }

    // the page has of each film the last picture, on which it stands still after it has played
    function stoppable(film) {
        const still = film.nextElementSibling;
        const show = moving => { film.hidden = !moving; still.hidden = moving; };
        const button = (text, act) => {
            const made = make("button", { type: "button" }, text);
            made.addEventListener("click", act);
            return made;
        };
        const again = button("Play again", () => {
            // a browser that has played a film plays it again only from an address that is new to it
            const mark = film.src.startsWith("data:") ? "#" : "?";
            film.src = film.src.replace(/[#?]\d+$/, "") + mark + Date.now();
            show(true);
        });
        still.after(make("div", { class: "film" }, button("Stop", () => show(false)), again));
        show(!matchMedia("(prefers-reduced-motion: reduce)").matches);
    }

    document.addEventListener("DOMContentLoaded", () => {
        // the theme listens to the first button of each kind only, which a narrow page hides
        for (const kind of ["primary", "secondary"]) {
            const [first, ...others] = document.querySelectorAll(`button.${kind}-toggle`);
            for (const button of others) button.addEventListener("click", () => first.click());
        }
        const near = new IntersectionObserver(entries => {
            for (const { isIntersecting, target } of entries) {
                if (!isIntersecting) continue;
                near.unobserve(target);
                load(target);
            }
        }, { rootMargin: "800px" });
        for (const figure of document.querySelectorAll("[data-recording]")) near.observe(figure);
        for (const still of document.querySelectorAll("img.still")) stoppable(still.previousElementSibling);
    });
    // on a phone the page's contents cover what an entry leads to
    document.addEventListener("click", event => {
        const link = event.target.closest("dialog a");
        if (!link) return;
        const dialog = link.closest("dialog");
        // when it closes, the theme puts its entries back above the text, which moves
        const there = () => document.getElementById(decodeURIComponent(link.hash.slice(1)))?.scrollIntoView();
        dialog.addEventListener("close", there, { once: true });
        dialog.close();
    });
    // what scrolls is reached by key too; formulas have their width late
    window.addEventListener("load", async () => {
        await window.MathJax?.startup?.promise;
        for (const part of document.querySelectorAll("article .output, article pre, article div, article mjx-container"))
            if (part.scrollWidth > part.clientWidth && getComputedStyle(part).overflowX === "auto") part.tabIndex = 0;
    });
    // printed are what is folded, too, and dark letters on white
    const page = document.documentElement.dataset;
    let theme;
    window.addEventListener("beforeprint", () => {
        for (const folded of document.querySelectorAll("details")) folded.open = true;
        theme = page.theme;
        page.theme = "light";
    });
    window.addEventListener("afterprint", () => { page.theme = theme; });
})();
