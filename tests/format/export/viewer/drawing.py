"""What a page draws of a layer, beside what the C++ reader says the layer is: motion by motion."""

import math
import subprocess

ROLE_COLORS = [
    "8a8f94", "e2641f", "f2b134", "8e44ad", "c08552", "9aa0a6", "4f8fc4", "6dbfb8", "d64f6a", "7b6cc0", "2e9e6b",
    "66b88f", "ef9fb0", "9bb84a", "62892b", "7f8c8d", "b8a68c", "8d7b68", "5d7380"]
QUANTUM_MM = 0.001
SCALE = 1000  # pixels per mm of what is recorded: a quantum is a pixel
FLOAT_MM = 1e-9  # what 300 mm lose in doubles, with room
CURVE_MM = 1.01e-4  # what an arc of many pixels' radius may lie off when it is drawn in chords: a tenth of a pixel
LARGE_MM = 199  # such a radius
WIDEST_MM = 65.535  # on the graphics card
EDGE_SHARE, CORE = 0.28, 0.68


class Motion:
    def __init__(self, line):
        words = line.split()
        self.kind, self.role = words[0], int(words[1])
        x0, y0, z0, x1, y1, z1, a, b, flag = (int(word) for word in words[2:11])
        self.start, self.end = (x0, y0), (x1, y1)
        self.z = (z0, z1)
        self.width_mm, self.height_mm, self.flow, self.speed_mm_s = (float(word) for word in words[11:])
        self.curved = self.kind == "circle" or (self.kind in ("arc", "wipe") and a != 0)
        if self.kind == "circle":
            self.center, self.turn = (a, b), 2 * math.pi * (1 if flag else -1)
            self.radius = math.dist(self.start, self.center)
        elif self.curved:
            # As the format's specification has it.
            chord = math.dist(self.start, self.end)
            self.quarter = t = 2 * a / chord
            rise = (1 - t * t) / (4 * t)
            self.center = ((x0 + x1) / 2 - rise * (y1 - y0), (y0 + y1) / 2 + rise * (x1 - x0))
            self.turn, self.radius = 4 * math.atan(t), chord * (1 + t * t) / (4 * abs(t))


def motions_of(dump, path, layer):
    text = subprocess.run([dump, "dump", path, str(layer)], check=True, capture_output=True, text=True).stdout
    return [Motion(line) for line in text.splitlines()]


def mm(place):
    return tuple(value * QUANTUM_MM for value in place)


def check(condition, *what):
    if not condition:
        raise AssertionError(" ".join(str(part) for part in what))


class Pen:
    """Follows a recorded path and finds motions in it."""

    def __init__(self, path):
        self.path, self.at, self.place = path, 0, None

    def peek(self):
        return self.path[self.at][0] if self.at < len(self.path) else None

    def take(self):
        self.at += 1
        return self.path[self.at - 1]

    def near(self, place, what, most_mm=FLOAT_MM):
        check(math.dist(self.place, place) <= most_mm, what, self.place, "instead of", place)

    def follow(self, motion):
        if self.peek() == "move":
            self.place = tuple(self.take()[1:])
        self.near(mm(motion.start), "a motion begins at")
        if not motion.curved:
            check(self.peek() == "line", "a line is drawn as", self.peek())
            self.place = tuple(self.take()[1:])
        elif self.peek() == "arc":
            self.arc(motion)
        else:
            self.chords(motion)
        self.near(mm(motion.end), f"a {motion.kind} ends at", FLOAT_MM * max(1, motion.radius / 1000)
                  if motion.curved else FLOAT_MM)

    def arc(self, motion):
        _, x, y, radius, start, end, counter_clockwise = self.take()
        slack = FLOAT_MM * max(1, motion.radius / 1000)
        check(math.dist((x, y), mm(motion.center)) <= slack, "a centre is", (x, y), "not", mm(motion.center))
        check(abs(radius - motion.radius * QUANTUM_MM) <= slack, "a radius is", radius, "not", motion.radius)
        check(counter_clockwise == (motion.turn > 0), "an arc turns the wrong way")
        check(abs(end - start - motion.turn) < 1e-9, "an arc turns by", end - start, "not", motion.turn)
        check(math.dist((x + radius * math.cos(start), y + radius * math.sin(start)), mm(motion.start)) <= slack,
              "an arc does not begin where the pen is")
        self.place = (x + radius * math.cos(end), y + radius * math.sin(end))

    def chords(self, motion):
        """Of an arc too large for a canvas: every chord, ends and middle, lies on the circle."""
        check(motion.radius * QUANTUM_MM > LARGE_MM, "an arc of radius", motion.radius, "is drawn in chords")
        goal, steps = mm(motion.end), 0
        while self.peek() == "line":
            place = tuple(self.take()[1:])
            middle = ((place[0] + self.place[0]) / 2, (place[1] + self.place[1]) / 2)
            for point in (place, middle):
                off = abs(math.dist(point, mm(motion.center)) - motion.radius * QUANTUM_MM)
                check(off <= CURVE_MM, "a chord lies", off, "mm off its arc")
            self.place, steps = place, steps + 1
            if math.dist(place, goal) <= FLOAT_MM * motion.radius / 1000 and (motion.kind != "circle" or steps > 2):
                return

    def done(self):
        check(self.at == len(self.path), "more is drawn than the layer has:", self.path[self.at:self.at + 3])


def css(color, darker=0.0):
    values = [int(color[i:i + 2], 16) for i in (0, 2, 4)]
    return "rgb({} {} {})".format(*(math.floor(v * (1 - darker) + 0.5) for v in values))


def follow_all(strokes, motions, what):
    pen = Pen([step for stroke in strokes for step in stroke["path"]])
    try:
        for motion in motions:
            pen.follow(motion)
        pen.done()
    except AssertionError as error:
        raise AssertionError(f"{what}: {error}") from None


def compare_plan(drawn, motions):
    """Every motion once, in its place, colour and width: its edge and its core; ways without extrusion apart."""
    groups = {}
    for motion in motions:
        if motion.kind in ("line", "arc", "circle"):
            groups.setdefault((motion.role, motion.width_mm), []).append(motion)
    left = list(drawn["strands"])
    for (role, width_mm), list_of in groups.items():
        for color, width in ((css(ROLE_COLORS[role], EDGE_SHARE), width_mm), (css(ROLE_COLORS[role]), CORE * width_mm)):
            mine = [s for s in left if s["color"] == color and abs(s["width_mm"] - max(width, 0.0)) < 1e-9]
            left = [s for s in left if s not in mine]
            follow_all(mine, list_of, f"role {role}, width {width_mm}")
    check(not left, "strokes that no motion has:", left[:1])
    for kind in ("travel", "wipe"):
        follow_all([s for s in drawn["ways"] if s["color"] == kind], [m for m in motions if m.kind == kind], kind)


def half(value_mm):
    """In half quanta: what single precision keeps apart."""
    return math.floor(2 * value_mm / QUANTUM_MM + 0.5)


def instances_of(motion):
    """What the graphics card should get: from, to, tangent of a quarter of the turn."""
    start, end = (*motion.start, motion.z[0]), (*motion.end, motion.z[1])
    if motion.kind == "circle":
        middle = tuple(2 * c - s for c, s in zip(motion.center, motion.start)) + (sum(motion.z) / 2,)
        sign = 1.0 if motion.turn > 0 else -1.0
        return [(start, middle, sign), (middle, end, sign)]
    return [(start, end, motion.quarter if motion.curved else 0.0)]


def compare_space(drawn, motions):
    left = {}
    for instance in drawn:
        values = instance["values"]
        left.setdefault(tuple(half(v) for v in values[:6]), []).append(instance)
    count = 0
    for motion in motions:
        for start, end, quarter in instances_of(motion):
            count += 1
            key = tuple(half(v * QUANTUM_MM) for v in (*start, *end))
            found = [i for i in left.get(key, []) if abs(i["values"][6] - quarter) <= 1e-6 * max(1, abs(quarter)) and
                     i["role"] == motion.role and
                     (motion.role < 0 or abs(i["width_mm"] - min(motion.width_mm, WIDEST_MM)) <= 0.00051)]
            check(found, "the card has no", motion.kind, start, end, quarter)
            left[key].remove(found[0])
    check(count == len(drawn), "the card has", len(drawn), "instances for", count)
