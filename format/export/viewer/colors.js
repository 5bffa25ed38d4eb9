// Which colour a motion has: by role, speed, flow or the time of its layer. The two views ask for the colour of a style
// in a layer; the legend asks for what there is to tell.
"use strict";

lyr.colors = (() => {
    const byRole = [
        "#8a8f94", "#e2641f", "#f2b134", "#8e44ad", "#c08552", "#9aa0a6", "#4f8fc4", "#6dbfb8", "#d64f6a",
        "#7b6cc0", "#2e9e6b", "#66b88f", "#ef9fb0", "#9bb84a", "#62892b", "#7f8c8d", "#b8a68c", "#8d7b68", "#5d7380",
    ];
    // From low to high, each step as far from the next to the eye, told apart by the colour-blind as well.
    const scale = [
        [59, 60, 142], [48, 103, 160], [38, 140, 152], [58, 173, 122], [142, 196, 77], [231, 200, 58], [240, 150, 56],
        [217, 87, 62],
    ];

    // A share of 0 to 1 as [r, g, b].
    function onScale(share) {
        const at = Math.min(1, Math.max(0, share)) * (scale.length - 1);
        const low = Math.min(scale.length - 2, Math.floor(at)), part = at - low;
        return scale[low].map((value, i) => Math.round(value + part * (scale[low + 1][i] - value)));
    }

    function css([r, g, b]) {
        return `rgb(${r} ${g} ${b})`;
    }

    function rgb(hex) {
        return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
    }

    // Towards black (share < 0) or white.
    function shaded(color, share) {
        const goal = share < 0 ? 0 : 255;
        return color.map((value) => Math.round(value + Math.abs(share) * (goal - value)));
    }

    const modes = {
        role: {name: "Role"},
        speed: {name: "Speed", unit: "mm/s", of: (style) => style.speed_mm_s},
        flow: {name: "Flow", unit: "mm³/s", of: (style) => style.area_mm2 * style.speed_mm_s},
        time: {name: "Layer time", unit: "s"},
    };

    // What lies between the smallest and the largest value of a print so far.
    class Range {
        constructor() {
            this.low = Infinity;
            this.high = -Infinity;
        }

        take(value) {
            this.low = Math.min(this.low, value);
            this.high = Math.max(this.high, value);
        }

        share(value) {
            return this.high > this.low ? (value - this.low) / (this.high - this.low) : 0.5;
        }
    }

    class Coloring {
        constructor(schedule) {
            this.mode = "role";
            this.schedule = schedule;
            this.ranges = {speed: new Range(), flow: new Range(), time: new Range()};
            this.hidden = new Set(); // roles
        }

        // The styles of a layer that was decoded.
        take(motions, duration_s) {
            this.ranges.time.take(duration_s);
            for (const style of motions.styles) {
                if (style.role < 0) continue;
                for (const mode of ["speed", "flow"]) this.ranges[mode].take(modes[mode].of(style));
            }
        }

        // [r, g, b] of an extruding style.
        of(style, layer) {
            if (this.mode === "role") return rgb(byRole[style.role]);
            const value = this.mode === "time" ? this.schedule.durations_s[layer] : modes[this.mode].of(style);
            return onScale(this.ranges[this.mode].share(value));
        }
    }

    return {Coloring, modes, byRole, onScale, css, rgb, shaded};
})();
