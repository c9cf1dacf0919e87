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
        const controls = recorded.controls.map((control, k) => input(control, place => { places[k] = place; show(); }));
        const kept = recorded.kept.length ? [`Kept here: ${recorded.kept.join(", ")}.`] : [];
        kept.push("Here only some places are recorded; the notebook has all.");
        figure.querySelector(".hoverslam-controls").replaceChildren(...controls, make("p", { class: "kept" }, kept.join(" ")));
        still.replaceWith(make("div", { class: "scroll", tabindex: "0", role: "group", "aria-label": "figure" }, picture));
        show();
    }

    function input(control, moved) {
        const text = place => `${control.shown[place]}${control.unit ? ` ${control.unit}` : ""}`;
        const value = make("output", {}, text(control.start));
        const field = control.checkbox
            ? make("input", { type: "checkbox" })
            : make("input", { type: "range", min: 0, max: control.shown.length - 1, step: 1, value: control.start });
        if (control.checkbox) field.checked = Boolean(control.start);
        const tell = () => {
            const place = control.checkbox ? Number(field.checked) : Number(field.value);
            value.textContent = text(place);
            if (!control.checkbox) field.setAttribute("aria-valuetext", text(place));
            moved(place);
        };
        field.addEventListener("input", tell);
        if (!control.checkbox) field.setAttribute("aria-valuetext", text(control.start));
        return make("label", {}, make("span", {}, control.name), field, value);
    }

    // films can be paused
    function pausable(film) {
        const still = document.createElement("canvas");
        const button = make("button", { type: "button", class: "pause" }, "Pause");
        button.addEventListener("click", () => {
            const paused = film.hidden;
            if (!paused) {
                still.width = film.naturalWidth;
                still.height = film.naturalHeight;
                still.style.width = `${film.clientWidth}px`;
                still.getContext("2d").drawImage(film, 0, 0);
            } else {
                film.src = film.src; // plays from its beginning
            }
            film.hidden = !paused;
            still.hidden = paused;
            button.textContent = paused ? "Pause" : "Play again";
        });
        still.hidden = true;
        still.setAttribute("role", "img");
        still.setAttribute("aria-label", film.alt);
        film.after(still, button);
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
        for (const film of document.querySelectorAll("img[src^='data:image/gif'], img[src$='.gif']")) pausable(film);
    });
    // what scrolls is reached by key too; formulas have their width late
    window.addEventListener("load", async () => {
        await window.MathJax?.startup?.promise;
        for (const part of document.querySelectorAll("article .output, article pre, article div, article mjx-container"))
            if (part.scrollWidth > part.clientWidth && getComputedStyle(part).overflowX === "auto") part.tabIndex = 0;
    });
    window.addEventListener("beforeprint", () => {
        for (const folded of document.querySelectorAll("details")) folded.open = true;
    });
})();
