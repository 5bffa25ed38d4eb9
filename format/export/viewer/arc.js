// The circle that an arc record stands for. An arc is its ends and its sagitta s, the signed height of its middle over
// the chord c; with t = 2 s / c, radius and centre follow by division alone, and stay exact where a centre is far away.
"use strict";

lyr.arc = (() => {
    const mostSagittaPerChord = 1.25;

    // In the unit of the input. The chord must not be 0 nor the sagitta.
    function shape(x0, y0, x1, y1, sagitta) {
        const dx = x1 - x0, dy = y1 - y0, chord = Math.hypot(dx, dy);
        const t = 2 * sagitta / chord;
        const rise = (1 - t * t) / (4 * t);
        const x = x0 + dx / 2 - dy * rise, y = y0 + dy / 2 + dx * rise;
        return {
            x, y,
            radius: chord * (1 + t * t) / (4 * Math.abs(t)),
            start: Math.atan2(y0 - y, x0 - x),
            sweep: 4 * Math.atan(t),
        };
    }

    function circleShape(x0, y0, x, y, counterClockwise) {
        return {
            x, y,
            radius: Math.hypot(x0 - x, y0 - y),
            start: Math.atan2(y0 - y, x0 - x),
            sweep: counterClockwise ? 2 * Math.PI : -2 * Math.PI,
        };
    }

    function length(x0, y0, x1, y1, sagitta) {
        const chord = Math.hypot(x1 - x0, y1 - y0), t = 2 * sagitta / chord;
        return chord * (1 + t * t) / Math.abs(t) * Math.abs(Math.atan(t));
    }

    // The point at this share of the way.
    function pointAt(arc, share) {
        const angle = arc.start + share * arc.sweep;
        return {x: arc.x + arc.radius * Math.cos(angle), y: arc.y + arc.radius * Math.sin(angle)};
    }

    // Where, as a share of the way, the arc is nearest to a point: 0 to 1.
    function nearestShare(arc, x, y) {
        const turn = 2 * Math.PI;
        let angle = (Math.atan2(y - arc.y, x - arc.x) - arc.start) * Math.sign(arc.sweep);
        angle -= turn * Math.floor(angle / turn);
        const sweep = Math.abs(arc.sweep);
        if (angle <= sweep) return angle / sweep;
        return angle - sweep < turn - angle ? 1 : 0;
    }

    // Calls take(x, y) for the points where the arc is farthest to a side, but for its ends.
    function farthest(arc, take) {
        const quarter = Math.PI / 2, low = Math.min(arc.start, arc.start + arc.sweep);
        for (let k = Math.ceil(low / quarter); k * quarter <= low + Math.abs(arc.sweep); ++k)
            take(arc.x + arc.radius * Math.cos(k * quarter), arc.y + arc.radius * Math.sin(k * quarter));
    }

    return {mostSagittaPerChord, shape, circleShape, length, pointAt, nearestShare, farthest};
})();
