// Contract of target/config/printer.h, by number.

#include "target/config/printer.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

using namespace lyr;
using namespace lyr::config;

namespace {

// A whole file, into which tests write their mistakes. Lines count from 1.
const std::string good =
    "name = \"test\"\n"                                                 // 1
    "start_mm = [1, 2.5, 0]\n"                                          // 2
    "[pulse]\n"                                                         // 3
    "high_us = 1.5\n"                                                   // 4
    "[axis.x]\n"                                                        // 5
    "steps_per_mm = 80\n"                                               // 6
    "max_speed_mm_s = 300\n"                                            // 7
    "max_acceleration_mm_s2 = 3000\n"                                   // 8
    "range_mm = [0, 220]\n"                                             // 9
    "step = 17\n"                                                       // 10
    "direction = \"X_DIR\"\n"                                           // 11
    "enable = { chip = \"gpiochip1\", line = 3, active_low = true }\n"  // 12
    "[axis.y]\n"                                                        // 13
    "steps_per_mm = 80.5\n"                                             // 14
    "max_speed_mm_s = 300\n"                                            // 15
    "max_acceleration_mm_s2 = 3000\n"                                   // 16
    "range_mm = [-10.5, 220]\n"                                         // 17
    "invert = true\n"                                                   // 18
    "[axis.z]\n"                                                        // 19
    "steps_per_mm = 400\n"                                              // 20
    "max_speed_mm_s = 10\n"                                             // 21
    "max_acceleration_mm_s2 = 100\n"                                    // 22
    "range_mm = [0, 200]\n"                                             // 23
    "[axis.e]\n"                                                        // 24
    "steps_per_mm = 415\n"                                              // 25
    "max_speed_mm_s = 40\n"                                             // 26
    "max_acceleration_mm_s2 = 5000\n";                                  // 27

std::string with(const std::string& old_text, const std::string& new_text) {
    std::string text = good;
    const std::size_t at = text.find(old_text);
    REQUIRE(at != std::string::npos);
    return text.replace(at, old_text.size(), new_text);
}

Diagnostic error_of(const std::string& text) {
    CAPTURE(text);
    const Result<Printer> printer = parse_printer(text, "printer.toml");
    REQUIRE_FALSE(printer.ok());
    CHECK(printer.error().status == ExitStatus::input);
    CHECK(printer.error().where.file == "printer.toml");
    CHECK(printer.error().message.find('\n') == std::string::npos);
    return printer.error();
}

void check_error(const std::string& text, std::uint32_t line, const std::string& part) {
    const Diagnostic error = error_of(text);
    CAPTURE(error.message);
    CHECK(error.where.line == line);
    CHECK(error.message.find(part) != std::string::npos);
}

std::string file_text(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

}  // namespace

TEST_CASE("printer: a whole file arrives as it is written") {
    const Result<Printer> read = parse_printer(good, "printer.toml");
    REQUIRE_MESSAGE(read.ok(), read.error().message);
    const Printer& printer = *read;
    CHECK(printer.name == "test");
    CHECK(printer.start_mm == std::array<double, 3>{1, 2.5, 0});
    CHECK(printer.pulse.high_ns == 1'500);
    CHECK(printer.pulse.low_ns == PulseTiming{}.low_ns);
    CHECK_FALSE(printer.filament_diameter_mm.has_value());
    const Axis& x = printer.axes[axis_x];
    CHECK(x.steps_per_mm == 80);
    CHECK(x.max_speed_mm_s == 300);
    CHECK(x.max_acceleration_mm_s2 == 3000);
    CHECK(x.max_mm == 220);
    CHECK_FALSE(x.invert);
    REQUIRE((x.step && x.direction && x.enable));
    CHECK(x.step->chip == "gpiochip0");
    CHECK(std::get<std::uint32_t>(x.step->line) == 17);
    CHECK(std::get<std::string>(x.direction->line) == "X_DIR");
    CHECK(x.enable->chip == "gpiochip1");
    CHECK(x.enable->active_low);
    CHECK_FALSE(x.enable->open_drain);
    const auto open = parse_printer(with("active_low = true }", "open_drain = true }"), "p");
    REQUIRE(open.ok());
    CHECK(open->axes[axis_x].enable->open_drain);
    CHECK(printer.axes[axis_y].steps_per_mm == 80.5);
    CHECK(printer.axes[axis_y].min_mm == -10.5);
    CHECK(printer.axes[axis_y].invert);
    CHECK_FALSE(printer.axes[axis_y].step.has_value());
    CHECK(printer.axes[axis_e].steps_per_mm == 415);
}

TEST_CASE("printer: the chip of all lines may be named once, before or after them") {
    const Result<Printer> read = parse_printer("chip = \"pinctrl-bcm2835\"\n" + good, "p");
    REQUIRE(read.ok());
    CHECK(read->axes[axis_x].step->chip == "pinctrl-bcm2835");
    CHECK(read->axes[axis_x].enable->chip == "gpiochip1");
}

TEST_CASE("printer 2: unknown keys come with line and nearest key") {
    check_error(with("steps_per_mm = 80\n", "stpes_per_mm = 80\n"), 6,
                "did you mean `steps_per_mm`?");
    check_error(with("[pulse]", "[puls]"), 3, "did you mean `pulse`?");
    check_error(with("[axis.e]", "[axis.extruder]"), 24, "unknown key `extruder` in [axis]");
    check_error(with("high_us", "hihg_us"), 4, "did you mean `high_us`?");
    check_error(with("active_low", "activelow"), 12, "did you mean `active_low`?");
    check_error(with("name", "colour"), 1, "docs/configuration.md");
    check_error(with("name =", "\"axis.x.invert\" ="), 1, "unknown key `axis.x.invert`");
    check_error(with("[axis.e]\n", "[axis.e]\nrange_mm = [0, 1]\n"), 25, "unknown key `range_mm`");
}

TEST_CASE("printer 2: limits at which no machine ever gets anywhere were simulated for ever") {
    check_error(with("max_acceleration_mm_s2 = 100\n", "max_acceleration_mm_s2 = 1e-9\n"), 22,
                "from 1 to 1000000");
    check_error(with("max_speed_mm_s = 10\n", "max_speed_mm_s = 0.01\n"), 21, "from 0.1 to 10000");
    check_error(with("steps_per_mm = 400\n", "steps_per_mm = 1e-3\n"), 20, "from 0.1 to 100000");
    check_error(good + "[pause]\nspeed_mm_s = 0.001\n", 29, "from 0.1 to 10000");
    CHECK(parse_printer(with("max_acceleration_mm_s2 = 100\n", "max_acceleration_mm_s2 = 1\n"), "p")
              .ok());
}

TEST_CASE("printer 2: wrong types and ranges come with line, rule and what was found") {
    check_error(with("= 80\n", "= \"80\"\n"), 6,
                "axis.x.steps_per_mm: expected a number from 0.1 to 100000");
    check_error(with("= 80\n", "= 0\n"), 6, "found 0");
    check_error(with("= 80\n", "= -80\n"), 6, "found -80");
    check_error(with("= 80\n", "= nan\n"), 6, "expected a number");
    check_error(with("= 80\n", "= inf\n"), 6, "expected a number");
    check_error(with("= 80\n", "= true\n"), 6, "found true or false");
    check_error(with("= 80\n", "= 9223372036854775807\n"), 6, "from 0.1 to 100000");
    check_error(with("[0, 220]", "[220, 0]"), 9, "the first below the second");
    check_error(with("[0, 220]", "[0]"), 9, "[lowest, highest]");
    check_error(with("[0, 220]", "[0, \"220\"]"), 9, "[lowest, highest]");
    check_error(with("[1, 2.5, 0]", "[1, 2.5]"), 2, "[x, y, z]");
    check_error(with("= 17", "= -1"), 10, "axis.x.step: expected the number");
    check_error(with("= 17", "= 70000"), 10, "found 70000");
    check_error(with("= 17", "= \"\""), 10, "name of a line");
    check_error(with("= 17", "= { chip = \"gpiochip0\" }"), 10, "expected `line`");
    check_error(with("invert = true", "invert = 1"), 18, "expected true or false, found 1");
    check_error(with("name = \"test\"", "name = \"\""), 1, "empty");
    check_error(with("name = \"test\"", "kinematics = \"scara\""), 1,
                "expected \"cartesian\", \"corexy\" or \"delta\"");
    check_error(with("name = \"test\"", "name = \"test\"\njunction_deviation_mm = 2"), 2, "0 to 1");
    check_error(with("[pulse]\nhigh_us = 1.5", "pulse = 3"), 3, "expected a section [pulse]");
    check_error(with("= 1.5", "= 0"), 4, "0.05 to 1000");
}

TEST_CASE("printer 2: a key that stands twice, and text that is not TOML, come with their line") {
    check_error(with("= 80\n", "= 80\nsteps_per_mm = 81\n"), 7, "");
    check_error(with("[axis.e]", "[axis.x]"), 24, "");
    check_error(with("= 80\n", "= \n"), 6, "");
    check_error(with("[axis.e]", "[axis.e"), 24, "");
    check_error("\xff\xfe\x01 not a text", 1, "");
    check_error("name = \"never closed", 1, "");
}

TEST_CASE("printer 2: the first error in the file is given, not the first by name") {
    check_error(with("[axis.z]", "[axis.zz]"), 19, "unknown key `zz`");
    std::string two = with("invert = true", "invert = 1");
    two.replace(two.find("[axis.e]\nsteps_per_mm = 415"), 27, "[axis.e]\nsteps_per_mm = 0  ");
    check_error(two, 18, "invert");
}

TEST_CASE("printer: a start or a park place outside of the axes was taken") {
    check_error(with("[1, 2.5, 0]", "[1, 2.5, -1]"), 2,
                "start_mm: z = -1 is outside of axis.z.range_mm");
    check_error(with("[1, 2.5, 0]", "[221, 2.5, 0]"), 2,
                "x = 221 is outside of axis.x.range_mm = [0, 220]");
    std::string none = with("start_mm = [1, 2.5, 0]\n", "\n");
    none.replace(none.find("[0, 220]"), 8, "[5, 220]");
    check_error(none, 9, "start_mm is [0, 0, 0] where it is not given");
    check_error(good + "[pause]\npark_mm = [0, -11]\n", 29,
                "y = -11 is outside of axis.y.range_mm = [-10.5, 220]");
}

TEST_CASE("printer 3: each axis must have its own figures") {
    check_error(with("steps_per_mm = 80\n", ""), 5, "axis.x.steps_per_mm is missing");
    check_error(with("range_mm = [0, 220]\n", ""), 5, "axis.x.range_mm is missing");
    check_error(good.substr(0, good.find("[axis.e]")), 5, "axis.e.");
    check_error("", 0, "is missing");
}

TEST_CASE("printer 1: a speed that leaves no time for the pulses is refused") {
    // 80 steps/mm x 300 mm/s: 41.7 us a step.
    check_error(with("high_us = 1.5", "high_us = 40"), 7, "axis.x.max_speed_mm_s: 24000 steps");
    CHECK(parse_printer(with("high_us = 1.5", "high_us = 35"), "p").ok());
}

TEST_CASE("printer 4: no line may be used twice") {
    check_error(with("direction = \"X_DIR\"", "direction = 17"), 11, "already used");
    check_error(with("invert = true", "step = 17"), 18, "already used by axis.x.step");
    check_error(with("invert = true", "enable = { chip = \"gpiochip1\", line = 3 }"), 18, "share");
    CHECK(parse_printer(with("invert = true", "step = { chip = \"gpiochip1\", line = 17 }"), "p")
              .ok());
}

TEST_CASE("printer 5: docs/configuration.md lists every known key") {
    const std::string page = file_text(std::filesystem::path(LYR_DOCS) / "configuration.md");
    REQUIRE_FALSE(page.empty());
    const std::vector<std::string> keys = known_keys();
    CHECK(keys.size() > 20);
    for (const std::string& key : keys) {
        CAPTURE(key);
        CHECK(page.find('`' + key + '`') != std::string::npos);
    }
}

TEST_CASE("printer 1, 3: the sample files are right, and generic.toml is the built-in printer") {
    std::size_t files = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(LYR_FIXTURES) + "/printers")) {
        if (entry.path().extension() != ".toml") continue;
        const Result<Printer> printer = read_printer(entry.path().string());
        CHECK_MESSAGE(printer.ok(), to_string(printer.ok() ? Diagnostic{} : printer.error()));
        ++files;
    }
    CHECK(files >= 3);
    const Result<Printer> read = read_printer(std::string(LYR_FIXTURES) + "/printers/generic.toml");
    REQUIRE(read.ok());
    const Printer built_in = generic_printer();
    CHECK(read->name == built_in.name);
    CHECK(read->junction_deviation_mm == built_in.junction_deviation_mm);
    CHECK(read->start_mm == built_in.start_mm);
    CHECK(read->pulse.high_ns == built_in.pulse.high_ns);
    CHECK(read->pulse.low_ns == built_in.pulse.low_ns);
    CHECK(read->pulse.direction_setup_ns == built_in.pulse.direction_setup_ns);
    CHECK(read->pulse.direction_hold_ns == built_in.pulse.direction_hold_ns);
    CHECK(read->pulse.late_limit_ns == built_in.pulse.late_limit_ns);
    for (std::size_t i = 0; i < axis_count; ++i) {
        const Axis &a = read->axes[i], &b = built_in.axes[i];
        CHECK(a.steps_per_mm == b.steps_per_mm);
        CHECK(a.max_speed_mm_s == b.max_speed_mm_s);
        CHECK(a.max_acceleration_mm_s2 == b.max_acceleration_mm_s2);
        CHECK(a.min_mm == b.min_mm);
        CHECK(a.max_mm == b.max_mm);
        CHECK(a.invert == b.invert);
    }
    for (std::size_t i = 0; i < heater_count; ++i)
        CHECK(read->heaters[i].has_value() == built_in.heaters[i].has_value());
    CHECK(read->part_fan.has_value() == built_in.part_fan.has_value());
}

TEST_CASE("printer 2: heaters have the defaults of their kind, and each key overrides its own") {
    const auto with = [](const std::string& text) {
        return parse_printer(good + '\n' + text, "heat.toml");
    };
    const Result<Printer> none = with("");
    REQUIRE(none.ok());
    for (const auto& heater : none->heaters) CHECK_FALSE(heater);
    const Result<Printer> bed = with("[heater.bed]\nguard.gain_time_s = 90\noutput = \"BED\"\n");
    REQUIRE_MESSAGE(bed.ok(), (bed.ok() ? "" : to_string(bed.error())));
    REQUIRE(bed->heaters[heater_bed]);
    CHECK_FALSE(bed->heaters[heater_tool]);
    CHECK(bed->heaters[heater_bed]->guard.gain_time_s == 90);
    CHECK(bed->heaters[heater_bed]->guard.stray_c == 2);
    CHECK(bed->heaters[heater_bed]->guard.stray_time_s == 20);
    REQUIRE(bed->heaters[heater_bed]->output);
    CHECK_FALSE(bed->heaters[heater_bed]->output->chip.empty());
    const Heater tool = default_heater(heater_tool);
    CHECK(tool.guard.gain_c == 2);
    CHECK(tool.guard.gain_time_s == 20);
    CHECK(tool.guard.stray_c == 4);
    CHECK(tool.guard.stray_time_s == 40);
    CHECK(default_heater(heater_bed).guard.gain_time_s == 60);
}

TEST_CASE("printer 2: what is wrong with heat is told with its key") {
    const auto complaint = [](const std::string& text) {
        const Result<Printer> refused = parse_printer(good + '\n' + text, "heat.toml");
        REQUIRE_FALSE(refused.ok());
        CHECK(refused.error().where.line > 0);
        return refused.error().message;
    };
    const auto names = [&](const std::string& text, const char* part) {
        CHECK_MESSAGE(complaint(text).find(part) != std::string::npos, complaint(text));
    };
    names("[heater.bde]\nkp = 1\n", "did you mean `bed`");
    names("[heater.bed]\nsensr.kind = 1\n", "did you mean `sensor`");
    names("[heater.bed]\nsensor.kind = \"pt100\"\n", "\"pt1000\"");
    names("[heater.bed]\nrange_c = [100, 20]\n", "heater.bed.range_c");
    names("[heater.bed]\nmin_extrude_c = 170\n", "min_extrude_c");
    names("[heater.bed]\nkp = nan\n", "heater.bed.kp");
    names("[heater.bed]\ncycle_s = 0\n", "0.2");
    names("[heater.tool]\nmin_extrude_c = 271\n", "gets to 270 °C at the most");
    names("[heater.tool]\nrange_c = [0, 150]\n", "heater.tool.min_extrude_c is 170");
    names("[heater.bed]\nrange_c = [25, 130]\n", "leaves out a cold heater");
    names("[heater.bed]\nrange_c = [-10, 20]\n", "to at least 25");
    names("[heater.bed]\nsensor.beta_k = 3950\n", "heater.bed.sensor.kind = \"beta\"");
    names("[heater.bed]\nsensor.celsius_per_unit = 1\n", "\"celsius\"");
    names("[heater.bed]\nsensor.points = [[0, 100], [50, 10]]\n",
          "\"steinhart_hart\" or \"table\"");
    names("[heater.tool]\nsensor.kind = \"steinhart_hart\"\n", "needs 3 points");
    names("[heater.tool]\nsensor.kind = \"table\"\n", "at least 2");
    names("[heater.tool]\nsensor.points = [[0, 100], [50, 100]]\n", "resistances falling");
    names("[heater.tool]\nsensor.points = [[0, 100], [50]]\n", "pairs");
    names("[heater.tool]\noutput = 5\npwm = \"/sys/x\"\n", "is given too");
    names("[heater.tool]\noutput = 77\n[fan.part]\noutput = 77\n",
          "already used by heater.tool.output");
}

TEST_CASE("printer: a heater and a fan shared a PWM channel, and two heaters a sensor") {
    const auto check = [](const std::string& text, const std::string& part) {
        const Result<Printer> refused = parse_printer(good + '\n' + text, "heat.toml");
        REQUIRE_FALSE(refused.ok());
        CHECK_MESSAGE(refused.error().message == part, refused.error().message);
        CHECK(refused.error().where.line > 0);
    };
    check("[heater.tool]\npwm = \"/sys/p\"\n[fan.part]\npwm = \"/sys/p/\"\n",
          "fan.part.pwm: this file is already used by heater.tool.pwm");
    check("[heater.tool]\nsensor.file = \"/sys/a\"\n[heater.bed]\nsensor.file = \"/sys/a\"\n",
          "heater.bed.sensor.file: this file is already used by heater.tool.sensor.file");
}

TEST_CASE("printer: a key of 100,000 parts ended the program") {
    std::string key = "a";
    for (int part = 1; part < 100'000; ++part) key += ".a";
    check_error(good + key + " = 1\n", 28, "more than 4096 bytes");
    check_error("\n[" + key + "]\n" + good, 2, "more than 4096 bytes");
    key.resize(1'999);
    check_error(good + key + " = 1\n", 28, "unknown key `a`");
    // Such keys in one another, in lists, which may have many lines.
    std::string nested;
    for (int depth = 0; depth < 100; ++depth) nested += "{ " + key + " = [\n";
    check_error("name = " + nested, 9, "nested value depth of 16");
}

TEST_CASE("printer: a delta without its section was told of where it parks") {
    const std::string text =
        "kinematics = \"delta\"\n[pause]\npark_mm = [10, 0]\n" + good.substr(good.find("[pulse]"));
    check_error(text, 1, "kinematics: \"delta\" needs a section [delta]");
    check_error(text + "[delta]\narm_mm = 200\nradius_mm = 100\n", 29, "delta.reach_mm is missing");
}

TEST_CASE("printer: an empty name of a line was told to be a text") {
    check_error(with("= 17", "= \"\""), 10, "found an empty text");
    check_error(with("= 17", "= { line = \"\" }"), 10, "found an empty text");
}

TEST_CASE("printer: half a name got no suggestion") {
    check_error(with("max_acceleration_mm_s2 = 3000", "max_accel = 3000"), 8,
                "did you mean `max_acceleration_mm_s2`?");
    check_error(good + "[heater.hotend]\n", 28, "known are bed, chamber, tool");
    // Of several none is better.
    check_error(with("max_acceleration_mm_s2 = 3000", "mm_s = 3000"), 8, "configuration.md");
}

TEST_CASE("printer: a folder as calibration file was told to be the printer's") {
    const auto read = parse_printer("calibration_file = \"/tmp\"\n" + good, "printer.toml");
    REQUIRE_FALSE(read.ok());
    CHECK(read.error().where.file == "/tmp");
    CHECK(read.error().message == "cannot read: Is a directory");
}

TEST_CASE("printer: files that are missing, folders or far too large are refused by name") {
    const auto missing = read_printer("/nonexistent/printer.toml");
    REQUIRE_FALSE(missing.ok());
    CHECK(missing.error().where.file == "/nonexistent/printer.toml");
    CHECK_FALSE(read_printer("/tmp").ok());
    const auto endless = read_printer("/dev/zero");
    REQUIRE_FALSE(endless.ok());
    CHECK(endless.error().message.find("longer than 1048576 bytes") != std::string::npos);
}

TEST_CASE("printer 6: cut and garbled files give a printer or an error, never a crash" *
          doctest::test_suite("long")) {
    for (std::size_t length = 0; length < good.size(); ++length)
        (void)parse_printer(good.substr(0, length), "cut.toml");
    std::mt19937 random(11);
    std::size_t errors = 0;
    for (int i = 0; i < 3'000; ++i) {
        std::string text = good;
        for (int k = 0; k < 4; ++k)
            text[random() % text.size()] = static_cast<char>(random() % 256);
        errors += !parse_printer(text, "garbled.toml").ok();
    }
    CHECK(errors > 1'000);
    CHECK_FALSE(parse_printer(std::string(100'000, '['), "deep.toml").ok());
    CHECK_FALSE(parse_printer("x = " + std::string(100'000, '['), "deep.toml").ok());
}
