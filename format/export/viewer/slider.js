// A slider with two thumbs for a range of layers, upright or lying, for mouse, finger and keyboard.
"use strict";

lyr.slider = (() => {
    class RangeSlider {
        // `root` is an element with .track, .span and two .thumb in it; change(low, high, which) is called for what the
        // user does. With `single`, there is one thumb and low = high.
        constructor(root, count, change) {
            this.root = root;
            this.count = count;
            this.change = change;
            this.low = 0;
            this.high = count - 1;
            this.single = false;
            [this.lowThumb, this.highThumb] = root.querySelectorAll(".thumb");
            this.span = root.querySelector(".span");
            this.listen();
        }

        lies() {
            return this.root.clientWidth > this.root.clientHeight;
        }

        set(low, high, single) {
            Object.assign(this, {low, high, single});
            const share = (layer) => this.count > 1 ? layer / (this.count - 1) : 1;
            const from = single ? 0 : share(low), to = share(high);
            this.root.style.setProperty("--from", from);
            this.root.style.setProperty("--to", to);
            this.lowThumb.hidden = single;
            this.describe(this.lowThumb, low, 0, high);
            this.describe(this.highThumb, high, single ? 0 : low, this.count - 1);
        }

        describe(thumb, value, least, most) {
            thumb.setAttribute("aria-valuemin", least + 1);
            thumb.setAttribute("aria-valuemax", most + 1);
            thumb.setAttribute("aria-valuenow", value + 1);
        }

        layerAt(event) {
            const box = this.root.querySelector(".track").getBoundingClientRect();
            const share = this.lies() ? (event.clientX - box.left) / box.width
                : (box.bottom - event.clientY) / box.height;
            return Math.round(Math.min(1, Math.max(0, share)) * (this.count - 1));
        }

        listen() {
            let held = null;
            this.root.addEventListener("pointerdown", (event) => {
                const layer = this.layerAt(event);
                held = event.target === this.lowThumb ? "low" : event.target === this.highThumb ? "high"
                    : !this.single && Math.abs(layer - this.low) < Math.abs(layer - this.high) ? "low" : "high";
                this.root.setPointerCapture(event.pointerId);
                this.move(held, layer);
                event.preventDefault();
            });
            this.root.addEventListener("pointermove", (event) => {
                if (held) this.move(held, this.layerAt(event));
            });
            for (const type of ["pointerup", "pointercancel"])
                this.root.addEventListener(type, () => {
                    held = null;
                });
            this.root.addEventListener("wheel", (event) => {
                event.preventDefault();
                this.move("high", this.high - Math.sign(event.deltaY));
            }, {passive: false});
        }

        move(which, layer) {
            const within = (value, low, high) => Math.min(high, Math.max(low, value));
            if (which === "low") this.change(within(layer, 0, this.high), this.high, which);
            else this.change(this.low, within(layer, this.single ? 0 : this.low, this.count - 1), which);
        }
    }

    return {RangeSlider};
})();
