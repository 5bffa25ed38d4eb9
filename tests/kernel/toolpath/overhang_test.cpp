// What hangs over the layer below, on regions whose overhangs are known.

#include "kernel/toolpath/overhang.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

constexpr OverhangRequest usual{
    .ledge_mm = 0.5, .margin_mm = 1, .longest_bridge_mm = 10, .width_mm = 0.45, .allowed_mm = 1e-4};

Contours square(double half) {
    return {rectangle(-half, -half, half, half)};
}

Contours held(const Contours& layer, const Contours& below, const OverhangEdges& edges = {}) {
    const Overhang overhang = overhang_of(layer, below, edges, {}, true, usual);
    CHECK(overhang.unresolved == 0);
    return overhang.contours;
}

Path along_bottom(const Contours& square) {
    const Path& path = std::get<Path>(square[0]);
    return {path.start, {path.segments[0]}};
}

}  // namespace

TEST_CASE("strokes: all within a distance of open paths, which stay lines and arcs") {
    std::size_t unresolved = 0;
    const Path line{{1, 2}, {{{11, 2}}}}, half_circle{{30, 0}, {{{20, 0}, 5}}};
    const Path paths[] = {line, half_circle};
    const Contours region = strokes(paths, 1, 1e-4, unresolved);
    CHECK(unresolved == 0);
    REQUIRE(region.size() == 2);
    CHECK(total_area(region) == doctest::Approx(20 + pi + (36 - 16) * pi / 2 + pi));
    // One that is closed has a hole, the other way round too.
    for (const double sagitta : {5.0, -5.0}) {
        const Path circle{{30, 0}, {{{20, 0}, sagitta}, {{30, 0}, sagitta}}};
        const Contours ring = strokes({&circle, 1}, 1, 1e-4, unresolved);
        CHECK(ring.size() == 2);
        CHECK(total_area(ring) == doctest::Approx((36 - 16) * pi));
    }
    CHECK(strokes({}, 1, 1e-4, unresolved).empty());
}

TEST_CASE("overhang 1: a ledge is held if it is wider than the lines below carry") {
    const double corner = usual.margin_mm + usual.ledge_mm / 2;
    CHECK(held(square(5), square(5)).empty());
    CHECK(held(square(5.4), square(5)).empty());
    const Contours ring = held(square(6), square(5));
    // Corners are rounded, by the disc and the margin.
    const double whole = 4 * (7 * 7 - 4 * 4);
    CHECK(total_area(ring) == doctest::Approx(whole - (4 - pi) * corner * corner));
    for (const Point2& p : {Point2(5.5, 0), Point2(0, -5.5), Point2(5.6, 5.6), Point2(4.1, 2)})
        CHECK(winding(ring, p) > 0);
    CHECK(winding(ring, {3.9, 0}) == 0);
}

TEST_CASE("overhang 1: edges that lean are held as far as the margin, wherever they lie") {
    for (const Motion& motion : {Motion{}, Motion{0.7, {3, -2}}, Motion{2.5, {0, 1}, true}}) {
        const Contours layer = moved(square(5), motion);
        const OverhangEdges edges{.leaning = {along_bottom(layer)}};
        CHECK(total_area(held(layer, layer, edges)) == doctest::Approx(20 + pi));
    }
}

TEST_CASE(
    "overhang 2: an underside held on two sides is a bridge, unless it is long or beside a slope") {
    const auto gap = [](double width) {
        return Contours{rectangle(-20, -4, -width / 2, 4), rectangle(width / 2, -4, 20, 4)};
    };
    const Contours plate{rectangle(-20, -4, 20, 4)};
    CHECK(held(plate, gap(9.5)).empty());
    CHECK(total_area(held(plate, gap(10.5))) > 80);
    // Held on one side only.
    CHECK(total_area(held(plate, {rectangle(-20, -4, 15, 4)})) > 30);
    const Path beside{{-4.75, -4}, {{{-4.75, 4}}}};
    const Overhang slope = overhang_of(plate, gap(9.5), {}, {&beside, 1}, true, usual);
    CHECK(total_area(slope.contours) > 70);
}

TEST_CASE("overhang 3: nothing is held under what is blocked") {
    const Contours layer = square(6);
    CHECK(held(layer, square(4), {.blocked_area = square(6)}).empty());
    // One side of four.
    const Contours side{rectangle(-6, -6, 6, -4)};
    const Contours others = held(layer, square(4), {.blocked_area = side});
    CHECK(winding(others, {0, -5}) == 0);
    CHECK(winding(others, {0, 5}) > 0);
    // An edge that leans, but for the reach of a blocked one.
    const Path edge = along_bottom(layer);
    const Contours left = held(layer, layer, {.leaning = {edge}, .blocked = {{edge, 0.4}}});
    CHECK(total_area(left) == doctest::Approx(24 + pi - 0.8 * 12 - 0.16 * pi));
    for (const Contour& contour : left) CHECK(area_mm2(contour) * 1e6 != 0);
}

TEST_CASE("overhang 4: numbers that are not finite are counted") {
    Contours broken = square(6);
    std::get<Path>(broken[0]).segments[1].end.x() = std::numeric_limits<double>::quiet_NaN();
    CHECK(overhang_of(broken, square(4), {}, {}, true, usual).unresolved > 0);
}
