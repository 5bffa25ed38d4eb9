// Where in a layer the head is. The printer says how far in time it is and where the head stands; the same place may be
// passed many times, and the time of a layer is an estimate, so the two are asked together.
"use strict";

lyr.progress = (() => {
    // How far from the path the head may be told: positions come as whole steps, between two looks at the printer.
    const reach_mm = 0.1;
    // Motions around the expected one that are looked at first.
    const windows = [12, 100, 1000, Infinity];

    class Follower {
        constructor(print) {
            this.print = print;
            this.index = -1; // of the layer
        }

        // The motions that are over, and the share of the next one: {done, share}.
        follow(index, time_s, position_mm) {
            const layer = this.print.layer(index);
            if (!layer) return {done: Infinity, share: 0};
            if (index !== this.index) {
                // A layer that was entered between two looks began after the last; of the first one that is seen, the
                // file's own times tell the begin.
                const guess_s = this.print.schedule.begins_s[index];
                this.begin_s = this.index < 0 || index !== this.index + 1 ? Math.min(guess_s, time_s) : time_s;
                this.index = index;
                this.place = {done: 0, share: 0};
            }
            const {ends_s} = layer.timing, expected = lyr.timing.progress(ends_s, time_s - this.begin_s);
            if (!position_mm) return expected;
            const found = this.nearest(layer, position_mm, expected.done);
            // Parked, or on its way to where the layer begins.
            if (!found) return this.place;
            const before_s = found.i > 0 ? ends_s[found.i - 1] : 0;
            this.begin_s = time_s - (before_s + found.share * (ends_s[found.i] - before_s));
            this.place = {done: found.i, share: found.share};
            return this.place;
        }

        nearest(layer, [x_mm, y_mm], expected) {
            const q = this.print.quantum_mm;
            for (const window of windows) {
                const wanted = (i) => Math.abs(i - expected) <= window;
                const found = lyr.pick.motion(layer.motions, x_mm / q, y_mm / q, reach_mm / q, wanted);
                if (found) return found;
            }
            return null;
        }
    }

    return {Follower};
})();
