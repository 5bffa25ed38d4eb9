// Real files against the figures of an independent CAD kernel (fixtures/parts/reference.toml).

#include <doctest/doctest.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>

#include "kernel/section/cutter.h"
#include "slicer/bounds.h"
#include "slicer/layers.h"
#include "slicer/scene.h"
#include "slicer/slicer.h"

using namespace lyr;
using namespace lyr::slicer;
using lyr::testing::parts;

namespace {

// Relative agreement of areas with the reference, and what the tolerance allows along the boundary.
constexpr double area_agreement = 1e-5;

}  // namespace

TEST_CASE("real files have the reference's solids, faces, box and sections") {
    const toml::table reference = toml::parse_file(parts + "reference.toml");
    const toml::array* list = reference["part"].as_array();
    REQUIRE(list);
    REQUIRE(list->size() >= 12);
    for (const toml::node& node : *list) {
        const toml::table& part = *node.as_table();
        const std::string file = part["file"].value_or(std::string());
        CAPTURE(file);
        Options options;
        Diagnostics diagnostics;
        const auto model = load(parts + file, options, diagnostics);
        REQUIRE_MESSAGE(model, file, ": ", model ? "" : to_string(model.error()));
        CHECK(model->solids.size() == part["solids"].value_or(0u));
        CHECK(model->faces.size() == part["faces"].value_or(0u));
        const auto box = bounding_box(*model, options.tolerance());
        for (int axis = 0; axis < 3; ++axis) {
            const auto corner = [&](int i) {
                return part["box_mm"][static_cast<std::size_t>(i)].value_or(NAN);
            };
            CHECK(std::abs(box.min()[axis] - corner(axis)) < 1e-4);
            CHECK(std::abs(box.max()[axis] - corner(axis + 3)) < 1e-4);
        }
        const Cutter cutter(*model, options.tolerance());
        for (const toml::node& row : *part["planes"].as_array()) {
            const auto number = [&](std::size_t i) {
                return row.as_array()->get(i)->value_or(NAN);
            };
            const double z = number(0), area = number(1), length = number(2), loops = number(3);
            CAPTURE(z);
            const SectionFigures figures = figures_of(cutter.cut(z));
            const double allowed =
                std::max(area_agreement * area, 0.5 * options.tolerance().total_mm * length);
            CHECK(figures.open == 0);
            CHECK(std::abs(figures.area_mm2 - area) <= allowed);
            if (loops >= 0) CHECK(figures.loops == static_cast<std::size_t>(loops));
        }
    }
}

TEST_CASE("the gearbox base agrees to 1e-5 without help from the tolerance") {
    const toml::table reference = toml::parse_file(parts + "reference.toml");
    Diagnostics diagnostics;
    const auto model = load(parts + "gearbox_base.step", {}, diagnostics);
    REQUIRE(model);
    const Cutter cutter(*model, {});
    for (const toml::node& row : *reference["part"][0]["planes"].as_array()) {
        const double z = row.as_array()->get(0)->value_or(NAN);
        const double area = row.as_array()->get(1)->value_or(NAN);
        CHECK(figures_of(cutter.cut(z)).area_mm2 == doctest::Approx(area).epsilon(area_agreement));
    }
}

TEST_CASE("the areas of the sections add up to the reference's volume, whichever side is up") {
    const toml::table reference = toml::parse_file(parts + "reference.toml");
    for (const toml::node& node : *reference["part"].as_array()) {
        const toml::table& part = *node.as_table();
        const std::string file = part["file"].value_or(std::string());
        const double volume = part["volume_mm3"].value_or(NAN);
        CAPTURE(file);
        for (const Vector3& up : {Vector3(0, 0, -1), Vector3(0, 1, 0), Vector3(1, 1, 0),
                                  Vector3(1, 2, 3), Vector3(0.01, 0.02, 1)}) {
            CAPTURE(up.transpose());
            Options options;
            options.up = up;
            Diagnostics diagnostics;
            const auto model = load(parts + file, options, diagnostics);
            REQUIRE(model);
            const Cutter cutter(*model, options.tolerance());
            const HeightRange range = cutter.height_range();
            // Not in step with the parts' own levels.
            constexpr int planes = 397;
            const double step = (range.top_mm - range.bottom_mm) / planes;
            double sum = 0;
            for (int i = 0; i < planes; ++i) {
                const SectionFigures figures =
                    figures_of(cutter.cut(range.bottom_mm + (i + 0.5) * step));
                CHECK(figures.open == 0);
                CHECK(figures.area_mm2 > 0);
                sum += step * figures.area_mm2;
            }
            // A level face between two planes is worth up to half a step of its area.
            CHECK(sum == doctest::Approx(volume).epsilon(0.005));
        }
    }
}
