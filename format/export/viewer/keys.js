// Keys, what they do, and the page that tells of them.
"use strict";

lyr.keys = (() => {
    const {element} = lyr.panel;

    // [keys, what they do as the help says it, what is called on the page's actions].
    const table = [
        [["ArrowUp", "ArrowDown"], "next, previous layer", (page, key, fast) =>
            page.stepLayer((key === "ArrowUp" ? 1 : -1) * (fast ? 10 : 1))],
        [["PageUp", "PageDown"], "ten layers", (page, key) => page.stepLayer(key === "PageUp" ? 10 : -10)],
        [["Home", "End"], "first, last layer", (page, key) => page.stepLayer(key === "Home" ? -Infinity : Infinity)],
        [["w", "s"], "lower end of the range", (page, key) => page.stepLow(key === "w" ? 1 : -1)],
        [["ArrowLeft", "ArrowRight"], "motion by motion (Shift: 100)", (page, key, fast) =>
            page.stepMotion((key === "ArrowRight" ? 1 : -1) * (fast ? 100 : 1))],
        [[" "], "play or stop", (page) => page.togglePlay()],
        [["[", "]"], "slower, faster", (page, key) => page.stepFactor(key === "]" ? 1 : -1)],
        [["2", "3"], "layer from above, print in space", (page, key) => page.setView(key === "2" ? "plan" : "space")],
        [["v"], "the other view", (page) => page.setView(page.state.view === "plan" ? "space" : "plan")],
        [["c"], "colour: role, speed, flow, layer time", (page) => page.nextMode()],
        [["r"], "one layer or a range", (page) => page.toggleRange()],
        [["t"], "travels and wipes", (page) => page.toggle("travels")],
        [["b"], "the layer below", (page) => page.toggle("below")],
        [["m"], "measure", (page) => page.toggleMeasure()],
        [["+", "-"], "zoom", (page, key) => page.zoomBy(key === "-" ? 1 / 1.3 : 1.3)],
        [["f", "0"], "fit to the window", (page) => page.fit()],
        [["i"], "statistics", (page) => page.togglePanel()],
        [["?", "h"], "this help", (page) => page.toggleHelp()],
        [["Escape"], "end measuring, close", (page) => page.escape()],
    ];
    const names = {
        ArrowUp: "↑", ArrowDown: "↓", ArrowLeft: "←", ArrowRight: "→", " ": "Space", PageUp: "Page ↑",
        PageDown: "Page ↓", Escape: "Esc", Home: "Home", End: "End",
    };

    function listen(page) {
        document.addEventListener("keydown", (event) => {
            if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
            if (event.target.tagName === "BUTTON" && (event.key === " " || event.key === "Enter")) return;
            const key = event.key === "=" ? "+" : event.key.length === 1 ? event.key.toLowerCase() : event.key;
            const entry = table.find(([keys]) => keys.includes(key));
            if (!entry) return;
            event.preventDefault();
            // The lower thumb has the arrows to itself.
            if (event.target.classList.contains("low") && (key === "ArrowUp" || key === "ArrowDown"))
                page.stepLow(key === "ArrowUp" ? 1 : -1);
            else entry[2](page, key, event.shiftKey);
        });
    }

    function fillHelp(dialog) {
        const rows = table.map(([keys, what]) => element("div", {}, element("span", {}, what),
            element("span", {}, ...keys.flatMap((key) => [element("kbd", {}, names[key] ?? key.toUpperCase()), " "]))));
        const close = element("button", {click: () => dialog.close()}, "Close");
        dialog.replaceChildren(
            element("h2", {}, "Keys", close), element("div", {class: "keys"}, ...rows),
            element("p", {}, "Drag to move the layer or to turn the print (Shift or the right button moves it), wheel " +
                "or two fingers to zoom. Point at a strand, or tap it, to see what it is; of an arc, radius and centre."),
        );
    }

    return {listen, fillHelp};
})();
