// Reads the print that the page carries, and shows it. `lyr.shown` is the page, for tests and for the curious:
// lyr.drawn(layer) tells what is drawn of a layer, lyr.drawnInSpace(layer) what the graphics card is given of it.
"use strict";

(() => {
    // What a canvas would be told, in mm of the bed.
    class Recorder {
        constructor(frame) {
            this.frame = frame;
            this.strokes = [];
            this.path = [];
        }
        x(px) {
            return this.frame.x_mm + (px - this.frame.width / 2) / this.frame.scale;
        }
        y(px) {
            return this.frame.y_mm - (px - this.frame.height / 2) / this.frame.scale;
        }
        beginPath() {
            this.path = [];
        }
        moveTo(x, y) {
            this.path.push(["move", this.x(x), this.y(y)]);
        }
        lineTo(x, y) {
            this.path.push(["line", this.x(x), this.y(y)]);
        }
        arc(x, y, radius, start, end, counterClockwise) {
            this.path.push(["arc", this.x(x), this.y(y), radius / this.frame.scale, -start, -end, counterClockwise]);
        }
        stroke() {
            this.strokes.push({
                color: this.strokeStyle, width_mm: this.lineWidth / this.frame.scale, path: this.path,
            });
        }
    }

    function drawn(print, index, scale = 1000) {
        const {low, high} = print.box(), size = Math.hypot(high[0] - low[0], high[1] - low[1]) * scale + 100;
        const frame = {x_mm: (low[0] + high[0]) / 2, y_mm: (low[1] + high[1]) / 2, scale, width: size, height: size};
        const layer = print.layer(index), strands = new Recorder(frame), ways = new Recorder(frame);
        const options = {coloring: print.coloring, quantum_mm: print.quantum_mm};
        for (const step of lyr.planView.strokes(strands, frame, layer, options)) void step;
        const colors = {travelColor: "travel", wipeColor: "wipe"};
        for (const step of lyr.planView.ways(ways, frame, layer, {...options, ...colors})) void step;
        return {strands: strands.strokes, ways: ways.strokes};
    }

    function drawnInSpace(strands, index) {
        const {wordsPerInstance, instancesPerPage} = lyr.strands, out = [];
        for (const stream of strands.streams)
            for (let at = stream.layerStarts[index]; at < stream.layerStarts[index + 1]; ++at) {
                const page = stream.pages[Math.floor(at / instancesPerPage)];
                const base = at % instancesPerPage * wordsPerInstance;
                const packed = page.uints[base + 7], style = strands.styles[page.uints[base + 8]];
                out.push({
                    values: [...page.floats.subarray(base, base + 7)], role: style.role,
                    width_mm: (packed & 0xffff) / 1000, height_mm: (packed >>> 16) / 1000,
                });
            }
        return out;
    }

    function complain(error) {
        const notice = document.getElementById("notice");
        notice.textContent = `This print cannot be shown: ${error.message}.`;
        notice.classList.add("bad");
        notice.hidden = false;
    }

    const carrier = document.getElementById("print-file");
    try {
        const print = new lyr.print.Print(lyr.bytes.fromBase64(carrier.textContent));
        carrier.remove(); // its text is half as large again as the file
        const name = print.file.metadata.values.get("source") || document.title;
        document.getElementById("title").textContent = name;
        if (print.layerCount === 0) throw new lyr.file.Damage("it has no whole layer");
        const page = new lyr.page.Page(print);
        lyr.shown = page;
        lyr.drawn = (index, scale) => drawn(print, index, scale);
        lyr.drawnInSpace = (index) => drawnInSpace(page.space.strands, index);
    } catch (error) {
        if (!(error instanceof lyr.file.Damage)) throw error;
        complain(error);
    }
})();
