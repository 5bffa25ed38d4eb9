"""What the kernel recorded in the guest, and what lyrrun simulated, as lists of changes of lines.

A record is that of the event gpio:gpio_value, one entry a line and write, in the pages of the kernel's ring buffer as
they are read from trace_pipe_raw, one file a processor. Texts of trace_marker stand between.
"""

import heapq
import re
import struct
import tomllib
from dataclasses import dataclass

PAGE = 4096


@dataclass
class Entry:
    time_ns: int
    line: int = -1  # its number on the whole machine; -1: a mark
    level: int = 0
    text: str = ""


@dataclass
class Edge:
    """A line that becomes active or inactive; `line` is its purpose, such as x_step."""

    time_ns: int
    line: str
    active: bool


def event_number(results, name):
    return int(re.search(r"^ID: (\d+)", (results / "formats" / name).read_text(), re.M).group(1))


def read_pages(data):
    """(time, payload) of each event of the ring buffer, as Documentation/trace/ring-buffer-map and the kernel's
    header_page and header_event state it."""
    for start in range(0, len(data) - PAGE + 1, PAGE):
        time_ns, commit = struct.unpack_from("<QQ", data, start)
        place, end = start + 16, start + 16 + (commit & 0xFFFFF)
        while place < end:
            (head,) = struct.unpack_from("<I", data, place)
            kind, delta = head & 31, head >> 5
            place += 4
            if kind == 29:  # padding
                (length,) = struct.unpack_from("<I", data, place)
                if not delta:
                    break
                place += length
                continue
            if kind in (30, 31):  # a long time since the last event, or the time itself
                (high,) = struct.unpack_from("<I", data, place)
                place += 4
                whole = delta + (high << 27)
                time_ns = time_ns + whole if kind == 30 else whole
                continue
            time_ns += delta
            if kind:
                length = 4 * kind
            else:
                length = struct.unpack_from("<I", data, place)[0] - 4
                place += 4
            yield time_ns, data[place : place + length]
            place += length


def read_record(results, case):
    value, mark = event_number(results, "gpio_value"), event_number(results, "print")
    files = sorted((results / case).glob("trace*"))
    for time_ns, event in heapq.merge(*(read_pages(file.read_bytes()) for file in files)):
        (number,) = struct.unpack_from("<H", event)
        if number == value:
            line, is_read, level = struct.unpack_from("<Iii", event, 8)
            if not is_read:
                yield Entry(time_ns, line, level)
        elif number == mark:
            yield Entry(time_ns, text=event[16:].split(b"\0")[0].decode().strip())


class Board:
    """Which line of the guest is for what: by the printer's file, the table of named lines and the chips' numbers."""

    def __init__(self, printer_path, table_path, chips_path):
        self.printer = tomllib.loads(printer_path.read_text())
        self.names = {}
        if table_path.exists():
            for chip, number, name in map(str.split, table_path.read_text().splitlines()):
                self.names[chip, name] = int(number)
        bases = dict(map(str.split, chips_path.read_text().splitlines()))
        self.base = {chip: int(base) for chip, base in bases.items()}
        self.purpose = {}  # by number on the whole machine: its name, and whether it is active at the low level
        for axis, keys in self.printer["axis"].items():
            self.add(axis + "_step", keys.get("step"))
            self.add(axis + "_direction", keys.get("direction"), keys.get("invert", False))
            self.add(axis + "_enable", keys.get("enable"))
        for heater, keys in self.printer.get("heater", {}).items():
            self.add("heater_" + heater, keys.get("output"))
        self.add("fan_part", self.printer.get("fan", {}).get("part", {}).get("output"))

    def add(self, purpose, pin, inverted=False):
        if pin is None:
            return
        pin = pin if isinstance(pin, dict) else {"line": pin}
        chip, line = pin.get("chip", self.printer.get("chip", "gpiochip0")), pin["line"]
        number = self.names.get((chip, line)) if isinstance(line, str) else line
        if number is not None:
            self.purpose[self.base[chip] + number] = (purpose, pin.get("active_low", False) != inverted)


def edges_of(record, purpose):
    """Changes only: most writes repeat what a line has already. A line is inactive before its first entry."""
    active = {}
    for entry in record:
        if entry.line not in purpose:
            continue
        name, inverted = purpose[entry.line]
        now = (entry.level == 1) != inverted
        if now != active.get(name, False):
            yield Edge(entry.time_ns, name, now)
        active[name] = now


def read_wave(path):
    """The groups of edges that a Value Change Dump of lyrrun has, one a write."""
    names, active, groups, time_ns = {}, {}, [], 0
    for line in path.read_text().splitlines():
        if line.startswith("$var"):
            _, _, _, identifier, name, _ = line.split()
            names[identifier] = name
        elif line.startswith("#"):
            time_ns = int(line[1:])
            groups.append([])
        elif line[0] in "01" and groups:
            name, now = names[line[1:]], line[0] == "1"
            if now != active.get(name, False):
                groups[-1].append(Edge(time_ns, name, now))
            active[name] = now
    return [group for group in groups if group]
