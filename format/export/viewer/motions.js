// The motions of a layer in flat arrays, in the order in which they are done; coordinates in quanta, exact.
//
//   kind    line, arc, circle, travel or wipe
//   from    fromX, fromY, fromZ;  to: toX, toY, toZ
//   a       sagitta of an arc (or of a wipe's piece, 0: it is straight); x of a circle's centre
//   b       y of a circle's centre
//   flags   fromHatch, counterClockwise (circles)
//   style   number of an entry of `styles`
"use strict";

lyr.motions = (() => {
    const kind = {line: 0, arc: 1, circle: 2, travel: 3, wipe: 4};
    const flag = {fromHatch: 1, counterClockwise: 2};

    const roles = [
        "other", "outer wall", "inner wall", "overhang wall", "thin wall", "gap fill", "solid infill",
        "sparse infill", "top skin", "bottom skin", "bridge", "internal bridge", "ironing", "support",
        "support interface", "skirt", "brim", "raft", "prime tower",
    ];

    // Area of an extruded strand.
    function crossSection_mm2(style) {
        const w = style.width_mm, h = style.height_mm;
        return style.flow * (w >= h ? (w - h) * h + Math.PI / 4 * h * h : Math.PI / 4 * w * h);
    }

    function grown(array, capacity) {
        const out = new array.constructor(capacity);
        out.set(array);
        return out;
    }

    class Motions {
        constructor(expected) {
            const capacity = Math.max(64, Math.min(expected, 1 << 20));
            this.count = 0;
            this.kind = new Uint8Array(capacity);
            this.flags = new Uint8Array(capacity);
            this.style = new Uint32Array(capacity);
            for (const name of Motions.coordinates) this[name] = new Int32Array(capacity);
            this.a = new Float64Array(capacity);
            this.b = new Float64Array(capacity);
            this.styles = [];
            this.styleNumbers = new Map();
        }

        // The number of a style that is equal to this one: {role, width_mm, height_mm, flow, speed_mm_s,
        // acceleration_mm_s2}.
        styleNumber(style) {
            const key = Object.values(style).join();
            let number = this.styleNumbers.get(key);
            if (number === undefined) {
                number = this.styles.length;
                this.styleNumbers.set(key, number);
                this.styles.push({...style, area_mm2: crossSection_mm2(style)});
            }
            return number;
        }

        add(kindOf, from, to, style, flags, a, b) {
            const i = this.count;
            if (i === this.kind.length) this.grow(2 * i);
            this.kind[i] = kindOf;
            this.flags[i] = flags;
            this.style[i] = style;
            this.fromX[i] = from.x;
            this.fromY[i] = from.y;
            this.fromZ[i] = from.z;
            this.toX[i] = to.x;
            this.toY[i] = to.y;
            this.toZ[i] = to.z;
            this.a[i] = a;
            this.b[i] = b;
            this.count = i + 1;
        }

        grow(capacity) {
            for (const name of [...Motions.coordinates, "kind", "flags", "style", "a", "b"])
                this[name] = grown(this[name], capacity);
        }

        extrudes(i) {
            return this.kind[i] <= kind.circle;
        }

        isCurved(i) {
            const k = this.kind[i];
            return k === kind.circle || ((k === kind.arc || k === kind.wipe) && this.a[i] !== 0);
        }

        // In quanta; of a curved motion only.
        shape(i) {
            if (this.kind[i] === kind.circle)
                return lyr.arc.circleShape(this.fromX[i], this.fromY[i], this.a[i], this.b[i],
                    (this.flags[i] & flag.counterClockwise) !== 0);
            return lyr.arc.shape(this.fromX[i], this.fromY[i], this.toX[i], this.toY[i], this.a[i]);
        }

        // In quanta, along the slope.
        length(i) {
            let level = 0;
            const x = this.fromX[i], y = this.fromY[i];
            if (this.kind[i] === kind.circle) level = 2 * Math.PI * Math.hypot(x - this.a[i], y - this.b[i]);
            else if (this.isCurved(i)) level = lyr.arc.length(x, y, this.toX[i], this.toY[i], this.a[i]);
            else level = Math.hypot(this.toX[i] - x, this.toY[i] - y);
            const climb = this.toZ[i] - this.fromZ[i];
            return climb === 0 ? level : Math.hypot(level, climb);
        }

        // Where the head is after this share of the motion, in quanta.
        pointAt(i, share) {
            const z = this.fromZ[i] + share * (this.toZ[i] - this.fromZ[i]);
            if (this.isCurved(i)) return {...lyr.arc.pointAt(this.shape(i), share), z};
            return {
                x: this.fromX[i] + share * (this.toX[i] - this.fromX[i]),
                y: this.fromY[i] + share * (this.toY[i] - this.fromY[i]), z,
            };
        }
    }
    Motions.coordinates = ["fromX", "fromY", "fromZ", "toX", "toY", "toZ"];

    return {Motions, kind, flag, roles};
})();
