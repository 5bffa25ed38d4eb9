// The motions of a print as instances for the graphics card: one per line or arc, a circle is two. They are kept in
// streams of one kind, each in the order of the print, so that any range of layers and any moment of the print is one
// stretch of each stream. Streams tell apart what is drawn with as many segments (lines, arcs from short to long) and
// what lies outside of a part from what lies within.
"use strict";

lyr.strands = (() => {
    const {kind} = lyr.motions;

    // from x, y, z, to x, y, z, tangent of a quarter of the turn (0: straight); then width and height in um, 16 bits
    // each, number of the style, number of the layer.
    const wordsPerInstance = 10;
    const instancesPerPage = 16384; // of one buffer
    const instancesPerBlock = 512; // that are seen or not seen together
    const shell = new Set([0, 1, 3, 4, 8, 9, 13, 14, 15, 16, 17, 18]); // roles that can be seen from outside

    // An arc needs turn x sqrt(radius / (8 error)) segments; classes by turn x sqrt(radius), in sqrt(mm).
    const arcClasses = [0.4, 1.6, 6.4, Infinity];

    class Stream {
        constructor(name) {
            Object.assign(this, name); // {travel} or {inside, arc}
            this.count = 0;
            this.layerStarts = [0];
            this.pages = [];
            this.need = 0; // largest turn x sqrt(radius) in it
        }

        slot() {
            const at = this.count % instancesPerPage;
            if (at === 0) {
                const words = new ArrayBuffer(4 * wordsPerInstance * instancesPerPage);
                this.pages.push({
                    floats: new Float32Array(words), uints: new Uint32Array(words), fresh: true, buffer: null,
                    boxes: new Float32Array(6 * instancesPerPage / instancesPerBlock).fill(NaN),
                });
            }
            ++this.count;
            const page = this.pages[this.pages.length - 1];
            page.fresh = true;
            return {page, at};
        }

        add(from, to, quarter, bulge, packed, style, layer) {
            const {page, at} = this.slot(), base = at * wordsPerInstance;
            page.floats.set(from, base);
            page.floats.set(to, base + 3);
            page.floats[base + 6] = quarter;
            page.uints[base + 7] = packed;
            page.uints[base + 8] = style;
            page.uints[base + 9] = layer;
            this.widen(page.boxes, 6 * Math.floor(at / instancesPerBlock), from, to, bulge);
        }

        widen(boxes, at, from, to, bulge) {
            for (let axis = 0; axis < 3; ++axis) {
                const low = Math.min(from[axis], to[axis]) - bulge, high = Math.max(from[axis], to[axis]) + bulge;
                if (!(boxes[at + axis] <= low)) boxes[at + axis] = low;
                if (!(boxes[at + 3 + axis] >= high)) boxes[at + 3 + axis] = high;
            }
        }
    }

    class Strands {
        constructor(quantum_mm) {
            this.quantum_mm = quantum_mm;
            this.layers = 0; // that were added
            this.instances = 0;
            this.styles = [];
            this.styleNumbers = new Map();
            this.streams = [];
            for (const inside of [false, true])
                for (let arc = 0; arc <= arcClasses.length; ++arc) this.streams.push(new Stream({inside, arc}));
            this.travels = new Stream({travel: true, arc: arcClasses.length});
            this.streams.push(this.travels);
        }

        streamOf(style, need) {
            if (style.role < 0) return this.travels;
            const arc = need === 0 ? 0 : 1 + arcClasses.findIndex((most) => need <= most);
            return this.streams[(shell.has(style.role) ? 0 : arcClasses.length + 1) + arc];
        }

        globalStyle(style) {
            const key = `${style.role},${style.speed_mm_s},${style.area_mm2}`;
            let number = this.styleNumbers.get(key);
            if (number === undefined) {
                number = this.styles.push(style) - 1;
                this.styleNumbers.set(key, number);
            }
            return number;
        }

        // The next layer; null: one that is left out.
        add(layer) {
            if (layer) {
                const {motions} = layer;
                const numbers = motions.styles.map((style) => this.globalStyle(style));
                for (let i = 0; i < motions.count; ++i) this.addMotion(motions, i, numbers, layer.index);
            }
            ++this.layers;
            for (const stream of this.streams) stream.layerStarts.push(stream.count);
        }

        addMotion(motions, i, numbers, layer) {
            const q = this.quantum_mm, style = motions.styles[motions.style[i]];
            const packed = Math.min(65535, Math.round(style.width_mm * 1000)) |
                Math.min(65535, Math.round(style.height_mm * 1000)) << 16;
            const from = [motions.fromX[i] * q, motions.fromY[i] * q, motions.fromZ[i] * q];
            const to = [motions.toX[i] * q, motions.toY[i] * q, motions.toZ[i] * q];
            const put = (begin, end, quarter, need, bulge) => {
                const stream = this.streamOf(style, need);
                stream.need = Math.max(stream.need, need);
                stream.add(begin, end, quarter, bulge + style.width_mm, packed, numbers[motions.style[i]], layer);
                ++this.instances;
            };
            if (!motions.isCurved(i)) return put(from, to, 0, 0, 0);
            const arc = motions.shape(i), radius = arc.radius * q;
            if (motions.kind[i] === kind.circle) {
                const middle = [2 * arc.x * q - from[0], 2 * arc.y * q - from[1], (from[2] + to[2]) / 2];
                const quarter = Math.sign(arc.sweep), need = Math.PI * Math.sqrt(radius);
                put(from, middle, quarter, need, radius);
                return put(middle, to, quarter, need, radius);
            }
            const chord = Math.hypot(to[0] - from[0], to[1] - from[1]), quarter = 2 * motions.a[i] * q / chord;
            return put(from, to, quarter, Math.abs(arc.sweep) * Math.sqrt(radius), Math.abs(motions.a[i]) * q +
                (Math.abs(quarter) > 1 ? radius : 0));
        }

        // How many instances of each stream the first `done` motions of a layer are.
        countsWithin(layer, done) {
            const counts = new Map(this.streams.map((stream) => [stream, 0]));
            const {motions} = layer, q = this.quantum_mm;
            for (let i = 0; i < done; ++i) {
                let need = 0;
                if (motions.isCurved(i)) {
                    const arc = motions.shape(i), circle = motions.kind[i] === kind.circle;
                    need = (circle ? Math.PI : Math.abs(arc.sweep)) * Math.sqrt(arc.radius * q);
                }
                const stream = this.streamOf(motions.styles[motions.style[i]], need);
                counts.set(stream, counts.get(stream) + (motions.kind[i] === kind.circle ? 2 : 1));
            }
            return counts;
        }
    }

    return {Strands, wordsPerInstance, instancesPerPage, instancesPerBlock};
})();
