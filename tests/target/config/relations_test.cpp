// Contract of target/config/printer.h, 10: combinations of keys that a new owner would notice only at the printer.

#include <doctest/doctest.h>

#include <map>

#include "target/config/printer.h"

using namespace lyr;
using namespace lyr::config;

namespace {

// A Cartesian printer, line by line from 1; what a test adds to a section goes behind its header.
const std::string cartesian =
    "[axis.x]\nsteps_per_mm = 80\nmax_speed_mm_s = 200\nmax_acceleration_mm_s2 = 3000\n"
    "range_mm = [0, 200]\n"
    "[axis.y]\nsteps_per_mm = 80\nmax_speed_mm_s = 150\nmax_acceleration_mm_s2 = 2000\n"
    "range_mm = [0, 200]\n"
    "[axis.z]\nsteps_per_mm = 400\nmax_speed_mm_s = 10\nmax_acceleration_mm_s2 = 300\n"
    "range_mm = [0, 180]\n"
    "[axis.e]\nsteps_per_mm = 415\nmax_speed_mm_s = 40\nmax_acceleration_mm_s2 = 5000\n";

std::string delta(const std::string& more_of_towers) {
    std::string text =
        "kinematics = \"delta\"\n[delta]\narm_mm = 250\nradius_mm = 110\nreach_mm = 90\n" +
        cartesian;
    for (const char* range : {"[0, 200]", "[0, 200]"})
        text.replace(text.find(range), 8, "[-90, 90]");
    for (const char* axis : {"[axis.x]\n", "[axis.y]\n", "[axis.z]\n"}) {
        std::string line = more_of_towers;
        if (const std::size_t at = line.find('#'); at != std::string::npos) line[at] = axis[6];
        text.insert(text.find(axis) + 9, line);
    }
    return text;
}
const std::string towers = "endstop = \"STOP_#\"\n";

std::string with(const std::string& section, const std::string& lines) {
    std::string text = cartesian;
    const std::size_t at = text.find('[' + section + "]\n");
    REQUIRE(at != std::string::npos);
    return text.insert(at + section.size() + 3, lines);
}

void check_taken(const std::string& text) {
    const Result<Printer> printer = parse_printer(text, "p.toml");
    CHECK_MESSAGE(printer.ok(), text, (printer.ok() ? "" : to_string(printer.error())));
}

// The line that is complained about, and what is said.
void check_refused(const std::string& text, const std::string& line, const std::string& message) {
    CAPTURE(text);
    const Result<Printer> printer = parse_printer(text, "p.toml");
    REQUIRE_FALSE(printer.ok());
    CHECK_MESSAGE(printer.error().message == message, printer.error().message);
    std::size_t begin = 0;
    for (std::uint32_t i = 1; i < printer.error().where.line; ++i)
        begin = text.find('\n', begin) + 1;
    CHECK(text.substr(begin, text.find('\n', begin) - begin) == line);
}

// Taken with `needed`, refused without.
void check_idle(const std::string& lines, const std::string& needed, const std::string& message) {
    check_taken(lines + needed + cartesian);
    check_refused(lines + cartesian, lines.substr(0, lines.find('\n')), message);
}

}  // namespace

TEST_CASE("printer 10: keys of an endstop need one") {
    for (const std::string key :
         {"endstop_end = \"high\"", "endstop_mm = 100", "home_slow_mm_s = 3",
          "home_speed_mm_s = 30", "home_back_off_mm = 2"}) {
        const std::string name = key.substr(0, key.find(' '));
        const std::string of_y = key == "endstop_mm = 100" ? "endstop_mm = -1" : key;
        check_refused(with("axis.y", of_y + '\n'), of_y,
                      "axis.y." + name + ": does nothing without axis.y.endstop");
        check_taken(with("axis.y", of_y + "\nendstop = 5\n"));
    }
    check_refused(with("axis.z", "home_speed_mm_s = 5\n") + "[probe]\ninput = 9\n",
                  "home_speed_mm_s = 5",
                  "axis.z.home_speed_mm_s: does nothing without axis.z.endstop; z is homed as "
                  "[probe] says");
}

TEST_CASE("printer 10: what would do nothing is refused, and taken beside what it needs") {
    const std::string probe = "[probe]\ninput = 9\n";
    check_idle("[probe]\nsamples = 3\n", "input = 9\n", "probe: does nothing without probe.input");
    check_idle("homing.tolerance_mm = 0.1\n", probe,
               "homing.tolerance_mm: does nothing without an endstop or probe.input");
    check_idle("homing.before_print = true\n", probe,
               "homing.before_print: does nothing without an endstop or probe.input");
    check_taken("homing.before_print = false\n" + cartesian);
    check_idle("mesh.points = [3, 3]\n", probe,
               "mesh.points: does nothing without probe.input, to measure the bed by, or "
               "mesh.heights_mm");
    check_idle("mesh.fade_mm = 5\n",
               "mesh.points = [2, 2]\nmesh.area_mm = [0, 0, 9, 9]\n"
               "mesh.heights_mm = [[0, 1], [0, 1]]\n",
               "mesh.fade_mm: does nothing without probe.input, to measure the bed by, or "
               "mesh.heights_mm");
    check_idle("simulate.probe_noise_mm = 0.01\n", probe,
               "simulate.probe_noise_mm: does nothing without probe.input");
    check_idle("pressure_advance.smooth_s = 0.03\n", "pressure_advance.advance_s = 0\n",
               "pressure_advance.smooth_s: does nothing without pressure_advance.advance_s");
    check_idle("timing.write_us = 3\n", "timing.late_us = 100\n",
               "timing.write_us: does nothing without timing.late_us");
    check_idle("watchdog.timeout_s = 20\n", "watchdog.device = \"/dev/watchdog\"\n",
               "watchdog.timeout_s: does nothing without watchdog.device");
    check_taken("fan.part.cycle_s = 0.5\n" + cartesian);
    check_refused(
        "fan.part.cycle_s = 0.5\nfan.part.pwm = \"/sys/p\"\n" + cartesian, "fan.part.cycle_s = 0.5",
        "fan.part.cycle_s: does nothing beside fan.part.pwm, whose folder has a period of "
        "its own");
    check_refused("simulate.arm_error_mm = [1, 1, 1]\n" + cartesian,
                  "simulate.arm_error_mm = [1, 1, 1]",
                  "simulate.arm_error_mm: does nothing but on a delta");
    check_refused(
        "homing.order = \"xyz\"\n" + delta(towers), "homing.order = \"xyz\"",
        "homing.order: does nothing on a delta, which homes all towers at once and upwards");
}

TEST_CASE("printer 10: a probe that is never over the bed, or has no height to begin from") {
    const std::string probe = "[probe]\ninput = 9\n";
    check_refused(cartesian + probe + "offset_mm = [0, 210, 1]\n", "offset_mm = [0, 210, 1]",
                  "probe.offset_mm: so far from the nozzle the probe is never over the bed");
    const std::string far = probe + "offset_mm = [0, 110, 1]\n";
    check_refused(cartesian + far, "offset_mm = [0, 110, 1]",
                  "probe.offset_mm: with it the probe, which homes z, cannot get to the middle of "
                  "the bed; say in probe.home_mm where it can");
    check_taken(cartesian + far + "home_mm = [100, 150]\n");
    check_taken(with("axis.z", "endstop = 4\n") + far);
    check_refused(cartesian + probe + "offset_mm = [0, 0, 2]\nreach_mm = 99\nlift_mm = 80\n",
                  "reach_mm = 99",
                  "probe.reach_mm: probing begins at probe.lift_mm = 80 and probe.reach_mm = 99 "
                  "over where the probe triggers, which is more than all of axis.z.range_mm = [0, "
                  "180]");
    check_taken(cartesian + probe + "offset_mm = [0, 0, 1]\nreach_mm = 99\nlift_mm = 80\n");
    std::string low = cartesian;
    low.replace(low.find("[0, 180]"), 8, "[0, 16]");
    check_taken(low + probe);
    check_refused(low + probe + "[homing]\nlift_mm = 16\n", "lift_mm = 16",
                  "homing.lift_mm: homing.lift_mm = 16 is more than all of axis.z.range_mm = [0, "
                  "16]");
    check_taken(delta(towers) + probe + "offset_mm = [60, 60, 1]\n");
    check_refused(delta(towers) + probe + "offset_mm = [70, 70, 1]\n", "offset_mm = [70, 70, 1]",
                  "probe.offset_mm: so far from the nozzle the probe is never over the bed");
    check_refused(delta("") + probe, "input = 9",
                  "probe.input: a delta is probed only after it has been homed by its endstops, "
                  "axis.x.endstop and so on, which it has none of");
}

TEST_CASE("printer 10: a jump in speed was taken for a limit of jerk") {
    check_refused("max_jerk_mm_s3 = 8\n" + cartesian, "max_jerk_mm_s3 = 8",
                  "max_jerk_mm_s3: with 8 no axis gets to its max_acceleration_mm_s2 within a "
                  "second, and every move would crawl; it is a change of acceleration, not the "
                  "jump in speed that some firmwares call jerk: 100000 is a start, 0 no limit");
    check_taken("max_jerk_mm_s3 = 2000\n" + cartesian);
    check_taken("max_jerk_mm_s3 = 0\n" + cartesian);
}

TEST_CASE("printer 10: the belts of a CoreXY were calibrated as if they were axes") {
    const auto steps_of_y = [](const std::string& steps) {
        std::string text = with("axis.y", "#");
        return text.replace(text.find("#steps_per_mm = 80"), 18, "steps_per_mm = " + steps);
    };
    check_taken(steps_of_y("80.4"));
    check_refused(
        "kinematics = \"corexy\"\n" + steps_of_y("80.4"), "steps_per_mm = 80.4",
        "axis.y.steps_per_mm: 80.4 is not axis.x.steps_per_mm = 80, nor that doubled or "
        "halved for other microsteps: both belts of a CoreXY move x as well as y, so that "
        "neither axis has steps of its own");
    for (const char* steps : {"80", "160", "20"})
        check_taken("kinematics = \"corexy\"\n" + steps_of_y(steps));
}

TEST_CASE("printer 10: a simulated head that endstops never find, or that no arms hold") {
    const std::string homed = with("axis.x", "endstop = 5\n");
    check_taken("simulate.head_mm = [209, 500, 500]\n" + homed);
    check_refused(
        "simulate.head_mm = [211, 0, 0]\n" + homed, "simulate.head_mm = [211, 0, 0]",
        "simulate.head_mm: x = 211 is outside of axis.x.range_mm = [0, 200], by more than "
        "homing.margin_mm = 10");
    check_taken(delta(towers) + "[simulate]\nhead_mm = [0, 90, 400]\n");
    check_refused(delta(towers) + "[simulate]\nhead_mm = [0, 91, 40]\n", "head_mm = [0, 91, 40]",
                  "simulate.head_mm: farther from the middle than delta.reach_mm");
    std::string tight = delta(towers);
    tight.replace(tight.find("arm_mm = 250"), 12, "arm_mm = 230");
    check_taken(tight + "[simulate]\nradius_error_mm = [0, 12, 0]\n");
    check_refused(tight + "[simulate]\nradius_error_mm = [0, 12, 0]\narm_error_mm = [1, -20, 0]\n",
                  "[simulate]", "simulate: with these errors an arm does not reach delta.reach_mm");
}

TEST_CASE("printer 10: a heater's range ends within what its sensor measures") {
    const auto tool = [](const std::string& lines) {
        return cartesian + "[heater.tool]\n" + lines;
    };
    check_taken(tool("range_c = [0, 305]\n"));
    check_refused(
        tool("range_c = [0, 310]\n"), "range_c = [0, 310]",
        "heater.tool.range_c: it lets the heater get to 305 °C, and a thermistor lasts to "
        "300 °C; it may end at 305");
    check_taken(tool("range_c = [0, 500]\nsensor.kind = \"pt1000\"\n"));
    check_refused(
        tool("range_c = [0, 700]\nsensor.kind = \"pt1000\"\n"), "range_c = [0, 700]",
        "heater.tool.range_c: it lets the heater get to 695 °C, and a pt1000 lasts to 600 "
        "°C; it may end at 605");
    const std::string points = "sensor.points = [[25, 100000], [150, 1641.9], [250, 226.15]]\n";
    check_taken(tool("sensor.kind = \"table\"\n" + points));
    check_refused(tool("sensor.kind = \"table\"\nrange_c = [0, 350]\n" + points),
                  "range_c = [0, 350]",
                  "heater.tool.range_c: it lets the heater get to 345 °C, and sensor.points end at "
                  "250 °C, and more than 50 beyond them the curve is a guess; it may end at 305");
    check_refused(tool("sensor.kind = \"table\"\nsensor.points = [[80, 12000], [250, 230]]\n"),
                  "sensor.points = [[80, 12000], [250, 230]]",
                  "heater.tool.sensor.points: a cold heater has 20 °C, and they begin at 80; more "
                  "than 50 before them the curve is a guess");
    const std::string one_wire =
        "[heater.bed]\nsensor.kind = \"celsius\"\n"
        "sensor.file = \"/sys/bus/w1/devices/28-0316/temperature\"\n";
    check_taken(cartesian + one_wire + "range_c = [0, 125]\n");
    check_refused(cartesian + one_wire + "range_c = [0, 130]\n", "range_c = [0, 130]",
                  "heater.bed.range_c: it lets the heater get to 125 °C, and a 1-wire thermometer "
                  "counts to 125 °C and could not tell 5 more; it may end at 125");
    // A thermocouple's converter on the same bus.
    std::string couple = one_wire;
    couple.replace(couple.find("28-"), 3, "3b-");
    check_taken(cartesian + couple);
}

TEST_CASE("printer 10: a sensor's file and its kind go together") {
    const auto tool = [](const std::string& lines) {
        return cartesian + "[heater.tool]\n" + lines;
    };
    const std::string raw = "sensor.file = \"/sys/bus/iio/devices/iio:device1/in_temp_raw\"\n";
    check_refused(tool("sensor.kind = \"celsius\"\n" + raw), raw.substr(0, raw.size() - 1),
                  "heater.tool.sensor.file: this file holds counts: it needs "
                  "heater.tool.sensor.celsius_per_unit, which is 0.25 for a MAX31855 or MAX6675");
    check_taken(tool("sensor.kind = \"celsius\"\nsensor.celsius_per_unit = 0.25\n" + raw));
    check_refused(tool(raw), raw.substr(0, raw.size() - 1),
                  "heater.tool.sensor.file: this file holds a temperature: it needs "
                  "heater.tool.sensor.kind = \"celsius\"");
    check_taken(tool("sensor.file = \"/sys/bus/iio/devices/iio:device1/in_voltage0_raw\"\n"));
    const std::string hwmon = "sensor.file = \"/sys/class/hwmon/hwmon2/temp1_input\"\n";
    check_refused(tool(hwmon), hwmon.substr(0, hwmon.size() - 1),
                  "heater.tool.sensor.file: this file holds a temperature: it needs "
                  "heater.tool.sensor.kind = \"celsius\"");
    check_taken(tool("sensor.kind = \"celsius\"\n" + hwmon));
    check_refused(tool("sensor.kind = \"celsius\"\nsensor.full_scale = 1023\n"),
                  "sensor.full_scale = 1023",
                  "heater.tool.sensor.full_scale: not for heater.tool.sensor.kind = \"celsius\", "
                  "whose driver states the temperature itself");
}

TEST_CASE("printer 10: a divider shows a cold sensor and a hot one, each of its kind") {
    const auto tool = [](const std::string& lines) {
        return cartesian + "[heater.tool]\n" + lines;
    };
    for (const std::string_view kind : sensor_kinds) {
        if (kind == "steinhart_hart" || kind == "table") continue;
        check_taken(tool("sensor.kind = \"" + std::string(kind) + "\"\n"));
        if (kind == "celsius") continue;
        check_taken(
            tool("sensor.full_scale = 1023\nsensor.kind = \"" + std::string(kind) + "\"\n"));
    }
    check_refused(tool("sensor.pullup_ohm = 100\n"), "sensor.pullup_ohm = 100",
                  "heater.tool.sensor.pullup_ohm: at 20 °C the sensor has 1.25e+05 Ohm, and under "
                  "pullup_ohm = 100 that reads as a broken wire");
    check_refused(tool("sensor.pullup_ohm = 200000\n"), "sensor.pullup_ohm = 200000",
                  "heater.tool.sensor.pullup_ohm: at 275 °C the sensor has 238 Ohm, and under "
                  "pullup_ohm = 200000 that reads as a short circuit");
    check_refused(tool("sensor.kind = \"beta\"\nsensor.r25_ohm = 1000\nsensor.beta_k = 5000\n"),
                  "sensor.kind = \"beta\"",
                  "heater.tool.sensor.kind: at 275 °C the sensor has 0.477 Ohm, and under "
                  "pullup_ohm = 4700 that reads as a short circuit");
    check_refused(tool("sensor.pullup_ohm = 47000\nsensor.full_scale = 1023\n"),
                  "sensor.full_scale = 1023",
                  "heater.tool.sensor.full_scale: at 270 °C one count of the converter is 13.5 °C, "
                  "and guard.stray_c is 4: it takes a smaller pullup_ohm, or a converter with more "
                  "counts");
    check_refused(tool("sensor.kind = \"steinhart_hart\"\n"
                       "sensor.points = [[25, 100000], [150, 99000], [250, 300]]\n"),
                  "sensor.points = [[25, 100000], [150, 99000], [250, 300]]",
                  "heater.tool.sensor.points: the curve through them has no resistance for 20 °C");
}

TEST_CASE("printer 10: guards and models that would end every print") {
    const auto bed = [](const std::string& lines) { return cartesian + "[heater.bed]\n" + lines; };
    check_refused(bed("guard.gain_c = 50\nguard.gain_time_s = 2\n"), "guard.gain_c = 50",
                  "heater.bed.guard.gain_c: guard.gain_c = 50 in guard.gain_time_s = 2 is faster "
                  "than guard.rate_c_s = 20, which no heater may be");
    check_refused(bed("cycle_s = 30\nguard.frozen_time_s = 59\n"), "guard.frozen_time_s = 59",
                  "heater.bed.guard.frozen_time_s: guard.frozen_time_s = 59 must be at least two "
                  "cycles of cycle_s = 30, or a sound sensor could be taken for dead");
    check_taken(bed("cycle_s = 30\n"));
    check_refused(bed("kp = 0\nki = 0\n"), "kp = 0",
                  "heater.bed.kp: with kp = 0 and ki = 0 the heater would never be switched on");
    check_taken(bed("ki = 0\n"));
    check_taken(bed("pwm = \"/sys/p\"\nguard.frozen_time_s = 1\n"));
    check_refused(
        bed("model.power_w = 10\nmodel.loss_w_k = 0.05\n"), "model.power_w = 10",
        "heater.bed.model: 10 W warm capacity_j_k = 700 by 0.86 °C in guard.gain_time_s = "
        "60 at the most, and guard.gain_c is 2");
    const auto tool = [](const std::string& lines) {
        return cartesian + "[heater.tool]\n" + lines;
    };
    check_refused(tool("model.power_w = 12\n"), "model.power_w = 12",
                  "heater.tool.model: 12 W against loss_w_k = 0.1 get to 140 °C at the most, and "
                  "heater.tool.min_extrude_c is 170");
    check_taken(tool("model.power_w = 16\n"));
    // The default model is no claim of the owner's.
    check_taken(tool("max_power = 0.3\n"));
}
