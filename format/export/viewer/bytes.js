// The numbers that a .lyr file is made of, and its checksum. docs/lyr-format.md is the specification.
"use strict";

lyr.bytes = (() => {
    // Eight tables, so that eight bytes are taken at a time.
    const tables = (() => {
        const polynomial = 0x82f63b78; // 0x1edc6f41 with its bits reflected
        const out = Array.from({length: 8}, () => new Uint32Array(256));
        for (let i = 0; i < 256; ++i) {
            let crc = i;
            for (let bit = 0; bit < 8; ++bit) crc = crc & 1 ? (crc >>> 1) ^ polynomial : crc >>> 1;
            out[0][i] = crc;
        }
        for (let i = 0; i < 256; ++i)
            for (let k = 1; k < 8; ++k)
                out[k][i] = (out[k - 1][i] >>> 8) ^ out[0][out[k - 1][i] & 0xff];
        return out;
    })();

    function crc32c(bytes, begin, end) {
        const [t0, t1, t2, t3, t4, t5, t6, t7] = tables;
        let crc = 0xffffffff | 0, at = begin;
        for (; at + 8 <= end; at += 8) {
            const low = crc ^ (bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16 | bytes[at + 3] << 24);
            crc = t7[low & 0xff] ^ t6[low >>> 8 & 0xff] ^ t5[low >>> 16 & 0xff] ^ t4[low >>> 24] ^
                t3[bytes[at + 4]] ^ t2[bytes[at + 5]] ^ t1[bytes[at + 6]] ^ t0[bytes[at + 7]];
        }
        for (; at < end; ++at) crc = (crc >>> 8) ^ t0[(crc ^ bytes[at]) & 0xff];
        return ~crc >>> 0;
    }

    function u16(bytes, at) {
        return bytes[at] | bytes[at + 1] << 8;
    }
    function u24(bytes, at) {
        return bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16;
    }
    function u32(bytes, at) {
        return u24(bytes, at) + bytes[at + 3] * 0x1000000;
    }
    // Exact up to 2^53, which no file reaches.
    function u64(bytes, at) {
        return u32(bytes, at) + u32(bytes, at + 4) * 0x100000000;
    }

    // Takes numbers from begin to end. What would go beyond gives 0 and makes the cursor bad.
    class Cursor {
        constructor(bytes, begin, end) {
            this.bytes = bytes;
            this.at = begin;
            this.end = end;
            this.bad = false;
        }

        atEnd() {
            return this.at >= this.end;
        }

        left() {
            return this.end - this.at;
        }

        skip(count) {
            if (count > this.left()) return this.fail();
            this.at += count;
            return 0;
        }

        byte() {
            if (this.at >= this.end) return this.fail();
            return this.bytes[this.at++];
        }

        // A double: exact up to 2^53. What is larger is in range nowhere but in a grid, which has bigSigned().
        varint() {
            const bytes = this.bytes;
            let at = this.at, value = bytes[at++];
            if (value >= 0x80) {
                let scale = 128;
                value -= 128;
                for (let i = 1;; ++i) {
                    const byte = bytes[at++];
                    if (!(byte < 0x80) && (i === 9 || at > this.end)) return this.fail();
                    if (i === 9 && byte > 1) return this.fail();
                    value += (byte & 0x7f) * scale;
                    if (byte < 0x80) break;
                    scale *= 128;
                }
            }
            if (at > this.end) return this.fail();
            this.at = at;
            return value;
        }

        signed() {
            const value = this.varint();
            if (value < 0x80000000) return (value >>> 1) ^ -(value & 1);
            return value % 2 === 0 ? value / 2 : -(value + 1) / 2;
        }

        // As BigInt: any 64 bits.
        bigSigned() {
            let value = 0n;
            for (let i = 0; i < 10; ++i) {
                const byte = this.byte();
                if (this.bad || (i === 9 && byte > 1)) return BigInt(this.fail());
                value |= BigInt(byte & 0x7f) << BigInt(7 * i);
                if (byte < 0x80) return value & 1n ? -(value + 1n) / 2n : value / 2n;
            }
            return BigInt(this.fail());
        }

        fail() {
            this.bad = true;
            this.at = this.end;
            return 0;
        }
    }

    // The bytes that a text in base64 stands for.
    function fromBase64(text) {
        return Uint8Array.fromBase64 ? Uint8Array.fromBase64(text) : pieceByPiece(text);
    }

    // For browsers without that.
    function pieceByPiece(text) {
        const clean = text.replace(/\s+/g, "");
        const padding = clean.endsWith("==") ? 2 : clean.endsWith("=") ? 1 : 0;
        const out = new Uint8Array(clean.length / 4 * 3 - padding);
        const piece = 1 << 20; // characters: what atob() makes of them stays small
        for (let begin = 0, at = 0; begin < clean.length; begin += piece) {
            const part = atob(clean.slice(begin, begin + piece));
            for (let i = 0; i < part.length; ++i) out[at++] = part.charCodeAt(i);
        }
        return out;
    }

    return {crc32c, u16, u24, u32, u64, Cursor, fromBase64, pieceByPiece};
})();
