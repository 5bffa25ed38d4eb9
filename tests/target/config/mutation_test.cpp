// Contract of target/config/printer.h, 2 and 6: whatever happens to a byte of a printer's file, it is read as another
// printer or refused in one line that says where.

#include <doctest/doctest.h>

#include <string>

#include "target/config/printer.h"

using namespace lyr;
using namespace lyr::config;

namespace {

// Every kind of value, and as few of each as may be.
const std::string sample = R"(name = "a"
start_mm = [0, 1.5, 0]
kinematics = "corexy"
[pulse]
high_us = 2
[axis.x]
steps_per_mm = 80
max_speed_mm_s = 300
max_acceleration_mm_s2 = 3e3
range_mm = [-5, 200]
invert = true
step = 2
direction = { chip = "c", line = 3, active_low = true }
[axis.y]
steps_per_mm = 80
max_speed_mm_s = 300
max_acceleration_mm_s2 = 3000
range_mm = [0, 200]
[axis.z]
steps_per_mm = 400
max_speed_mm_s = 12
max_acceleration_mm_s2 = 200
range_mm = [0, 200]
[axis.e]
steps_per_mm = 400
max_speed_mm_s = 60
max_acceleration_mm_s2 = 5000
[heater.tool]
output = "GPIO9"
sensor.kind = "table"
sensor.points = [[0, 330000], [250, 230]]
[input.pause]
line = 7 # left
pull = "up"
[pause]
park_mm = [0, 0]
)";

// None: it is a printer's file.
void check_refused_well(const std::string& text, std::size_t& refused) {
    const Result<Printer> printer = parse_printer(text, "p.toml");
    if (printer.ok()) return;
    ++refused;
    const Diagnostic& error = printer.error();
    const std::string line = to_string(error);
    const bool is_well = error.status == ExitStatus::input && error.where.file == "p.toml" &&
                         line.starts_with("p.toml") && error.message.size() > 8 &&
                         line.find('\n') == std::string::npos;
    // What is missing altogether has no line.
    const bool has_place = error.where.line > 0 || error.message.ends_with(" is missing");
    if (!is_well || !has_place) FAIL_CHECK("for\n" << text << "\nfound: " << line);
}

}  // namespace

TEST_CASE(
    "printer 2, 6: any byte that is changed, lost or doubled is read or refused with its line" *
    doctest::test_suite("long")) {
    REQUIRE(parse_printer(sample, "p.toml").ok());
    std::size_t refused = 0, tried = 0;
    for (std::size_t i = 0; i < sample.size(); ++i) {
        for (const char other : {'\0', '\n', '"', ']', '9', '\xff'}) {
            std::string text = sample;
            text[i] = other;
            check_refused_well(text, refused);
            ++tried;
        }
        std::string lost = sample, doubled = sample;
        lost.erase(i, 1);
        doubled.insert(i, 1, sample[i]);
        check_refused_well(lost, refused);
        check_refused_well(doubled, refused);
        check_refused_well(sample.substr(0, i), refused);
        tried += 3;
    }
    CHECK(refused > tried / 2);
}
