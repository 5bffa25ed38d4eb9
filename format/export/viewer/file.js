// A .lyr file in memory: what it says about itself, and where its layers are. Only what is asked for is read; nothing is
// used before its checksum was found right. docs/lyr-format.md is the specification.
//
//     const file = new lyr.file.PrintFile(bytes);   // throws lyr.file.Damage
//     file.layers[7].z_mm                            // heads of all layers
//     lyr.decode.layer(file, 7)                      // its motions
"use strict";

lyr.file = (() => {
    const {crc32c, u16, u24, u32, u64, Cursor} = lyr.bytes;

    const blockType = {metadata: 1, layer: 2, chunk: 3, index: 4, end: 5, thumbnail: 0x81, configuration: 0x82};
    const skippable = 0x80;
    const frameBytes = 8, headBytes = 4, prologueBytes = 16, endPayloadBytes = 36;
    const largestSetting = 0xffffffff, coordinateLimit = 0x7fffffff;

    // What is wrong with the file, for people.
    class Damage extends Error {}

    // The block at an offset: type, and payload from begin to end. Its checksum is looked at unless told otherwise.
    function blockAt(bytes, offset, check = true) {
        if (offset + frameBytes > bytes.length) throw new Damage(`the file is cut short at byte ${bytes.length}`);
        const type = bytes[offset], begin = offset + headBytes, end = begin + u24(bytes, offset + 1);
        if (end + 4 > bytes.length) throw new Damage(`the file is cut short at byte ${bytes.length}`);
        if (check && crc32c(bytes, offset, end) !== u32(bytes, end))
            throw new Damage(`the block at byte ${offset} has a wrong checksum`);
        return {type, begin, end, next: end + 4};
    }

    function parseMetadata(text) {
        const out = {objects: [], values: new Map()};
        for (const line of text.split("\n")) {
            const equals = line.indexOf("=");
            if (equals < 0) continue;
            const key = line.slice(0, equals);
            const value = line.slice(equals + 1).replace(/\\(n|\\)/g, (_, c) => c === "n" ? "\n" : "\\");
            if (key === "object") out.objects.push(value);
            else out.values.set(key, value);
        }
        return out;
    }

    function listOf(cursor, most, read) {
        const count = cursor.varint(), out = [];
        if (count > most) cursor.fail();
        for (let i = 0; i < count && !cursor.bad; ++i) out.push(read());
        return out;
    }

    // The layer block's fields, in their order.
    function parseLayer(bytes, begin, end, quantum_mm) {
        const c = new Cursor(bytes, begin, end);
        const setting = (perUnit) => {
            const value = c.varint();
            return value > largestSetting ? c.fail() : value / perUnit;
        };
        const point = (from) => ({x: from.x + c.signed(), y: from.y + c.signed(), z: from.z + c.signed()});
        const out = {};
        out.index = setting(1);
        out.start = point({x: 0, y: 0, z: 0});
        out.z_mm = out.start.z * quantum_mm;
        out.height_mm = setting(1e4);
        out.travelSpeed_mm_s = setting(100);
        out.travelAcceleration_mm_s2 = setting(1);
        out.tool = setting(1);
        out.object = setting(1);
        out.retracted_mm = setting(1000);
        out.retractLength_mm = setting(1000);
        out.retractSpeed_mm_s = setting(100);
        out.unretractSpeed_mm_s = setting(100);
        out.heaters = listOf(c, 16, () => ({kind: setting(1), tool: setting(1), target_c: setting(10)}));
        out.fans = listOf(c, 8, () => ({fan: setting(1), duty: setting(1000)}));
        out.estimate_s = c.varint() / 1000;
        out.chunks = setting(1);
        out.operations = c.varint();
        out.low = point(out.start);
        out.high = point(out.low);
        out.extruded_mm = c.varint() * quantum_mm;
        out.travel_mm = c.varint() * quantum_mm;
        out.volume_mm3 = c.varint() / 1e6;
        if (c.bad) throw new Damage("a layer's head is cut short or out of range");
        for (const p of [out.start, out.low, out.high])
            if (Math.max(Math.abs(p.x), Math.abs(p.y), Math.abs(p.z)) > coordinateLimit)
                throw new Damage("a layer's head is out of range");
        return out;
    }

    class PrintFile {
        constructor(bytes) {
            this.bytes = bytes;
            this.warnings = [];
            this.thumbnails = [];
            this.configuration = "";
            this.readPrologue();
            const first = this.readFront();
            const offsets = this.readIndex() ?? this.findLayers(first);
            this.layers = [];
            for (const offset of offsets) this.layers.push(this.headOrGap(offset));
        }

        readPrologue() {
            const bytes = this.bytes;
            if (bytes.length < prologueBytes || u32(bytes, 0) !== 0x1a52594c) throw new Damage("this is no .lyr file");
            if (crc32c(bytes, 0, 12) !== u32(bytes, 12)) throw new Damage("the prologue has a wrong checksum");
            this.version = {major: u16(bytes, 4), minor: u16(bytes, 6)};
            if (this.version.major !== 1)
                throw new Damage(`version ${this.version.major} of the format is newer than this page`);
            this.quantum_mm = u32(bytes, 8) / 1e6;
        }

        // Metadata, configuration and thumbnails. Returns where the first block behind them is.
        readFront() {
            const text = new TextDecoder();
            const metadata = blockAt(this.bytes, prologueBytes);
            if (metadata.type !== blockType.metadata) throw new Damage("the metadata is missing");
            this.metadata = parseMetadata(text.decode(this.bytes.subarray(metadata.begin, metadata.end)));
            let at = metadata.next;
            while (this.bytes[at] & skippable) {
                const block = blockAt(this.bytes, at);
                const payload = this.bytes.subarray(block.begin, block.end);
                if (block.type === blockType.configuration) this.configuration = text.decode(payload);
                if (block.type === blockType.thumbnail && payload.length > 8)
                    this.thumbnails.push({
                        width: u32(payload, 0), height: u32(payload, 4), png: payload.subarray(8),
                    });
                at = block.next;
            }
            return at;
        }

        // None: it is damaged, and the layers must be looked for.
        readIndex() {
            try {
                const end = blockAt(this.bytes, this.bytes.length - frameBytes - endPayloadBytes);
                const count = u32(this.bytes, end.begin);
                this.operations = u64(this.bytes, end.begin + 12);
                const index = blockAt(this.bytes, u64(this.bytes, end.begin + 28));
                if (end.type !== blockType.end || index.type !== blockType.index ||
                    index.end - index.begin !== 8 * count || u64(this.bytes, end.begin + 20) !== this.bytes.length)
                    throw new Damage("the index does not fit the file");
                return Array.from({length: count}, (_, i) => u64(this.bytes, index.begin + 8 * i));
            } catch (error) {
                if (!(error instanceof Damage)) throw error;
                this.warnings.push(`${error.message}; its layers were found without the index`);
                return null;
            }
        }

        // From block to block, up to the first that is not whole.
        findLayers(at) {
            const out = [];
            try {
                for (let block; at < this.bytes.length; at = block.next) {
                    block = blockAt(this.bytes, at, this.bytes[at] !== blockType.chunk);
                    if (block.type === blockType.layer) out.push(at);
                }
            } catch (error) {
                if (!(error instanceof Damage)) throw error;
            }
            this.operations = 0;
            return out;
        }

        // A layer's head or, where it is damaged, what stands for it: no chunk, at the height of the layer before.
        headOrGap(offset) {
            const index = this.layers.length, before = this.layers[index - 1];
            try {
                const head = this.readLayerHead(offset);
                if (head.index !== index) throw new Damage(`it says that it is layer ${head.index + 1}`);
                return head;
            } catch (error) {
                if (!(error instanceof Damage)) throw error;
                const origin = {x: 0, y: 0, z: 0};
                return {
                    ...before ?? {
                        start: origin, low: origin, high: origin, z_mm: 0, height_mm: 0, heaters: [], fans: [], tool: 0,
                        object: 0, travelSpeed_mm_s: 0, travelAcceleration_mm_s2: 0, retracted_mm: 0,
                    },
                    index, estimate_s: 0, chunks: 0, operations: 0, extruded_mm: 0, travel_mm: 0, volume_mm3: 0,
                    damage: `layer ${index + 1}: ${error.message}`,
                };
            }
        }

        readLayerHead(offset) {
            const block = blockAt(this.bytes, offset);
            if (block.type !== blockType.layer) throw new Damage(`there is no layer at byte ${offset}`);
            const head = parseLayer(this.bytes, block.begin, block.end, this.quantum_mm);
            head.chunksAt = block.next;
            return head;
        }

        // Calls use(cursor, operations) for each chunk of a layer, in order.
        eachChunk(index, use) {
            const head = this.layers[index];
            if (head.damage) throw new Damage(head.damage);
            for (let at = head.chunksAt, number = 0; number < head.chunks;) {
                const block = blockAt(this.bytes, at);
                at = block.next;
                if (block.type & skippable) continue;
                if (block.type !== blockType.chunk) throw new Damage("a chunk is missing");
                const cursor = new Cursor(this.bytes, block.begin, block.end);
                if (cursor.varint() !== index || cursor.varint() !== number)
                    throw new Damage("a chunk is out of order");
                use(cursor, cursor.varint());
                ++number;
            }
        }
    }

    return {Damage, PrintFile, coordinateLimit, largestSetting};
})();
