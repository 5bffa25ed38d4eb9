// What is under the pointer: the nearest motion of a layer, and the points of it that one measures from.
"use strict";

lyr.pick = (() => {
    // The nearest point of a motion to (x, y), in quanta: {x, y, away, share}.
    function nearestOn(motions, i, x, y) {
        let share = 0;
        if (motions.isCurved(i)) {
            share = lyr.arc.nearestShare(motions.shape(i), x, y);
        } else {
            const x0 = motions.fromX[i], y0 = motions.fromY[i];
            const dx = motions.toX[i] - x0, dy = motions.toY[i] - y0, square = dx * dx + dy * dy;
            if (square > 0) share = Math.min(1, Math.max(0, ((x - x0) * dx + (y - y0) * dy) / square));
        }
        const at = motions.pointAt(i, share);
        return {x: at.x, y: at.y, away: Math.hypot(at.x - x, at.y - y), share};
    }

    // Is a motion's box within reach of a point? Boxes of arcs are a little too large.
    function near(motions, i, x, y, reach) {
        let more = reach;
        if (motions.isCurved(i)) {
            const arc = motions.shape(i);
            if (Math.abs(arc.sweep) > Math.PI)
                return Math.abs(Math.hypot(x - arc.x, y - arc.y) - arc.radius) <= reach;
            more += Math.abs(motions.a[i]);
        }
        return Math.min(motions.fromX[i], motions.toX[i]) - more <= x &&
            Math.max(motions.fromX[i], motions.toX[i]) + more >= x &&
            Math.min(motions.fromY[i], motions.toY[i]) - more <= y &&
            Math.max(motions.fromY[i], motions.toY[i]) + more >= y;
    }

    // The motion nearest to a point within reach, of those that `wanted` (a number) says yes to: {i, x, y, away, share},
    // or null.
    function motion(motions, x, y, reach, wanted) {
        let best = null;
        for (let i = 0; i < motions.count; ++i) {
            if (!wanted(i) || !near(motions, i, x, y, best ? best.away : reach)) continue;
            const found = nearestOn(motions, i, x, y);
            if (found.away <= (best ? best.away : reach)) best = {i, ...found};
        }
        return best;
    }

    // Where a measurement begins or ends: an end or a centre within reach, else a point of a path, else the place
    // itself. {x, y, what: "end", "centre", "path" or "free", i}.
    function snap(motions, x, y, reach, wanted) {
        let best = null;
        const offer = (px, py, what, i) => {
            const away = Math.hypot(px - x, py - y);
            if (away <= reach && (!best || away < best.away)) best = {x: px, y: py, what, i, away};
        };
        for (let i = 0; i < motions.count; ++i) {
            if (!wanted(i)) continue;
            offer(motions.fromX[i], motions.fromY[i], "end", i);
            offer(motions.toX[i], motions.toY[i], "end", i);
            if (motions.isCurved(i)) {
                const arc = motions.shape(i);
                offer(arc.x, arc.y, "centre", i);
            }
        }
        if (best) return best;
        const on = motion(motions, x, y, reach, wanted);
        return on ? {...on, what: "path"} : {x, y, what: "free", i: -1};
    }

    return {motion, snap};
})();
