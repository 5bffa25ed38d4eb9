// Packed runs: lines and arcs stored as differences from what the motions before let expect. The expectations are
// worked out in doubles, each operation rounded by itself, in the order of docs/lyr-format.md: JavaScript's numbers do
// just that.
"use strict";

lyr.packed = (() => {
    const longestHistory = 1024, mostZeros = 40;
    const nearestLimit = 2 ** 40, magic = 1.5 * 2 ** 52;

    // The nearest whole number, the even one of two; 0 where it would be too large, or is none.
    function nearest(value) {
        return value > -nearestLimit && value < nearestLimit ? value + magic - magic : 0;
    }

    // Takes numbers from a cursor's bytes, bit by bit from each byte's low end.
    class Bits {
        constructor(cursor) {
            this.cursor = cursor;
            this.byte = 0;
            this.left = 0;
        }

        bit() {
            if (this.left === 0) {
                this.byte = this.cursor.byte();
                this.left = 8;
            }
            const bit = this.byte & 1;
            this.byte >>= 1;
            --this.left;
            return bit;
        }

        // A signed number of an order.
        signed(order) {
            let zeros = 0;
            while (this.bit() === 0)
                if (++zeros > mostZeros || this.cursor.bad) return this.cursor.fail();
            let value = 0;
            for (let i = 0, weight = 1; i < zeros + order; ++i, weight *= 2) value += weight * this.bit();
            value += 2 ** order * (2 ** zeros - 1);
            return value % 2 === 0 ? value / 2 : -(value + 1) / 2;
        }

        // What is left of the last byte must be 0. False: it is not.
        end() {
            return this.byte === 0;
        }
    }

    // The lines and arcs of a layer that do not climb, the last of them: {x0, y0, x1, y1, sagitta}.
    class History {
        constructor() {
            this.count = 0;
            this.list = new Array(longestHistory);
        }

        add(from, to, sagitta) {
            this.list[this.count++ % longestHistory] = {x0: from.x, y0: from.y, x1: to.x, y1: to.y, sagitta};
        }

        // 1: the last one. None: it does not reach so far.
        before(back) {
            return back > this.count || back > longestHistory ? null : this.list[(this.count - back) % longestHistory];
        }
    }

    // The sagitta that goes on smoothly from a motion (or null) along the chord from (x0, y0) by (x, y).
    function smoothSagitta(last, at, x, y) {
        if (!last || last.x1 !== at.x || last.y1 !== at.y) return 0;
        const x0 = last.x1 - last.x0, y0 = last.y1 - last.y0;
        const c0 = Math.sqrt(x0 * x0 + y0 * y0), c = Math.sqrt(x * x + y * y);
        const along = x0 * x + y0 * y, across = x0 * y - y0 * x;
        const turn = c0 * c + along, rise = 2 * last.sagitta;
        const e = c * (across * c0 - rise * turn) / (2 * (c0 * turn + across * rise));
        return 4 * e > c || -4 * e > c ? 0 : nearest(e);
    }

    // A motion's directions at its ends, both as long as `size`.
    function directions(motion) {
        const x = motion.x1 - motion.x0, y = motion.y1 - motion.y0, s = motion.sagitta;
        const square = x * x + y * y, rise = 4 * s * s;
        const across = 4 * s * Math.sqrt(square), along = square - rise, sum = square + rise;
        return {
            start: {x: x * along + y * across, y: y * along - x * across},
            end: {x: x * along - y * across, y: y * along + x * across},
            size: Math.sqrt(square) * sum, curvature: 8 * s / sum,
        };
    }

    // Where the parallel of `old` ends, d quanta to its left, before `next`: {x, y, sagitta}.
    function parallel(old, next, d) {
        const {end: e, size: a, curvature} = directions(old);
        let n = e, b = a;
        if (next.x0 === old.x1 && next.y0 === old.y1) ({start: n, size: b} = directions(next));
        let cosine = e.x * n.x + e.y * n.y, one = a * b;
        if (cosine < -0.5 * one) {
            n = e;
            b = a;
            one = a * a;
            cosine = one;
        }
        const reach = d / (one + cosine);
        return {
            x: nearest(old.x1 - reach * (e.y * b + n.y * a)), y: nearest(old.y1 + reach * (e.x * b + n.x * a)),
            sagitta: nearest(old.sagitta * (1 - d * curvature)),
        };
    }

    // Where `old` ends if it begins at a point: {x, y, sagitta}.
    function repeated(old, at) {
        return {x: at.x + old.x1 - old.x0, y: at.y + old.y1 - old.y0, sagitta: old.sagitta};
    }

    return {Bits, History, smoothSagitta, parallel, repeated};
})();
