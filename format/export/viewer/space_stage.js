// The view in space: builds the instances as layers are looked at, keeps the camera, and draws when something has
// changed. Where the graphics card is too slow for all in one frame, a rough picture is shown while the view moves, and
// the whole one is made behind it over several frames, so that the page never waits.
"use strict";

lyr.spaceStage = (() => {
    const mostInstances = 3e6; // 120 MB; of a larger print only every so many layers are built
    const rest_ms = 150; // after which a view that was moved is at rest
    const building_ms = 400; // between two pictures of a print that is not all there yet
    // Instances for one frame: so many that the card takes no longer than slow_ms.
    const firstBudget = 60000, leastBudget = 30000, slow_ms = 60, fast_ms = 25;
    const upright = new Set([0, 1, 2, 3, 4, 7, 13, 15, 16, 18]); // roles that make walls, in the shader's eyes
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
            this.stats = {last_ms: 0, card_ms: 0, frames: 0, instances: 0, coarse: false};
            this.touched = false; // by hand, since it was fitted
            this.coloredFor = "";
            this.movedAt_ms = -Infinity;
            this.budget = firstBudget;
            this.job = null; // a picture that takes several frames
            this.finished = false; // all of it is shown
        }

        // The system takes the card away from pages in the background; `request` asks for a frame when it is back.
        watchLoss(request) {
            this.canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
            this.canvas.addEventListener("webglcontextrestored", () => {
                for (const stream of this.strands.streams)
                    for (const page of stream.pages) Object.assign(page, {buffer: null, fresh: true});
                this.view = lyr.spaceView.create(this.canvas, this.strands, this.print.box());
                this.fence = this.job = null;
                this.key = this.coloredFor = "";
                request();
            });
        }

        resize(width, height, ratio) {
            this.ratio = ratio;
            this.height = height;
            this.canvas.width = Math.max(1, Math.round(width * ratio));
            this.canvas.height = Math.max(1, Math.round(height * ratio));
            if (!this.touched) this.fit();
        }

        // Stays so until one turns, shifts or zooms.
        fit() {
            this.camera.box = this.print.box();
            this.camera.fit(this.canvas.width / this.canvas.height);
            this.touched = false;
            this.moved();
        }

        moved() {
            this.movedAt_ms = performance.now();
        }

        pan(dx, dy, second) {
            this.touched = true;
            if (second) this.camera.pan(dx, dy, this.height);
            else this.camera.orbit(dx, dy);
            this.moved();
        }

        zoom(factor, x, y) {
            this.touched = true;
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
                return [...color.map((v) => v * onScreenShare), upright.has(style.role) ? 255 : 224];
            });
            const layers = coloring.mode !== "time" ? []
                : this.print.file.layers.map((_, i) => [...coloring.of(null, i), 255]);
            this.view.setColors(styles, layers);
        }

        // What is drawn, and by what one tells that it is another picture than before.
        wanted(state) {
            let inLast = null;
            if (state.done !== Infinity && state.high < this.strands.layers && state.high % this.every === 0) {
                const layer = this.print.layer(state.high);
                if (layer) inLast = this.strands.countsWithin(layer, Math.min(state.done, layer.motions.count));
            }
            const {camera, canvas} = this;
            const key = [camera.azimuth, camera.elevation, camera.distance, camera.target, canvas.width, canvas.height,
                state.low, state.high, inLast ? state.done : "", state.travels, this.coloredFor, this.builtFor].join();
            return {
                key, camera, first: state.low, last: state.high, inLast, travels: state.travels,
                byLayer: this.print.coloring.mode === "time", background: state.theme.stageRgb,
                bedColor: state.theme.bedRgb,
            };
        }

        // Builds for some time, and draws what can be drawn without waiting for the graphics card. True: there is more
        // to draw, now or soon.
        draw(build_ms) {
            if (this.view.gl.isContextLost()) return false;
            const begun_ms = performance.now(), state = this.state();
            const building = this.build(build_ms);
            if (!building || begun_ms - (this.builtAt_ms ?? -Infinity) > building_ms) {
                this.builtFor = this.strands.layers;
                this.builtAt_ms = begun_ms;
            }
            this.updateColors(state);
            if (!this.cardIsFree()) return true;
            const wanted = this.wanted(state);
            if (wanted.key !== this.key) {
                this.key = wanted.key;
                this.job = null;
                this.finished = false;
                this.first(wanted);
            } else if (!this.finished) {
                this.refine(wanted);
            }
            this.stats.last_ms = performance.now() - begun_ms;
            return building || !this.finished;
        }

        scope() {
            const {camera, canvas} = this;
            return [camera.matrix(canvas.width / canvas.height), camera.mmPerPixel(canvas.height)];
        }

        // All at once if the card is fast enough, else a rough picture.
        first(wanted) {
            const scope = this.scope(), plan = this.view.plan(wanted, ...scope);
            const total = plan.reduce((sum, part) => sum + part.count, 0);
            if (total <= this.budget) {
                this.start(wanted, plan, scope);
                return this.refine(wanted);
            }
            const every = Math.max(1, Math.ceil(this.view.shellCount(wanted) / this.budget));
            const coarse = this.view.coarsePlan(wanted, ...scope, every);
            this.view.begin(wanted, every);
            this.view.drawSome(coarse, 0, Infinity, 0);
            this.show(coarse, true);
        }

        start(wanted, plan, scope) {
            this.view.begin(wanted, 1);
            this.job = {plan, at: 0, sides: this.view.sidesFor(plan, scope[1])};
        }

        // A further part of the whole picture, once the view rests.
        refine(wanted) {
            if (!this.job) {
                if (performance.now() - this.movedAt_ms < rest_ms) return;
                const scope = this.scope();
                this.start(wanted, this.view.plan(wanted, ...scope), scope);
            }
            const {job} = this;
            this.view.resume();
            const from = job.at;
            job.at = this.view.drawSome(job.plan, from, this.budget, job.sides);
            if (job.at >= job.plan.length) {
                this.finished = true;
                this.job = null;
                this.show(job.plan, false);
            } else {
                this.watch(job.plan.slice(from, job.at));
            }
        }

        show(plan, coarse) {
            this.view.finish();
            this.watch(plan);
            this.stats.instances = plan.reduce((sum, part) => sum + part.count, 0);
            this.stats.coarse = coarse;
            ++this.stats.frames;
        }

        // The card works on after the calls return: how long for so many instances?
        watch(parts) {
            const {gl} = this.view;
            this.fence = {
                sync: gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0), begun_ms: performance.now(),
                instances: parts.reduce((sum, part) => sum + part.count, 0),
            };
            gl.flush();
        }

        // Has it done what it was told? What a frame may ask of it follows from how long it took.
        cardIsFree() {
            if (!this.fence) return true;
            const {gl} = this.view, {sync, begun_ms, instances} = this.fence;
            const status = gl.clientWaitSync(sync, 0, 0);
            if (status === gl.TIMEOUT_EXPIRED) return false;
            gl.deleteSync(sync);
            this.fence = null;
            const passed_ms = performance.now() - begun_ms;
            this.stats.card_ms = passed_ms;
            if (passed_ms > slow_ms) this.budget = Math.max(leastBudget, Math.min(this.budget, instances) * 0.6);
            else if (passed_ms < fast_ms && instances > this.budget / 2) this.budget *= 1.5;
            return true;
        }
    }

    return {SpaceStage};
})();
