// Temperatures over time, measured as lines and targets dashed.
"use strict";

lyr.chart = (() => {
    const names = ["tool", "bed", "chamber"];
    const colors = ["#e2641f", "#2b8fd0", "#2e9e6b"];
    const room_c = 20;
    const most = 3600; // samples, as many as lyrrun keeps

    class Temperatures {
        constructor() {
            this.samples = []; // [s, measured, target, measured, target, ...]
            this.next = 0;
        }

        take({next, samples}) {
            // Fewer than there were: another print.
            if (next < this.next) this.samples = [];
            this.next = next;
            this.samples.push(...samples);
            if (this.samples.length > most) this.samples.splice(0, this.samples.length - most);
        }
    }

    function line(context, samples, column, x, y) {
        context.beginPath();
        let pen = false;
        for (const sample of samples) {
            const value = sample[column];
            if (value === null || column % 2 === 0 && value === 0) {
                pen = false;
                continue;
            }
            context[pen ? "lineTo" : "moveTo"](x(sample[0]), y(value));
            pen = true;
        }
        context.stroke();
    }

    function draw(canvas, {samples}, theme, ratio) {
        const width = canvas.clientWidth, height = canvas.clientHeight, left = 30, foot = 16;
        canvas.width = Math.round(width * ratio);
        canvas.height = Math.round(height * ratio);
        const context = canvas.getContext("2d");
        context.setTransform(ratio, 0, 0, ratio, 0, 0);
        if (samples.length === 0) return;
        const values = samples.flatMap((sample) => sample.slice(1)).filter((value) => value !== null);
        const high = Math.ceil((Math.max(room_c + 20, ...highest(values)) + 5) / 20) * 20;
        const begin_s = samples[0][0], end_s = Math.max(begin_s + 60, samples[samples.length - 1][0]);
        const x = (s) => left + (s - begin_s) / (end_s - begin_s) * (width - left - 4);
        const y = (c) => height - foot - c / high * (height - foot - 6);
        context.font = theme.font;
        context.fillStyle = theme.faintText;
        context.strokeStyle = theme.ruling;
        const step = high > 200 ? 100 : high > 80 ? 50 : 20;
        context.textAlign = "right";
        for (let c = 0; c <= high; c += step) {
            context.fillText(c, left - 6, y(c) + 4);
            context.beginPath();
            context.moveTo(left, y(c));
            context.lineTo(width, y(c));
            context.stroke();
        }
        context.fillText(lyr.words.time(end_s), width - 2, height - 2);
        names.forEach((_, i) => {
            context.strokeStyle = colors[i];
            context.lineWidth = 1;
            context.setLineDash([3, 3]);
            line(context, samples, 2 + 2 * i, x, y);
            context.setLineDash([]);
            context.lineWidth = 1.6;
            line(context, samples, 1 + 2 * i, x, y);
        });
    }

    // Without a call of a thousand arguments.
    function highest(values) {
        return [values.reduce((high, value) => Math.max(high, value), -Infinity)];
    }

    return {names, colors, Temperatures, draw};
})();
