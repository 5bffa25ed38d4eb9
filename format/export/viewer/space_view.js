// Draws a print in space with WebGL 2. What is drawn are the instances of lyr.strands.
//
//     const view = lyr.spaceView.create(canvas, strands, box);   // null: no WebGL 2 here
//     view.begin(wanted, 1);
//     view.drawSome(view.plan(wanted, matrix, mmPerPixel), 0, Infinity, 0);
//     view.finish();
"use strict";

lyr.spaceView = (() => {
    const {wordsPerInstance, instancesPerPage, instancesPerBlock} = lyr.strands;
    const tableWidth = 1024;
    const error_px = 0.3; // of a chord from its arc
    const mostSegments = 512;
    const tube_px = 6; // strands that are wider get a true section
    const tubeSides = 10;
    const mostVertices = 6e6; // of a picture of tubes
    const bedStep_mm = 10;
    const wantedSamples = 4; // of a pixel

    function vertexCount(sides, segments) {
        return sides ? 6 * sides * (segments + 4) : 4 * (segments + 1) + 2;
    }

    function compile(gl, vertex, fragment) {
        const program = gl.createProgram();
        for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
            const shader = gl.createShader(type);
            gl.shaderSource(shader, source);
            gl.compileShader(shader);
            if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
            gl.attachShader(program, shader);
        }
        gl.linkProgram(program);
        if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
        const uniforms = {};
        for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); ++i) {
            const {name} = gl.getActiveUniform(program, i);
            uniforms[name] = gl.getUniformLocation(program, name);
        }
        return {program, uniforms};
    }

    class SpaceView {
        constructor(gl, canvas, strands, box) {
            this.gl = gl;
            this.canvas = canvas;
            this.strands = strands;
            this.strandProgram = compile(gl, lyr.shaders.strandVertex, lyr.shaders.strandFragment);
            this.lineProgram = compile(gl, lyr.shaders.lineVertex, lyr.shaders.lineFragment);
            this.tables = [gl.createTexture(), gl.createTexture()];
            this.bed = this.makeBed(box);
            gl.enable(gl.DEPTH_TEST);
        }

        makeBed({low, high}) {
            const gl = this.gl, step = bedStep_mm, points = [];
            const [x0, y0] = [low[0], low[1]].map((v) => step * (Math.floor(v / step) - 1));
            const [x1, y1] = [high[0], high[1]].map((v) => step * (Math.ceil(v / step) + 1));
            const sparse = Math.max(1, Math.ceil(Math.max(x1 - x0, y1 - y0) / step / 60)) * step;
            for (let x = x0; x <= x1; x += sparse) points.push(x, y0, 0, x, y1, 0);
            for (let y = y0; y <= y1; y += sparse) points.push(x0, y, 0, x1, y, 0);
            const array = gl.createVertexArray();
            gl.bindVertexArray(array);
            gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
            gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(points), gl.STATIC_DRAW);
            gl.enableVertexAttribArray(0);
            gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
            return {array, count: points.length / 3};
        }

        // Colours [r, g, b, a] (0 to 255) of all styles (a = 0: hidden, 128: a travel, 224: a strand that lies, 255: one
        // of a wall) and layers.
        setColors(styles, layers) {
            const gl = this.gl;
            [styles, layers].forEach((list, unit) => {
                const rows = Math.max(1, Math.ceil(list.length / tableWidth));
                const texels = new Uint8Array(4 * tableWidth * rows);
                list.forEach((color, i) => texels.set(color, 4 * i));
                gl.activeTexture(gl.TEXTURE0 + unit);
                gl.bindTexture(gl.TEXTURE_2D, this.tables[unit]);
                gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, tableWidth, rows, 0, gl.RGBA, gl.UNSIGNED_BYTE, texels);
                gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
                gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
            });
        }

        // Brings a page's instances to the card if they are not there.
        usePage(page) {
            const gl = this.gl;
            if (!page.buffer) {
                page.buffer = gl.createBuffer();
                page.array = gl.createVertexArray();
                gl.bindVertexArray(page.array);
                for (let i = 0; i < 6; ++i) {
                    gl.enableVertexAttribArray(i);
                    gl.vertexAttribDivisor(i, 1);
                }
                page.first = -1;
            } else {
                gl.bindVertexArray(page.array);
            }
            gl.bindBuffer(gl.ARRAY_BUFFER, page.buffer);
            if (page.fresh) gl.bufferData(gl.ARRAY_BUFFER, page.uints, gl.STATIC_DRAW);
            page.fresh = false;
        }

        drawRun(page, first, count, vertices, mode) {
            const gl = this.gl, stride = 4 * wordsPerInstance, at = first * stride;
            this.usePage(page);
            if (page.first !== first) {
                gl.vertexAttribPointer(0, 3, gl.FLOAT, false, stride, at);
                gl.vertexAttribPointer(1, 3, gl.FLOAT, false, stride, at + 12);
                gl.vertexAttribPointer(2, 1, gl.FLOAT, false, stride, at + 24);
                for (let i = 0; i < 3; ++i)
                    gl.vertexAttribIPointer(3 + i, 1, gl.UNSIGNED_INT, stride, at + 28 + 4 * i);
                page.first = first;
            }
            gl.drawArraysInstanced(mode, 0, vertices, count);
        }

        // Stretches of a stream that can be seen, [[page, first, count], ...].
        runs(stream, begin, end, matrix) {
            const out = [];
            for (let at = begin; at < end;) {
                const page = stream.pages[Math.floor(at / instancesPerPage)], first = at % instancesPerPage;
                const block = Math.floor(first / instancesPerBlock);
                const count = Math.min(end - at, (block + 1) * instancesPerBlock - first);
                if (lyr.camera.seen(matrix, page.boxes, 6 * block)) {
                    const last = out[out.length - 1];
                    if (last && last[0] === page && last[1] + last[2] === first) last[2] += count;
                    else out.push([page, first, count]);
                }
                at += count;
            }
            return out;
        }

        // What is to be drawn of whole layers and, of the last, what is printed: [{stream, segments, page, first,
        // count}].
        plan(wanted, matrix, mmPerPixel) {
            const out = [];
            for (const stream of this.strands.streams) {
                if (stream.travel && !wanted.travels) continue;
                // Travels of all layers would hide the print.
                const first = stream.travel ? wanted.last : wanted.first;
                const begin = stream.layerStarts[Math.min(first, this.strands.layers)];
                const whole = Math.min(wanted.inLast ? wanted.last : wanted.last + 1, this.strands.layers);
                const end = stream.layerStarts[whole] + (wanted.inLast?.get(stream) ?? 0);
                this.addRuns(out, stream, begin, end, matrix, mmPerPixel);
            }
            return out;
        }

        // The same for a machine that is too slow for all: the outside of every so many layers, as much taller.
        coarsePlan(wanted, matrix, mmPerPixel, every) {
            const out = [], last = Math.min(wanted.last, this.strands.layers - 1);
            for (const stream of this.strands.streams) {
                if (stream.travel) continue;
                if (stream.inside) {
                    if (wanted.inLast || last < 0) continue;
                    this.addRuns(out, stream, stream.layerStarts[last], stream.layerStarts[last + 1], matrix,
                        mmPerPixel);
                    continue;
                }
                for (let layer = last; layer >= wanted.first; layer -= every)
                    this.addRuns(out, stream, stream.layerStarts[layer], stream.layerStarts[layer + 1], matrix,
                        mmPerPixel);
            }
            return out;
        }

        // How many instances the outside of a range of layers is.
        shellCount(wanted) {
            const last = Math.min(wanted.last + 1, this.strands.layers), first = Math.min(wanted.first, last);
            return this.strands.streams.filter((stream) => !stream.inside && !stream.travel)
                .reduce((sum, stream) => sum + stream.layerStarts[last] - stream.layerStarts[first], 0);
        }

        addRuns(out, stream, begin, end, matrix, mmPerPixel) {
            if (end <= begin) return;
            const segments = Math.min(mostSegments,
                Math.max(1, Math.ceil(stream.need / Math.sqrt(8 * error_px * mmPerPixel))));
            for (const [page, first, count] of this.runs(stream, begin, end, matrix))
                out.push({stream, segments, page, first, count});
        }

        // Begins a picture: all that follows goes into it until finish(). `tall` is how many times as high strands are.
        // wanted: {camera, first, last (layers), inLast (null: whole; else a Map of instances of the last layer for each
        // stream), travels, byLayer, background, bedColor}.
        begin(wanted, tall) {
            const {gl, canvas} = this, {camera} = wanted;
            const matrix = camera.matrix(canvas.width / canvas.height);
            this.useFrame();
            gl.viewport(0, 0, canvas.width, canvas.height);
            gl.clearColor(...wanted.background.map((v) => v / 255), 1);
            gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
            this.drawBed(matrix, wanted.bedColor);
            gl.useProgram(this.strandProgram.program);
            this.setUniforms(this.strandProgram.uniforms, wanted, matrix, tall);
        }

        // The picture's own buffers, smoothed: it may take several frames, during which the old one is seen.
        useFrame() {
            const {gl, canvas} = this, size = `${canvas.width} ${canvas.height}`;
            if (!this.frame) this.frame = {buffer: gl.createFramebuffer(), color: gl.createRenderbuffer(),
                depth: gl.createRenderbuffer()};
            gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame.buffer);
            if (this.frame.size === size) return;
            this.frame.size = size;
            const samples = Math.min(wantedSamples, gl.getParameter(gl.MAX_SAMPLES));
            for (const [buffer, format, place] of [[this.frame.color, gl.RGBA8, gl.COLOR_ATTACHMENT0],
                [this.frame.depth, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
                gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
                gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, format, canvas.width, canvas.height);
                gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
            }
        }

        // Draws parts of a plan from a number on, up to so many instances. Returns the number of the next part.
        drawSome(plan, from, most, sides) {
            const {gl} = this, {uniforms} = this.strandProgram;
            let left = most, at = from;
            for (; at < plan.length && left > 0; ++at) {
                const {stream, segments, page, first, count} = plan[at];
                const sidesHere = stream.travel ? 0 : sides;
                gl.uniform1i(uniforms.u_segments, segments);
                gl.uniform1i(uniforms.u_sides, sidesHere);
                gl.uniform1f(uniforms.u_shade, stream.travel ? 0 : 1);
                gl.uniform1f(uniforms.u_least_px, stream.travel ? 1.2 : 0.9);
                this.drawRun(page, first, count, vertexCount(sidesHere, segments),
                    sidesHere ? gl.TRIANGLES : gl.TRIANGLE_STRIP);
                left -= count;
            }
            return at;
        }

        // Shows the picture.
        finish() {
            const {gl, canvas} = this, {width, height} = canvas;
            gl.bindVertexArray(null);
            gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.frame.buffer);
            gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
            gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
        }

        // Into the same picture, after a pause.
        resume() {
            const {gl} = this;
            gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame.buffer);
            gl.useProgram(this.strandProgram.program);
        }

        // True strands where they are wide enough to tell and few enough to draw.
        sidesFor(plan, mmPerPixel) {
            const typical_mm = 0.45;
            if (typical_mm / mmPerPixel < tube_px) return 0;
            const vertices = plan.reduce((sum, part) => sum + part.count * vertexCount(tubeSides, part.segments), 0);
            return vertices <= mostVertices ? tubeSides : 0;
        }

        setUniforms(uniforms, wanted, matrix, tall) {
            const gl = this.gl, {camera} = wanted, {right, up, back} = camera.axes();
            const pixel = camera.mmPerPixel(this.canvas.height) / camera.distance;
            const light = right.map((v, i) => -0.35 * v + 0.6 * up[i] + 0.72 * back[i]);
            gl.uniformMatrix4fv(uniforms.u_matrix, false, matrix);
            gl.uniform3fv(uniforms.u_eye, camera.eye());
            gl.uniform3fv(uniforms.u_light, light);
            gl.uniform1f(uniforms.u_pixel, pixel);
            gl.uniform1f(uniforms.u_tall, tall);
            gl.uniform1i(uniforms.u_by_layer, wanted.byLayer ? 1 : 0);
            gl.uniform1i(uniforms.u_style_colors, 0);
            gl.uniform1i(uniforms.u_layer_colors, 1);
        }

        drawBed(matrix, color) {
            const gl = this.gl, {program, uniforms} = this.lineProgram;
            gl.useProgram(program);
            gl.uniformMatrix4fv(uniforms.u_matrix, false, matrix);
            gl.uniform4fv(uniforms.u_color, [...color.map((v) => v / 255), 1]);
            gl.bindVertexArray(this.bed.array);
            gl.drawArrays(gl.LINES, 0, this.bed.count);
        }
    }

    function create(canvas, strands, box) {
        const gl = canvas.getContext("webgl2", {antialias: false, depth: false, powerPreference: "high-performance"});
        return gl ? new SpaceView(gl, canvas, strands, box) : null;
    }

    return {create};
})();
