// What lies on the view from above: the bed's ruling, a scale bar, the head, the motion under the pointer with its
// centre and radius, a measurement. In CSS pixels, the ruling in device pixels.
"use strict";

lyr.planMarks = (() => {
    const {fixed} = lyr.words;

    // 1, 2 or 5 times a power of ten, at least so many pixels apart.
    function roundStep(least_mm) {
        const power = 10 ** Math.floor(Math.log10(least_mm));
        return [1, 2, 5, 10].map((digit) => digit * power).find((step) => step >= least_mm * 0.999);
    }

    function ruling(context, frame, theme, ratio) {
        const step = roundStep(36 * ratio / frame.scale);
        const left = frame.x_mm - frame.width / 2 / frame.scale, right = frame.x_mm + frame.width / 2 / frame.scale;
        const low = frame.y_mm - frame.height / 2 / frame.scale, high = frame.y_mm + frame.height / 2 / frame.scale;
        context.strokeStyle = theme.ruling;
        context.lineWidth = 1;
        context.beginPath();
        for (let k = Math.ceil(left / step); k * step <= right; ++k) {
            const x = Math.round((k * step - left) * frame.scale) + 0.5;
            context.moveTo(x, 0);
            context.lineTo(x, frame.height);
        }
        for (let k = Math.ceil(low / step); k * step <= high; ++k) {
            const y = Math.round((high - k * step) * frame.scale) + 0.5;
            context.moveTo(0, y);
            context.lineTo(frame.width, y);
        }
        context.stroke();
    }

    function scaleBar(context, stage, theme) {
        const step = roundStep(70 / stage.scale), length = step * stage.scale;
        const x = 16, y = stage.canvas.height / stage.ratio - 16;
        context.fillStyle = theme.stage;
        context.globalAlpha = 0.8;
        context.beginPath();
        context.roundRect(x - 8, y - 24, length + 16, 32, 6);
        context.fill();
        context.globalAlpha = 1;
        context.strokeStyle = context.fillStyle = theme.faintText;
        context.lineWidth = 1.5;
        context.beginPath();
        context.moveTo(x, y - 5);
        context.lineTo(x, y);
        context.lineTo(x + length, y);
        context.lineTo(x + length, y - 5);
        context.stroke();
        context.font = theme.font;
        context.textAlign = "left";
        context.textBaseline = "alphabetic";
        context.fillText(step >= 0.1 ? `${+step.toFixed(1)} mm` : `${+(step * 1000).toFixed(3)} µm`, x + 6, y - 6);
    }

    function head(context, at, theme) {
        context.beginPath();
        context.arc(at.x, at.y, 6, 0, 2 * Math.PI);
        context.fillStyle = theme.accent;
        context.fill();
        context.lineWidth = 2.5;
        context.strokeStyle = theme.stage;
        context.stroke();
    }

    // A motion's own line, thin, over its strand.
    function trace(context, stage, layer, i) {
        const {motions} = layer, q = stage.print.quantum_mm;
        const from = stage.toScreen(motions.fromX[i] * q, motions.fromY[i] * q);
        context.beginPath();
        if (motions.isCurved(i)) {
            const arc = motions.shape(i), radius = arc.radius * q * stage.scale;
            if (radius < 1e5) {
                const center = stage.toScreen(arc.x * q, arc.y * q);
                context.arc(center.x, center.y, radius, -arc.start, -(arc.start + arc.sweep), arc.sweep > 0);
                return;
            }
        }
        const to = stage.toScreen(motions.toX[i] * q, motions.toY[i] * q);
        context.moveTo(from.x, from.y);
        context.lineTo(to.x, to.y);
    }

    function under(context, stage, theme) {
        if (!stage.under) return;
        const {layer, i} = stage.under, {motions} = layer, q = stage.print.quantum_mm;
        context.lineCap = "round";
        for (const [color, width] of [[theme.stage, 6], [theme.text, 2.5]]) {
            context.strokeStyle = color;
            context.lineWidth = width;
            trace(context, stage, layer, i);
            context.stroke();
        }
        if (!motions.isCurved(i)) return;
        const arc = motions.shape(i), center = stage.toScreen(arc.x * q, arc.y * q);
        const at = stage.toScreen(stage.under.x * q, stage.under.y * q);
        context.setLineDash([5, 4]);
        line(context, center, at, theme.accent, 1.5);
        context.setLineDash([]);
        cross(context, center, theme.accent);
        const middle = {x: (center.x + at.x) / 2, y: (center.y + at.y) / 2};
        label(context, `R ${fixed(arc.radius * q, 3)}`, middle, theme);
    }

    function line(context, from, to, color, width) {
        context.beginPath();
        context.moveTo(from.x, from.y);
        context.lineTo(to.x, to.y);
        context.strokeStyle = color;
        context.lineWidth = width;
        context.stroke();
    }

    function cross(context, at, color) {
        line(context, {x: at.x - 5, y: at.y}, {x: at.x + 5, y: at.y}, color, 1.5);
        line(context, {x: at.x, y: at.y - 5}, {x: at.x, y: at.y + 5}, color, 1.5);
    }

    function label(context, text, at, theme) {
        context.font = theme.strongFont;
        context.textAlign = "center";
        context.textBaseline = "middle";
        const width = context.measureText(text).width + 12;
        context.fillStyle = theme.card;
        context.beginPath();
        context.roundRect(at.x - width / 2, at.y - 10, width, 20, 5);
        context.fill();
        context.fillStyle = theme.text;
        context.fillText(text, at.x, at.y + 0.5);
    }

    // What kind of point it is shows in its mark: a square at an end, a ring at a centre, a dot on a path.
    function point(context, stage, snap, theme) {
        const q = stage.print.quantum_mm, at = stage.toScreen(snap.x * q, snap.y * q);
        context.strokeStyle = theme.accent;
        context.fillStyle = theme.stage;
        context.lineWidth = 2;
        context.beginPath();
        if (snap.what === "end") context.rect(at.x - 5, at.y - 5, 10, 10);
        else context.arc(at.x, at.y, snap.what === "centre" ? 6 : 4, 0, 2 * Math.PI);
        context.fill();
        context.stroke();
        if (snap.what === "centre") cross(context, at, theme.accent);
        return at;
    }

    function measurement(context, stage, theme) {
        const {measure} = stage;
        if (!measure.on) return;
        const points = [...measure.points];
        if (points.length < 2 && measure.snap) points.push(measure.snap);
        const places = points.map((snap) => {
            const q = stage.print.quantum_mm;
            return stage.toScreen(snap.x * q, snap.y * q);
        });
        if (places.length === 2) line(context, places[0], places[1], theme.accent, 2);
        points.forEach((snap) => point(context, stage, snap, theme));
        if (places.length < 2) return;
        const text = `${fixed(distance(points, stage.print.quantum_mm).length_mm, 3)} mm`;
        label(context, text, {x: (places[0].x + places[1].x) / 2, y: (places[0].y + places[1].y) / 2}, theme);
    }

    function distance([from, to], quantum_mm) {
        const dx_mm = (to.x - from.x) * quantum_mm, dy_mm = (to.y - from.y) * quantum_mm;
        return {dx_mm, dy_mm, length_mm: Math.hypot(dx_mm, dy_mm)};
    }

    return {ruling, scaleBar, head, under, measurement, distance};
})();
