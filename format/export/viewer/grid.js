// The grid on which hatch runs lie, in whole numbers. They need 64 bits; here each is held as two doubles, high and low
// part, so that every product and sum is below 2^53 and hence exact, and the halves of a floor are taken one by one:
// floor((h 2^n + l) / 2^m) = floor((h + floor(l / 2^n)) / 2^(m-n)).
"use strict";

lyr.grid = (() => {
    const limit = 3 * 2 ** 30; // of u and w
    const offsetLimit = 3n << 54n;
    const one = 1n << 30n;

    class Grid {
        // BigInt as in the file.
        constructor(a, b, offset, pitch) {
            this.offset = offset;
            this.pitch = pitch;
            this.aHigh = Number(a >> 15n);
            this.aLow = Number(a & 0x7fffn);
            this.bHigh = Number(b >> 15n);
            this.bLow = Number(b & 0x7fffn);
            this.offsetHigh = Number(offset >> 24n);
            this.offsetLow = Number(offset & 0xffffffn);
            this.pitchHigh = Number(pitch >> 24n);
            this.pitchLow = Number(pitch & 0xffffffn);
        }

        static inRange(a, b, offset, pitch) {
            const within = (value, most) => value >= -most && value <= most;
            return within(a, one) && within(b, one) && within(a * a + b * b - one * one, 2n * one) &&
                within(offset, offsetLimit) && within(pitch, offsetLimit);
        }

        // How far row k lies to the left; beyond the limit it is out of range.
        row(k) {
            if (Math.abs(k) >= 2 ** 28 || this.pitchHigh > 2 ** 24 || this.pitchHigh < -(2 ** 24))
                return Number((this.offset + BigInt(k) * this.pitch + 0x800000n) >> 24n);
            return this.offsetHigh + k * this.pitchHigh +
                Math.floor((this.offsetLow + k * this.pitchLow + 0x800000) / 0x1000000);
        }

        x(u, w) {
            const low = u * this.aLow - w * this.bLow + 0x20000000;
            return Math.floor((u * this.aHigh - w * this.bHigh + Math.floor(low / 0x8000)) / 0x8000);
        }

        y(u, w) {
            const low = u * this.bLow + w * this.aLow + 0x20000000;
            return Math.floor((u * this.bHigh + w * this.aHigh + Math.floor(low / 0x8000)) / 0x8000);
        }
    }

    // What a row's ends will probably be, from the two rows before.
    class RowPredictor {
        constructor() {
            this.rows = [new Float64Array(64), new Float64Array(64), new Float64Array(64)];
            this.begin();
        }

        // Of a hatch operation.
        begin() {
            this.counts = [0, 0, 0];
            this.last = 0;
            this.order = 0;
        }

        beginRow(intervals) {
            this.rows.unshift(this.rows.pop());
            this.counts = [intervals, this.counts[0], this.counts[1]];
            const known = intervals <= 32 && this.counts[1] === intervals;
            this.order = !known ? 0 : this.counts[2] === intervals ? 2 : 1;
        }

        predict(j) {
            if (this.order === 0) return this.last;
            return this.order === 1 ? this.rows[1][j] : 2 * this.rows[1][j] - this.rows[2][j];
        }

        note(j, value) {
            if (j < 64) this.rows[0][j] = value;
            this.last = value;
        }
    }

    return {Grid, RowPredictor, limit};
})();
