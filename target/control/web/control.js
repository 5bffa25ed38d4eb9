// The page: asks how the print is going, shows it, and sends commands with the token.
"use strict";

lyr.control = (() => {
    const look_ms = 500, patience_ms = 4000;
    const {time, capital, number} = lyr.words;
    const byId = (id) => document.getElementById(id);
    const element = lyr.panel.element;

    // Which state allows what; lyrrun says the last word.
    const over = ["stopping", "done", "failed", "stopped"], rests = ["pausing", "paused"];
    const allowed = {
        pause: (state) => !over.includes(state) && !rests.includes(state),
        resume: (state) => rests.includes(state),
        change: (state) => !over.includes(state),
        cancel: (state) => !over.includes(state),
        set: (state) => !over.includes(state),
    };

    // It comes behind # in the address, which browsers send to nobody, and is taken out of sight at once.
    function readToken() {
        const given = new URLSearchParams(location.hash.slice(1)).get("token");
        if (given) {
            sessionStorage.setItem("token", given);
            history.replaceState(null, "", location.pathname);
        }
        return sessionStorage.getItem("token") ?? "";
    }

    class Page {
        constructor() {
            this.token = readToken();
            this.temperatures = new lyr.chart.Temperatures();
            this.theme = lyr.theme.read();
            this.place = {done: Infinity, share: 0};
            Object.assign(this, {status: null, number: 0, connected: false, lost: false});
            this.listen();
            this.showToken();
            this.look();
        }

        listen() {
            const send = (id, command) => byId(id).addEventListener("click", () => this.send({command}));
            send("pause", "pause");
            send("resume", "resume");
            send("change", "change_filament");
            send("stop", "stop");
            byId("cancel").addEventListener("click", () => {
                if (confirm("End this print? It cannot be gone on with.")) this.send({command: "cancel"});
            });
            byId("settings").addEventListener("submit", (event) => {
                event.preventDefault();
                this.set(event.target);
            });
            byId("enter").addEventListener("submit", (event) => {
                event.preventDefault();
                this.token = byId("token").value.trim();
                sessionStorage.setItem("token", this.token);
                byId("token").value = "";
                this.showToken();
            });
            byId("fit").addEventListener("click", () => {
                this.moved = false;
                this.plan?.fit();
                this.request();
            });
            matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
                this.theme = lyr.theme.read();
                this.request();
            });
        }

        async loadPrint() {
            try {
                const answer = await fetch("/print.lyr");
                if (!answer.ok) throw new lyr.file.Damage("its file cannot be read");
                this.print = new lyr.print.Print(new Uint8Array(await answer.arrayBuffer()));
            } catch (error) {
                return this.notice(`The layer cannot be drawn: ${error.message}.`, true);
            }
            this.follower = new lyr.progress.Follower(this.print);
            this.plan = new lyr.planStage.PlanStage(byId("plan"), this.print, () => this.shown());
            const and = (act) => (...values) => {
                this.moved = true;
                act.apply(this.plan, values);
                this.request();
            };
            lyr.gestures.listen(byId("plan"), {
                pan: and(this.plan.pan), zoom: and(this.plan.zoom), tap() {}, hover() {}, leave() {},
            });
            new ResizeObserver(() => this.resize()).observe(byId("stage"));
            this.resize();
        }

        resize() {
            const box = byId("stage").getBoundingClientRect();
            this.plan.needsFit = this.plan.needsFit || !this.moved; // whoever has looked closer goes on doing so
            this.plan.resize(box.width, box.height, Math.min(2, devicePixelRatio || 1));
            this.request();
        }

        shown() {
            const high = Math.min(this.print.layerCount, Math.max(1, this.status?.layer ?? 1)) - 1;
            return {
                low: high, high, ...this.place, travels: false, below: true, theme: this.theme, revision: 0,
            };
        }

        async look() {
            try {
                const answer = await fetch(`/status?since=${this.temperatures.next}`,
                    {signal: AbortSignal.timeout(patience_ms)});
                const {print, connected, status, history: temperatures} = await answer.json();
                // Another print is another page.
                if (this.number > 0 && print !== this.number) return location.reload();
                if (print > 0 && !this.number) this.loadPrint();
                this.number = print;
                this.status = status;
                this.connected = connected;
                this.temperatures.take(temperatures);
                this.lost = false;
            } catch {
                this.lost = true;
            }
            this.show();
            setTimeout(() => this.look(), look_ms);
        }

        // What the page has to say about the print, and whether it is bad.
        stateNow() {
            if (this.lost) return ["no answer from lyrctl web", true];
            if (!this.status) return ["no print", false];
            const {state} = this.status;
            if (!this.connected && !this.isOver()) return ["lyrrun has gone", true];
            return [state, state === "failed"];
        }

        isOver() {
            return this.status !== null && ["done", "failed", "stopped"].includes(this.status.state);
        }

        show() {
            const {status} = this;
            const [state, bad] = this.stateNow();
            byId("state").textContent = capital(state);
            byId("state").classList.toggle("bad", bad);
            const may = Boolean(this.token) && !this.lost && this.connected && status !== null;
            byId("controls").disabled = !may;
            byId("stop").disabled = !may || this.isOver();
            if (!status) return;
            for (const [id, is] of Object.entries(allowed)) byId(id).disabled = !is(status.state);
            const name = status.file.split("/").pop();
            byId("title").textContent = `${name} on ${status.printer}`;
            document.title = `${capital(state)}: ${name}`;
            // Where the file does not say, the page reckons.
            this.total_s = status.estimated_s ?? this.print?.schedule.total_s ?? null;
            byId("progress").value = state === "done" ? 1 : this.total_s ? Math.min(1, status.time_s / this.total_s) : 0;
            byId("message").textContent = capital(status.message || " ");
            byId("message").hidden = !status.message;
            this.showFigures(status);
            this.showHeaters(status);
            lyr.chart.draw(byId("chart"), this.temperatures, this.theme, Math.min(2, devicePixelRatio || 1));
            if (this.print && status.layer > 0 && status.layer <= this.print.layerCount)
                this.place = state === "done" ? {done: Infinity, share: 0}
                    : this.follower.follow(status.layer - 1, status.time_s, status.position_mm);
            this.request();
        }

        showFigures(status) {
            const left_s = this.total_s === null ? null : Math.max(0, this.total_s - status.time_s) / status.speed;
            const at = status.position_mm;
            const figures = [
                ["Layer", `${status.layer} of ${status.layers}`],
                ["Time", time(status.elapsed_s)],
                ["Left, about", left_s === null ? "unknown" : time(left_s)],
                ["Head", at ? at.map((mm) => mm.toFixed(2)).join(", ") + " mm" : "lost"],
                ["Filament", `${number(status.filament_mm / 1000)} m`],
                ["Fan", `${Math.round(100 * status.fan)} %`],
                ["Speed", `${Math.round(100 * status.speed)} %`],
            ];
            byId("figures").replaceChildren(...figures.flatMap(([key, value]) =>
                [element("dt", {}, key), element("dd", {}, value)]));
        }

        showHeaters({heaters}) {
            const degrees = (value) => value === null ? "–" : value.toFixed(1);
            byId("heaters").replaceChildren(...lyr.chart.names.filter((name) => heaters[name]).map((name) =>
                element("tr", {}, element("td", {}, element("span", {
                    class: "chip", style: `background: ${lyr.chart.colors[lyr.chart.names.indexOf(name)]}`,
                }), ` ${capital(name)}`), element("td", {id: `${name}-now`}, degrees(heaters[name].temperature_c)),
                element("td", {}, heaters[name].target_c > 0 ? `of ${heaters[name].target_c}` : "off"))));
            for (const name of lyr.chart.names)
                byId("settings").elements[`${name}_c`].closest("label").hidden = !heaters[name];
        }

        set(form) {
            const request = {command: "set"};
            for (const {name, value} of form.querySelectorAll("input")) {
                if (value.trim() === "") continue;
                const shown = Number(value.trim().replace(",", "."));
                request[name] = name.endsWith("_c") ? shown : shown / 100;
            }
            form.reset();
            this.send(request);
        }

        // What is answered; what is refused is shown.
        async send(request) {
            let answer = {ok: false, error: {message: "lyrctl web does not answer"}};
            try {
                const sent = await fetch("/command", {
                    method: "POST", body: JSON.stringify(request), signal: AbortSignal.timeout(patience_ms),
                    headers: {"Content-Type": "application/json", "Authorization": `Bearer ${this.token}`},
                });
                answer = await sent.json();
            } catch {
                // Told as it is.
            }
            if (!answer.ok) this.notice(`${capital(answer.error.message)}.`, true);
            else byId("notice").hidden = true;
            if (answer.error?.code === "forbidden") {
                this.token = "";
                sessionStorage.removeItem("token");
                this.showToken();
            }
            return answer;
        }

        showToken() {
            byId("enter").hidden = Boolean(this.token);
            this.show();
        }

        notice(text, bad) {
            const notice = byId("notice");
            notice.textContent = text;
            notice.classList.toggle("bad", bad);
            notice.hidden = false;
        }

        request() {
            if (this.scheduled || !this.plan) return;
            this.scheduled = true;
            requestAnimationFrame(() => {
                this.scheduled = false;
                if (this.plan.draw()) this.request();
            });
        }
    }

    return {Page};
})();

lyr.page = new lyr.control.Page();
