#!/usr/bin/env python3
"""Judges what the guest brought back: the kernel's record of every line write beside what lyrrun simulates.

    check.py FOLDER CASE...

FOLDER has the printer's file, the table of named lines, the folder that init filled, and cold.vcd and hot.vcd, the
waves of the same print simulated without and with heat. Prints a line for each check and ends with status 1 if one
failed.
"""

import bisect
import pathlib
import re
import statistics
import sys

import record

AXES = "xyze"
NS = 1e9
HEATERS = ("heater_tool", "heater_bed")
failures = 0


def check(case, claim, holds, detail=""):
    global failures
    failures += not holds
    print(f"{'ok  ' if holds else 'FAIL'} {case}: {claim}{': ' if detail else ''}{detail}")


class Case:
    """One case of init."""

    def __init__(self, board, results, name):
        self.name, self.folder, self.printer = name, results / name, board.printer
        self.entries = list(record.read_record(results, name))
        self.edges = list(record.edges_of(self.entries, board.purpose))
        self.motion = [edge for edge in self.edges if edge.line[0] in AXES and edge.line[1] == "_"]
        self.marks = {entry.text: entry.time_ns for entry in self.entries if entry.text}
        self.check("nothing of the record was lost",
                   set(re.findall(r"overrun: (\d+)", self.text("stats"))) == {"0"})
        self.check("no process is left", not self.text("left").strip(), self.text("left").strip())

    def text(self, file):
        return (self.folder / file).read_text()

    def check(self, claim, holds, detail=""):
        check(self.name, claim, holds, detail)

    def check_status(self, expected):
        status = int(self.text("status"))
        self.check(f"it ended with status {expected}", status == expected,
                   "" if status == expected else f"{status}: {self.text('err')[-300:]}")

    def check_says(self, text, file="err"):
        said = self.text(file).strip()
        self.check(f'it says "{text}"', text in said, said.splitlines()[-1] if said else "nothing")

    def active_at_end(self):
        last = {edge.line: edge.active for edge in self.edges}
        return [line for line, active in last.items() if active]


def key(edge):
    return edge.line, edge.active


def common_edges(edges, groups):
    """How many edges from the first on are the simulated ones: those of a write in any order, the writes in theirs."""
    place = 0
    for group in groups:
        found = edges[place : place + len(group)]
        if sorted(map(key, found)) == sorted(map(key, group)):
            place += len(group)
            continue
        wanted = list(map(key, group))
        for edge in found:
            if key(edge) not in wanted:
                break
            wanted.remove(key(edge))
            place += 1
        break
    return place


def path_of(edges):
    """The steps as a motor driver takes them: after each, where the four motors stand."""
    direction, position, path = dict.fromkeys(AXES, -1), dict.fromkeys(AXES, 0), []
    for edge in edges:
        axis, _, kind = edge.line.partition("_")
        if kind == "direction":
            direction[axis] = 1 if edge.active else -1
        elif kind == "step" and edge.active:
            position[axis] += direction[axis]
            path.append(tuple(position.values()))
    return path


def check_same(case, groups):
    """Are every edge of the motors' lines, and the path that they make, the simulated ones?"""
    simulated = [edge for group in groups for edge in group]
    common = common_edges(case.motion, groups)
    same = common == len(simulated) == len(case.motion)
    detail = f"{len(simulated)} edges in {len(groups)} writes"
    if not same:
        detail = f"{len(case.motion)} of {detail}, the first {common} agree, then {case.motion[common:common + 3]}"
    case.check("the kernel's edges are the simulated ones", same, detail)
    # Steps of one write happen at once; their order in the record is that of the lines.
    ours, theirs, done = path_of(case.motion), path_of(simulated), 0
    for group in groups:
        done += sum(edge.active and edge.line.endswith("_step") for edge in group)
        if ours[done - 1 : done] != theirs[done - 1 : done]:
            break
    case.check("and so is the path", done == len(ours) == len(theirs),
               f"{len(ours)} steps, the last at {ours[-1] if ours else None}")
    return same


def widths(edges, line):
    times = [edge.time_ns for edge in edges if edge.line == line]
    return [fall - rise for rise, fall in zip(times[::2], times[1::2])]


def step_times(case, groups):
    """When each write of steps was asked for and when it came, as far as the edges are the simulated ones."""
    asked, got, place, common = [], [], 0, common_edges(case.motion, groups)
    for group in groups:
        if place + len(group) > common:
            break
        if any(edge.active and edge.line.endswith("_step") for edge in group):
            asked.append(group[0].time_ns)
            got.append(case.motion[place].time_ns)
        place += len(group)
    return asked, got


def check_times(case, groups):
    """How far steps are apart, beside what was asked for, and how long they last."""
    asked, got = step_times(case, groups)
    errors_us = sorted((got[i] - got[i - 1] - asked[i] + asked[i - 1]) / 1e3 for i in range(1, len(got)))
    centiles = statistics.quantiles(errors_us, n=100)
    longer = (got[-1] - got[0]) / (asked[-1] - asked[0]) - 1
    # A pulse that is asked to be shorter than a write lasts as long as one.
    write_us = min(min(widths(case.motion, axis + "_step")) for axis in AXES) / 1e3
    case.check("no pulse is too short", write_us >= case.printer["pulse"]["high_us"], f"{write_us:.2f} us")
    case.check("steps are as far apart as asked for, all but one in a hundred within a write's time",
               abs(centiles[49]) < 1 and centiles[98] < write_us,
               f"least {errors_us[0]:+.2f} us, 1st centile {centiles[0]:+.2f}, median {centiles[49]:+.2f}, "
               f"99th {centiles[98]:+.2f}, most {errors_us[-1]:+.2f}; {100 * longer:.3f} % longer in all")


def check_rest(case, groups):
    """Stopped on the way, with the path up to there the simulated one."""
    common = common_edges(case.motion, groups)
    rest = case.motion[common:]
    case.check("the edges up to the stop are the simulated ones", common > 1000, f"{common} edges")
    case.check("then lines only become inactive", not any(edge.active for edge in rest),
               f"{len(rest)} edges {[key(edge) for edge in rest if edge.active]}")
    case.check("no line is left active", not case.active_at_end(), f"{case.active_at_end()}")


def check_slows_down(case, groups, mark_ns):
    """Whatever way the head is on: the print's own time passes ever slower until it stands still."""
    asked, got = step_times(case, groups)
    first = bisect.bisect_left(got, mark_ns)
    rest_ns = got[-1] - mark_ns if got else 0
    if rest_ns > 0 and len(got) - first > 1:
        middle = bisect.bisect_right(got, mark_ns + rest_ns / 2)
        share = (mark_ns + rest_ns / 2 - got[middle - 1]) / (got[middle] - got[middle - 1])
        half_ns = asked[middle - 1] + share * (asked[middle] - asked[middle - 1])
        halves_ms = (half_ns - asked[first]) / 1e6, (asked[-1] - half_ns) / 1e6
    else:
        halves_ms = 0, 0
    # At a steady rate it would be a third; who stops at once has as much of both.
    case.check("the head comes to rest within a second, ever slower",
               0 < rest_ns < NS and halves_ms[1] < halves_ms[0] / 2,
               f"{rest_ns / NS:.3f} s; {halves_ms[0]:.1f} ms of the print in their first half, "
               f"{halves_ms[1]:.1f} in the second")


def check_heaters_off(case, mark, within_s):
    """On before the mark, off soon after, and off for good."""
    time_ns = case.marks[mark]
    for heater in HEATERS:
        edges = [edge for edge in case.edges if edge.line == heater]
        on = [edge for edge in edges if edge.active and edge.time_ns < time_ns]
        last = edges[-1] if edges else None
        off_s = (last.time_ns - time_ns) / NS if last else 0
        case.check(f"{heater} was on, and is off for good within {within_s:g} s",
                   bool(on) and not last.active and off_s <= within_s,
                   f"{len(on)} times on before, off after {max(0, off_s):.3f} s")


def check_unit(case, waves):
    case.check_status(0)
    case.check("no test was left out", "SKIPPED" not in case.text("out"), case.text("out").splitlines()[-2])


def check_homed(case, waves):
    """The axes of rails.awk: where they stand after homing is what they were above their contacts, the other way."""
    case.check_status(0)
    case.check_says("the head is at x 0.000, y 0.000, z 0.000", "out")
    place = path_of(case.motion)[-1]
    off = [abs(place[i] - wanted) for i, wanted in enumerate((-240, -160, -300, 0))]
    case.check("the axes are at their contacts, within two steps", max(off) <= 2, f"{place}")


def check_cold(case, waves):
    case.check_status(0)
    if check_same(case, waves["cold"]):
        check_times(case, waves["cold"])


def check_terminated(case, waves):
    case.check_status(8)
    check_rest(case, waves["cold"])
    check_slows_down(case, waves["cold"], case.marks["TERM"])
    case.check_says("another print of this file keeps the journal", "second")


def check_killed(case, waves):
    case.check_status(137)
    check_heaters_off(case, "KILL", 0.1)


def check_silent(case, waves):
    case.check_status(7)
    check_heaters_off(case, "STOP", 3.1)


def check_hot(case, waves):
    case.check_status(0)
    check_same(case, waves["hot"])
    waited_s = float((re.search(r"waited ([\d.]+) s", case.text("out")) or [0, "0"])[1])
    case.check("it waited for the temperatures", waited_s > 20, f"{waited_s} s")
    case.check("no line is left active", not case.active_at_end(), f"{case.active_at_end()}")


def check_torn(case, waves):
    case.check_status(7)
    check_heaters_off(case, "torn", 1)
    check_rest(case, waves["hot"])
    case.check_says("a broken wire")


def check_watched(case, waves):
    case.check_status(137)
    ended, died = case.text("ended"), case.text("died")
    case.check("the watchdog is stopped by a print that ends in order", "did not stop" not in ended, ended.strip()[-100:])
    case.check("and strikes after one that does not", "softdog: Triggered" in died, died.strip()[-100:])


CHECKS = {"unit": check_unit, "homed": check_homed, "cold": check_cold, "terminated": check_terminated,
          "killed": check_killed, "silent": check_silent, "hot": check_hot, "torn": check_torn,
          "watched": check_watched}


def main():
    folder, names = pathlib.Path(sys.argv[1]), sys.argv[2:]
    results = folder / "results"
    board = record.Board(folder / "printer.toml", folder / "lines", results / "chips")
    waves = {path.stem: record.read_wave(path) for path in folder.glob("*.vcd")}
    uptime_s = float((results / "uptime").read_text().split()[0])
    print(f"Linux {(results / 'kernel').read_text().strip()}, {uptime_s:.0f} s of its time")
    for name in names:
        CHECKS[name](Case(board, results, name), waves)
    print(f"{failures} failed" if failures else "all passed")
    sys.exit(failures > 0)


main()
