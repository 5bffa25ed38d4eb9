// What a print without support says of what nothing holds from below.

#include "slicer/air_below.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "kernel/brep/assembly.h"
#include "kernel/brep/placement.h"
#include "kernel/solids.h"
#include "scratch.h"
#include "slicer/slicer.h"

using namespace lyr;
using namespace lyr::slicer;
using lyr::testing::box;

namespace {

struct Block {
    const char* name;
    Vector3 low, high;
};

Model blocks(const std::vector<Block>& list, double turn_rad = 0) {
    Model all;
    for (const Block& block : list) {
        const Vector3 size = block.high - block.low, middle = (block.low + block.high) / 2;
        Model one = transformed(box(size.x(), size.y(), size.z()),
                                Eigen::Affine3d(Eigen::Translation3d(middle)));
        one.solids[0].name = block.name;
        one.solids[0].source = 100 + all.solids.size();
        append(all, one);
    }
    return transformed(all, Eigen::Affine3d(Eigen::AngleAxisd(turn_rad, Vector3::UnitZ())));
}

Diagnostics said_of(const Model& model, const Options& options = {}) {
    Diagnostics diagnostics;
    REQUIRE(print(
        model, "blocks", lyr::tests::scratch("blocks.lyr"), "", options,
        [](const char*, std::size_t, std::size_t) {}, diagnostics));
    return diagnostics;
}

const Block plate{"plate", {0, 0, 0}, {20, 20, 2}};

}  // namespace

TEST_CASE("a solid that began in mid-air was sliced without a word") {
    for (const double turn : {0.0, 0.3, 1.7}) {
        const Diagnostics said = said_of(blocks(
            {plate, {"floater", {4, 4, 6}, {9, 9, 9}}, {"other", {12, 12, 7}, {15, 15, 9}}}, turn));
        REQUIRE(said.size() == 1);
        CHECK(said[0].severity == Severity::warning);
        CHECK(
            said[0].message ==
            "of solid \"floater\" a part begins in mid-air: nothing is printed under it, nor under "
            "1 other island (support.kind is none)");
        CHECK(said[0].where.entity == 101);
        CHECK(said[0].where.layer == 31);
        CHECK(said[0].where.z_mm.value() == doctest::Approx(6.1));
        CHECK(said[0].where.x_mm.has_value());
    }
}

TEST_CASE("a pin in mid-air is told from one that rows a quarter of a millimetre apart miss") {
    const Diagnostics said = said_of(blocks({plate, {"pin", {4.31, 4.31, 3}, {4.53, 4.53, 5}}}));
    REQUIRE(!said.empty());
    CHECK(said[0].message.starts_with("of solid \"pin\" a part begins in mid-air"));
    // Upright from the plate it is held.
    CHECK(said_of(blocks({plate, {"pin", {4.31, 4.31, 2}, {4.6, 4.6, 5}}})).empty());
}

TEST_CASE("a roof over air is no bridge if it is held on one side, and a bridge if on two") {
    const Block left{"left", {0, 0, 0}, {3, 10, 5}}, right{"right", {15, 0, 0}, {18, 10, 5}};
    const Block roof{"roof", {0, 0, 5}, {18, 10, 7}};
    for (const double turn : {0.0, 0.3, 1.7}) {
        CHECK(said_of(blocks({left, right, roof}, turn)).empty());
        const Diagnostics said = said_of(blocks({left, roof}, turn));
        REQUIRE(said.size() == 1);
        CHECK(said[0].message.starts_with("in 1 layer the part reaches far out over air"));
        CHECK(said[0].message.find("by up to 149 mm2") != std::string::npos);
        CHECK(said[0].where.layer == 26);
    }
}

TEST_CASE("an overhang of a few lines' width is left to them, and support ends all warnings") {
    const Block roof{"roof", {-1.5, -1.5, 2}, {21.5, 21.5, 4}};
    CHECK(said_of(blocks({plate, roof})).empty());
    Options held;
    held.profile.support.kind = profile::SupportKind::grid;
    CHECK(said_of(blocks({plate, {"floater", {4, 4, 6}, {9, 9, 9}}}), held).empty());
}

TEST_CASE("what could not be worked out of overhangs was dropped without a word") {
    const Options options;
    const Model model = box(1, 1, 1);
    const Cutter cutter(model, options.tolerance());
    const LayerSpan span{0.2, 0.4};
    const auto disc = [&](double x_mm, double radius_mm) {
        OutlinedLayer layer{.outline = {FullCircle{{x_mm, 0}, radius_mm, true}}};
        layer.seen = SkinOutline(layer.outline, options.profile.skin.width_mm);
        return layer;
    };
    const auto said = [&](const std::vector<OutlinedLayer>& layers) {
        Diagnostics diagnostics;
        warn_of_air_below(layers, std::vector(layers.size(), span), 0, model, cutter, options,
                          diagnostics);
        return diagnostics;
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(said({disc(0, 5), disc(0, 5), disc(0, 5)}).empty());
    for (const double wrong : {nan, std::numeric_limits<double>::infinity()}) {
        const Diagnostics found = said({disc(0, 5), disc(0, 5), disc(0, wrong), disc(0, 5)});
        REQUIRE(found.size() == 1);
        CHECK(found[0].severity == Severity::warning);
        CHECK(found[0].message ==
              "in 2 layers, first here, it could not be worked out what hangs "
              "over air (support.kind is none)");
        CHECK(found[0].where.layer == 3);
        CHECK(found[0].where.z_mm == doctest::Approx(0.3));
        CHECK(!found[0].where.x_mm);
    }
}
