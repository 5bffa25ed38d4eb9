// Walls of outlines as real sections have them, which are not always regions.

#include "slicer/outline.h"

#include <doctest/doctest.h>

#include <numbers>

#include "slicer/scene.h"

using namespace lyr;
using namespace lyr::slicer;
using lyr::testing::span;

namespace {

Contour polygon(std::initializer_list<Point2> corners, double turn_rad) {
    const Eigen::Rotation2Dd turn(turn_rad);
    Path path{turn * *(corners.end() - 1), {}};
    for (const Point2& corner : corners) path.segments.push_back({turn * corner, 0});
    return path;
}

OutlinedLayer walled(std::vector<Contour> outline) {
    OutlinedLayer layer{.outline = std::move(outline)};
    add_walls(layer, span, {});
    return layer;
}

}  // namespace

TEST_CASE("outlines that cross themselves, as faces overlap a little, have walls that are right") {
    for (const double turn_rad : {0.0, 0.3, 1.7}) {
        CAPTURE(turn_rad);
        // Two halves of a square; a side of each goes on past the other's.
        const OutlinedLayer layer = walled({polygon(
            {{0, 0}, {20, 0}, {20, 20}, {10, 20}, {10, 19}, {10.5, 19}, {10.5, 20.5}, {0, 20.5}},
            turn_rad)});
        CHECK(layer.uncrossed);
        CHECK(layer.walls.unresolved == 0);
        CHECK(layer.walls.second_method == 0);
        for (const Strand& strand : layer.walls.strands) CHECK(area_mm2(strand.path) > 0);
    }
}

TEST_CASE("an outline that does not cross itself is left as it is") {
    const std::vector<Contour> outline{polygon({{0, 0}, {20, 0}, {20, 20}, {0, 20}}, 0.3)};
    const OutlinedLayer layer = walled(outline);
    CHECK_FALSE(layer.uncrossed);
    CHECK(layer.outline.size() == 1);
    CHECK(area_mm2(layer.outline) == area_mm2(outline));
    CHECK(layer.walls.unresolved == 0);
}
