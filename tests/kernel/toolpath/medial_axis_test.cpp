#include "kernel/toolpath/medial_axis.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"
#include "kernel/toolpath/boundary.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

// Discs touch the boundary and do not reach over it; tangents lead along the edge.
void check_discs(const Contours& region, const MedialAxis& axis) {
    const Boundary boundary(region);
    double worst_mm = 0, worst_cosine = 1;
    for (const MedialEdge& edge : axis.edges)
        for (std::size_t i = 0; i < edge.points.size(); ++i) {
            const MedialPoint& point = edge.points[i];
            const double distance = boundary.distance_mm(point.centre, 10);
            worst_mm = std::max(worst_mm, std::abs(distance - point.radius_mm));
            if (i == 0) continue;
            const Vector2 way = point.centre - edge.points[i - 1].centre;
            worst_cosine = std::min(worst_cosine, way.normalized().dot(point.tangent));
        }
    CHECK(worst_mm < 1e-4);
    CHECK(worst_cosine > 0.9);
}

// The radii at edges' ends that no other edge shares.
std::vector<double> free_ends(const MedialAxis& axis) {
    std::vector<MedialPoint> ends;
    for (const MedialEdge& edge : axis.edges) {
        ends.push_back(edge.points.front());
        ends.push_back(edge.points.back());
    }
    std::vector<double> radii;
    for (const MedialPoint& end : ends)
        if (std::count_if(ends.begin(), ends.end(), [&](const MedialPoint& other) {
                return other.centre == end.centre;
            }) == 1)
            radii.push_back(end.radius_mm);
    return radii;
}

}  // namespace

TEST_CASE("medial axis 1: that of a rectangle is its middle line and a branch to each corner") {
    for (const Motion& motion : {Motion{}, Motion{0.7, {3, 4}}, Motion{2, {100, -50}, true}}) {
        const Contours region = lyr::testing::moved(Contours{rectangle(0, 0, 10, 1)}, motion);
        const MedialAxis axis = medial_axis(region, 1);
        CHECK(axis.complete);
        CHECK(axis.edges.size() == 5);
        CHECK(free_ends(axis).size() == 4);
        check_discs(region, axis);
        double area = 0;
        for (const MedialEdge& edge : axis.edges) area += edge.points.back().area_mm2;
        CHECK(area == doctest::Approx(10));
    }
}

TEST_CASE("medial axis 2, 3: edges of random regions hang together and share the area") {
    for (unsigned seed = 0; seed < 40; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        const Contours region = random_region(random, {0, 0}, 4);
        const MedialAxis axis = medial_axis(region, 1);
        CHECK(axis.complete);
        check_discs(region, axis);
        // Edges end in all corners that turn into the material and in centres of arcs.
        std::ptrdiff_t corners = 0;
        std::vector<double> radii{0};
        for_neighbours(boundary_pieces(region), [&](const auto& before, const auto& piece) {
            corners += cross(before.end_tangent, piece.start_tangent) > 1e-6;
            if (piece.curvature_per_mm > 0) radii.push_back(1 / piece.curvature_per_mm);
        });
        const std::vector<double> ends = free_ends(axis);
        CHECK(std::count(ends.begin(), ends.end(), 0) == corners);
        for (const double end : ends)
            CHECK(std::any_of(radii.begin(), radii.end(),
                              [&](double radius) { return std::abs(radius - end) < 1e-6; }));
    }
}

TEST_CASE("medial axis 4: of a disc there is no edge") {
    const Contours disc{FullCircle{{1, 2}, 3, true}};
    const MedialAxis axis = medial_axis(disc, 1);
    CHECK(axis.complete);
    CHECK(axis.edges.empty());
    REQUIRE(axis.discs.size() == 1);
    CHECK(axis.discs[0].radius_mm == doctest::Approx(3));
    Path halves{{4, 2}, {}};
    halves.segments.push_back(arc_with_sweep({4, 2}, {-2, 2}, pi));
    halves.segments.push_back(arc_with_sweep({-2, 2}, {4, 2}, pi));
    CHECK(medial_axis(Contours{halves}, 1).discs.size() == 1);
}

TEST_CASE("medial axis 5: contours that the region is on the wrong side of are not complete") {
    CHECK(!medial_axis(Contours{reversed(Contour(rectangle(0, 0, 10, 1)))}, 1).complete);
}

TEST_CASE("medial axis: a square's four branches meet in one point") {
    for (int i = 0; i < 20; ++i) {
        const Contours square =
            lyr::testing::moved(Contours{rectangle(-1, -1, 1, 1)}, Motion{0.1 * i, {0.3 * i, 5}});
        const MedialAxis axis = medial_axis(square, 1);
        CHECK(axis.complete);
        CHECK(axis.edges.size() == 4);
        CHECK(free_ends(axis).size() == 4);
    }
}

TEST_CASE("medial axis: a boundary's start on a full circle that is opposite does not matter") {
    Path half{{0, -1}, {}};
    half.segments.push_back(arc_with_sweep({0, -1}, {0, 1}, pi));
    half.segments.push_back(arc_with_sweep({0, 1}, {0, -1}, pi));
    const Contours ring{half, FullCircle{{0, 0}, 0.5, false}};
    const MedialAxis axis = medial_axis(ring, 1);
    CHECK(axis.complete);
    CHECK(free_ends(axis).empty());
}
