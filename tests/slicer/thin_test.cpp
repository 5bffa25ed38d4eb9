// Walls and pins from what is too thin for a line to what has several: how much of them is printed, and what is said.

#include <doctest/doctest.h>

#include <filesystem>
#include <numbers>

#include "kernel/brep/assembly.h"
#include "kernel/brep/placement.h"
#include "kernel/solids.h"
#include "scratch.h"
#include "slicer/scene.h"
#include "slicer/slicer.h"

using namespace lyr;
using namespace lyr::slicer;
using lyr::testing::at;
using lyr::testing::box;
using lyr::testing::pi;

namespace {

struct Measured {
    Result<Summary> summary;
    Diagnostics diagnostics;

    double volume_mm3(const Options& options) const {
        const double radius_mm = options.profile.filament.diameter_mm / 2;
        return summary->filament_mm * pi * radius_mm * radius_mm;
    }
};

Measured measured(const Model& model, const Options& options = {}) {
    Diagnostics diagnostics;
    auto summary = print(
        model, "thin", lyr::tests::scratch("thin.lyr"), "", options,
        [](const char*, std::size_t, std::size_t) {}, diagnostics);
    return {std::move(summary), std::move(diagnostics)};
}

// On a plate of 10 x 10 x 1 mm.
Model on_plate(const Model& model, double z) {
    Model all = box(10, 10, 1);
    append(all, at(model, 1, 1, z));
    return all;
}

}  // namespace

TEST_CASE("walls of 0.8, 0.9 and 0.95 mm were a fifteenth too full or a tenth too empty") {
    // A line has round flanks: so much is missing at the sides of any wall.
    const double height_mm = 0.2, round_mm = height_mm * (1 - pi / 4);
    for (const double density : {1.0, 0.15})
        for (int i = 8; i <= 40; ++i) {
            const double wall_mm = 0.05 * i;
            CAPTURE(wall_mm);
            CAPTURE(density);
            Options options;
            options.profile.infill.density = density;
            const Measured wall = measured(box(40, wall_mm, 0.8), options);
            REQUIRE(wall.summary);
            CHECK(wall.diagnostics.empty());
            CHECK(wall.volume_mm3(options) ==
                  doctest::Approx(40 * 0.8 * (wall_mm - round_mm)).epsilon(0.02));
        }
}

// Strands end half their width before the part does.
TEST_CASE(
    "posts of 0.3 to 1.5 mm lost three quarters of their volume at the ends of their strands") {
    const double height_mm = 0.2, round_mm = height_mm * (1 - pi / 4);
    Options options;
    options.profile.infill.density = 1;
    for (const double post_mm : {0.3, 0.4, 0.5, 0.64, 0.7, 0.9, 1.2, 1.5}) {
        CAPTURE(post_mm);
        const Measured post = measured(box(post_mm, post_mm, 2), options);
        REQUIRE(post.summary);
        const double edge_mm = post_mm - round_mm;
        CHECK(post.volume_mm3(options) == doctest::Approx(2 * edge_mm * edge_mm).epsilon(0.03));
    }
    for (const double length_mm : {0.9, 1.3, 2.6}) {
        CAPTURE(length_mm);
        const Measured bar = measured(box(0.64, length_mm, 2), options);
        REQUIRE(bar.summary);
        CHECK(bar.volume_mm3(options) ==
              doctest::Approx(2 * (0.64 - round_mm) * (length_mm - round_mm)).epsilon(0.05));
    }
}

TEST_CASE("pins and walls of less than 0.22 mm were left out without a word") {
    for (const double pin_mm : {0.1, 0.15, 0.19, 0.21}) {
        CAPTURE(pin_mm);
        const Measured made = measured(on_plate(box(pin_mm, pin_mm, 4), 2.5));
        REQUIRE(made.summary);
        REQUIRE(made.diagnostics.size() == 1);
        const Diagnostic& warning = made.diagnostics[0];
        CHECK(warning.severity == Severity::warning);
        CHECK(warning.message.find("are left out in 20 layers, from z = 1 to 5 mm") !=
              std::string::npos);
        CHECK(warning.where.layer == 6);
        CHECK(warning.where.x_mm.value() == doctest::Approx(6).epsilon(0.001));
        CHECK(warning.where.y_mm.value() == doctest::Approx(6).epsilon(0.001));
    }
    const Measured wall = measured(on_plate(box(3, 0.15, 4), 2.5));
    REQUIRE(wall.diagnostics.size() == 1);
    CHECK(wall.diagnostics[0].where.y_mm.value() == doctest::Approx(6).epsilon(0.01));
}

TEST_CASE(
    "a short neck thinner than the least width was lost without a word: two bodies came apart") {
    for (const double neck_mm : {0.1, 0.15, 0.18, 0.22, 0.3}) {
        CAPTURE(neck_mm);
        Model all = box(4, 4, 1);
        append(all, at(box(4, 4, 1), 4.3, 0, 0));
        append(all, at(box(0.5, neck_mm, 1), 2.15, 0, 0));
        const Measured made = measured(all);
        REQUIRE(made.summary);
        REQUIRE(made.diagnostics.size() == (neck_mm < 0.2 ? 1 : 0));
        if (neck_mm > 0.2) continue;
        const Diagnostic& warning = made.diagnostics[0];
        CHECK(
            warning.message.starts_with("parts thinner than 0.2 mm (perimeters.min_width) are "
                                        "left out in 5 layers, from z = 0 to 1 mm"));
        CHECK(warning.where.layer == 1);
        CHECK(warning.where.x_mm.value() == doctest::Approx(4.15).epsilon(0.01));
        CHECK(warning.where.y_mm.value() == doctest::Approx(2).epsilon(0.01));
    }
}

TEST_CASE("pins of 0.25 to 0.6 mm are printed") {
    for (const double pin_mm : {0.25, 0.3, 0.4, 0.45, 0.6}) {
        CAPTURE(pin_mm);
        const Measured plate = measured(box(10, 10, 1));
        const Measured pin = measured(on_plate(box(pin_mm, pin_mm, 4), 2.5));
        CHECK(pin.diagnostics.empty());
        if (pin_mm > 0.25) CHECK(pin.summary->filament_mm > plate.summary->filament_mm + 0.02);
    }
}

TEST_CASE("of pins alone that no line fits into nothing is printed, and that is an error") {
    const Measured pin = measured(box(0.21, 0.21, 4));
    REQUIRE(!pin.summary);
    CHECK(pin.summary.error().message.starts_with("nothing to print"));
}
