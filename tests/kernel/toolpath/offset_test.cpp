// Offsets of random and of awkward regions, by what must hold for all of them.

#include "kernel/toolpath/offset.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"
#include "kernel/toolpath/sizes.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

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

// Every corner and every middle of one lies on the boundary of the other, twice as far off as each may be.
bool is_on(const Contours& one, const Contours& other) {
    for (const Contour& contour : one) {
        bool on = true;
        region::for_monotone_curves(contour, [&](const region::Curve& curve, std::size_t) {
            for (const Point2& point : {curve.start, curve.middle}) {
                on = on && distance_to(other, point) <= 2 * allowed_mm;
            }
        });
        if (!on) return false;
    }
    return true;
}

// What is so narrow that it may be there or not.
Contours without_narrow(Contours contours) {
    std::erase_if(contours, [](const Contour& contour) {
        return std::abs(area_mm2(contour)) < 4 * allowed_mm * length_mm(contour);
    });
    return contours;
}

void check_same(const Contours& one, const Contours& other) {
    CHECK(is_on(without_narrow(one), other));
    CHECK(is_on(without_narrow(other), one));
    const double off = std::abs(total_area(one) - total_area(other));
    CHECK(off <= 2 * allowed_mm * (total_length(one) + total_length(other)));
}

// From another of its corners on.
Contour begun_elsewhere(const Contour& contour, int corner) {
    if (std::holds_alternative<FullCircle>(contour)) return contour;
    Path path = std::get<Path>(contour);
    const auto by = corner % static_cast<int>(path.segments.size());
    std::rotate(path.segments.begin(), path.segments.begin() + by, path.segments.end());
    path.start = path.segments.back().end;
    return path;
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

TEST_CASE(
    "offset: turned, mirrored and shifted regions give the turned, mirrored, shifted result") {
    Random random(2);
    for (int i = 0; i < 150; ++i) {
        const double size = std::pow(10.0, random.within(-0.5, 2));
        const Contours region = random_region(random, {0, 0}, size);
        const double distance = size * random.within(-0.4, 0.4);
        const Corner corner = random.coin() ? Corner::round : Corner::mitre;
        const Motion motion{random.within(0, 2 * pi),
                            {random.within(-100, 100), random.within(-100, 100)},
                            random.coin()};
        CAPTURE(i);
        CAPTURE(distance);
        const OffsetResult result = offset_by(region, distance, corner);
        const OffsetResult there = offset_by(moved(region, motion), distance, corner);
        CHECK(!there.second_method);
        check_same(moved(result.contours, motion), there.contours);
    }
}

TEST_CASE("offset: where a contour begins and which comes first changes nothing but round-off") {
    Random random(3);
    for (int i = 0; i < 100; ++i) {
        const double size = std::pow(10.0, random.within(-0.5, 2));
        const Contours region = random_region(random, {5, -4}, size);
        Contours other;
        for (const Contour& contour : region) {
            other.insert(other.begin(), begun_elsewhere(contour, random.whole(1, 6)));
        }
        const double distance = size * random.within(-0.4, 0.4);
        CAPTURE(i);
        check_same(offset_by(region, distance).contours, offset_by(other, distance).contours);
    }
}

TEST_CASE("offset 1: outwards in two steps is outwards in one") {
    Random random(4);
    for (int i = 0; i < 150; ++i) {
        const double size = std::pow(10.0, random.within(-0.5, 2));
        const Contours region = random_region(random, {0, 0}, size);
        const double first = size * random.within(0.01, 0.3),
                     second = size * random.within(0.01, 0.3);
        CAPTURE(i);
        check_same(offset_by(offset_by(region, first).contours, second).contours,
                   offset_by(region, first + second).contours);
    }
}

// Closing what is convex changes nothing; so every rounded corner is about its own.
TEST_CASE("offset 1: out and in again gives back what is convex") {
    Random random(5);
    for (int i = 0; i < 100; ++i) {
        const double width = random.within(1, 50), height = random.within(1, 50);
        const Motion motion{random.within(0, 2 * pi), {random.within(-9, 9), 3}};
        const Contours region = moved(
            Contours{random.coin() ? rectangle(0, 0, width, height) : slot(0, 0, width, height)},
            motion);
        const double distance = random.within(0.1, 20);
        const Contours outer = offset_by(region, distance).contours;
        REQUIRE(outer.size() == 1);
        check_same(offset_by(outer, -distance).contours, region);
    }
}

TEST_CASE("offset 2: a mitred rectangle is a rectangle; a corner beyond the limit is round") {
    const Contours box{rectangle(0, 0, 30, 20)};
    for (const double angle : {0.0, 0.7}) {
        const Contours mitred = offset_by(moved(box, {angle}), 2, Corner::mitre).contours;
        REQUIRE(mitred.size() == 1);
        CHECK(count(mitred[0]).lines == 4);
        CHECK(count(mitred[0]).arcs == 0);
        CHECK(total_area(mitred) == doctest::Approx(34 * 24));
        const Contours round = offset_by(moved(box, {angle}), 2).contours;
        REQUIRE(round.size() == 1);
        CHECK(count(round[0]).arcs == 4);
        CHECK(total_area(round) == doctest::Approx(600 + 100 * 2 + pi * 4));
        // Beyond its limit of twice the distance: the two corners of 45 degrees.
        const Path sharp{{0, 0}, {{{20, 0}}, {{0, 20}}, {{0, 0}}}};
        const Contours mixed =
            offset_by(moved(Contours{sharp}, {angle}), 1, Corner::mitre).contours;
        REQUIRE(mixed.size() == 1);
        CHECK(count(mixed[0]).arcs == 2);
    }
}

TEST_CASE("offset 2: parallels of arcs are about the arcs' centres") {
    Random random(6);
    for (int i = 0; i < 200; ++i) {
        const Contours region{slot(0, 0, random.within(5, 30), random.within(2, 20))};
        const Motion motion{random.within(0, 2 * pi), {random.within(-9, 9), random.within(-9, 9)}};
        const double height = std::get<Path>(region[0]).segments[1].end.y();
        const double distance = random.within(-0.45, 0.45) * height;
        const Contours result = offset_by(moved(region, motion), distance).contours;
        REQUIRE(result.size() == 1);
        const SegmentCount found = count(result[0]);
        CHECK(found.lines == 2);
        CHECK(found.arcs == 2);
        const Path& path = std::get<Path>(result[0]);
        Point2 from = path.start;
        for (const Segment& segment : path.segments) {
            if (const auto circle = circle_of(from, segment)) {
                CHECK(circle->radius_mm == doctest::Approx(height / 2 + distance).epsilon(1e-9));
                const double left = (circle->centre - motion({0, height / 2})).norm();
                const Point2 right_centre(std::get<Path>(region[0]).segments[0].end.x(),
                                          height / 2);
                CHECK(std::min(left, (circle->centre - motion(right_centre)).norm()) < 1e-9);
            }
            from = segment.end;
        }
    }
}

// Islands between two bores, a neck that opens and closes, a wall just as thick as twice the distance.
TEST_CASE(
    "offset 3: regions split where they are narrower than twice the distance, and just there") {
    Path dumbbell{{0, 0}, {}};
    dumbbell.segments = {{{10, 0}},  {{10, 4}}, {{20, 4}}, {{20, 0}},  {{30, 0}}, {{30, 10}},
                         {{20, 10}}, {{20, 6}}, {{10, 6}}, {{10, 10}}, {{0, 10}}, {{0, 0}}};
    for (const double angle : {0.0, 0.4, pi / 2}) {
        const Contours region = moved(Contours{dumbbell}, {angle, {1, 2}});
        CHECK(offset_by(region, -0.999).contours.size() == 1);
        CHECK(offset_by(region, -1.001).contours.size() == 2);
        const OffsetResult just = offset_by(region, -1);
        CHECK(!just.unresolved);
        // Two squares, and what reaches into the neck between discs about its corners.
        CHECK(total_area(just.contours) == doctest::Approx(2 * (64 + 2 - pi / 2)).epsilon(1e-5));
        CHECK(offset_by(region, -5.001).contours.empty());
        // Outwards the two gaps of 4 mm close at 5, the wide side first.
        CHECK(offset_by(region, 4.999).contours.size() == 1);
    }
}
