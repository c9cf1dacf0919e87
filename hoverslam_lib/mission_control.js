// A button for each method, with a piece of its line.
export default {
    render({ model, el }) {
        el.classList.add("hoverslam-methods");
        el.setAttribute("role", "group");
        el.setAttribute("aria-label", "methods");
        const buttons = {};
        const toggle = key => {
            const chosen = new Set(model.get("value"));
            if (!chosen.delete(key)) chosen.add(key);
            model.set("value", model.get("looks").map(look => look.key).filter(known => chosen.has(known)));
            model.save_changes();
        };
        for (const { key, title, mark } of model.get("looks")) {
            const button = buttons[key] = document.createElement("button");
            button.innerHTML = mark;
            button.append(title);
            button.addEventListener("click", () => toggle(key));
            el.append(button);
        }
        const show = () => {
            for (const [key, button] of Object.entries(buttons))
                button.setAttribute("aria-pressed", model.get("value").includes(key));
        };
        show();
        model.on("change:value", show);
    },
};
