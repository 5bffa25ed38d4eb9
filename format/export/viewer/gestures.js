// What fingers, mouse and wheel do on a stage, as: pan(dx, dy, second) with `second` for the other button or Shift;
// zoom(factor, x, y) about a point; tap(x, y); hover(x, y); leave(). Pixels from the stage's corner.
"use strict";

lyr.gestures = (() => {
    const tap_px = 6, tap_ms = 400;

    function listen(element, use) {
        const pointers = new Map();
        let begun = null; // of what may become a tap

        const place = (event) => {
            const box = element.getBoundingClientRect();
            return {x: event.clientX - box.left, y: event.clientY - box.top};
        };
        const spread = () => {
            const [a, b] = pointers.values();
            return {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.max(1, Math.hypot(a.x - b.x, a.y - b.y))};
        };

        element.addEventListener("pointerdown", (event) => {
            try {
                element.setPointerCapture(event.pointerId);
            } catch {
                // The pointer is gone already.
            }
            pointers.set(event.pointerId, place(event));
            begun = pointers.size === 1 ? {...place(event), at_ms: event.timeStamp} : null;
            element.focus({preventScroll: true});
        });
        element.addEventListener("pointermove", (event) => {
            const at = place(event), before = pointers.get(event.pointerId);
            if (!before) return event.pointerType === "mouse" && use.hover(at.x, at.y);
            if (begun && Math.hypot(at.x - begun.x, at.y - begun.y) > tap_px) begun = null;
            if (pointers.size === 2) {
                const old = spread();
                pointers.set(event.pointerId, at);
                const now = spread();
                use.pan(now.x - old.x, now.y - old.y, true);
                use.zoom(now.apart / old.apart, now.x, now.y);
                return;
            }
            pointers.set(event.pointerId, at);
            if (begun || pointers.size > 2) return;
            use.pan(at.x - before.x, at.y - before.y, event.shiftKey || (event.buttons & 6) !== 0);
        });
        const end = (event) => {
            if (!pointers.delete(event.pointerId)) return;
            if (event.type === "pointerup" && begun && event.timeStamp - begun.at_ms < tap_ms) use.tap(begun.x, begun.y);
            begun = null;
        };
        element.addEventListener("pointerup", end);
        element.addEventListener("pointercancel", end);
        // A finger leaves whenever it is lifted; what it tapped stays.
        element.addEventListener("pointerleave", (event) => event.pointerType === "mouse" && use.leave());
        element.addEventListener("contextmenu", (event) => event.preventDefault());
        element.addEventListener("wheel", (event) => {
            event.preventDefault();
            const lines = event.deltaMode === 1 ? 16 : 1, {x, y} = place(event);
            use.zoom(Math.exp(-event.deltaY * lines * (event.ctrlKey ? 0.01 : 0.0015)), x, y);
        }, {passive: false});
    }

    return {listen};
})();
