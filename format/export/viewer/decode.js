// Carries out a layer's operations on paper: what the head does, motion by motion, and what the machine does between.
//
//     const layer = lyr.decode.layer(file, index);   // throws lyr.file.Damage, with layer and chunk in its text
//     layer.motions                                   // lyr.motions.Motions
//     layer.events                                    // [{before: number of a motion, what, ...}]
"use strict";

lyr.decode = (() => {
    const {Damage, coordinateLimit, largestSetting} = lyr.file;
    const {Grid, RowPredictor, limit: hatchLimit} = lyr.grid;
    const {Motions, kind, flag, roles} = lyr.motions;
    const {History} = lyr.packed;

    const code = {
        lines: 0x00, arcs: 0x10, climbingLines: 0x20, climbingArcs: 0x30, travel: 0x40, climbingTravel: 0x41,
        circleCcw: 0x42, circleCw: 0x43, helixCcw: 0x44, helixCw: 0x45, grid: 0x46, hatch: 0x47, smoothRun: 0x48,
        parallelRun: 0x49, repeatedRun: 0x4a, wipe: 0x4b, path: 0x50,
        width: 0x51, speed: 0x52, acceleration: 0x53, travelSpeed: 0x54, travelAcceleration: 0x55, retract: 0x56,
        temperature: 0x57, fan: 0x58, dwell: 0x59, tool: 0x5a, pause: 0x5b, object: 0x5c, firstSkippable: 0xf0,
    };
    // What a path states anew, lowest bit first, and how many of the file's units make one.
    const pathFields = [
        ["width_mm", 1e4], ["height_mm", 1e4], ["flow", 1e5], ["speed_mm_s", 100], ["acceleration_mm_s2", 1],
    ];
    const largestRow = 2 ** 32;
    const furthest = 2 ** 36; // of a parallel run, 1/16 quantum

    class Decoder {
        constructor(head) {
            this.motions = new Motions(head.operations + 16);
            this.events = [];
            this.at = head.start;
            this.path = null;
            this.travel = {
                role: -1, width_mm: 0, height_mm: 0, flow: 0, speed_mm_s: head.travelSpeed_mm_s,
                acceleration_mm_s2: head.travelAcceleration_mm_s2,
            };
            this.grid = null;
            this.predictor = new RowPredictor();
            this.history = new History();
            this.back = 0; // of the last parallel or repeated run
            this.distance = 0; // of the last parallel run
            this.noteStyle();
        }

        noteStyle() {
            this.style = this.path ? this.motions.styleNumber(this.path) : -1;
            this.travelStyle = this.motions.styleNumber(this.travel);
        }

        chunk(cursor, stated) {
            this.cursor = cursor;
            let operations = 0;
            while (!cursor.atEnd()) operations += this.operation(cursor.byte());
            if (cursor.bad) throw new Damage("a number is cut short or too long");
            if (operations !== stated) throw new Damage("it has another number of operations than it says");
        }

        // Returns how many operations it was.
        operation(op) {
            if (op < code.travel) {
                const count = (op & 15) + 1;
                for (let i = 0; i < count; ++i) this.runPiece(op & 0xf0);
                return count;
            }
            if (op >= code.smoothRun && op <= code.repeatedRun) return this.packedRun(op);
            if (op <= code.wipe) this.motion(op);
            else if (op >= code.path && op <= code.travelAcceleration) this.changeStyle(op);
            else if (op >= code.retract && op <= code.object) this.machine(op);
            else if (op >= code.firstSkippable) this.cursor.skip(this.cursor.varint());
            else throw new Damage("unknown operation");
            return 1;
        }

        setting(perUnit = 1) {
            const value = this.cursor.varint();
            if (value > largestSetting) throw new Damage("a number is out of range");
            return value / perUnit;
        }

        // The point that is as far from another as the cursor says.
        step(from, climbs) {
            const c = this.cursor;
            const to = {x: from.x + c.signed(), y: from.y + c.signed(), z: climbs ? from.z + c.signed() : from.z};
            return this.checked(to);
        }

        checked(point) {
            if (this.cursor.bad) throw new Damage("a number is cut short or too long");
            if (Math.abs(point.x) > coordinateLimit || Math.abs(point.y) > coordinateLimit ||
                Math.abs(point.z) > coordinateLimit)
                throw new Damage("a position is out of range");
            return point;
        }

        mustExtrude() {
            if (!this.path) throw new Damage("extrusion before a path begins");
        }

        runPiece(op) {
            const climbs = op >= code.climbingLines;
            if (op === code.lines || op === code.climbingLines) {
                const from = this.at, to = this.step(from, climbs);
                this.mustExtrude();
                if (!climbs && !same(from, to)) this.history.add(from, to, 0);
                this.line(to, 0);
                return;
            }
            const to = this.step(this.at, climbs), sagitta = this.cursor.signed();
            this.mustExtrude();
            if (!climbs) this.history.add(this.at, to, sagitta);
            this.arc(to, sagitta);
        }

        arc(to, sagitta) {
            checkArc(this.at, to, sagitta);
            this.motions.add(kind.arc, this.at, to, this.style, 0, sagitta, 0);
            this.at = to;
        }

        // Returns how many motions it was.
        packedRun(op) {
            const c = this.cursor;
            this.mustExtrude();
            if (op !== code.smoothRun) this.back += c.signed();
            if (op === code.parallelRun) this.distance += c.signed();
            const least = op === code.parallelRun ? 2 : 1;
            if (op !== code.smoothRun && (this.back < least || !this.history.before(this.back)))
                throw new Damage("a run leans on motions out of reach");
            if (Math.abs(this.distance) > furthest)
                throw new Damage("a run is too far from what it is parallel to");
            const count = c.varint(), orders = c.byte(), bits = new lyr.packed.Bits(c);
            if (count === 0) throw new Damage("a run has no motion");
            for (let i = 0; i < count && !c.bad; ++i) this.packedMotion(bits, orders, op);
            if (!bits.end()) throw new Damage("a run ends in bits that are not 0");
            return count;
        }

        packedMotion(bits, orders, op) {
            const from = this.at, {history} = this;
            let expected = {x: from.x, y: from.y, sagitta: 0};
            if (op === code.parallelRun)
                expected = lyr.packed.parallel(history.before(this.back), history.before(this.back - 1), this.distance / 16);
            if (op === code.repeatedRun) expected = lyr.packed.repeated(history.before(this.back), from);
            const x = bits.signed(orders & 15), y = bits.signed(orders & 15), more = bits.signed(orders >> 4);
            const to = this.checked({x: expected.x + x, y: expected.y + y, z: from.z});
            if (op === code.smoothRun)
                expected.sagitta = lyr.packed.smoothSagitta(history.before(1), from, to.x - from.x, to.y - from.y);
            const sagitta = expected.sagitta + more;
            if (same(from, to)) throw new Damage("a motion of a packed run has no length");
            history.add(from, to, sagitta);
            if (sagitta === 0) this.line(to, 0);
            else this.arc(to, sagitta);
        }

        line(to, flags) {
            if (!same(this.at, to)) this.motions.add(kind.line, this.at, to, this.style, flags, 0, 0);
            this.at = to;
        }

        travelTo(to, flags) {
            if (!same(this.at, to)) this.motions.add(kind.travel, this.at, to, this.travelStyle, flags, 0, 0);
            this.at = to;
        }

        motion(op) {
            switch (op) {
                case code.travel:
                case code.climbingTravel:
                    return this.travelTo(this.step(this.at, op === code.climbingTravel), 0);
                case code.grid:
                    return this.readGrid();
                case code.hatch:
                    return this.hatch();
                case code.wipe:
                    return this.wipe();
                default:
                    return this.circle(op === code.circleCcw || op === code.helixCcw, op >= code.helixCcw);
            }
        }

        circle(counterClockwise, climbs) {
            const from = this.at, center = this.step(from, climbs), to = {...from, z: center.z};
            this.mustExtrude();
            if (center.x === from.x && center.y === from.y) throw new Damage("a circle has no radius");
            this.motions.add(kind.circle, from, to, this.style, counterClockwise ? flag.counterClockwise : 0,
                center.x, center.y);
            this.at = to;
        }

        readGrid() {
            const numbers = Array.from({length: 4}, () => this.cursor.bigSigned());
            if (!Grid.inRange(...numbers)) throw new Damage("a grid is out of range");
            this.grid = new Grid(...numbers);
        }

        hatch() {
            const c = this.cursor, flags = c.byte();
            let row = c.signed(), left = c.varint();
            if (flags & ~3) throw new Damage("a hatch has a flag that is not known");
            if (!this.path) throw new Damage("extrusion before a path begins");
            if (!this.grid) throw new Damage("a hatch without a grid");
            if (Math.abs(row) > largestRow || left > largestRow) throw new Damage("a hatch row is out of range");
            const oneWay = (flags & 1) !== 0;
            let forward = (flags & 2) === 0;
            this.predictor.begin();
            while (left > 0) {
                const head = c.varint(), rows = c.varint(), intervals = Math.floor(head / 2);
                if (c.bad || rows === 0 || rows > left)
                    throw new Damage("a hatch has another number of rows than it says");
                if (intervals * rows > c.left() / 2) throw new Damage("a hatch row is cut short");
                if (intervals === 0)
                    for (let i = 0; i < Math.min(rows, 2); ++i) this.predictor.beginRow(0);
                else
                    for (let i = 0; i < rows; ++i)
                        this.hatchRow(row + i, intervals, head % 2 === 1, forward !== (!oneWay && i % 2 === 1));
                row += rows;
                left -= rows;
                if (!oneWay && rows % 2 === 1) forward = !forward;
            }
        }

        hatchRow(row, intervals, linked, forward) {
            const w = this.grid.row(row), ends = 2 * intervals;
            if (Math.abs(w) > hatchLimit) throw new Damage("a hatch row is out of range");
            this.predictor.beginRow(intervals);
            for (let i = 0; i < ends; ++i) {
                const j = forward ? i : ends - 1 - i;
                const u = this.predictor.predict(j) + this.cursor.signed();
                if (Math.abs(u) > hatchLimit) throw new Damage("a hatch line is out of range");
                this.predictor.note(j, u);
                const to = this.checked({x: this.grid.x(u, w), y: this.grid.y(u, w), z: this.at.z});
                if (i % 2 === 1) {
                    this.line(to, flag.fromHatch);
                } else if (i === 0 && linked) {
                    this.mustExtrude();
                    this.line(to, flag.fromHatch);
                } else {
                    this.travelTo(to, flag.fromHatch);
                }
            }
        }

        wipe() {
            const c = this.cursor, depth_mm = this.setting(1000), pieces = c.varint();
            this.events.push({before: this.motions.count, what: "wipe", depth_mm});
            for (let i = 0; i < pieces && !c.bad; ++i) {
                const from = this.at, to = this.step(from, false), sagitta = c.signed();
                if (sagitta !== 0) checkArc(from, to, sagitta);
                if (!same(from, to)) this.motions.add(kind.wipe, from, to, this.travelStyle, 0, sagitta, 0);
                this.at = to;
            }
        }

        changeStyle(op) {
            switch (op) {
                case code.path:
                    this.readPath();
                    break;
                case code.travelSpeed:
                    this.travel.speed_mm_s = this.setting(100);
                    break;
                case code.travelAcceleration:
                    this.travel.acceleration_mm_s2 = this.setting();
                    break;
                default:
                    if (!this.path) throw new Damage("a style is changed before a path begins");
                    if (op === code.width) this.path.width_mm = this.setting(1e4);
                    else if (op === code.speed) this.path.speed_mm_s = this.setting(100);
                    else this.path.acceleration_mm_s2 = this.setting();
            }
            this.noteStyle();
        }

        readPath() {
            const role = this.cursor.byte(), fields = this.cursor.byte();
            if (fields & ~31) throw new Damage("a path has a field that is not known");
            this.path ??= {role: 0, width_mm: 0, height_mm: 0, flow: 1, speed_mm_s: 0, acceleration_mm_s2: 0};
            this.path.role = role < roles.length ? role : 0;
            pathFields.forEach(([name, perUnit], bit) => {
                if (fields >> bit & 1) this.path[name] = this.setting(perUnit);
            });
        }

        machine(op) {
            const before = this.motions.count;
            const note = (what, values) => this.events.push({before, what, ...values});
            switch (op) {
                case code.retract:
                    return note("retract", {depth_mm: this.setting(1000)});
                case code.temperature: {
                    const heater = this.cursor.byte(), tool = this.setting();
                    const target_c = this.setting(10), wait = this.cursor.byte() !== 0;
                    if (heater > 2) throw new Damage("unknown heater");
                    return note("temperature", {heater, tool, target_c, wait});
                }
                case code.fan: {
                    const fan = this.setting(), duty = this.setting(1000);
                    if (duty > 1) throw new Damage("a fan's duty is above 1");
                    return note("fan", {fan, duty});
                }
                case code.dwell:
                    return note("dwell", {time_s: this.setting(1000)});
                case code.tool:
                    return note("tool", {tool: this.setting()});
                case code.pause:
                    return note("pause", {reason: this.cursor.byte()});
                default:
                    return note("object", {object: this.setting()});
            }
        }
    }

    function same(from, to) {
        return from.x === to.x && from.y === to.y && from.z === to.z;
    }

    function checkArc(from, to, sagitta) {
        const chord = Math.hypot(to.x - from.x, to.y - from.y);
        if (sagitta === 0 || Math.abs(sagitta) > lyr.arc.mostSagittaPerChord * chord)
            throw new Damage("an arc has no or too large a sagitta");
    }

    function layer(file, index) {
        const head = file.layers[index];
        const decoder = new Decoder(head);
        let chunk = 0, operations = 0;
        try {
            file.eachChunk(index, (cursor, stated) => {
                decoder.chunk(cursor, stated);
                operations += stated;
                ++chunk;
            });
            if (operations !== head.operations)
                throw new Damage("it has another number of operations than it says");
        } catch (error) {
            if (!(error instanceof Damage) || head.damage) throw error;
            throw new Damage(`layer ${index + 1}, chunk ${chunk + 1} of ${head.chunks}: ${error.message}`);
        }
        return {index, head, motions: decoder.motions, events: decoder.events};
    }

    return {layer};
})();
