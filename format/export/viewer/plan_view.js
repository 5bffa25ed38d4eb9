// Draws layers from above on a canvas: strands in their true width, arcs as arcs at any zoom. Drawing is a generator
// that stops after each piece of work, so that the page can spread a large layer over several frames, or stop for a
// newer picture.
//
//     const frame = {x_mm, y_mm, scale, width, height};   // middle of the picture, pixels per mm, pixels
//     for (const _ of lyr.planView.strokes(context, frame, layer, options)) ...
//
// The context is a canvas's, or anything with its methods beginPath, moveTo, lineTo, arc, stroke and its properties
// strokeStyle, lineWidth, globalAlpha, lineCap, lineJoin.
"use strict";

lyr.planView = (() => {
    const {kind} = lyr.motions;
    const {css, shaded} = lyr.colors;

    // Shorter than this, in pixels, a piece of a chain of lines is left out.
    const least_px = 0.4;
    // Canvases compute in 32 bits; beyond this they would be wrong by a tenth of a pixel.
    const most_px = 2e5;
    // A strand that is wider shows its edge: the core takes this share of the width.
    const edged_px = 3, core = 0.68;
    const thinnest_px = 0.7;
    // Motions between two stops of the generator.
    const piece = 1500;
    const walls = new Set([1, 2, 3, 4]);

    // Motions of a layer that are drawn alike, in their order: [{color, width_mm, wall, list}].
    function groupsOf(layer, coloring, begin, end) {
        const {motions, index} = layer, groups = new Map();
        const ofStyle = motions.styles.map((style) => {
            if (style.role < 0 || coloring.hidden.has(style.role)) return null;
            const color = coloring.of(style, index), key = color.join() + "/" + style.width_mm + walls.has(style.role);
            if (!groups.has(key))
                groups.set(key, {color, width_mm: style.width_mm, wall: walls.has(style.role), list: []});
            return groups.get(key).list;
        });
        for (let i = begin; i < end; ++i)
            if (motions.extrudes(i)) ofStyle[motions.style[i]]?.push(i);
        return [...groups.values()].filter((group) => group.list.length > 0)
            .sort((p, q) => p.wall - q.wall); // what one looks for lies on top
    }

    // A pen in mm.
    class Pen {
        constructor(context, frame, quantum_mm) {
            this.context = context;
            this.scale = frame.scale;
            this.unit = frame.scale * quantum_mm;
            this.left = frame.width / 2 - frame.x_mm * frame.scale;
            this.top = frame.height / 2 + frame.y_mm * frame.scale;
            this.width = frame.width;
            this.height = frame.height;
            this.lift();
        }

        x(quanta) {
            return this.left + quanta * this.unit;
        }
        y(quanta) {
            return this.top - quanta * this.unit;
        }

        lift() {
            this.atX = NaN;
            this.atY = NaN;
            this.left_out = false;
        }

        moveTo(x, y) {
            this.finishChain();
            if (x !== this.atX || y !== this.atY) this.context.moveTo(x, y);
            this.atX = this.drawnX = x;
            this.atY = this.drawnY = y;
        }

        lineTo(x, y, always = false) {
            this.atX = x;
            this.atY = y;
            this.left_out = !always && Math.abs(x - this.drawnX) < least_px && Math.abs(y - this.drawnY) < least_px;
            if (this.left_out) return;
            this.context.lineTo(x, y);
            this.drawnX = x;
            this.drawnY = y;
        }

        // The end of a chain is where it is, however short its last piece.
        finishChain() {
            if (this.left_out) this.context.lineTo(this.atX, this.atY);
            this.left_out = false;
        }

        motion(motions, i, margin_px) {
            const x0 = this.x(motions.fromX[i]), y0 = this.y(motions.fromY[i]);
            const x1 = this.x(motions.toX[i]), y1 = this.y(motions.toY[i]);
            if (motions.isCurved(i)) this.curve(motions, i, x0, y0, x1, y1, margin_px);
            else if (this.meets(x0, y0, x1, y1, margin_px)) this.line(x0, y0, x1, y1, margin_px);
        }

        meets(x0, y0, x1, y1, margin) {
            return Math.max(x0, x1) >= -margin && Math.min(x0, x1) <= this.width + margin &&
                Math.max(y0, y1) >= -margin && Math.min(y0, y1) <= this.height + margin;
        }

        line(x0, y0, x1, y1, margin) {
            if (Math.max(Math.abs(x0), Math.abs(y0), Math.abs(x1), Math.abs(y1)) > most_px) {
                const cut = clipped(x0, y0, x1, y1, -margin, -margin, this.width + margin, this.height + margin);
                if (!cut) return;
                [x0, y0, x1, y1] = cut;
            }
            this.moveTo(x0, y0);
            this.lineTo(x1, y1);
        }

        curve(motions, i, x0, y0, x1, y1, margin) {
            const arc = motions.shape(i);
            const x = this.x(arc.x), y = this.y(arc.y), radius = arc.radius * this.unit;
            const rise = motions.kind[i] === kind.circle ? radius : Math.abs(motions.a[i]) * this.unit;
            const wide = 2 * rise > Math.hypot(x1 - x0, y1 - y0);
            if (wide ? !this.meets(x - radius, y - radius, x + radius, y + radius, margin)
                : !this.meets(x0, y0, x1, y1, margin + rise)) return;
            if (rise < least_px / 2) return this.line(x0, y0, x1, y1, margin);
            if (radius > most_px) return this.largeArc(motions, i, arc, margin);
            this.moveTo(x0, y0);
            this.context.arc(x, y, radius, -arc.start, -(arc.start + arc.sweep), arc.sweep > 0);
            this.atX = this.drawnX = x1;
            this.atY = this.drawnY = y1;
        }

        // Only the part that is seen, in chords that are within a tenth of a pixel.
        largeArc(motions, i, arc, margin) {
            const radius = arc.radius * this.unit;
            const chords = Math.min(1e6, Math.ceil(Math.abs(arc.sweep) / Math.sqrt(0.8 / radius)));
            const reach = Math.hypot(this.width, this.height) / 2 + margin;
            const middle = {
                x: (this.width / 2 - this.left) / this.unit, y: (this.top - this.height / 2) / this.unit,
            };
            const nearest = lyr.arc.nearestShare(arc, middle.x, middle.y) * chords;
            const half = Math.ceil(2 * reach / radius / Math.abs(arc.sweep) * chords) + 1;
            const first = Math.max(0, Math.floor(nearest - half)), last = Math.min(chords, Math.ceil(nearest + half));
            for (let k = first; k <= last; ++k) {
                const point = k === 0 ? {x: motions.fromX[i], y: motions.fromY[i]}
                    : k === chords ? {x: motions.toX[i], y: motions.toY[i]} : lyr.arc.pointAt(arc, k / chords);
                const x = this.x(point.x), y = this.y(point.y);
                if (k === first) this.moveTo(x, y);
                else this.lineTo(x, y, true);
            }
        }
    }

    // The part of a line in a box, or null.
    function clipped(x0, y0, x1, y1, left, top, right, bottom) {
        let from = 0, to = 1;
        for (const [p, d, low, high] of [[x0, x1 - x0, left, right], [y0, y1 - y0, top, bottom]]) {
            if (d === 0) {
                if (p < low || p > high) return null;
                continue;
            }
            const a = (low - p) / d, b = (high - p) / d;
            from = Math.max(from, Math.min(a, b));
            to = Math.min(to, Math.max(a, b));
        }
        if (from > to) return null;
        const dx = x1 - x0, dy = y1 - y0;
        return [x0 + from * dx, y0 + from * dy, x0 + to * dx, y0 + to * dy];
    }

    // One path of several motions, stroked in each of the ways [[color, width_px], ...].
    function* strokeList(context, pen, motions, list, ways) {
        const margin = Math.max(...ways.map((way) => way[1]));
        for (let begin = 0; begin < list.length; begin += piece) {
            context.beginPath();
            pen.lift();
            const end = Math.min(list.length, begin + piece);
            for (let k = begin; k < end; ++k) pen.motion(motions, list[k], margin);
            pen.finishChain();
            for (const [color, width_px] of ways) {
                context.strokeStyle = color;
                context.lineWidth = width_px;
                context.stroke();
            }
            yield;
        }
    }

    // Extruding motions begin to end (numbers) of a decoded layer.
    // Options: {coloring, quantum_mm, alpha (1), begin (0), end (all)}.
    function* strokes(context, frame, layer, options) {
        const {motions} = layer, pen = new Pen(context, frame, options.quantum_mm);
        const groups = groupsOf(layer, options.coloring, options.begin ?? 0, options.end ?? motions.count);
        context.globalAlpha = options.alpha ?? 1;
        context.lineCap = "round";
        context.lineJoin = "round";
        for (const {color, width_mm, list} of groups) {
            const width_px = Math.max(thinnest_px, width_mm * frame.scale);
            // Edges first, so that strands which belong together are told apart where they touch.
            if (width_px >= edged_px) {
                yield* strokeList(context, pen, motions, list, [[css(shaded(color, -0.28)), width_px]]);
                yield* strokeList(context, pen, motions, list, [[css(color), core * width_px]]);
            } else {
                yield* strokeList(context, pen, motions, list, [[css(color), width_px]]);
            }
        }
        context.globalAlpha = 1;
    }

    // Motions without extrusion, thin. Options: {quantum_mm, travelColor, wipeColor, begin, end}.
    function* ways(context, frame, layer, options) {
        const {motions} = layer, pen = new Pen(context, frame, options.quantum_mm);
        const travels = [], wipes = [];
        for (let i = options.begin ?? 0; i < (options.end ?? motions.count); ++i) {
            if (motions.kind[i] === kind.travel) travels.push(i);
            else if (motions.kind[i] === kind.wipe) wipes.push(i);
        }
        const thin_px = options.thin_px ?? 1;
        yield* strokeList(context, pen, motions, travels, [[options.travelColor, thin_px]]);
        yield* strokeList(context, pen, motions, wipes, [[options.wipeColor, 1.6 * thin_px]]);
    }

    // A part of one motion, from its start: where the print is at.
    function partial(context, frame, layer, i, share, options) {
        const {motions} = layer, pen = new Pen(context, frame, options.quantum_mm);
        const style = motions.styles[motions.style[i]], extrudes = motions.extrudes(i);
        if (extrudes && options.coloring.hidden.has(style.role)) return;
        context.lineCap = "round";
        context.strokeStyle = extrudes ? css(options.coloring.of(style, layer.index)) : options.travelColor;
        context.lineWidth = extrudes ? Math.max(thinnest_px, style.width_mm * frame.scale) : 1;
        context.beginPath();
        const steps = motions.isCurved(i) ? 1 + Math.ceil(64 * share) : 1;
        for (let k = 0; k <= steps; ++k) {
            const point = motions.pointAt(i, share * k / steps);
            if (k === 0) context.moveTo(pen.x(point.x), pen.y(point.y));
            else context.lineTo(pen.x(point.x), pen.y(point.y));
        }
        context.stroke();
    }

    return {strokes, ways, partial};
})();
