// Offsets of random and of awkward regions, by what must hold for all of them.

#include "kernel/toolpath/offset.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

constexpr double allowed_mm = 1e-4;

OffsetResult offset_by(const Contours& region, double distance_mm, Corner corner = Corner::round) {
    return offset(region, {distance_mm, allowed_mm, corner});
}

// By the definition: what is deeper in the offset than allowed is in, what is farther from it is out.
void check_points(const Contours& region, double distance_mm, const Contours& result,
                  Random& random, int points) {
    Eigen::AlignedBox2d box = box_of(region);
    const double margin = std::max(0.0, distance_mm) * 1.2;
    const Vector2 low = box.min() - Vector2(margin, margin),
                  high = box.max() + Vector2(margin, margin);
    for (int i = 0; i < points; ++i) {
        const Point2 point(random.within(low.x(), high.x()), random.within(low.y(), high.y()));
        const double distance = distance_to(region, point);
        const double depth = (winding(region, point) > 0 ? distance : -distance) + distance_mm;
        if (std::abs(depth) < 2 * allowed_mm) continue;
        CAPTURE(point.x());
        CAPTURE(point.y());
        CAPTURE(depth);
        CHECK(winding(result, point) == (depth > 0 ? 1 : 0));
    }
}

}  // namespace

TEST_CASE("offset 1: a point is in the result if its distance to the region says so") {
    Random random(1);
    for (int i = 0; i < 300; ++i) {
        const double size = std::pow(10.0, random.within(-0.5, 2));
        const Contours region =
            random_region(random, {random.within(-100, 100), random.within(-100, 100)}, size);
        const double distance = size * random.within(-0.6, 0.6) * random.within(0, 1);
        CAPTURE(i);
        CAPTURE(distance);
        const OffsetResult result = offset_by(region, distance);
        CHECK(!result.unresolved);
        for (const Contour& contour : result.contours) CHECK(is_closed(contour));
        check_points(region, distance, result.contours, random, 60);
    }
}

TEST_CASE("offset 2: a hole grows about its own centre and stays a full circle") {
    const Contours region{rectangle(-20, -20, 20, 20), FullCircle{{1.1, 2.3}, 5, false}};
    const OffsetResult result = offset_by(region, -0.2);
    REQUIRE(result.contours.size() == 2);
    bool found = false;
    for (const Contour& contour : result.contours) {
        const auto* circle = std::get_if<FullCircle>(&contour);
        if (!circle) continue;
        found = true;
        CHECK(circle->centre == Point2(1.1, 2.3));
        CHECK(circle->radius_mm == 5.2);
        CHECK(!circle->counter_clockwise);
    }
    CHECK(found);
}

TEST_CASE("offset: a disc that is offset inwards by more than its radius is gone") {
    for (const double distance : {-1.0, -1.5, -1.9, -2.5}) {
        const Contours circle{FullCircle{{3, 4}, 1, true}};
        Path halves{{4, 4}, {}};
        halves.segments.push_back(arc_with_sweep({4, 4}, {2, 4}, pi));
        halves.segments.push_back(arc_with_sweep({2, 4}, {4, 4}, pi));
        CHECK(offset_by(circle, distance).contours.empty());
        CHECK(offset_by({halves}, distance).contours.empty());
    }
}

TEST_CASE("offset 5: where contours touch in the middle of a segment, nothing is wrong") {
    // The hole grows to touch the wall at just the place where the check would look which side is which.
    const Contours touches_wall{rectangle(0, 0, 136, 64.5),
                                FullCircle{{30, 32.25}, 1.6499999999999986, false}};
    // The region splits along a gap without width.
    const Contours touch_each_other{rectangle(0, 0, 10, 10), FullCircle{{5, 5}, 1, false},
                                    reversed(rectangle(4, 8, 6, 9))};
    for (const auto& [region, distance] :
         {std::pair{touches_wall, -14.175}, std::pair{touch_each_other, -1.0}}) {
        for (const double angle : {0.0, 0.3, pi / 2}) {
            CAPTURE(distance);
            CAPTURE(angle);
            const OffsetResult result = offset_by(moved(region, {angle, {3, -7}}), distance);
            CHECK(!result.second_method);
            CHECK(!result.unresolved);
        }
    }
}
