// The statistics beside the stage: what the print is, the layer that is shown, and the roles, which are the colours'
// legend and switches as well.
"use strict";

lyr.panel = (() => {
    const {count, length, volume, time, number, size, capital} = lyr.words;

    // An element with attributes and children; text is never taken as markup.
    function element(name, attributes = {}, ...children) {
        const out = document.createElement(name);
        for (const [key, value] of Object.entries(attributes))
            if (typeof value === "function") out.addEventListener(key, value);
            else if (value !== undefined) out.setAttribute(key, value);
        out.append(...children);
        return out;
    }

    function list(pairs) {
        const out = element("dl");
        for (const [name, value] of pairs)
            if (value) out.append(element("dt", {}, name), element("dd", {}, value));
        return out;
    }

    function printPairs(print) {
        const {file} = print, values = file.metadata.values;
        const of = (key) => Number(values.get(key) ?? 0);
        const {low, high} = print.box(), box = [high[0] - low[0], high[1] - low[1], high[2]];
        const filament_mm = of("filament_mm"), mass_g = of("mass_g");
        const filament = filament_mm > 0 && length(filament_mm) + (mass_g > 0 ? `, ${number(mass_g)} g` : "");
        return [
            ["Time", time(print.schedule.total_s)],
            ["Filament", filament],
            ["Layers", count(print.layerCount)],
            ["Size", box.some((v) => v > 0) && `${box.map((v) => number(v)).join(" × ")} mm`],
            ["Operations", file.operations > 0 && count(file.operations)],
            ["File", size(file.bytes.length)],
            ["Printer", values.get("printer")],
            ["Material", values.get("material")],
            ["Profile", values.get("profile")],
            ["Tolerance", of("tolerance_mm") > 0 && `${of("tolerance_mm")} mm`],
            ["Made by", values.get("generator")],
        ];
    }

    function layerPairs(print, index) {
        const head = print.file.layers[index];
        const fan = head.fans.find((entry) => entry.fan === 0);
        const tool = head.heaters.find((entry) => entry.kind === 2 && entry.tool === head.tool);
        const bed = head.heaters.find((entry) => entry.kind === 0);
        const name = print.file.metadata.objects[head.object - 1];
        return [
            ["Top", `${number(head.z_mm)} mm`],
            ["Thickness", `${+head.height_mm.toFixed(4)} mm`],
            ["Time", time(print.schedule.durations_s[index])],
            ["Operations", count(head.operations)],
            ["Extruded", `${length(head.extruded_mm)}, ${volume(head.volume_mm3)}`],
            ["Travels", length(head.travel_mm)],
            ["Nozzle, bed", tool && `${number(tool.target_c)} °C${bed ? `, ${number(bed.target_c)} °C` : ""}`],
            ["Fan", fan && `${Math.round(100 * fan.duty)} %`],
            ["Object", name],
        ];
    }

    function scale(print, mode) {
        const range = print.coloring.ranges[mode], {unit, name} = lyr.colors.modes[mode];
        if (!(range.low <= range.high)) return [];
        const stops = Array.from({length: 9}, (_, i) => lyr.colors.css(lyr.colors.onScale(i / 8)));
        const ticks = [0, 0.5, 1].map((share) => number(range.low + share * (range.high - range.low)));
        return [
            element("h2", {}, `${name}, ${unit}`),
            element("div", {class: "scale", style: `background: linear-gradient(90deg, ${stops.join()})`}),
            element("div", {class: "ticks"}, ...ticks.map((tick) => element("span", {}, tick))),
        ];
    }

    // toggle(role) is called for a role's switch; role -1 are the travels.
    function roleTable(print, travelsShown, toggle) {
        const {sums, coloring} = print;
        const row = (role, name, sum) => {
            const shown = role < 0 ? travelsShown : !coloring.hidden.has(role);
            const color = coloring.mode === "role" && role >= 0 ? `background: ${lyr.colors.byRole[role]}` : "";
            const chip = element("span", {class: role < 0 ? "chip dashed" : "chip", style: color});
            const button = element("button", {
                "aria-pressed": shown, "data-role": role, title: "Show or hide", click: () => toggle(role),
            }, ...coloring.mode === "role" || role < 0 ? [chip] : [], capital(name));
            return element("tr", {}, element("td", {}, button), element("td", {}, number(sum.length_mm / 1000)),
                element("td", {}, role < 0 ? "" : number(sum.volume_mm3 / 1000)), element("td", {}, time(sum.time_s)));
        };
        const roles = [...sums.roles].sort((p, q) => q[1].time_s - p[1].time_s);
        return element("table", {class: "roles"},
            element("tr", {}, ...["", "m", "cm³", "time"].map((name) => element("th", {}, name))),
            ...roles.map(([role, sum]) => row(role, lyr.motions.roles[role], sum)),
            row(-1, "travels", sums.travel));
    }

    function totals(print) {
        const {sums} = print;
        return list([
            ["Motions", count(sums.motions)],
            ["of them arcs", count(sums.arcs)],
            ["Retractions", count(sums.retractions)],
        ]);
    }

    // Writes the panel anew.
    function fill(root, print, state, toggle) {
        const {coloring} = print;
        const surveyed = print.surveyed === print.layerCount ? "" : ` (${print.surveyed} of ${print.layerCount} layers)`;
        const scroll = root.scrollTop;
        root.replaceChildren(
            ...coloring.mode === "role" ? [] : scale(print, coloring.mode),
            element("h2", {}, `What is printed${surveyed}`), roleTable(print, state.travels, toggle), totals(print),
            element("h2", {}, `Layer ${state.high + 1}`), list(layerPairs(print, state.high)),
            element("h2", {}, "Print"), list(printPairs(print)),
        );
        root.scrollTop = scroll;
    }

    return {element, fill};
})();
