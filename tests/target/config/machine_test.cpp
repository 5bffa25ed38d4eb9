// Keys of kinematics, shapers and pressure advance; contracts 8 and 9 of target/config/printer.h.

#include <doctest/doctest.h>

#include <cmath>

#include "target/config/printer.h"

using namespace lyr;
using namespace lyr::config;

namespace {

const std::string axes =
    "[axis.x]\nsteps_per_mm = 80\nmax_speed_mm_s = 200\nmax_acceleration_mm_s2 = 3000\n"
    "range_mm = [-120, 120]\n"
    "[axis.y]\nsteps_per_mm = 80\nmax_speed_mm_s = 150\nmax_acceleration_mm_s2 = 3000\n"
    "range_mm = [-120, 120]\n"
    "[axis.z]\nsteps_per_mm = 80\nmax_speed_mm_s = 100\nmax_acceleration_mm_s2 = 3000\n"
    "range_mm = [0, 300]\n"
    "[axis.e]\nsteps_per_mm = 415\nmax_speed_mm_s = 40\nmax_acceleration_mm_s2 = 5000\n";

const std::string delta =
    "kinematics = \"delta\"\n"         // 1
    "[delta]\n"                        // 2
    "arm_mm = 250\n"                   // 3
    "radius_mm = [120, 121, 122.5]\n"  // 4
    "reach_mm = 100\n";                // 5

Printer read(const std::string& text) {
    const Result<Printer> printer = parse_printer(text + axes, "p.toml");
    REQUIRE_MESSAGE(printer.ok(), to_string(printer.ok() ? Diagnostic{} : printer.error()));
    return *printer;
}

void check_error(const std::string& text, std::uint32_t line, const std::string& part) {
    CAPTURE(text);
    const Result<Printer> printer = parse_printer(text + axes, "p.toml");
    REQUIRE_FALSE(printer.ok());
    CHECK(printer.error().status == ExitStatus::input);
    CHECK(printer.error().where.line == line);
    CAPTURE(printer.error().message);
    CHECK(printer.error().message.find(part) != std::string::npos);
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("machine: a delta's frame, one number for three towers or a list") {
    const Printer printer = read(delta);
    CHECK(printer.kinematics == Kinematics::delta);
    CHECK(printer.delta.arm_mm == std::array<double, 3>{250, 250, 250});
    CHECK(printer.delta.radius_mm == std::array<double, 3>{120, 121, 122.5});
    CHECK(printer.delta.tower_angle_deg == std::array<double, 3>{210, 330, 90});
    CHECK(printer.delta.reach_mm == 100);
}

TEST_CASE("printer 7: a delta without its frame, or that does not reach, is refused") {
    check_error("kinematics = \"delta\"\n", 1, "needs a section [delta] with arm_mm, radius_mm");
    check_error(changed(delta, "arm_mm = 250\n", ""), 2, "delta.arm_mm is missing");
    check_error(changed(delta, "reach_mm = 100\n", ""), 2, "delta.reach_mm is missing");
    check_error(changed(delta, "reach_mm = 100", "reach_mm = 125"), 5, "reaches 123.75 mm");
    check_error("start_mm = [90, 60, 0]\n" + delta, 1, "farther from the middle");
    check_error(changed(delta, "reach_mm", "tower_angle_deg = [210, 330, -20]\nreach_mm"), 5,
                "two towers are 10 degrees apart");
    check_error(changed(delta, "[120, 121, 122.5]", "[120, 121]"), 4, "a list of three");
    check_error(changed(delta, "[120, 121, 122.5]", "[120, 121, true]"), 4, "from 1 to 10000");
    check_error(changed(delta, "arm_mm", "arms_mm"), 3, "did you mean `arm_mm`?");
    check_error(changed(delta, "\"delta\"", "\"corexy\""), 2, "only for kinematics");
}

TEST_CASE("machine: shapers and pressure advance, and what they need") {
    const Printer printer = read(
        "max_jerk_mm_s3 = 1e5\n[shaper.x]\nkind = \"mzv\"\nfrequency_hz = 40\n"
        "[shaper.y]\nkind = \"ei\"\nfrequency_hz = 35.5\ndamping = 0.05\n"
        "[pressure_advance]\nadvance_s = 0.05\n");
    CHECK(printer.max_jerk_mm_s3 == 1e5);
    CHECK(printer.shapers[axis_x].kind == ShaperKind::mzv);
    CHECK(printer.shapers[axis_x].damping == 0.1);
    CHECK(printer.shapers[axis_y].kind == ShaperKind::ei);
    CHECK(printer.shapers[axis_y].frequency_hz == 35.5);
    CHECK(printer.shapers[axis_y].damping == 0.05);
    CHECK(printer.shapers[axis_z].kind == ShaperKind::none);
    CHECK(printer.pressure_advance_s == 0.05);
    CHECK(printer.pressure_smooth_s == 0.04);
    check_error("[shaper.x]\nkind = \"zvd\"\n", 2, "\"mzv\" or \"ei\"");
    check_error("[shaper.x]\nkind = \"zv\"\n", 2, "needs shaper.x.frequency_hz");
    check_error("[shaper.x]\nkind = \"zv\"\nfrequency_hz = 1\n", 3, "from 2 to 500");
    check_error("[shaper.x]\nkind = \"zv\"\nfrequncy_hz = 40\n", 3, "did you mean `frequency_hz`?");
    check_error("[shaper.y]\nfrequency_hz = 40\n", 1, "does nothing without shaper.y.kind");
    check_error("[timing]\nlate_us = 5000\n", 2, "later than pulse.late_limit_ms = 5");
    check_error("[timing]\ncpu = 1024\n", 2, "a whole number from 0 to 1023");
    check_error("[timing]\ncpu = 1.5\n", 2, "a whole number");
    check_error("max_jerk_mm_s3 = 0.5\n", 1, "from 1 on");
    CHECK(read("").minimum_cruise_ratio == 0);
    CHECK(read("minimum_cruise_ratio = 0.5\n").minimum_cruise_ratio == 0.5);
    check_error("minimum_cruise_ratio = 1\n", 1, "from 0 to 0.95");
    check_error("min_cruise_ratio = 0.5\n", 1, "did you mean `minimum_cruise_ratio`?");
    check_error("[shaper.e]\n", 1, "unknown key `e` in [shaper]");
    check_error("[pressure_advance]\nadvance_s = -1\n", 2, "from 0 to 2");
    check_error("[pressure_advance]\nadvance = 1\n", 2, "did you mean `advance_s`?");
}

TEST_CASE("printer 1: the step rate is that of the motors, not of the axes") {
    Printer printer = read("");
    CHECK(fastest_motor_mm_s(printer, axis_x) == 200);
    printer = read("kinematics = \"corexy\"\n");
    CHECK(fastest_motor_mm_s(printer, axis_x) == 350);
    CHECK(fastest_motor_mm_s(printer, axis_y) == 350);
    CHECK(fastest_motor_mm_s(printer, axis_z) == 100);
    printer = read(delta);
    CHECK(fastest_motor_mm_s(printer, axis_x) ==
          doctest::Approx(100 + 250 * 220 / std::sqrt(250.0 * 250 - 220 * 220)));
    // 350 mm/s x 80 steps/mm leave 35.7 us.
    const std::string slow = "[pulse]\nhigh_us = 20\nlow_us = 20\n";
    CHECK(parse_printer(slow + axes, "p").ok());
    check_error("kinematics = \"corexy\"\n" + slow, 7, "28000 steps a second");
}

TEST_CASE("machine: backlash is a length of x, y and z") {
    CHECK(read("").backlash_mm == std::array<double, 3>{});
    const std::string with = changed(axes, "[axis.y]\n", "[axis.y]\nbacklash_mm = 0.12\n");
    const Result<Printer> read_back = parse_printer(with, "p.toml");
    REQUIRE(read_back.ok());
    CHECK(read_back->backlash_mm == std::array<double, 3>{0, 0.12, 0});
    CHECK_FALSE(
        parse_printer(changed(axes, "[axis.y]\n", "[axis.y]\nbacklash_mm = 3\n"), "p").ok());
    CHECK_FALSE(
        parse_printer(changed(axes, "[axis.e]\n", "[axis.e]\nbacklash_mm = 0.1\n"), "p").ok());
}

TEST_CASE("printer 9: measured lateness limits what every motor is asked for, on all kinematics") {
    Printer printer = generic_printer();
    CHECK(std::isinf(held_steps_per_s(printer)));
    for (std::size_t axis = 0; axis < axis_count; ++axis)
        CHECK(held_speed_mm_s(printer, axis) == printer.axes[axis].max_speed_mm_s);
    printer.timing.late_ns = 160'000;
    printer.timing.write_ns = 3'000;
    // 160 us, and eight edges of 3 us that are 2 us apart.
    CHECK(held_steps_per_s(printer) == doctest::Approx(1e9 / 200'000));
    CHECK(held_speed_mm_s(printer, axis_x) == doctest::Approx(5'000 / 80.0));
    CHECK(held_speed_mm_s(printer, axis_z) == printer.axes[axis_z].max_speed_mm_s);
    for (const Kinematics kinematics :
         {Kinematics::cartesian, Kinematics::corexy, Kinematics::delta}) {
        printer.kinematics = kinematics;
        printer.delta.arm_mm = {290, 300, 310};
        printer.delta.radius_mm = {130, 125, 120};
        printer.delta.reach_mm = 110;
        Printer held = printer;
        for (std::size_t axis = 0; axis < axis_count; ++axis)
            held.axes[axis].max_speed_mm_s = held_speed_mm_s(printer, axis);
        double busiest_hz = 0;
        for (std::size_t motor = 0; motor < axis_count; ++motor) {
            const double hz = fastest_motor_mm_s(held, motor) * held.axes[motor].steps_per_mm;
            CHECK(hz < held_steps_per_s(printer) * (1 + 1e-12));
            busiest_hz = std::max(busiest_hz, hz);
        }
        CHECK(busiest_hz == doctest::Approx(held_steps_per_s(printer)));
    }
}
