// The page: what is shown (the state), the controls that change it, and the frames that draw it.
"use strict";

lyr.page = (() => {
    const {time, number, fixed, capital} = lyr.words;
    const factors = [1, 2, 5, 10, 20, 50, 100, 200, 500];
    // Of a frame, for looking the print through; more where frames are slow for other reasons.
    const work_ms = 8, mostWork_ms = 100, workShare = 0.4;
    const narrow_px = 720; // as in viewer.css
    const motionGap_s = 1e-6; // behind a motion's end, so that it is over

    const byId = (id) => document.getElementById(id);

    class Page {
        constructor(print) {
            const last = print.layerCount - 1;
            this.print = print;
            this.theme = lyr.theme.read();
            this.state = {
                view: "plan", high: last, low: 0, lows: {plan: null, space: 0}, travels: false, below: true,
                time_s: print.schedule.total_s, whole: true, playing: false, factor: 20, revision: 0,
            };
            const shown = () => this.shown();
            this.plan = new lyr.planStage.PlanStage(byId("plan"), print, shown);
            this.space = new lyr.spaceStage.SpaceStage(byId("space"), print, shown);
            this.slider = new lyr.slider.RangeSlider(byId("layer-slider"), print.layerCount,
                (low, high, which) => this.setLayers(low, high, which));
            this.panelDirty = true;
            this.scheduled = false;
            this.listen();
            this.resize();
            this.setView(this.space.available && location.hash !== "#2d" ? "space" : "plan");
            if (!this.space.available) this.notice("3D needs WebGL 2, which this browser does not offer here.");
            for (const warning of print.file.warnings) this.notice(`Damaged: ${warning}.`, true);
            this.request();
        }

        get stage() {
            return this.state.view === "plan" ? this.plan : this.space;
        }

        // What a stage draws.
        shown() {
            const {state, print, theme} = this;
            let done = Infinity, share = 0;
            if (!state.whole) {
                const layer = print.layer(state.high);
                if (layer) ({done, share} = lyr.timing.progress(layer.timing.ends_s,
                    state.time_s - print.schedule.begins_s[state.high]));
            }
            const {low, high, travels, below, revision} = state;
            return {low, high, done, share, travels, below, theme, revision};
        }

        listen() {
            const click = (id, act) => byId(id).addEventListener("click", act);
            click("view-plan", () => this.setView("plan"));
            click("view-space", () => this.setView("space"));
            click("travels", () => this.toggle("travels"));
            click("below", () => this.toggle("below"));
            click("measure", () => this.toggleMeasure());
            click("fit", () => this.fit());
            click("show-panel", () => this.togglePanel());
            click("show-help", () => this.toggleHelp());
            click("range", () => this.toggleRange());
            click("play", () => this.togglePlay());
            this.fillChoices();
            byId("time").addEventListener("input", (event) => this.setTime(Number(event.target.value)));
            for (const [name, stage] of [["plan", this.plan], ["space", this.space]]) this.listenOn(byId(name), stage);
            this.space.watchLoss(() => this.request());
            lyr.keys.listen(this);
            lyr.keys.fillHelp(byId("help"));
            new ResizeObserver(() => this.resize()).observe(byId("stage"));
            matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
                this.theme = lyr.theme.read();
                this.request();
            });
            if (innerWidth <= narrow_px) this.togglePanel();
        }

        fillChoices() {
            const mode = byId("mode"), factor = byId("factor");
            for (const [key, {name}] of Object.entries(lyr.colors.modes)) mode.add(new Option(name, key));
            for (const value of factors) factor.add(new Option(`× ${value}`, value));
            factor.value = this.state.factor;
            mode.addEventListener("change", () => this.setMode(mode.value));
            factor.addEventListener("change", () => {
                this.state.factor = Number(factor.value);
            });
        }

        listenOn(canvas, stage) {
            const and = (act) => (...values) => {
                act.apply(stage, values);
                this.showCard();
                this.request();
            };
            const tap = and(stage.tap);
            lyr.gestures.listen(canvas, {
                pan: and(stage.pan), zoom: and(stage.zoom), tap: (x, y) => this.closeSheet() || tap(x, y),
                hover: and(stage.hover), leave: and(stage.leave),
            });
        }

        resize() {
            const box = byId("stage").getBoundingClientRect(), ratio = Math.min(2, devicePixelRatio || 1);
            this.plan.resize(box.width, box.height, ratio);
            this.space.resize(box.width, box.height, ratio);
            this.request();
        }

        // Something that is drawn or told has changed.
        changed() {
            const {state} = this;
            this.panelDirty = true;
            this.slider.set(state.low, state.high, state.lows[state.view] === null);
            const press = (id, on) => byId(id).setAttribute("aria-pressed", on);
            press("view-plan", state.view === "plan");
            press("view-space", state.view === "space");
            press("travels", state.travels);
            press("below", state.below);
            press("measure", this.plan.measure.on);
            press("range", state.lows[state.view] !== null);
            byId("below").disabled = byId("measure").disabled = state.view !== "plan";
            byId("view-space").disabled = !this.space.available;
            byId("stage").classList.toggle("measures", state.view === "plan" && this.plan.measure.on);
            byId("play").querySelector("use").setAttribute("href", state.playing ? "#i-pause" : "#i-play");
            byId("mode").value = this.print.coloring.mode;
            byId("factor").value = state.factor;
            this.showLabels();
            this.showCard();
            this.request();
        }

        showLabels() {
            const {state, print} = this, {element} = lyr.panel;
            const from = state.low < state.high ? `${state.low + 1}–` : "";
            byId("layer-label").replaceChildren(element("b", {}, `${from}${state.high + 1}`),
                element("small", {class: "of"}, `of ${print.layerCount}`),
                element("small", {}, `${number(print.file.layers[state.high].z_mm)} mm`));
            const slider = byId("time"), total_s = print.schedule.total_s;
            slider.max = total_s;
            slider.value = state.time_s;
            byId("time-label").replaceChildren(time(state.time_s), element("small", {}, ` / ${time(total_s)}`));
        }

        setView(view) {
            if (view === "space" && !this.space.available) return;
            this.state.view = view;
            byId("plan").hidden = view !== "plan";
            byId("space").hidden = view !== "space";
            this.plan.leave();
            this.state.low = Math.min(this.state.lows[view] ?? this.state.high, this.state.high);
            this.changed();
        }

        setLayers(low, high, which) {
            const {state} = this, single = state.lows[state.view] === null;
            if (high !== state.high || which === "high") {
                state.high = high;
                state.whole = true;
                state.time_s = this.print.schedule.begins_s[high + 1];
                this.plan.under = null;
            }
            state.low = single ? high : Math.min(low, high);
            if (!single) state.lows[state.view] = state.low;
            this.changed();
        }

        stepLayer(by) {
            const high = Math.min(this.print.layerCount - 1, Math.max(0, this.state.high + by));
            this.setLayers(Math.min(this.state.low, high), high, "high");
        }

        stepLow(by) {
            const {state} = this;
            if (state.lows[state.view] === null) state.lows[state.view] = state.low;
            this.setLayers(Math.min(state.high, Math.max(0, state.low + by)), state.high, "low");
        }

        toggleRange() {
            const {state} = this;
            state.lows[state.view] = state.lows[state.view] === null ? 0 : null;
            state.low = state.lows[state.view] ?? state.high;
            this.changed();
        }

        setTime(time_s) {
            const {state, print} = this, {schedule} = print;
            state.time_s = Math.min(schedule.total_s, Math.max(0, time_s));
            state.whole = state.time_s >= schedule.total_s;
            state.high = schedule.layerAt(state.time_s);
            const low = state.lows[state.view];
            state.low = Math.min(low ?? state.high, state.high);
            this.changed();
        }

        stepMotion(by) {
            const {state, print} = this, layer = print.layer(state.high);
            if (!layer || layer.motions.count === 0) return;
            const done = state.whole ? layer.motions.count : this.shown().done, goal = done + by;
            const begin_s = print.schedule.begins_s[state.high];
            if (goal < 0) return this.setTime(begin_s - motionGap_s);
            if (goal > layer.motions.count) return this.setTime(begin_s + layer.timing.duration_s + motionGap_s);
            this.setTime(goal === 0 ? begin_s : begin_s + layer.timing.ends_s[goal - 1] + motionGap_s);
        }

        togglePlay() {
            const {state} = this;
            state.playing = !state.playing;
            if (state.playing && state.whole) this.setTime(this.print.schedule.begins_s[state.high + 1] >=
                this.print.schedule.total_s && state.lows[state.view] !== null ? 0
                : this.print.schedule.begins_s[state.high]);
            this.playedAt_ms = performance.now();
            this.changed();
        }

        stepFactor(by) {
            const at = factors.indexOf(this.state.factor) + by;
            this.state.factor = factors[Math.min(factors.length - 1, Math.max(0, at))];
            this.changed();
        }

        setMode(mode) {
            this.print.coloring.mode = mode;
            ++this.state.revision;
            this.changed();
        }

        nextMode() {
            const modes = Object.keys(lyr.colors.modes);
            this.setMode(modes[(modes.indexOf(this.print.coloring.mode) + 1) % modes.length]);
        }

        toggle(what) {
            this.state[what] = !this.state[what];
            this.changed();
        }

        toggleRole(role) {
            if (role < 0) return this.toggle("travels");
            const {hidden} = this.print.coloring;
            if (!hidden.delete(role)) hidden.add(role);
            ++this.state.revision;
            this.changed();
        }

        toggleMeasure() {
            const {measure} = this.plan;
            if (this.state.view !== "plan") this.setView("plan");
            measure.on = !measure.on;
            measure.points = [];
            measure.snap = null;
            this.changed();
        }

        togglePanel() {
            const closed = byId("panel").classList.toggle("closed");
            byId("show-panel").setAttribute("aria-pressed", !closed);
            this.panelDirty = true;
            this.request();
        }

        toggleHelp() {
            const help = byId("help");
            if (help.open) help.close();
            else help.showModal();
        }

        // On a phone the statistics lie over the stage.
        closeSheet() {
            const open = innerWidth <= narrow_px && !byId("panel").classList.contains("closed");
            if (open) this.togglePanel();
            return open;
        }

        escape() {
            if (byId("help").open) byId("help").close();
            else if (this.plan.measure.on) this.toggleMeasure();
            else this.closeSheet();
        }

        fit() {
            this.stage.fit();
            this.request();
        }

        zoomBy(factor) {
            const box = byId("stage").getBoundingClientRect();
            this.stage.zoom(factor, box.width / 2, box.height / 2);
            this.request();
        }

        notice(text, bad = false) {
            const notice = byId("notice");
            notice.textContent = text;
            notice.classList.toggle("bad", bad);
            notice.hidden = false;
            clearTimeout(this.noticeTimer);
            if (!bad) this.noticeTimer = setTimeout(() => {
                notice.hidden = true;
            }, 6000);
        }

        // What is under the pointer, and what was measured.
        showCard() {
            const card = byId("card"), lines = this.state.view === "plan"
                ? [...this.measuredLines(), ...this.underLines()] : [];
            card.hidden = lines.length === 0;
            card.replaceChildren(...lines);
        }

        measuredLines() {
            const {measure} = this.plan, {element} = lyr.panel;
            if (!measure.on) return [];
            const points = [...measure.points, ...measure.points.length === 1 && measure.snap ? [measure.snap] : []];
            if (points.length < 2) return [element("b", {}, points.length === 0 && measure.points.length === 0
                ? "Measure: point at the first place" : "Now the second place")];
            const {dx_mm, dy_mm, length_mm} = lyr.planMarks.distance(points, this.print.quantum_mm);
            return [
                element("div", {class: "result"}, `${fixed(length_mm, 3)} mm`),
                element("p", {}, `x ${fixed(dx_mm, 3)}, y ${fixed(dy_mm, 3)} mm, ` +
                    `${points[0].what} to ${points[1].what}`),
            ];
        }

        underLines() {
            const {under} = this.plan, {element} = lyr.panel;
            if (!under) return [];
            const {layer, i} = under, {motions} = layer, q = this.print.quantum_mm;
            const style = motions.styles[motions.style[i]], kinds = ["line", "arc", "circle", "travel", "wipe"];
            const name = style.role < 0 ? kinds[motions.kind[i]]
                : `${lyr.motions.roles[style.role]}, ${kinds[motions.kind[i]]}`;
            const chip = style.role < 0 ? [] : [element("span", {
                class: "chip", style: `background: ${lyr.colors.css(this.print.coloring.of(style, layer.index))}`,
            })];
            const out = [element("div", {}, ...chip, element("b", {}, capital(name)))];
            if (motions.isCurved(i)) {
                const arc = motions.shape(i), degrees = Math.abs(arc.sweep) * 180 / Math.PI;
                out.push(element("p", {}, `Radius ${fixed(arc.radius * q, 3)} mm, ${fixed(degrees, 1)}°, centre ` +
                    `${fixed(arc.x * q, 3)}, ${fixed(arc.y * q, 3)}`));
            }
            const flow = style.area_mm2 * style.speed_mm_s;
            out.push(element("p", {}, `Length ${fixed(motions.length(i) * q, 3)} mm` + (style.role < 0 ? ""
                : `, ${+style.width_mm.toFixed(4)} × ${+style.height_mm.toFixed(4)} mm`)));
            out.push(element("p", {}, `${number(style.speed_mm_s)} mm/s` +
                (style.role < 0 ? "" : `, ${number(flow)} mm³/s`)));
            return out;
        }

        request() {
            if (this.scheduled) return;
            this.scheduled = true;
            requestAnimationFrame(() => this.frame());
        }

        frame() {
            this.scheduled = false;
            const now_ms = performance.now(), gap_ms = now_ms - (this.frameAt_ms ?? now_ms);
            this.frameAt_ms = now_ms;
            this.work_ms = Math.min(mostWork_ms, Math.max(work_ms, workShare * gap_ms));
            if (this.state.playing) this.advance(now_ms);
            const surveying = this.print.surveyed < this.print.layerCount && this.survey();
            const drawing = this.stage.draw(this.work_ms);
            const panel = byId("panel");
            // While the print plays or is looked through, the panel is written a few times a second.
            const busy = this.state.playing || surveying;
            if (this.panelDirty && !panel.classList.contains("closed") &&
                (!busy || now_ms - (this.filledAt_ms ?? 0) > 250)) {
                lyr.panel.fill(panel, this.print, this.state, (role) => this.toggleRole(role));
                this.panelDirty = false;
                this.filledAt_ms = now_ms;
            }
            if (drawing || busy) this.request();
        }

        advance(now_ms) {
            const {state} = this, passed_s = Math.min(0.25, (now_ms - this.playedAt_ms) / 1000);
            this.playedAt_ms = now_ms;
            this.setTime(state.time_s + passed_s * state.factor);
            if (state.whole) {
                state.playing = false;
                this.changed();
            }
        }

        survey() {
            const more = this.print.survey(this.work_ms);
            const {state, print} = this;
            if (state.whole) state.time_s = print.schedule.begins_s[state.high + 1];
            this.panelDirty = true;
            if (!more) {
                ++this.state.revision; // ranges of colours are known now
                if (!this.space.touched) this.space.fit(); // and so is the box
                if (print.damaged.size > 0) this.notice([...print.damaged.values()][0] +
                    (print.damaged.size > 1 ? ` (and ${print.damaged.size - 1} more)` : ""), true);
                if (this.space.every > 1 && this.space.available)
                    this.notice(`A large print: in 3D every ${this.space.every}th layer is drawn.`);
            }
            this.showLabels();
            return more;
        }
    }

    return {Page};
})();
