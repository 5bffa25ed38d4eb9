// What each command means, line by line, and what is wrong with others.

#include <doctest/doctest.h>

#include <fstream>
#include <numbers>
#include <random>

#include "../export/gcode_machine.h"
#include "format/arc.h"
#include "imported.h"

using namespace lyr;
using namespace lyr::format;
using test::Imported;
using test::imported;

namespace {

constexpr double filament_mm2 = std::numbers::pi / 4 * 1.75 * 1.75;

const std::string begin =
    "G28\nM83\n;LAYER_CHANGE\n;Z:0.2\n;HEIGHT:0.2\nG1 Z0.2 F600\nG0 X10 Y20 F6000\n"
    ";TYPE:Perimeter\n;WIDTH:0.4\n";

// E of 10 mm of a strand 0.4 mm wide and 0.2 high.
const std::string ten_mm = " E0.29777";

void check_line(const Line& line, double x_mm, double y_mm, double z_mm) {
    CHECK(line.to ==
          Point{std::llround(x_mm * 1000), std::llround(y_mm * 1000), std::llround(z_mm * 1000)});
}

Line only_line(const std::string& text) {
    const auto lines = imported(text).all<Line>();
    REQUIRE(lines.size() == 1);
    return lines[0];
}

Diagnostic refused(const std::string& text) {
    Diagnostics diagnostics;
    std::filesystem::remove(test::scratch("refused"));
    const auto totals =
        import_gcode(text, "a.gcode", "a", test::scratch("refused"), {}, diagnostics);
    REQUIRE(!totals.ok());
    CHECK(!std::filesystem::exists(test::scratch("refused")));
    return totals.error();
}

std::string text_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("gcode import: modes, offsets and units say where a line ends") {
    check_line(only_line(begin + "G1 X20 Y20" + ten_mm), 20, 20, 0.2);
    check_line(only_line(begin + "g01x20y20e.29777 ; of whatever case"), 20, 20, 0.2);
    check_line(only_line(begin + "N12 G1 X20 (to the right) Y20" + ten_mm + "*71"), 20, 20, 0.2);
    check_line(only_line(begin + "G91\nM83\nG1 X10 Y-5" + ten_mm), 20, 15, 0.2);
    check_line(only_line(begin + "G92 X0 Y0\nG1 X10 Y1" + ten_mm), 20, 21, 0.2);
    check_line(only_line(begin + "G92\nG1 X10 Y1" + ten_mm), 20, 21, 0.2);
    check_line(only_line(begin + "G20\nG1 X1 Y1 E0.011723"), 25.4, 25.4, 0.2);
    check_line(only_line(begin + "M82\nG92 E100\nG1 X20 E100.29777"), 20, 20, 0.2);
    check_line(only_line(begin + "G1 X20 Z0.4" + ten_mm), 20, 20, 0.4);
}

TEST_CASE("gcode import: G90 sets E for Marlin, and leaves it for Klipper") {
    const std::string text = begin + "G91\nG90\nG1 X20 E0.29777\nG1 X30 E0.59554\n";
    const Imported marlin = imported(text);
    const Imported klipper = imported(text + "; gcode_flavor = klipper\n");
    CHECK(marlin.volume_mm3() == doctest::Approx(0.59554 * filament_mm2).epsilon(0.001));
    CHECK(klipper.volume_mm3() == doctest::Approx(0.89331 * filament_mm2).epsilon(0.001));
}

TEST_CASE("gcode import 1: arcs by centre and by radius, of either sense, are one") {
    for (const char* text :
         {"G3 X20 Y20 I5 J0 E0.46774", "G3 X20 Y20 R5 E0.46774", "G3X20Y20J0I5E.46774"}) {
        CAPTURE(text);
        const auto arcs = imported(begin + text).all<Arc>();
        REQUIRE(arcs.size() == 1);
        CHECK(arcs[0].to == Point{20000, 20000, 200});
        CHECK(arcs[0].sagitta == 5000);
    }
    // Less and more than half a turn, by the sign of R.
    const auto sagitta = [](const std::string& text) {
        const auto arcs = imported(begin + text).all<Arc>();
        REQUIRE(arcs.size() == 1);
        return static_cast<double>(arcs[0].sagitta);
    };
    CHECK(sagitta("G2 X16 Y20 R5 E1") == doctest::Approx(-1000));
    CHECK(sagitta("G3 X16 Y20 R5 E1") == doctest::Approx(1000));
    double turned_rad = 0;  // more than the 3/2 pi of one record
    for (const Arc& arc : imported(begin + "G2 X16 Y20 R-5 E1").all<Arc>())
        turned_rad += arc_shape(arc).sweep_rad;
    CHECK(turned_rad == doctest::Approx(2 * std::asin(0.6) - 2 * std::numbers::pi).epsilon(1e-3));
    const auto circles = imported(begin + "G2 I3 J4 E1\nG3 X10 Y20 I-3 J-4 E1").all<Circle>();
    REQUIRE(circles.size() == 2);
    CHECK(circles[0].center_x == 13000);
    CHECK(!circles[0].counter_clockwise);
    CHECK(circles[1].center_y == 16000);
}

TEST_CASE("gcode import 1: a helix, a wide arc and an arc without extrusion keep their way") {
    const Imported helix = imported(begin + "G3 X10 Y20 Z1.2 I5 J0 E1\n");
    double climb = 0;
    for (const Arc& arc : helix.all<Arc>()) climb += static_cast<double>(arc.to.z - arc.from.z);
    CHECK(climb == 1000);
    CHECK(helix.volume_mm3() == doctest::Approx(filament_mm2).epsilon(0.001));
    CHECK(imported(begin + "G3 X10.001 Y20.1 I-5 J0 E1\n").volume_mm3() ==
          doctest::Approx(filament_mm2).epsilon(0.001));
    const Imported way =
        imported(begin + "G1 X11" + ten_mm + "\nG2 X21 Y20 I5 J0\nG1 X22" + ten_mm);
    CHECK(way.all<Arc>().empty());
    double farthest = 0;
    for (const Travel& travel : way.all<Travel>()) {
        const double x = static_cast<double>(travel.to.x) - 16000,
                     y = static_cast<double>(travel.to.y) - 20000;
        if (travel.from.x >= 11000)
            farthest = std::max(farthest, std::abs(std::hypot(x, y) - 5000));
    }
    CHECK(farthest <= 1);
}

TEST_CASE("gcode import 2: amounts are kept with and without comments on widths") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> amount(0.05, 0.6);
    std::string commented = begin, plain = "G28\nM83\nG1 Z0.2\nG0 X10 Y20\n";
    double sum_mm = 0;
    std::vector<double> amounts;
    for (int i = 0; i < 200; ++i) {
        amounts.push_back(std::round(amount(random) * 1e5) / 1e5);
        sum_mm += amounts.back();
        const std::string line =
            "G1 X" + std::to_string(20 + 10 * i) + " E" + std::to_string(amounts.back()) + "\n";
        commented += line;
        plain += line;
    }
    for (const std::string& text : {commented, plain}) {
        const Imported print = imported(text);
        CHECK(print.volume_mm3() == doctest::Approx(sum_mm * filament_mm2).epsilon(0.001));
        std::size_t i = 0;
        for (const auto& given : print.operations) {
            if (!std::holds_alternative<Line>(given.operation)) continue;
            CHECK(10 * cross_section_mm2(given.style) ==
                  doctest::Approx(amounts[i++] * filament_mm2).epsilon(0.001));
        }
        CHECK(i == 200);
    }
}

TEST_CASE(
    "gcode import: the filament is drawn back at a standstill, on the way or by the firmware") {
    const std::string line = "G1 X20" + ten_mm + "\n", next = "G0 X30\n";
    const auto depths = [&](const std::string& retract, const std::string& back) {
        std::vector<double> all;
        for (const Retract& one :
             imported(begin + line + retract + next + back + "G1 X40" + ten_mm).all<Retract>())
            all.push_back(one.depth_mm);
        return all;
    };
    CHECK(depths("G1 E-0.8 F2100\n", "G1 E0.8 F1200\n") == std::vector<double>{0.8, 0});
    CHECK(depths("G10\n", "G11\n") == std::vector<double>{1, 0});
    CHECK(depths("M207 S0.6 F1800\nG10\n", "G11\n") == std::vector<double>{0.6, 0});
    const Imported speeds =
        imported(begin + line + "G1 E-0.8 F2100\n" + next + "G1 E0.8 F1200\nG1 X40" + ten_mm);
    CHECK(speeds.layers[0].state.retract_speed_mm_s == 35);
    CHECK(speeds.layers[0].state.unretract_speed_mm_s == 20);
    const Imported wiped =
        imported(begin + line + "G1 E-0.2 F2100\nG1 X18 E-0.3\nG2 X16 I-1 E-0.3\n" + next +
                 "G1 E0.8\nG1 X40" + ten_mm);
    const auto wipes = wiped.all<Wipe>();
    REQUIRE(wipes.size() == 2);
    CHECK(wipes[1].depth_mm == doctest::Approx(0.8));
    CHECK(wipes[1].sagitta == -1000);
    // What is extruded right behind a wipe needs a travel, of no way.
    CHECK(imported(begin + line + "G1 X18 E-0.3\nG1 E0.3\nG1 X8" + ten_mm).all<Line>().size() == 2);
}

TEST_CASE("gcode import 3: layers are those of comments, or of heights") {
    const std::string cura =
        "M82\nG0 X0 Y0 Z0.3\n;LAYER:0\n;TYPE:WALL-OUTER\nG1 X10 E0.5\n;LAYER:1\nG0 X20 Z0.5\n"
        ";TYPE:SKIN\nG1 X30 E1\n;TIME_ELAPSED:10\n";
    const Imported print = imported(cura);
    REQUIRE(print.layers.size() == 2);
    CHECK(print.layers[1].state.z_mm == 0.5);
    CHECK(print.layers[1].state.height_mm == doctest::Approx(0.2));
    CHECK(print.layers[1].state.start_x_mm == 20);
    // Without comments a hop between extrusions at one height begins none.
    const std::string plain =
        "M83\nG1 Z0.2\nG1 X10 E0.5\nG1 Z0.6\nG1 X20\nG1 Z0.2\nG1 X30 E0.5\nG1 E-1\nG1 Z0.8\nG1 "
        "X5\nG1 "
        "Z0.4\nG1 E1\nG1 X20 E0.5\nG1 Z5\n";
    const Imported hops = imported(plain);
    REQUIRE(hops.layers.size() == 2);
    CHECK(hops.layers[0].state.z_mm == 0.2);
    CHECK(hops.layers[1].state.z_mm == 0.4);
    CHECK(hops.layers[1].state.retracted_mm == 1);
    CHECK(hops.layers[1].state.start_x_mm == 5);
    CHECK(hops.diagnostics.empty());
    // A vase climbs all the way: one layer.
    CHECK(imported("M83\nG1 Z0.2\nG1 X10 Z0.3 E0.5\nG1 X0 Z0.4 E0.5\nG1 X10 Z0.5 E0.5")
              .layers.size() == 1);
}

TEST_CASE("gcode import: what waits before the first layer is not lost") {
    const Imported print =
        imported("M190 S60\nG4 P250\nM0\nM109 S200\n" + begin + "G1 X20" + ten_mm);
    REQUIRE(print.layers.size() == 1);
    CHECK(print.layers[0].state.temperatures.size() == 2);
    CHECK(print.all<Dwell>().size() == 1);
    CHECK(print.all<Pause>().size() == 1);
}

TEST_CASE("gcode import 3: comments of OrcaSlicer, Bambu Studio and Simplify3D are understood") {
    const std::string moves = "G0 X0 Y0 Z0.3\nG1 X10 E0.5\n", above = "G0 Z0.5\nG1 X20 E0.5\n";
    struct Dialect {
        std::string first, second;
        Role role;
        bool states_width;
    };
    for (const Dialect& dialect :
         {Dialect{"; CHANGE_LAYER\n; Z_HEIGHT: 0.3\n; LAYER_HEIGHT: 0.3\n; FEATURE: Outer wall\n; "
                  "LINE_WIDTH: 0.5\n",
                  "; CHANGE_LAYER\n; Z_HEIGHT: 0.5\n; LAYER_HEIGHT: 0.2\n", Role::outer_wall, true},
          Dialect{";LAYER_CHANGE\n;Z:0.3\n;HEIGHT:0.3\n;TYPE:Top surface\n;WIDTH:0.5\n",
                  ";LAYER_CHANGE\n;Z:0.5\n;HEIGHT:0.2\n", Role::top_skin, true},
          Dialect{"; layer 1, Z = 0.300\n", "; layer 2, Z = 0.500\n", Role::other, false}}) {
        CAPTURE(dialect.first);
        const Imported print = imported("M83\n" + dialect.first + moves + dialect.second + above);
        REQUIRE(print.layers.size() == 2);
        CHECK(print.layers[0].state.height_mm == doctest::Approx(0.3));
        CHECK(print.layers[1].state.height_mm == doctest::Approx(0.2));
        CHECK(print.layers[1].state.z_mm == 0.5);
        for (const auto& given : print.operations) {
            if (!std::holds_alternative<Line>(given.operation)) continue;
            CHECK(given.style.role == dialect.role);
            if (dialect.states_width) CHECK(given.style.width_mm == 0.5);
            CHECK(10 * cross_section_mm2(given.style) ==
                  doctest::Approx(0.5 * filament_mm2).epsilon(0.001));
        }
    }
}

TEST_CASE("gcode import 4: what is not known is told once, with its line and how often it stands") {
    const Imported print =
        imported(begin + "G29\nM117 Hello, world 1.2.3\nSTART_PRINT BED=60\nG29\nM999 S1\nG1 X20" +
                 ten_mm + "\nG1 E3\nG1 E2 F300\n");
    REQUIRE(print.diagnostics.size() == 4);
    CHECK(print.diagnostics[0].message.find("\"G29\"") != std::string::npos);
    CHECK(print.diagnostics[0].message.find("2 times") != std::string::npos);
    CHECK(print.diagnostics[0].where.line == 10);
    CHECK(print.diagnostics[0].where.file == "a.gcode");
    CHECK(print.diagnostics[1].message.find("START_PRINT") != std::string::npos);
    CHECK(print.diagnostics[3].message.find("5 mm in 2 places") != std::string::npos);
    for (const Diagnostic& diagnostic : print.diagnostics)
        CHECK(diagnostic.severity == Severity::warning);
}

TEST_CASE("gcode import 5: a line that is none is an error with its number") {
    for (const char* text : {"G1 X1.2.3 E1", "G1 X", "G1 XY E1", "G1 X1 X2", "G1 X1 ?", "G1 Xinf",
                             "!x", "G2 X20 Y20 E1", "G3 X30 Y20 R1 E1", "G2 R5 E1",
                             "G1 X99999999 E1", "G1 X-+1", "\x01\x02", "\"quoted\""}) {
        CAPTURE(std::string(text));
        const Diagnostic error = refused(begin + text + "\nG1 X20" + ten_mm);
        CHECK(error.status == ExitStatus::input);
        CHECK(error.where.line == 10);
        CHECK(error.where.file == "a.gcode");
    }
    CHECK(refused(begin + "G18\n").status == ExitStatus::unsupported);
    CHECK(refused("").message.find("nothing in it extrudes") != std::string::npos);
    CHECK(refused("G28\nG1 X10\n").message.find("nothing in it extrudes") != std::string::npos);
}

TEST_CASE("gcode import: M221 and M220 change what follows, E drawn back as well") {
    const Imported less = imported(begin + "M221 S95\nG1 X20 F6000 E1\nM221 S100\nG1 X30 E1\n");
    CHECK(less.volume_mm3() == doctest::Approx(1.95 * filament_mm2).epsilon(0.001));
    const Imported counted =
        imported(begin + "M82\nM221 S50\nG1 X20 E1\nG1 E0\nG0 X25\nG1 E1\nG1 X30 E2\n");
    CHECK(counted.volume_mm3() == doctest::Approx(filament_mm2).epsilon(0.001));
    CHECK(counted.all<Retract>().at(0).depth_mm == doctest::Approx(0.5));
    // Of a tool; of all of Klipper's.
    const std::string tools = begin + "M221 S50\nT1\nG1 X20 E1\n";
    CHECK(imported(tools).volume_mm3() == doctest::Approx(filament_mm2).epsilon(0.001));
    CHECK(imported(tools + "; gcode_flavor = klipper\n").volume_mm3() ==
          doctest::Approx(filament_mm2 / 2).epsilon(0.001));
    std::vector<double> speeds;
    for (const auto& given : imported(begin + "M220 S200\nG1 X20 F600 E1\nM220 B\nM220 S50\n"
                                              "G1 X30 E1\nM220 R\nG1 X40 E1\n")
                                 .operations)
        if (std::holds_alternative<Line>(given.operation)) speeds.push_back(given.style.speed_mm_s);
    CHECK(speeds == std::vector<double>{20, 5, 20});
    for (const char* text : {"M220 S0", "M221 S-5", "M221 S100000", "M220 Sfast"})
        CHECK(refused(begin + text + "\nG1 X20 E1").where.line == 10);
}

TEST_CASE("gcode import: layers in which nothing extrudes are no print") {
    for (const char* text :
         {";LAYER_CHANGE\nG1 X10 F100\n", ";LAYER_CHANGE\nG1 X10 A1\n;LAYER_CHANGE\nG1 X20 A2\n",
          ";LAYER:0\nG1 E5\nG1 E-1\n"}) {
        const Diagnostic error = refused(text);
        CHECK(error.status == ExitStatus::input);
        CHECK(error.message == "nothing in it extrudes");
    }
    const Imported axis = imported(begin + "G1 X20 A1 E1\n");
    REQUIRE(axis.diagnostics.size() == 1);
    CHECK(axis.diagnostics[0].message.find("the axis A") != std::string::npos);
}

TEST_CASE("gcode import: no motion is dropped without an error") {
    check_line(only_line(begin + "(go) N5 (on) G1 X20" + ten_mm), 20, 20, 0.2);
    for (const char* text :
         {"X20 E1", "X-20 E1", "F300", "G53 G1 X20 E1", "G5 X20 Y20 I1 J1 P1 Q1 E1", "G90 G1 X20",
          "G2 X20 Y20 I5 P3 E1", "G81 X20 Z1", "G51 X2", "%G1 X20 E1"}) {
        CAPTURE(std::string(text));
        const Diagnostic error = refused(begin + text + "\nG1 X20" + ten_mm);
        CHECK(error.where.line == 10);
    }
}

TEST_CASE("gcode import: objects end where the file says, and M486 begins them") {
    const auto objects = [](const Imported& print) {
        std::vector<std::uint32_t> all{print.layers.at(0).state.object};
        for (const Object& one : print.all<Object>()) all.push_back(one.object);
        return all;
    };
    const Imported klipper = imported("EXCLUDE_OBJECT_START NAME=a\n" + begin +
                                      "G1 X20 E1\nEXCLUDE_OBJECT_END\n" + "G1 X30 E1\n");
    CHECK(objects(klipper) == std::vector<std::uint32_t>{1, 0});
    const Imported marlin = imported("M486 T2\nM486 S0\nM486 Aleft one\n" + begin +
                                     "G1 X20 E1\nM486 S4\nG1 X30 E1\nM486 S-1\nG1 X40 E1\n");
    CHECK(objects(marlin) == std::vector<std::uint32_t>{1, 2, 0});
    CHECK(marlin.header.metadata.objects == std::vector<std::string>{"left one", "object 2"});
    CHECK(marlin.diagnostics.empty());
    const Imported one_line =
        imported("M486 T2\nM486 S0 A\"left S one\"\nM486 S-1\n" + begin +
                 "G1 X20 E1\nM486 S0\nG1 X30 E1\nM486 S1 Aright\nG1 X40 E1\n");
    CHECK(objects(one_line) == std::vector<std::uint32_t>{0, 1, 2});
    CHECK(one_line.header.metadata.objects == std::vector<std::string>{"left S one", "right"});
    CHECK(one_line.diagnostics.empty());
}

TEST_CASE("gcode import: heating without a temperature sets none, as Marlin") {
    const Imported print = imported("M104 S200\nM140 S60\nM104 T0\nM190\nM109\n" + begin +
                                    "G1 X20 E1\nM140\nM104\nG1 X30 E1\n");
    REQUIRE(print.layers[0].state.temperatures.size() == 2);
    CHECK(print.layers[0].state.temperatures[0].target_c == 200);
    CHECK(print.layers[0].state.temperatures[1].target_c == 60);
    CHECK(print.all<Temperature>().empty());
}

TEST_CASE("gcode import: an arc's ends are as far from its centre, but for rounding") {
    CHECK(refused(begin + "G2 X20 Y20 I2 J0 E1").message.find("2.000 and 8.000") !=
          std::string::npos);
    CHECK(imported(begin + "G2 X20.03 Y20 I5 J0 E1").all<Arc>().size() == 1);
}

TEST_CASE("gcode import: more heaters and fans than a layer starts with are told of") {
    std::string heaters, fans;
    for (int i = 0; i < 17; ++i) heaters += "M104 S200 T" + std::to_string(i) + "\n";
    for (int i = 0; i < 9; ++i) fans += "M106 S200 P" + std::to_string(i) + "\n";
    for (const std::string& text : {heaters, fans}) {
        const Imported print = imported(text + begin + "G1 X20 E1\n");
        REQUIRE(print.diagnostics.size() == 1);
        CHECK(print.diagnostics[0].message.find("16 heaters or 8 fans") != std::string::npos);
    }
}

TEST_CASE("gcode import: a byte order mark is skipped, binary G-code named") {
    check_line(only_line("\xEF\xBB\xBF" + begin + "G1 X20" + ten_mm), 20, 20, 0.2);
    CHECK(refused("GCDE\x01\x00").message.find("binary G-code") != std::string::npos);
}

TEST_CASE("gcode import 5: whatever the bytes, it ends with a print or an error") {
    std::mt19937 random(11);
    const std::string whole =
        begin +
        "G1 X20 E1\nG2 X30 I5 J0 E1 F100\nG1 E-1\nG92 E0\nM104 S200 T1\nT2\n;LAYER:1\nG1 Z1\n"
        "G1 X1 E1\n; filament_diameter = 1.75,1.75\nM106 S300\nG4 P-1\n";
    for (int round = 0; round < 3000; ++round) {
        std::string text = whole;
        for (int edits = 1 + static_cast<int>(random() % 4); edits > 0; --edits) {
            const std::size_t at = random() % text.size();
            const char byte =
                static_cast<char>(random() % 2 ? random() % 256 : text[random() % text.size()]);
            if (random() % 3 == 0)
                text.erase(at, 1 + random() % 5);
            else
                text[at] = byte;
        }
        Diagnostics diagnostics;
        const auto totals = import_gcode(text, "a", "a", "/dev/null", {}, diagnostics);
        CAPTURE(totals.ok() ? std::string() : to_string(totals.error()));
        if (!totals.ok())
            CHECK((totals.error().status == ExitStatus::input ||
                   totals.error().status == ExitStatus::unsupported));
    }
}

TEST_CASE("gcode import: PrusaSlicer's print is what a machine makes of it") {
    const std::string text = text_of(LYR_FIXTURES "/gcode/cube_hole_prusaslicer.gcode");
    REQUIRE(!text.empty());
    const Imported print = imported(text);
    CHECK(print.diagnostics.empty());
    CHECK(print.header.metadata.material == "PLA");
    const test::GcodeMachine machine(text);
    std::vector<double> filament_mm;
    std::size_t extruding = 0;
    for (const test::GcodeMove& move : machine.moves) {
        filament_mm.resize(std::max(filament_mm.size(), static_cast<std::size_t>(move.layer) + 1));
        if (!move.moves() || move.filament_mm <= 1e-9) continue;
        filament_mm[static_cast<std::size_t>(move.layer)] += move.filament_mm;
        ++extruding;
    }
    REQUIRE(print.layers.size() + 1 == filament_mm.size());
    for (std::size_t i = 0; i < print.layers.size(); ++i) {
        CAPTURE(i);
        CHECK(print.layers[i].totals.volume_mm3 ==
              doctest::Approx(filament_mm[i + 1] * filament_mm2).epsilon(0.001));
    }
    CHECK(print.all<Line>().size() == extruding);
    CHECK(print.all<Wipe>().size() > 10);
    std::array<std::size_t, role_count> roles{};
    for (const auto& given : print.operations)
        if (std::holds_alternative<Line>(given.operation))
            ++roles[static_cast<std::size_t>(given.style.role)];
    CHECK(roles[static_cast<std::size_t>(Role::outer_wall)] > 0);
    CHECK(roles[static_cast<std::size_t>(Role::other)] == 0);
}
