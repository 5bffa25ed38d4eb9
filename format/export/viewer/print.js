// A print that is being looked at: its file, the layers that were decoded of it, its time, its colours and what it adds
// up to. Layers are decoded when they are asked for; one pass over all of them, a few milliseconds at a time, finds what
// only all can tell (ranges of colours, sums of roles).
"use strict";

lyr.print = (() => {
    const keptMotions = 1.5e6; // of decoded layers in memory, 60 bytes each
    const {kind} = lyr.motions;

    class RoleSums {
        constructor() {
            this.roles = new Map(); // role: {length_mm, volume_mm3, time_s}
            this.travel = {length_mm: 0, time_s: 0, count: 0};
            this.motions = 0;
            this.arcs = 0;
            this.retractions = 0;
        }

        take(layer, timing, quantum_mm) {
            const {motions} = layer;
            let before_s = 0;
            for (let i = 0; i < motions.count; ++i) {
                const length_mm = motions.length(i) * quantum_mm, time_s = timing.ends_s[i] - before_s;
                before_s = timing.ends_s[i];
                const style = motions.styles[motions.style[i]];
                const sum = style.role < 0 ? this.travel : this.ofRole(style.role);
                sum.length_mm += length_mm;
                sum.time_s += time_s;
                ++sum.count;
                if (style.role >= 0) sum.volume_mm3 += length_mm * style.area_mm2;
                if (motions.kind[i] === kind.arc || motions.kind[i] === kind.circle) ++this.arcs;
            }
            this.motions += motions.count;
            for (const event of layer.events)
                if (event.what === "retract" && event.depth_mm > 0) ++this.retractions;
        }

        ofRole(role) {
            if (!this.roles.has(role)) this.roles.set(role, {length_mm: 0, volume_mm3: 0, time_s: 0, count: 0});
            return this.roles.get(role);
        }
    }

    function noBox() {
        return {low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity]};
    }

    function widen(box, low, high) {
        for (let axis = 0; axis < 3; ++axis) {
            box.low[axis] = Math.min(box.low[axis], low[axis]);
            box.high[axis] = Math.max(box.high[axis], high[axis]);
        }
    }

    // With the strands' width.
    function extrudedBox(motions, quantum_mm) {
        const box = noBox();
        for (let i = 0; i < motions.count; ++i) {
            if (!motions.extrudes(i)) continue;
            const half = motions.styles[motions.style[i]].width_mm / 2;
            const take = (x, y, z) => widen(box, [x * quantum_mm - half, y * quantum_mm - half, z * quantum_mm],
                [x * quantum_mm + half, y * quantum_mm + half, z * quantum_mm]);
            take(motions.fromX[i], motions.fromY[i], motions.fromZ[i]);
            take(motions.toX[i], motions.toY[i], motions.toZ[i]);
            if (motions.isCurved(i)) lyr.arc.farthest(motions.shape(i), (x, y) => take(x, y, motions.toZ[i]));
        }
        return box;
    }

    class Print {
        constructor(bytes) {
            this.file = new lyr.file.PrintFile(bytes);
            this.quantum_mm = this.file.quantum_mm;
            this.schedule = new lyr.timing.Schedule(this.file.layers);
            this.coloring = new lyr.colors.Coloring(this.schedule);
            this.sums = new RoleSums();
            this.damaged = new Map(); // layer: what is wrong
            this.surveyed = 0; // layers
            this.boxes = new Map(); // layer: of what it extrudes, once it was decoded
            this.kept = new Map(); // decoded, the one used last at the end
            this.keptCount = 0;
        }

        get layerCount() {
            return this.file.layers.length;
        }

        // {low: [x, y, z], high: [...]} of what is extruded, mm: of layers that were not decoded yet, that of all motions.
        // The first and the last one are, as there the head comes from elsewhere, and goes.
        box() {
            for (const index of [0, this.layerCount - 1]) if (!this.boxes.has(index)) this.layer(index);
            const box = noBox(), {low, high} = box;
            this.file.layers.forEach((head, index) => {
                const own = this.boxes.get(index);
                if (own) widen(box, own.low, own.high);
                else if (!head.damage) widen(box, this.in_mm(head.low), this.in_mm(head.high));
            });
            return low[0] <= high[0] ? box : {low: [0, 0, 0], high: [1, 1, 1]};
        }

        in_mm(point) {
            return [point.x, point.y, point.z].map((quanta) => quanta * this.quantum_mm);
        }

        // Decoded, with timing; null: it is damaged.
        layer(index) {
            let layer = this.kept.get(index);
            if (layer) {
                this.kept.delete(index);
                this.kept.set(index, layer);
                return layer;
            }
            if (this.damaged.has(index)) return null;
            try {
                layer = lyr.decode.layer(this.file, index);
            } catch (error) {
                if (!(error instanceof lyr.file.Damage)) throw error;
                this.damaged.set(index, error.message);
                return null;
            }
            if (!this.boxes.has(index)) this.boxes.set(index, extrudedBox(layer.motions, this.quantum_mm));
            layer.timing = lyr.timing.spread(layer, this.quantum_mm);
            this.keep(layer);
            return layer;
        }

        keep(layer) {
            this.kept.set(layer.index, layer);
            this.keptCount += layer.motions.count;
            for (const [index, oldest] of this.kept) {
                if (this.keptCount <= keptMotions || index === layer.index) break;
                this.kept.delete(index);
                this.keptCount -= oldest.motions.count;
            }
        }

        // Looks at further layers for some time. False: all were seen.
        survey(budget_ms) {
            const until = performance.now() + budget_ms;
            while (this.surveyed < this.layerCount && performance.now() < until) {
                const index = this.surveyed++, layer = this.layer(index);
                if (layer) {
                    this.sums.take(layer, layer.timing, this.quantum_mm);
                    this.schedule.set(index, layer.timing.duration_s);
                    this.coloring.take(layer.motions, layer.timing.duration_s);
                }
            }
            this.schedule.update();
            return this.surveyed < this.layerCount;
        }
    }

    return {Print};
})();
