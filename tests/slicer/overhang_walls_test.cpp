// Walls over air: which stretches are, and that they are printed as bridges.

#include "slicer/overhang_walls.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <random>
#include <vector>

#include "format/reader.h"
#include "kernel/brep/assembly.h"
#include "kernel/brep/placement.h"
#include "kernel/region/regions.h"
#include "kernel/solids.h"
#include "scratch.h"

using namespace lyr;
using namespace lyr::slicer;
using namespace lyr::testing;

namespace {

const double width_mm = Options{}.profile.perimeters.width_mm;

OutlinedLayer seen_layer(const Contours& outline) {
    OutlinedLayer layer{.outline = outline};
    layer.seen = SkinOutline(layer.outline, Options{}.profile.skin.width_mm);
    return layer;
}

// Of walls over a layer. The layer itself is wide enough to be anywhere.
std::optional<HeldWalls> held_by(const Contours& below, const Options& options = {}) {
    const OutlinedLayer layer = seen_layer({rectangle(-90, -90, 90, 90)}),
                        under = seen_layer(below);
    return HeldWalls::of(layer, under, options);
}

double beyond_mm(const Contours& below, const Point2& point) {
    return winding(below, point) > 0 ? 0 : distance_to(below, point);
}

// All that must hold of the stretches of a wall; gives how much of it is over air.
double check_stretches(const Strand& wall, const Point2& start, const Contours& below,
                       const std::vector<WallStretch>& stretches) {
    double length = 0, area = 0, over_air = 0;
    std::optional<Point2> end;
    for (const WallStretch& stretch : stretches) {
        const double own = length_mm(stretch.strand.path);
        length += own;
        area += flat_area_mm2(stretch.strand);
        over_air += stretch.over_air ? own : 0;
        const auto* path = std::get_if<Path>(&stretch.strand.path);
        if (!path) continue;
        CHECK(path->start == end.value_or(start));
        Point2 from = path->start;
        for (const Segment& segment : path->segments) {
            for (const double share : {0.1, 0.5, 0.9}) {
                const Point2 at = point_at(from, segment, share);
                const double off = beyond_mm(below, at) - width_mm / 2;
                // But for what is too short to change for.
                const bool is_long = length_mm(from, segment) >= width_mm;
                if (is_long && std::abs(off) > 1e-3) CHECK(stretch.over_air == (off > 0));
            }
            from = segment.end;
        }
        end = from;
        if (stretches.size() > 1) CHECK(own >= width_mm);
    }
    if (end) CHECK(*end == start);
    CHECK(length == doctest::Approx(length_mm(wall.path)));
    CHECK(area == doctest::Approx(flat_area_mm2(wall)));
    return over_air;
}

std::vector<WallStretch> turned(const Strand& wall, const Contours& below) {
    const auto held = held_by(below);
    REQUIRE(held);
    return held->stretches(wall, start_of(wall.path));
}

const std::vector<Motion> motions{{}, {0.4, {3, -7}}, {pi / 2, {0, 1}}, {1.1, {-20, 5}, true}};

}  // namespace

TEST_CASE("overhang walls 1, 2: between two pillars a wall is over air, and nowhere else") {
    for (const Motion& motion : motions) {
        for (const bool backwards : {false, true}) {
            const Contours below =
                moved({rectangle(0, 0, 5, 10), rectangle(15, 0, 20, 10)}, motion);
            Contour path = moved(Contour(rectangle(0.225, 0.225, 19.775, 9.775)), motion);
            if (backwards) path = reversed(path);
            const Strand wall{path, width_mm};
            const auto stretches = turned(wall, below);
            CHECK(stretches.size() == 5);
            const double over_air = check_stretches(wall, start_of(path), below, stretches);
            CHECK(over_air == doctest::Approx(2 * (10 - width_mm)));
        }
    }
}

TEST_CASE("overhang walls 1, 2: any wall over anything, with widths of its own") {
    Random random(11);
    std::mt19937 widths(3);
    for (int i = 0; i < 60; ++i) {
        CAPTURE(i);
        const Contours below = random_region(random, {0, 0}, 12);
        const Path path = random_ring(random, {3, 2}, 14);
        Strand wall{path, width_mm};
        for (std::size_t k = 0; k < path.segments.size(); ++k)
            wall.widths_mm.push_back(0.3 + 0.01 * static_cast<double>(widths() % 30));
        check_stretches(wall, path.start, below, turned(wall, below));
    }
}

TEST_CASE(
    "overhang walls 2: a circle over air stays one, half of one is two arcs about its centre") {
    const FullCircle circle{{1, 2}, 4, false};
    const Contours around{rectangle(-20, -20, 20, 20), FullCircle{{1, 2}, 8, false}};
    const auto whole = turned({circle, width_mm}, around);
    REQUIRE(whole.size() == 1);
    CHECK(whole[0].over_air);
    CHECK(whole[0].strand.path == Contour(circle));
    const Contours beside{rectangle(-20, -20, 1, 20)};
    const Strand wall{circle, width_mm};
    const auto parts = turned(wall, beside);
    const double over_air = check_stretches(wall, start_of(circle), beside, parts);
    CHECK(over_air == doctest::Approx(2 * 4 * std::acos(width_mm / 2 / 4)));
    for (const WallStretch& part : parts) {
        const Path& path = std::get<Path>(part.strand.path);
        Point2 from = path.start;
        for (const Segment& segment : path.segments) {
            const auto about = circle_of(from, segment);
            REQUIRE(about);
            CHECK((about->centre - circle.centre).norm() < 1e-9);
            from = segment.end;
        }
    }
}

TEST_CASE("overhang walls 2: a slot that is hardly wider than a line changes nothing") {
    const Contours below{rectangle(0, 0, 9.6, 10), rectangle(10.4, 0, 20, 10)};
    const auto stretches = turned({rectangle(0.225, 0.225, 19.775, 9.775), width_mm}, below);
    REQUIRE(stretches.size() == 1);
    CHECK(!stretches[0].over_air);
}

TEST_CASE(
    "overhang walls: none where the layer below is as large, leans little, or they are not asked "
    "for") {
    const OutlinedLayer layer = seen_layer({rectangle(0, 0, 20, 10)});
    CHECK(!HeldWalls::of(layer, layer, {}));
    CHECK(HeldWalls::of(layer, seen_layer({rectangle(1, 1, 19, 9)}), {}));
    Options options;
    options.profile.bridge.walls = false;
    CHECK(!HeldWalls::of(layer, seen_layer({}), options));
}

TEST_CASE("walls over a counterbore were printed as if the layer below held them") {
    // A bore of 3 mm over one of 6.
    Model part = drilled_box(20, 20, 4, 6);
    append(part,
           transformed(drilled_box(20, 20, 4, 3), Eigen::Affine3d(Eigen::Translation3d(0, 0, 4))));
    Options options;
    options.threads = 1;
    options.profile.fan.min = options.profile.fan.max = 0.3;
    Diagnostics diagnostics;
    REQUIRE(print(
        part, "counterbore", lyr::tests::scratch("part.lyr"), "", options,
        [](const char*, std::size_t, std::size_t) {}, diagnostics));
    auto reader = format::Reader::open(lyr::tests::scratch("part.lyr"));
    REQUIRE(reader);
    double duty = 0;
    format::PathStyle style;
    std::map<std::uint32_t, std::size_t> circles;  // by layer
    for (;;) {
        const auto next = reader->next();
        REQUIRE(next);
        if (!*next) break;
        if (const auto* fan = std::get_if<format::Fan>(&**next)) duty = fan->duty;
        if (std::holds_alternative<format::LayerStart>(**next))
            duty = reader->layer().state.fans[0].duty;
        if (const auto* path = std::get_if<format::PathStart>(&**next)) style = path->style;
        if (style.role == format::Role::outer_wall && std::holds_alternative<format::Line>(**next))
            CHECK(duty < options.profile.bridge.fan);
        if (style.role != format::Role::overhang_wall) continue;
        CHECK(style.speed_mm_s <= options.profile.speed.bridge_mm_s);
        if (std::holds_alternative<format::Circle>(**next)) {
            CHECK(duty == options.profile.bridge.fan);
            ++circles[reader->layer().index];
        }
    }
    const std::uint32_t first = 20;  // of the narrow bore
    REQUIRE(circles.size() == 1);
    CHECK(circles.at(first) == options.profile.perimeters.count);
}
