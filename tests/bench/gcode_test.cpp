// The walls of a plate with a square window, as PrusaSlicer would print them: contracts of bench/gcode.h.

#include "bench/gcode.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bench/scratch_file.h"

namespace {

using namespace lyr;
using namespace lyr::bench;

constexpr double width_mm = 0.45, layer_height_mm = 0.2, filament_diameter_mm = 1.75;
constexpr double plate_mm = 10, window_mm = 4;  // half of their sides
constexpr double exact_mm = 1e-9;               // rounding of a few operations near 10 mm
constexpr double filament_a_mm = 0.03;

// Around a square, with filament.
std::string square(double half_mm, bool clockwise, double& filament_mm) {
    std::vector<Point2> corners{
        {-half_mm, -half_mm}, {half_mm, -half_mm}, {half_mm, half_mm}, {-half_mm, half_mm}};
    if (clockwise) std::reverse(corners.begin(), corners.end());
    corners.push_back(corners.front());
    std::string text;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        text += "G1 X" + std::to_string(corners[i].x()) + " Y" + std::to_string(corners[i].y());
        if (i > 0) {
            filament_mm += 2 * half_mm * filament_a_mm;
            text += " E" + std::to_string(filament_mm);
        }
        text += i > 0 ? "\n" : " F7800\n";
    }
    return text;
}

Gcode plate(bool plate_clockwise, bool window_clockwise, double& filament_mm) {
    std::string text = ";LAYER_CHANGE\n;Z:0.2\n;HEIGHT:0.2\nG1 Z.2 F7800\nG1 E-2 F2400\nG92 E0\n";
    text += "G1 E2 F2400\nG92 E0\n;TYPE:External perimeter\n;WIDTH:0.45\n";
    text += square(plate_mm - width_mm / 2, plate_clockwise, filament_mm);
    text += square(window_mm + width_mm / 2, window_clockwise, filament_mm);
    text += ";TYPE:Perimeter\n" + square(plate_mm / 2, false, filament_mm);
    const auto file = ScratchFile::with(text);
    REQUIRE(file);
    auto gcode = read_gcode(file->path(), filament_diameter_mm);
    REQUIRE(gcode);
    return *gcode;
}

}  // namespace

TEST_CASE("Volume is that of motions in x and y (contract 2)") {
    double filament_mm = 0;
    const Gcode gcode = plate(false, true, filament_mm);
    const double area_mm2 = std::numbers::pi / 4 * filament_diameter_mm * filament_diameter_mm;
    CHECK(gcode.volume_mm3 == doctest::Approx(filament_mm * area_mm2));
}

TEST_CASE("Flanks lie on the plate's and the window's sides, whichever way walls go (3, 4)") {
    for (const bool plate_clockwise : {false, true}) {
        for (const bool window_clockwise : {false, true}) {
            double filament_mm = 0;
            const Gcode gcode = plate(plate_clockwise, window_clockwise, filament_mm);
            CHECK(gcode.walls.size() == 2);
            std::size_t of_plate = 0, of_window = 0, astray = 0;
            for (const Point3& at : flank_points(gcode.walls, layer_height_mm, 1000)) {
                CHECK(at.z() == doctest::Approx(layer_height_mm / 2));
                const double away_mm = std::max(std::abs(at.x()), std::abs(at.y()));
                const bool on_plate = std::abs(away_mm - plate_mm) < exact_mm;
                const bool on_window = std::abs(away_mm - window_mm) < exact_mm;
                of_plate += on_plate ? 1 : 0;
                of_window += on_window ? 1 : 0;
                astray += on_plate || on_window ? 0 : 1;
            }
            CHECK(astray == 0);
            // As the sides' lengths are to each other; the plate's lose nothing, the window's their crossings.
            CHECK(of_plate > 600);
            CHECK(of_window > 250);
        }
    }
}

TEST_CASE("A file without outermost walls is an error") {
    const auto file = ScratchFile::with(";TYPE:Perimeter\nG1 X1 Y1 E1\n");
    REQUIRE(file);
    CHECK_FALSE(read_gcode(file->path(), filament_diameter_mm));
}
