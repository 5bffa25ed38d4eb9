// The view from above: keeps a picture of the layers, spreads a new one over several frames if it is large (the old one
// is moved and stretched meanwhile), and draws on top what changes with every frame: the head, what is under the
// pointer, a measurement.
"use strict";

lyr.planStage = (() => {
    const budget_ms = 9; // of a frame of 16 ms, for strands
    const reach_px = 14; // of the pointer
    const leastScale = 0.05, mostScale = 20000; // pixels per mm

    // A canvas that holds a picture: of which content, in which frame, and how far it got in the top layer.
    class Picture {
        constructor() {
            this.canvas = document.createElement("canvas");
            this.context = this.canvas.getContext("2d");
            this.frame = null;
        }

        begin(frame, content, done) {
            const {canvas} = this;
            if (canvas.width !== frame.width || canvas.height !== frame.height) {
                canvas.width = frame.width;
                canvas.height = frame.height;
            }
            this.context.clearRect(0, 0, frame.width, frame.height);
            Object.assign(this, {frame, content, done});
        }
    }

    class PlanStage {
        // state() gives what is to be shown: {low, high, done, share, travels, below, theme, revision}.
        constructor(canvas, print, state) {
            Object.assign(this, {canvas, print, state});
            this.context = canvas.getContext("2d");
            this.front = new Picture();
            this.back = new Picture();
            this.job = null;
            this.center = {x: 0, y: 0};
            this.scale = 1; // CSS pixels per mm
            this.ratio = 1; // device pixels per CSS pixel
            this.pointer = null;
            this.under = null; // what is under the pointer
            this.measure = {on: false, points: [], snap: null};
            this.stats = {last_ms: 0, frames: 0};
            this.needsFit = true;
        }

        resize(width, height, ratio) {
            this.ratio = ratio;
            this.canvas.width = Math.max(1, Math.round(width * ratio));
            this.canvas.height = Math.max(1, Math.round(height * ratio));
            if (this.needsFit) this.fit();
        }

        fit() {
            const {low, high} = this.print.box(), margin = 1.12;
            const width = this.canvas.width / this.ratio, height = this.canvas.height / this.ratio;
            this.center = {x: (low[0] + high[0]) / 2, y: (low[1] + high[1]) / 2};
            this.scale = this.limited(Math.min(width / Math.max(1, high[0] - low[0]),
                height / Math.max(1, high[1] - low[1])) / margin);
            this.needsFit = width < 2 || height < 2;
        }

        limited(scale) {
            return Math.min(mostScale, Math.max(leastScale, scale));
        }

        frame() {
            return {
                x_mm: this.center.x, y_mm: this.center.y, scale: this.scale * this.ratio,
                width: this.canvas.width, height: this.canvas.height,
            };
        }

        // CSS pixels to mm and back.
        toBed(x, y) {
            return {
                x: this.center.x + (x - this.canvas.width / this.ratio / 2) / this.scale,
                y: this.center.y - (y - this.canvas.height / this.ratio / 2) / this.scale,
            };
        }
        toScreen(x_mm, y_mm) {
            return {
                x: this.canvas.width / this.ratio / 2 + (x_mm - this.center.x) * this.scale,
                y: this.canvas.height / this.ratio / 2 - (y_mm - this.center.y) * this.scale,
            };
        }

        pan(dx, dy) {
            this.center.x -= dx / this.scale;
            this.center.y += dy / this.scale;
        }

        zoom(factor, x, y) {
            const before = this.toBed(x, y);
            this.scale = this.limited(this.scale * factor);
            const after = this.toBed(x, y);
            this.center.x += before.x - after.x;
            this.center.y += before.y - after.y;
        }

        // Is a motion of the top layer drawn, as far as one can choose?
        shows(layer, i, state) {
            if (!layer.motions.extrudes(i)) return state.travels;
            return !this.print.coloring.hidden.has(layer.motions.styles[layer.motions.style[i]].role);
        }

        hover(x, y) {
            this.pointer = {x, y};
            const state = this.state(), layer = this.print.layer(state.high);
            this.under = null;
            if (!layer) return;
            const q = this.print.quantum_mm, at = this.toBed(x, y), reach = reach_px / this.scale / q;
            const wanted = (i) => this.shows(layer, i, state);
            if (this.measure.on)
                this.measure.snap = lyr.pick.snap(layer.motions, at.x / q, at.y / q, reach, wanted);
            const found = lyr.pick.motion(layer.motions, at.x / q, at.y / q, reach, wanted);
            if (found) this.under = {layer, ...found};
        }

        leave() {
            this.pointer = this.under = this.measure.snap = null;
        }

        tap(x, y) {
            this.hover(x, y);
            const {measure} = this;
            if (!measure.on || !measure.snap) return;
            if (measure.points.length === 2) measure.points = [];
            measure.points.push(measure.snap);
        }

        // Draws what can be drawn in a frame's time. True: there is more to do.
        draw() {
            const begun_ms = performance.now();
            const state = this.state(), frame = this.frame();
            const content = [state.low, state.high, state.travels, state.below, state.theme.name, state.revision,
                state.done === Infinity].join();
            if (this.job && this.back.content !== content) this.job = null;
            if (!this.job && !this.upToDate(frame, content, state.done)) {
                this.back.begin(frame, content, state.done);
                this.job = this.paint(this.back, state);
            }
            let finished = !this.job;
            while (!finished && performance.now() - begun_ms < budget_ms) finished = this.job.next().done;
            if (this.job && finished) {
                this.job = null;
                [this.front, this.back] = [this.back, this.front];
            } else if (!this.job && state.done > this.front.done) {
                this.advance(state);
            }
            this.show(frame, state);
            this.stats.last_ms = performance.now() - begun_ms;
            ++this.stats.frames;
            return this.job !== null || !this.upToDate(frame, content, state.done);
        }

        upToDate(frame, content, done) {
            const {front} = this;
            if (!front.frame || front.content !== content || front.done > done) return false;
            return Object.keys(frame).every((key) => front.frame[key] === frame[key]);
        }

        * paint(picture, state) {
            const {context, frame} = picture, {print} = this, {theme} = state;
            const options = {coloring: print.coloring, quantum_mm: print.quantum_mm};
            if (state.below && state.low === state.high && state.high > 0) {
                const layer = print.layer(state.high - 1);
                if (layer) yield* lyr.planView.strokes(context, frame, layer, {...options, alpha: 0.13});
            }
            for (let index = state.low; index < state.high; ++index) {
                const layer = print.layer(index);
                if (layer) yield* lyr.planView.strokes(context, frame, layer, options);
            }
            const layer = print.layer(state.high);
            if (!layer) return;
            if (state.done !== Infinity)
                yield* lyr.planView.strokes(context, frame, layer, {...options, alpha: 0.12});
            const end = Math.min(picture.done, layer.motions.count);
            yield* lyr.planView.strokes(context, frame, layer, {...options, end});
            if (state.travels) yield* lyr.planView.ways(context, frame, layer, {...this.wayOptions(theme), end});
        }

        wayOptions(theme) {
            return {
                quantum_mm: this.print.quantum_mm, travelColor: theme.travel, wipeColor: theme.wipe,
                thin_px: this.ratio,
            };
        }

        // The print has gone on: only what is new is drawn.
        advance(state) {
            const {context, frame, done} = this.front, layer = this.print.layer(state.high);
            this.front.done = state.done;
            if (!layer || state.done === Infinity) return;
            const part = {begin: done, end: Math.min(state.done, layer.motions.count)};
            const options = {coloring: this.print.coloring, quantum_mm: this.print.quantum_mm, ...part};
            for (const step of lyr.planView.strokes(context, frame, layer, options)) void step;
            if (!state.travels) return;
            const ways = {...this.wayOptions(state.theme), ...part};
            for (const step of lyr.planView.ways(context, frame, layer, ways)) void step;
        }

        show(frame, state) {
            const {context, front} = this, {theme} = state;
            context.setTransform(1, 0, 0, 1, 0, 0);
            context.fillStyle = theme.stage;
            context.fillRect(0, 0, frame.width, frame.height);
            lyr.planMarks.ruling(context, frame, theme, this.ratio);
            if (front.frame) {
                const old = front.frame, factor = frame.scale / old.scale;
                const x = frame.width / 2 + (old.x_mm - frame.x_mm) * frame.scale - old.width / 2 * factor;
                const y = frame.height / 2 - (old.y_mm - frame.y_mm) * frame.scale - old.height / 2 * factor;
                if (factor === 1) context.drawImage(front.canvas, Math.round(x), Math.round(y));
                else context.drawImage(front.canvas, x, y, old.width * factor, old.height * factor);
            }
            this.showHead(frame, state);
            context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
            lyr.planMarks.under(context, this, theme);
            lyr.planMarks.measurement(context, this, theme);
            lyr.planMarks.scaleBar(context, this, theme);
        }

        // The motion that is under way, and the head.
        showHead(frame, state) {
            const layer = this.print.layer(state.high), {theme} = state;
            if (!layer || state.done === Infinity || layer.motions.count === 0) return;
            const last = layer.motions.count - 1, i = Math.min(state.done, last);
            const share = state.done > last ? 1 : state.share;
            const options = {coloring: this.print.coloring, ...this.wayOptions(theme)};
            if (layer.motions.extrudes(i) || state.travels)
                lyr.planView.partial(this.context, frame, layer, i, share, options);
            const at = layer.motions.pointAt(i, share), q = this.print.quantum_mm;
            const place = this.toScreen(at.x * q, at.y * q);
            this.context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
            lyr.planMarks.head(this.context, place, theme);
        }
    }

    return {PlanStage};
})();
