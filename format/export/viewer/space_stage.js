// The view in space: builds the instances as layers are looked at, keeps the camera, and draws when something has
// changed. While the view moves on a machine that is too slow for all, less is drawn, and all when it rests.
"use strict";

lyr.spaceStage = (() => {
    const mostInstances = 3e6; // 120 MB; of a larger print only every so many layers are built
    const slow_ms = 45, rest_ms = 180;
    const onScreenShare = 0.96; // of strands in dark colours, so that they stand out of a dark stage

    class SpaceStage {
        // state() as for the plan, with `done` = Infinity for whole layers.
        constructor(canvas, print, state) {
            Object.assign(this, {canvas, print, state});
            this.camera = new lyr.camera.Camera(print.box());
            this.strands = new lyr.strands.Strands(print.quantum_mm);
            this.view = lyr.spaceView.create(canvas, this.strands, print.box());
            this.available = this.view !== null;
            this.every = Math.max(1, Math.ceil(print.file.operations / mostInstances));
            this.stats = {last_ms: 0, frames: 0, instances: 0, vertices: 0, coarse: false};
            this.coloredFor = "";
            this.movedAt_ms = -Infinity;
            this.full_ms = 0;
        }

        resize(width, height, ratio) {
            this.ratio = ratio;
            this.height = height;
            this.canvas.width = Math.max(1, Math.round(width * ratio));
            this.canvas.height = Math.max(1, Math.round(height * ratio));
        }

        fit() {
            this.camera.fit(this.canvas.width / this.canvas.height);
            this.moved();
        }

        moved() {
            this.movedAt_ms = performance.now();
        }

        pan(dx, dy, second) {
            if (second) this.camera.pan(dx, dy, this.height);
            else this.camera.orbit(dx, dy);
            this.moved();
        }

        zoom(factor, x, y) {
            const middle = {x: this.canvas.width / this.ratio / 2, y: this.height / 2};
            this.camera.zoom(factor, x - middle.x, y - middle.y, this.height);
            this.moved();
        }

        hover() {}
        leave() {}
        tap() {}

        // Builds further layers for some time. True: there are more.
        build(budget_ms) {
            const until = performance.now() + budget_ms;
            while (this.strands.layers < this.print.layerCount && performance.now() < until) {
                const index = this.strands.layers;
                const wanted = index % this.every === 0 || index === this.print.layerCount - 1;
                this.strands.add(wanted ? this.print.layer(index) : null);
            }
            return this.strands.layers < this.print.layerCount;
        }

        updateColors(state) {
            const {coloring} = this.print;
            const key = [coloring.mode, [...coloring.hidden], state.theme.name, state.revision,
                this.strands.styles.length].join();
            if (key === this.coloredFor) return;
            this.coloredFor = key;
            const styles = this.strands.styles.map((style) => {
                if (style.role < 0) return [...state.theme.travelRgb, 128];
                if (coloring.hidden.has(style.role)) return [0, 0, 0, 0];
                const color = coloring.mode === "time" ? lyr.colors.rgb(lyr.colors.byRole[style.role])
                    : coloring.of(style, 0);
                return [...color.map((v) => v * onScreenShare), 255];
            });
            const layers = coloring.mode !== "time" ? []
                : this.print.file.layers.map((_, i) => [...coloring.of(null, i), 255]);
            this.view.setColors(styles, layers);
        }

        // True: there is more to draw, now or soon.
        draw() {
            const begun_ms = performance.now(), state = this.state();
            const building = this.build(this.strands.layers === 0 ? 30 : 10);
            this.updateColors(state);
            const moves = begun_ms - this.movedAt_ms < rest_ms;
            const coarse = moves && this.full_ms > slow_ms;
            let inLast = null;
            if (state.done !== Infinity && state.high < this.strands.layers && state.high % this.every === 0) {
                const layer = this.print.layer(state.high);
                if (layer) inLast = this.strands.countsWithin(layer, Math.min(state.done, layer.motions.count));
            }
            const drawn = this.view.draw({
                camera: this.camera, first: state.low, last: state.high, inLast, travels: state.travels, coarse,
                byLayer: this.print.coloring.mode === "time", background: state.theme.stageRgb,
                bedColor: state.theme.bedRgb,
            });
            this.measureTime(begun_ms, coarse);
            Object.assign(this.stats, drawn, {coarse});
            ++this.stats.frames;
            return building || coarse;
        }

        // The card works on after the calls return; a pixel that is read waits for it. That is done rarely.
        measureTime(begun_ms, coarse) {
            const {gl} = this.view;
            if (this.stats.frames % 8 === 0 || this.full_ms > slow_ms)
                gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
            this.stats.last_ms = performance.now() - begun_ms;
            if (!coarse) this.full_ms = this.stats.last_ms;
        }
    }

    return {SpaceStage};
})();
