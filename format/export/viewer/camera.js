// Where one looks from in space: round a target, at a distance, from a side (azimuth) and a height (elevation).
"use strict";

lyr.camera = (() => {
    const opening_rad = 0.6; // of the view, upright: a little long, so that upright edges look upright
    const steepest_rad = Math.PI / 2 - 0.001;

    const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const along = (a, b, share) => [a[0] + share * b[0], a[1] + share * b[1], a[2] + share * b[2]];

    class Camera {
        constructor(box) {
            this.box = box; // {low: [x, y, z], high: [...]}, mm
            this.fit(1);
        }

        fit(aspect) {
            const {low, high} = this.box;
            this.azimuth = -Math.PI / 3;
            this.elevation = 0.55;
            this.target = low.map((value, i) => (value + high[i]) / 2);
            this.radius = Math.max(1, Math.hypot(...low.map((value, i) => high[i] - value)) / 2);
            // The ball around the box touches the sides of the narrower opening.
            const narrow_rad = Math.atan(Math.tan(opening_rad / 2) * Math.min(1, aspect));
            this.distance = this.radius / Math.sin(narrow_rad);
        }

        // Unit vectors: to the right, upwards on the screen, and towards the eye.
        axes() {
            const ca = Math.cos(this.azimuth), sa = Math.sin(this.azimuth);
            const ce = Math.cos(this.elevation), se = Math.sin(this.elevation);
            return {right: [-sa, ca, 0], up: [-se * ca, -se * sa, ce], back: [ce * ca, ce * sa, se]};
        }

        eye() {
            return along(this.target, this.axes().back, this.distance);
        }

        mmPerPixel(height) {
            return 2 * this.distance * Math.tan(opening_rad / 2) / height;
        }

        orbit(dx_px, dy_px) {
            this.azimuth -= dx_px * 0.008;
            this.elevation = Math.min(steepest_rad, Math.max(-steepest_rad, this.elevation + dy_px * 0.008));
        }

        pan(dx_px, dy_px, height) {
            const {right, up} = this.axes(), unit = this.mmPerPixel(height);
            this.target = along(along(this.target, right, -dx_px * unit), up, dy_px * unit);
        }

        // Nearer (factor > 1), so that what is at an offset of the middle stays where it is.
        zoom(factor, dx_px, dy_px, height) {
            const before = this.mmPerPixel(height);
            this.distance = Math.min(20 * this.radius, Math.max(0.5, this.distance / factor));
            const moved = before - this.mmPerPixel(height);
            const {right, up} = this.axes();
            this.target = along(along(this.target, right, dx_px * moved), up, -dy_px * moved);
        }

        // Column by column, for WebGL.
        matrix(aspect) {
            const {right, up, back} = this.axes(), eye = this.eye();
            const reach = this.distance + 2 * this.radius +
                Math.hypot(...this.target.map((v, i) => v - (this.box.low[i] + this.box.high[i]) / 2));
            const near = Math.max(this.distance * 0.02, this.distance - 3 * this.radius), far = reach + near;
            const f = 1 / Math.tan(opening_rad / 2);
            const a = (far + near) / (near - far), b = 2 * far * near / (near - far);
            const view = (axis) => [axis[0], axis[1], axis[2], -dot(axis, eye)];
            const x = view(right).map((v) => v * f / aspect), y = view(up).map((v) => v * f), z = view(back);
            const out = new Float32Array(16);
            for (let column = 0; column < 4; ++column) {
                const last = column === 3 ? 1 : 0;
                out[4 * column] = x[column];
                out[4 * column + 1] = y[column];
                out[4 * column + 2] = a * z[column] + b * last;
                out[4 * column + 3] = -z[column];
            }
            return out;
        }
    }

    // Could a box (low x, y, z, high x, y, z at `at`) be seen? A box that is beyond one side of the view cannot.
    function seen(matrix, boxes, at) {
        let left = 0, right = 0, below = 0, above = 0, behind = 0;
        for (let corner = 0; corner < 8; ++corner) {
            const x = boxes[at + (corner & 1 ? 3 : 0)], y = boxes[at + (corner & 2 ? 4 : 1)];
            const z = boxes[at + (corner & 4 ? 5 : 2)];
            const w = matrix[3] * x + matrix[7] * y + matrix[11] * z + matrix[15];
            const px = matrix[0] * x + matrix[4] * y + matrix[8] * z + matrix[12];
            const py = matrix[1] * x + matrix[5] * y + matrix[9] * z + matrix[13];
            if (px < -w) ++left;
            if (px > w) ++right;
            if (py < -w) ++below;
            if (py > w) ++above;
            if (w <= 0) ++behind;
        }
        return left < 8 && right < 8 && below < 8 && above < 8 && behind < 8;
    }

    return {Camera, seen};
})();
