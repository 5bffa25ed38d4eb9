// Keys of endstops, homing, probe, mesh and the simulated machine, and the calibration file.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "scratch.h"
#include "target/config/printer.h"

using namespace lyr;
using namespace lyr::config;

namespace {

const std::string axes =
    "[axis.x]\nsteps_per_mm = 80\nmax_speed_mm_s = 200\nmax_acceleration_mm_s2 = 3000\n"
    "range_mm = [0, 200]\nendstop = { line = 5, pull = \"up\", active_low = true }\n"
    "[axis.y]\nsteps_per_mm = 80\nmax_speed_mm_s = 150\nmax_acceleration_mm_s2 = 3000\n"
    "range_mm = [0, 200]\nendstop = 6\nendstop_end = \"high\"\nendstop_mm = 203.5\n"
    "[axis.z]\nsteps_per_mm = 400\nmax_speed_mm_s = 10\nmax_acceleration_mm_s2 = 300\n"
    "range_mm = [0, 180]\n"
    "[axis.e]\nsteps_per_mm = 415\nmax_speed_mm_s = 40\nmax_acceleration_mm_s2 = 5000\n";

void check_error(const std::string& text, std::uint32_t line, const std::string& part) {
    CAPTURE(text);
    const Result<Printer> printer = parse_printer(text + axes, "p.toml");
    REQUIRE_FALSE(printer.ok());
    CAPTURE(printer.error().message);
    CHECK(printer.error().where.line == line);
    CHECK(printer.error().message.find(part) != std::string::npos);
}

}  // namespace

TEST_CASE("homing keys: endstops, probe, mesh and the simulated machine arrive") {
    const Result<Printer> printer = parse_printer(
        "[homing]\norder = \"zyx\"\nlift_mm = 2\n"
        "[probe]\ninput = { line = \"PROBE\", pull = \"down\" }\noffset_mm = [20, -3, 0.7]\n"
        "[mesh]\npoints = [3, 2]\narea_mm = [10, 20, 190, 180]\nheights_mm = [[0, 1, 2], [3, 4, "
        "5]]\n"
        "[simulate]\nbed_tilt = [0.001, 0]\nbumps = [[100, 100, 0.2, 30]]\n" +
            axes,
        "p.toml");
    REQUIRE_MESSAGE(printer.ok(), to_string(printer.ok() ? Diagnostic{} : printer.error()));
    CHECK(printer->endstops[0].input->pull == Pull::up);
    CHECK(printer->endstops[0].input->active_low);
    CHECK(printer->endstops[0].input->chip == "gpiochip0");
    CHECK(printer->endstops[1].at_high_end);
    CHECK(*printer->endstops[1].at_mm == 203.5);
    CHECK_FALSE(printer->endstops[2].input);
    CHECK(printer->homing.order == std::array<std::size_t, 3>{2, 1, 0});
    CHECK(printer->probe->input->pull == Pull::down);
    CHECK(printer->probe->offset_mm[2] == 0.7);
    CHECK(printer->mesh.heights_mm[1][2] == 5);
    CHECK(printer->simulated.bumps.size() == 1);
}

TEST_CASE("homing keys: slips come with line and suggestion") {
    check_error("[homing]\nordr = \"xyz\"\n", 2, "did you mean `order`?");
    check_error("[homing]\norder = \"xxz\"\n", 2, "\"xyz\" in any order");
    check_error("[probe]\ninput = { line = 5 }\n", 2, "");
    check_error("[probe]\ninput = { line = 9, pull = \"upp\" }\n", 2,
                "\"as_is\", \"up\", \"down\" or \"none\"");
    check_error("[probe]\ninput = { pull = \"up\" }\n", 2, "expected `line`");
    check_error("[probe]\noffset_mm = [1, 2]\n", 2, "[x, y, z]");
    check_error("[probe]\ninput = 9\nspeed_mm_s = 1\nslow_mm_s = 2\n", 4,
                "faster than probe.speed_mm_s = 1");
    check_error("[mesh]\nheights_mm = [[0, 1], [2]]\n", 2, "rows");
    check_error("[mesh]\nheights_mm = [[0, 1], [2, 3]]\narea_mm = [0, 0, 9, 9]\n", 2,
                "2 rows of 2 heights are not the mesh.points = [5, 5]");
    check_error("[mesh]\npoints = [2, 2]\nheights_mm = [[0, 1], [2, 3]]\n", 3, "area_mm");
    check_error("[mesh]\narea_mm = [9, 0, 0, 9]\n", 2, "first corner");
    const std::string probe = "[probe]\ninput = 9\noffset_mm = [20, -3, 0.7]\n";
    check_error(probe + "home_mm = [10, 100]\n", 4, "the head would stand at x = -10, y = 103");
    check_error(probe + "[mesh]\narea_mm = [20, 0, 200, 198]\n", 5,
                "cannot get to x = 20, y = 198");
    check_error(
        "[mesh]\npoints = [2, 2]\narea_mm = [0, 0, 9, 9]\nheights_mm = [[0, 1], [-2, 1]]\n"
        "fade_mm = 2\n",
        5, "up to 2 mm off by mesh.heights_mm");
    check_error("[simulate]\nbumps = [[1, 2, 3, 0]]\n", 2, "radius above 0");
}

TEST_CASE("homing keys: an endstop at the other end, and ways longer than the axis, were taken") {
    const auto check = [](const std::string& old_text, const std::string& new_text,
                          const std::string& part) {
        std::string text = axes;
        const std::size_t at = text.find(old_text);
        REQUIRE(at != std::string::npos);
        const Result<Printer> printer =
            parse_printer(text.replace(at, old_text.size(), new_text), "p.toml");
        REQUIRE_FALSE(printer.ok());
        CHECK_MESSAGE(printer.error().message == part, printer.error().message);
        CHECK(printer.error().where.line > 0);
    };
    check("endstop_mm = 203.5", "endstop_mm = -1",
          "axis.y.endstop_mm: -1 is at the other end of axis.y.range_mm = [0, 200]; endstop_end = "
          "\"low\" would have it there");
    check("endstop = 6", "endstop = 6\nhome_slow_mm_s = 30",
          "axis.y.home_slow_mm_s: faster than axis.y.home_speed_mm_s = 20");
    check("range_mm = [0, 200]", "range_mm = [0, 2.5]",
          "axis.x.home_back_off_mm: longer than all of axis.x.range_mm = [0, 2.5]");
    check("range_mm = [0, 180]", "range_mm = [0, 4]\nendstop = 7",
          "axis.z.range_mm: homing.lift_mm = 5 is more than all of axis.z.range_mm = [0, 4]");
}

TEST_CASE("homing keys: a delta has the endstops of all towers, at the top") {
    const std::string delta =
        "kinematics = \"delta\"\n[delta]\narm_mm = 250\nradius_mm = 120\nreach_mm = 100\n";
    check_error(delta, 6, "all three towers or none");
}

TEST_CASE("printer 7: the calibration file stands above the printer's file, and may be missing") {
    const std::filesystem::path folder = lyr::tests::scratch_folder("calibration");
    const std::string printer_path = (folder / "p.toml").string();
    std::ofstream(printer_path) << "calibration_file = \"found.toml\"\n" + axes;
    std::filesystem::remove(folder / "found.toml");
    REQUIRE(read_printer(printer_path).ok());
    CHECK(*read_printer(printer_path)->endstops[1].at_mm == 203.5);
    const auto calibrate = [&](const char* text) {
        std::ofstream(folder / "found.toml") << text;
        return read_printer(printer_path);
    };
    const Result<Printer> found = calibrate("[axis.y]\nendstop_mm = 203.25\n");
    REQUIRE(found.ok());
    CHECK(*found->endstops[1].at_mm == 203.25);
    CHECK(*found->uncalibrated->endstops[1].at_mm == 203.5);
    CHECK(found->calibrated == std::vector<std::string>{"axis.y.endstop_mm"});
    CHECK(found->calibration_file == (folder / "found.toml").string());
    const Result<Printer> slip = calibrate("[axis.y]\nendstp_mm = 203.25\n");
    REQUIRE_FALSE(slip.ok());
    CHECK(slip.error().where.file == (folder / "found.toml").string());
    CHECK(slip.error().where.line == 2);
    CHECK_FALSE(calibrate("calibration_file = \"other.toml\"\n").ok());
    const Result<Printer> foreign = calibrate("[axis.y]\nendstop_mm = 1\ninvert = true\n");
    REQUIRE_FALSE(foreign.ok());
    CHECK(foreign.error().where.line == 3);
    CHECK(foreign.error().message.find("not a key of a calibration") != std::string::npos);
    CHECK_FALSE(calibrate("[axis.y\n").ok());
    std::filesystem::remove_all(folder);
}
