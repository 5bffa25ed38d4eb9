"""The viewer's page in a real browser: what it draws is compared with what the C++ reader says, and it is used.

    viewer_test.py --build BUILD --fixtures FIXTURES [--stepc]    screenshots go to BUILD/viewer/
"""

import argparse
import base64
import os
import statistics
import subprocess
import sys
import time

import drawing
from browser import Browser
from drawing import check

READY = ("window.lyr && lyr.shown && lyr.shown.print.surveyed === lyr.shown.print.layerCount && "
         "(lyr.shown.state.view === 'plan' || lyr.shown.space.strands.layers === lyr.shown.print.layerCount)")
DRAWN = "lyr.shown.state.view === 'plan' ? !lyr.shown.plan.job : lyr.shown.space.finished"
FRAMES = "return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))));"
ARROW_UP, ARROW_DOWN, ARROW_RIGHT, HOME, END, ESCAPE = "\ue013", "\ue015", "\ue014", "\ue011", "\ue010", "\ue00c"

# Generous: a machine without a graphics card that builds something else meanwhile. What was measured is printed.
OPEN_S, DECODE_MS, FRAME_MS, SPACE_FRAME_MS = 15, 3000, 120, 1500


class Test:
    def __init__(self, arguments):
        self.build, self.fixtures = arguments.build, arguments.fixtures
        self.folder = os.path.join(self.build, "viewer")
        os.makedirs(self.folder, exist_ok=True)
        self.tool = os.path.join(self.build, "viewer_prints")
        subprocess.run([self.tool, "make", self.folder], check=True)
        self.prints, self.pages = ["kinds"], set()
        if arguments.stepc:
            subprocess.run([os.path.join(self.build, "stepc"), os.path.join(self.fixtures, "parts/gearbox_base.step"),
                            "-o", self.path("gearbox.lyr")], check=True, capture_output=True)
            self.prints.append("gearbox")

    def path(self, name):
        return os.path.join(self.folder, name)

    def page(self, name):
        html = self.path(name + ".html")
        if name not in self.pages:
            subprocess.run([os.path.join(self.build, "lyrview"), self.path(name + ".lyr"), "-o", html], check=True)
            self.pages.add(name)
        return html

    def show(self, browser, name, view="#2d"):
        """From above at first: drawing in space is slow without a graphics card."""
        browser.open(name if name.endswith(".html") else self.page(name), view)
        browser.wait(READY)
        browser.run(FRAMES)

    def picture(self, browser, name):
        browser.wait(DRAWN)
        browser.run(FRAMES)
        browser.screenshot(self.path(name + ".png"))


def layer_shown(browser):
    return browser.run("lyr.shown.state.high")


def set_layer(browser, layer):
    browser.run(f"lyr.shown.setLayers(0, {layer}, 'high');")


def stage_box(browser):
    return browser.run("const b = document.getElementById('stage').getBoundingClientRect();"
                       "return {x: b.x, y: b.y, width: b.width, height: b.height};")


def quiet(browser, name):
    """Nothing was asked of a network, and the console has no complaint."""
    # chrome: is the browser's own empty tab at its start.
    asked = [url for url in browser.requests() if not url.startswith(("file:", "data:", "blob:", "chrome:"))]
    check(not asked, name, "asked for", asked)
    # Chromium itself warns that drawing by software is slow.
    complaints = [e for e in browser.log("browser") if e["level"] == "SEVERE" or e["source"] != "rendering"]
    check(not complaints, name, "complains:", complaints)


def drawn_as_the_file_says(test, browser):
    """Every layer has as many motions as the reader finds; of some, each motion is looked at."""
    for name in [*test.prints, "large"]:
        in_space = name != "large"
        test.show(browser, name)
        layers = browser.run("lyr.shown.print.layerCount")
        heads = subprocess.run([test.tool, "heads", test.path(name + ".lyr")], check=True, capture_output=True,
                               text=True).stdout.splitlines()
        check(len(heads) == layers, name, "shows", layers, "layers of", len(heads))
        mine = browser.run("lyr.shown.print.file.layers.map((head, i) => [head.operations,"
                           " Math.round(head.estimate_s * 1000), lyr.shown.print.layer(i).motions.count])")
        check([" ".join(map(str, head)) for head in mine] == heads, name, "has other layers than the reader says")
        for layer in range(0, layers, max(1, layers // (6 if in_space else 2))):
            motions = drawing.motions_of(test.tool, test.path(name + ".lyr"), layer)
            drawing.compare_plan(browser.run(f"lyr.drawn({layer}, {drawing.SCALE})"), motions)
            if in_space:
                browser.run("lyr.shown.space.build(Infinity);")
                drawing.compare_space(browser.run(f"lyr.drawnInSpace({layer})"), motions)
        quiet(browser, name)


def strands_have_their_colour(test, browser):
    """On the screen itself: the middle of every tenth outer wall."""
    test.show(browser, test.prints[-1])
    browser.keys("2")
    set_layer(browser, 5)
    browser.wait(DRAWN)
    browser.run(FRAMES)
    hits = browser.run("""
        const page = lyr.shown, layer = page.print.layer(5), m = layer.motions, q = page.print.quantum_mm, out = [];
        for (let i = 0; i < m.count; ++i) {
            if (m.kind[i] > 1 || m.styles[m.style[i]].role !== 1 || m.length(i) * q < 0.5) continue;
            const at = m.pointAt(i, 0.5), p = page.plan.toScreen(at.x * q, at.y * q);
            const c = page.plan.context.getImageData(Math.round(p.x), Math.round(p.y), 1, 1).data;
            out.push(Math.hypot(c[0] - 0xe2, c[1] - 0x64, c[2] - 0x1f) < 60);
        }
        return out;""")
    check(len(hits) >= 1, "no outer wall was looked at")
    check(sum(hits) >= 0.8 * len(hits) or test.prints[-1] == "kinds", "only", sum(hits), "of", len(hits), "walls show")


def arcs_stay_arcs(test, browser):
    """Near enough that a quantum is 20 pixels, an arc of the page lies on its circle to a tenth of a pixel."""
    test.show(browser, "kinds")
    worst = browser.run("""
        let worst = 0, seen = 0;
        const page = lyr.shown, q = page.print.quantum_mm, scale = 20000;
        for (let index = 0; index < 4; ++index) {
            const layer = page.print.layer(index), m = layer.motions;
            for (let i = 0; i < m.count; ++i) {
                if (m.kind[i] !== 1) continue;
                const arc = m.shape(i), at = m.pointAt(i, 0.37);
                const frame = {x_mm: at.x * q, y_mm: at.y * q, scale, width: 1000, height: 800};
                const points = [];
                const context = {
                    beginPath() {}, stroke() {}, moveTo: (x, y) => points.push([x, y]),
                    lineTo: (x, y) => points.push([x, y]),
                    arc: (x, y, r) => points.push([x + r * 0.6, y + r * 0.8]),
                };
                const options = {coloring: page.print.coloring, quantum_mm: q, begin: i, end: i + 1};
                for (const _ of lyr.planView.strokes(context, frame, layer, options)) void _;
                for (const [x, y] of points) {
                    const dx = frame.x_mm + (x - 500) / scale - arc.x * q;
                    const dy = frame.y_mm - (y - 400) / scale - arc.y * q;
                    worst = Math.max(worst, Math.abs(Math.hypot(dx, dy) - arc.radius * q) * scale);
                    ++seen;
                }
            }
        }
        return seen > 1000 ? worst : 1e9;""")
    check(worst <= 0.1, "an arc is drawn", worst, "pixels off")


def keys_work(test, browser):
    test.show(browser, "kinds")
    last = layer_shown(browser)
    browser.keys("2", ARROW_DOWN, ARROW_DOWN)
    check(layer_shown(browser) == last - 2, "two layers down is", layer_shown(browser))
    browser.keys(HOME)
    check(layer_shown(browser) == 0, "Home goes to", layer_shown(browser))
    browser.keys(ARROW_UP, "r", ARROW_UP)
    check(browser.run("[lyr.shown.state.low, lyr.shown.state.high]") == [0, 2], "R makes no range")
    browser.keys("w")
    check(browser.run("lyr.shown.state.low") == 1, "W does not raise the lower end")
    browser.keys("r", "c", "t", "m")
    state = browser.run("[lyr.shown.print.coloring.mode, lyr.shown.state.travels, lyr.shown.plan.measure.on]")
    check(state == ["speed", True, True], "C, T and M give", state)
    browser.keys(ESCAPE, "?")
    check(browser.run("document.getElementById('help').open"), "? opens no help")
    browser.keys(ESCAPE, ARROW_RIGHT, ARROW_RIGHT, ARROW_RIGHT)
    before = browser.run("lyr.shown.plan.scale")
    browser.keys("+", "+", "-")
    check(browser.run("lyr.shown.plan.scale") > 1.2 * before, "+ does not zoom")
    browser.keys(END, "3")
    check(browser.run("lyr.shown.state.view") == "space", "3 shows no space")
    quiet(browser, "keys")


def time_runs(test, browser):
    test.show(browser, "kinds")
    browser.keys("2", "[", HOME)
    browser.run("lyr.shown.setTime(0);")
    total = browser.run("lyr.shown.print.schedule.total_s")
    check(abs(total - 12 * 12.345) < 1e-6, "the print takes", total)
    browser.keys(ARROW_RIGHT, ARROW_RIGHT, ARROW_RIGHT)
    check(browser.run("lyr.shown.shown().done") == 3, "three motions are", browser.run("lyr.shown.shown().done"))
    browser.keys(" ")
    browser.wait("lyr.shown.shown().done > 3 || lyr.shown.state.high > 0")
    browser.keys(" ")
    check(not browser.run("lyr.shown.state.playing"), "it does not stop")
    # At a moment in a layer, what is drawn ends where the head is.
    browser.run("lyr.shown.setTime(12.345 * 4.5);")
    browser.wait("lyr.shown.plan.front.done === lyr.shown.shown().done")
    at = browser.run("const s = lyr.shown.shown(), l = lyr.shown.print.layer(s.high);"
                     "return [s.high, s.done, l.motions.count, lyr.shown.plan.front.done];")
    check(at[0] == 4 and 0 < at[1] < at[2] and at[3] == at[1], "in the middle of layer 5:", at)
    browser.run("lyr.shown.setTime(1e9);")
    check(browser.run("lyr.shown.state.whole"), "the end is not the whole print")


def statistics_add_up(test, browser):
    for name in test.prints:
        test.show(browser, name)
        sums = browser.run("""
            const {print} = lyr.shown, roles = [...print.sums.roles.values()];
            const of = (key) => roles.reduce((sum, role) => sum + role[key], 0);
            const heads = (key) => print.file.layers.reduce((sum, head) => sum + head[key], 0);
            return [[of("length_mm"), heads("extruded_mm")], [of("volume_mm3"), heads("volume_mm3")],
                [print.sums.travel.length_mm, heads("travel_mm")]];""")
        for mine, stated in sums:
            check(abs(mine - stated) <= 1e-4 * stated + 0.2, name, "adds up to", mine, "and states", stated)
        rows = browser.run("document.querySelectorAll('#panel .roles tr').length")
        check(rows == browser.run("lyr.shown.print.sums.roles.size") + 2, "the table has", rows, "rows")


def roles_can_be_hidden(test, browser):
    test.show(browser, "kinds")
    before = len(browser.run("lyr.drawn(3).strands"))
    browser.run("document.querySelector('#panel [data-role=\"1\"]').click();")
    hidden = browser.run("lyr.drawn(3).strands")
    check(0 < len(hidden) < before, "hiding a role leaves", len(hidden), "of", before)
    check(all(stroke["color"] != drawing.css(drawing.ROLE_COLORS[1]) for stroke in hidden), "outer walls are drawn")


def measuring_snaps(test, browser):
    """From an arc's centre to the end of a line, by the mouse, beside the motions' own numbers."""
    test.show(browser, "kinds")
    browser.keys("2", HOME)
    browser.run("document.getElementById('measure').click();")
    place = browser.run("""
        const page = lyr.shown, m = page.print.layer(0).motions, q = page.print.quantum_mm;
        for (let i = 0; i < m.count; ++i) {
            if (m.kind[i] !== 2) continue;
            const arc = m.shape(i);
            if (arc.radius * q < 2 || arc.radius * q > 60) continue;
            const at = {x: arc.x + arc.radius, y: arc.y};
            page.plan.center = {x: (arc.x + at.x) / 2 * q, y: arc.y * q};
            page.plan.scale = 200 / (arc.radius * q);
            return {center: page.plan.toScreen(arc.x * q, arc.y * q),
                from: page.plan.toScreen(m.fromX[i] * q, m.fromY[i] * q),
                rim: page.plan.toScreen(at.x * q, at.y * q), radius_mm: arc.radius * q, i};
        }
        return null;""")
    check(place, "there is no circle to measure")
    box = stage_box(browser)
    on_page = lambda point: (box["x"] + point["x"], box["y"] + point["y"])
    browser.pointer([on_page(place["rim"])])
    browser.run(FRAMES)
    under = browser.run("[lyr.shown.plan.under?.i ?? -1, document.getElementById('card').textContent]")
    check("Radius" in under[1], "pointing at a circle tells", under)
    start = place["center"]
    browser.pointer([on_page(start), "down", "up"])
    browser.pointer([on_page(place["from"]), "down", "up"])
    points = browser.run("lyr.shown.plan.measure.points.map((p) => p.what)")
    length = browser.run("lyr.planMarks.distance(lyr.shown.plan.measure.points, lyr.shown.print.quantum_mm).length_mm")
    check(points[1] == "end" and points[0] in ("centre", "end"), "measuring snapped to", points)
    if points[0] == "centre":
        check(abs(length - place["radius_mm"]) < 0.02, "centre to rim is", length, "of radius", place["radius_mm"])
    check("mm" in browser.run("document.querySelector('#card .result').textContent"), "no distance is told")
    quiet(browser, "measuring")


def the_print_is_in_the_picture(test, browser):
    """The box's corners, on a phone and on a desktop, at first and fitted again."""
    for name in ["kinds", "far"]:
        for width, height, phone in [(390, 844, True), (360, 640, True), (1280, 800, False)]:
            browser.size(width, height, phone=phone)
            test.show(browser, name, view="#3d")
            for fitted in [False, True]:
                farthest = browser.run("""
                    if (arguments[0]) {
                        lyr.shown.space.zoom(3, 0, 0);
                        lyr.shown.fit();
                    }
                    const {low, high} = lyr.shown.print.box(), {camera, canvas} = lyr.shown.space;
                    const m = camera.matrix(canvas.width / canvas.height);
                    let farthest = 0;
                    for (let corner = 0; corner < 8; ++corner) {
                        const [x, y, z] = [0, 1, 2].map((axis) => (corner >> axis & 1 ? high : low)[axis]);
                        const [px, py, , w] = [0, 1, 2, 3].map((i) => m[i] * x + m[4 + i] * y + m[8 + i] * z + m[12 + i]);
                        farthest = Math.max(farthest, Math.abs(px / w), Math.abs(py / w));
                    }
                    return farthest;""", fitted)
                check(0.4 < farthest <= 1, name, "reaches", farthest, "of the picture of", width, height,
                      "fitted again" if fitted else "at first")
    browser.size(1280, 800)


def the_box_is_of_what_is_extruded(test, browser):
    """The head comes from far away, and goes there: neither counts."""
    test.show(browser, "far")
    low, high = browser.run("const b = lyr.shown.print.box(); return [b.low, b.high];")
    check(max(abs(a - b) for a, b in zip(low[:2] + high[:2], [99.8, 99.8, 110.2, 110.2])) < 1e-3, "the box is", low, high)
    browser.run("const p = document.getElementById('panel');"
                "if (p.classList.contains('closed')) document.getElementById('show-panel').click();")
    browser.run(FRAMES)
    size = browser.run("return document.getElementById('panel').textContent;")
    check("10.4 × 10.4 × 0.2" in size, "the panel tells", size)
    corner = browser.run("return lyr.shown.plan.toScreen(99.8, 105).x;")
    check(0 < corner < stage_box(browser)["width"] / 2, "it is not fitted to what is extruded:", corner)


def statistics_leave_the_sliders_free(test, browser):
    for width, height in [(700, 500), (390, 844), (360, 640)]:
        browser.size(width, height, phone=True)
        test.show(browser, "kinds")
        browser.run("const p = document.getElementById('panel');"
                    "if (p.classList.contains('closed')) document.getElementById('show-panel').click();")
        browser.run(FRAMES)
        covered = browser.run("""
            const panel = document.getElementById("panel").getBoundingClientRect();
            const free = document.getElementById("layers").getBoundingClientRect();
            const head = document.querySelector("header").getBoundingClientRect();
            return [head.bottom, panel.top, panel.bottom, free.top];""")
        check(covered[0] <= covered[1] < covered[2] <= covered[3] + 0.5, "statistics cover", width, height, covered)
        box = browser.run("const b = document.getElementById('show-help').getBoundingClientRect();"
                          "return [b.x + b.width / 2, b.y + b.height / 2, b.width, b.height, innerWidth];")
        check(min(box[2:4]) >= 34 and box[0] + box[2] / 2 <= box[4], "help is at", box)
        browser.pointer([(box[0], box[1]), "down", "up"], kind="touch")
        check(browser.run("document.getElementById('help').open"), "the help does not open at", width, height)
    browser.size(1280, 800)


def fingers_work(test, browser):
    browser.size(390, 844, phone=True, ratio=2)
    test.show(browser, test.prints[-1], view="")
    wide = browser.run("[document.documentElement.scrollWidth, innerWidth]")
    check(wide[0] <= wide[1], "the page is", wide, "wide")
    small = browser.run("""
        const small = [];
        for (const e of document.querySelectorAll("header button, select, #layer-slider, footer button, #range")) {
            const b = e.getBoundingClientRect();
            if (b.width === 0) continue;
            if (b.height < 34 || b.right > innerWidth || b.bottom > innerHeight) small.push(e.id + JSON.stringify(b));
        }
        return small;""")
    check(not small, "a finger cannot reach", small)
    test.picture(browser, "phone-space")
    box = stage_box(browser)
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    azimuth = browser.run("lyr.shown.space.camera.azimuth")
    browser.pointer([(x, y), "down", (x + 30, y), (x + 60, y), "up"], kind="touch")
    check(browser.run("lyr.shown.space.camera.azimuth") != azimuth, "a finger does not turn the print")
    browser.run("document.getElementById('view-plan').click();")
    center = browser.run("lyr.shown.plan.center.x")
    browser.pointer([(x, y), "down", (x + 30, y), (x + 60, y), "up"], kind="touch")
    check(browser.run("lyr.shown.plan.center.x") < center, "a finger does not move the layer")
    wall = browser.run("""
        const page = lyr.shown, m = page.print.layer(page.state.high).motions, q = page.print.quantum_mm;
        const i = [...m.kind].findIndex((kind, i) => kind <= 1 && m.length(i) * q > 1), at = m.pointAt(i, 0.5);
        page.plan.center = {x: at.x * q, y: at.y * q};
        return page.plan.toScreen(at.x * q, at.y * q);""")
    browser.pointer([(box["x"] + wall["x"], box["y"] + wall["y"]), "down", "up"], kind="touch")
    card = browser.run("[document.getElementById('card').hidden, document.getElementById('card').textContent]")
    check(not card[0] and "mm/s" in card[1], "a tap on a strand tells", card)
    scale = browser.run("lyr.shown.plan.scale")
    browser.pointer([(x - 20, y), "down", (x - 60, y), (x - 100, y), "up"],
                    [(x + 20, y), "down", (x + 60, y), (x + 100, y), "up"], kind="touch")
    check(browser.run("lyr.shown.plan.scale") > 2 * scale, "two fingers do not zoom")
    slider = browser.run("const b = document.getElementById('layer-slider').getBoundingClientRect();"
                         "return [b.x, b.y + b.height / 2, b.width];")
    browser.pointer([(slider[0] + 0.9 * slider[2], slider[1]), "down", (slider[0] + slider[2] / 2, slider[1]), "up"],
                    kind="touch")
    middle = browser.run("lyr.shown.print.layerCount / 2")
    check(abs(layer_shown(browser) - middle) < 0.1 * middle + 1, "the slider's middle is layer", layer_shown(browser))
    browser.run("lyr.shown.fit();")
    test.picture(browser, "phone-plan")
    browser.run("document.getElementById('show-panel').click();")
    browser.scheme("dark")
    test.picture(browser, "phone-dark")
    quiet(browser, "a phone")
    browser.scheme("light")
    browser.size(1280, 800)


def pictures(test, browser):
    test.show(browser, test.prints[-1], view="")
    test.picture(browser, "space")
    check(browser.run("lyr.shown.space.stats.instances") > 1000, "space is empty")
    browser.keys("2")
    browser.run("lyr.shown.stepLayer(-lyr.shown.print.layerCount * 3 / 4 | 0);")
    test.picture(browser, "plan")
    browser.scheme("dark")
    test.picture(browser, "plan-dark")
    dark = browser.run("lyr.shown.plan.context.getImageData(2, 2, 1, 1).data[0]")
    check(dark < 60, "in the dark the stage is", dark)
    browser.scheme("light")


def a_lost_card_comes_back(test, browser):
    test.show(browser, "small", view="")
    browser.wait(DRAWN)
    before = browser.run("lyr.shown.space.stats.instances")
    browser.run("window.loss = lyr.shown.space.view.gl.getExtension('WEBGL_lose_context'); loss.loseContext();")
    browser.wait("lyr.shown.space.view.gl.isContextLost()")
    browser.keys(ARROW_DOWN)
    browser.run(FRAMES)
    browser.keys(ARROW_UP)
    browser.run("loss.restoreContext();")
    browser.wait("!lyr.shown.space.view.gl.isContextLost() && lyr.shown.space.key !== '' && lyr.shown.space.finished")
    check(browser.run("lyr.shown.space.stats.instances") == before, "after a loss less is drawn")


def a_large_print_is_smooth(test, browser):
    browser.open(test.page("large"))
    browser.wait(READY, 60)
    opened = browser.run("performance.getEntriesByType('navigation')[0].domContentLoadedEventEnd / 1000")
    surveyed = browser.run("performance.now() / 1000")
    decode = browser.run("""
        const {file} = lyr.shown.print, begun = performance.now();
        let motions = 0;
        for (let i = 0; i < file.layers.length; ++i) motions += lyr.decode.layer(file, i).motions.count;
        return [performance.now() - begun, file.operations, file.layers.length, motions];""")
    check(decode[1] >= 1e6 and decode[2] == 200, "the large print has", decode[1:], "operations")
    frames = """
        return new Promise((done) => {{
            const page = lyr.shown, stage = page.stage, out = [];
            let last = performance.now();
            const step = () => {{
                const now = performance.now();
                out.push(now - last);
                last = now;
                {move}
                page.request();
                if (out.length < {count}) requestAnimationFrame(step);
                else done(out.slice(5));
            }};
            requestAnimationFrame(step);
        }});"""
    space = statistics.median(browser.run(frames.format(count=15, move="stage.pan(4, 1, false);")))
    browser.keys("2")
    set_layer(browser, 120)
    browser.wait(DRAWN)
    plan = statistics.median(browser.run(frames.format(count=60, move="stage.pan(2, 1); stage.zoom(1.02, 400, 300);")))
    scrub = statistics.median(browser.run(frames.format(count=60, move="page.setLayers(0, out.length * 3, 'high');")))
    memory = browser.run("performance.memory ? performance.memory.usedJSHeapSize / 1e6 : 0")
    print(f"1 million operations: page ready after {opened:.2f} s, all decoded in {decode[0]:.0f} ms, looked through "
          f"and built for 3D after {surveyed:.2f} s; median frame: 3D {space:.0f} ms, 2D pan and zoom {plan:.0f} ms, "
          f"layers {scrub:.0f} ms; heap {memory:.0f} MB")
    check(opened < OPEN_S and decode[0] < DECODE_MS, "opening takes", opened, "s, decoding", decode[0], "ms")
    check(plan < FRAME_MS and scrub < FRAME_MS and space < SPACE_FRAME_MS, "frames take", plan, scrub, space, "ms")
    quiet(browser, "a large print")


def every_flipped_bit_is_found(test, browser):
    """Every bit of a small print, and every truncation: each is told, and none makes the reader stumble."""
    test.show(browser, "small")
    missed = browser.run("""
        const whole = lyr.shown.print.file.bytes, missed = [];
        const found = (bytes) => {
            try {
                const file = new lyr.file.PrintFile(bytes);
                for (let i = 0; i < file.layers.length; ++i) lyr.decode.layer(file, i);
                return file.warnings.length > 0;
            } catch (error) {
                if (!(error instanceof lyr.file.Damage)) missed.push(error.message);
                return true;
            }
        };
        if (found(whole)) missed.push("the whole file");
        const bits = 8 * whole.length, step = Math.max(1, bits / 20000);
        for (let bit = 0; bit < bits; bit += step) {
            const bytes = whole.slice(), at = Math.floor(bit);
            bytes[at >> 3] ^= 1 << (at & 7);
            if (!found(bytes)) missed.push(at);
        }
        for (let length = 0; length < whole.length; ++length)
            if (!found(whole.slice(0, length))) missed.push(`cut at ${length}`);
        const text = btoa(String.fromCharCode(...whole)).replace(/(.{76})/g, "$1\\n");
        const again = lyr.bytes.pieceByPiece(text);
        if (again.length !== whole.length || again.some((byte, i) => byte !== whole[i])) missed.push("base64");
        return missed;""")
    check(not missed, "not found, or found by accident:", missed[:5])


def damage_is_told(test, browser):
    """Flipped bits in layer 7 and in layer 9's head: these are missing and named, the others are drawn."""
    with open(test.page("kinds"), encoding="utf-8") as file:
        page = file.read()
    mark = 'id="print-file">'
    begin = page.index(mark) + len(mark)
    end = page.index("</script>", begin)
    data = bytearray(base64.b64decode(page[begin:end]))
    test.show(browser, "kinds")
    places = browser.run("const heads = lyr.shown.print.file.layers;"
                         "return [heads[6].chunksAt + 200, heads[8].chunksAt - 20];")
    for place in places:
        data[place] ^= 4
    with open(test.path("damaged.html"), "w", encoding="utf-8") as file:
        file.write(page[:begin] + base64.b64encode(data).decode() + page[end:])
    test.show(browser, test.path("damaged.html"))
    notice = browser.run("document.getElementById('notice').textContent")
    check("layer 7, chunk 1" in notice and "checksum" in notice and "1 more" in notice, "it tells", notice)
    check(browser.run("[lyr.shown.print.layer(6), lyr.shown.print.layer(8), lyr.drawn(9).strands.length > 0]") ==
          [None, None, True],
          "a damaged layer is drawn, or a whole one is not")
    with open(test.path("damaged.html"), "w", encoding="utf-8") as file:
        file.write(page[:begin] + base64.b64encode(b"no print").decode() + page[end:])
    browser.open(test.path("damaged.html"))
    check("no .lyr file" in browser.run("document.getElementById('notice').textContent"), "it shows what is no print")
    quiet(browser, "damage")


def without_webgl(test):
    with Browser(flags=["--disable-3d-apis"]) as browser:
        test.show(browser, "kinds", view="")
        told = browser.run("[lyr.shown.state.view, lyr.shown.space.available,"
                           " document.getElementById('notice').textContent]")
        check(told[:2] == ["plan", False] and "WebGL" in told[2], "without WebGL it shows", told)
        browser.keys("3")
        check(browser.run("lyr.shown.state.view") == "plan", "it goes into space without WebGL")


TESTS = [drawn_as_the_file_says, strands_have_their_colour, arcs_stay_arcs, keys_work, time_runs, statistics_add_up,
         roles_can_be_hidden, measuring_snaps, every_flipped_bit_is_found, damage_is_told, the_print_is_in_the_picture,
         the_box_is_of_what_is_extruded, statistics_leave_the_sliders_free, fingers_work, pictures,
         a_lost_card_comes_back, a_large_print_is_smooth]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", required=True)
    parser.add_argument("--fixtures", required=True)
    parser.add_argument("--stepc", action="store_true")
    parser.add_argument("--only", default="")
    test, failed = Test(arguments := parser.parse_args()), 0
    with Browser() as browser:
        for each in TESTS + [without_webgl]:
            if arguments.only not in each.__name__:
                continue
            begun = time.monotonic()
            try:
                if each is without_webgl:
                    each(test)
                else:
                    each(test, browser)
                result = "ok"
            except (AssertionError, RuntimeError) as error:
                result, failed = f"FAILED: {error}", failed + 1
            print(f"{each.__name__}: {result} ({time.monotonic() - begun:.1f} s)", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
