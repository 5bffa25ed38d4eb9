// The check of an offset: what is right passes, what is spoilt does not, and the second method puts it right.

#include "kernel/toolpath/offset_check.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"
#include "kernel/toolpath/boundary.h"
#include "kernel/toolpath/sizes.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

// A contour so wide, in distances, holds a place that the check looks at, or nearly always.
constexpr double wide_share = 0.5;

struct Case {
    Contours region;
    OffsetRequest request;
    Contours result;
};

Case random_case(Random& random, Corner corner = Corner::round) {
    const double size = std::pow(10.0, random.within(-0.5, 2));
    Case made{random_region(random, {random.within(-100, 100), random.within(-100, 100)}, size),
              {size * random.within(-0.25, 0.25), allowed_mm, corner},
              {}};
    made.result = offset(made.region, made.request).contours;
    return made;
}

std::optional<OffsetFault> fault_of(const Case& made, const Contours& result) {
    return lyr::fault_of(BoundedRegion(result), BoundedRegion(made.region), made.request);
}

double mean_width_mm(const Contour& contour) {
    return 2 * std::abs(area_mm2(contour)) / length_mm(contour);
}

bool is_wide(const Case& made, const Contour& contour) {
    return mean_width_mm(contour) > wide_share * std::abs(made.request.distance_mm);
}

RegionResult as_found(const Contours& contours) {
    RegionResult result;
    result.contours = contours;
    return result;
}

}  // namespace

TEST_CASE("offset check: what offset() makes is right") {
    Random random(31);
    for (int i = 0; i < 300; ++i) {
        const Case made = random_case(random, i % 2 == 0 ? Corner::round : Corner::mitre);
        CAPTURE(i);
        CHECK(!fault_of(made, made.result));
    }
}

TEST_CASE("offset check 1: a result that is off by more than allowed is found") {
    Random random(32);
    for (int i = 0; i < 200; ++i) {
        const Case made = random_case(random);
        if (made.result.empty()) continue;
        CAPTURE(i);
        const Vector2 shift(2.5 * allowed_mm, -1.5 * allowed_mm);
        const auto moved_away = fault_of(made, moved(made.result, {0, shift}));
        REQUIRE(moved_away);
        CHECK(moved_away->kind == OffsetFault::Kind::distance);
        OffsetRequest farther = made.request;
        farther.distance_mm += 3 * allowed_mm;
        const Contours other = offset(made.region, farther).contours;
        if (!other.empty()) CHECK(fault_of(made, other));
    }
}

TEST_CASE("offset check 1: the offset on the other side is found") {
    Random random(33);
    for (int i = 0; i < 200; ++i) {
        const Case made = random_case(random);
        OffsetRequest inverse = made.request;
        inverse.distance_mm = -inverse.distance_mm;
        CAPTURE(i);
        CHECK(fault_of(made, offset(made.region, inverse).contours));
        CHECK(fault_of(made, made.region));
    }
}

TEST_CASE("offset check 2: a contour that runs the wrong way round, or twice, is found") {
    Random random(34);
    for (int i = 0; i < 200; ++i) {
        const Case made = random_case(random);
        for (std::size_t c = 0; c < made.result.size(); ++c) {
            if (!is_wide(made, made.result[c])) continue;
            Contours spoilt = made.result;
            spoilt[c] = reversed(spoilt[c]);
            CAPTURE(i);
            CAPTURE(c);
            CHECK(fault_of(made, spoilt));
            spoilt[c] = made.result[c];
            spoilt.push_back(made.result[c]);
            CHECK(fault_of(made, spoilt));
        }
    }
}

// Among them: a hole that had grown inwards was missed by a check that counted windings on one side of it only, and
// islands between the ends of long segments by one that looked beside their middles.
TEST_CASE("offset check 4: a contour that is missing is found") {
    Random random(35);
    int dropped = 0, missed = 0;
    for (int i = 0; i < 1000; ++i) {
        const Case made = random_case(random, i % 2 == 0 ? Corner::round : Corner::mitre);
        for (std::size_t c = 0; c < made.result.size(); ++c) {
            if (!is_wide(made, made.result[c])) continue;
            Contours spoilt = made.result;
            spoilt.erase(spoilt.begin() + static_cast<std::ptrdiff_t>(c));
            ++dropped;
            missed += !fault_of(made, spoilt);
        }
    }
    CHECK(dropped > 1000);
    CHECK(missed == 0);
}

TEST_CASE("offset 5: what the first method makes wrong is made again by the second") {
    Random random(36);
    for (int i = 0; i < 60; ++i) {
        const Case made = random_case(random, i % 2 == 0 ? Corner::round : Corner::mitre);
        if (made.result.empty()) continue;
        OffsetRequest nearer = made.request;
        nearer.distance_mm *= 0.9;
        CAPTURE(i);
        CAPTURE(made.request.distance_mm);
        const Contours wrong = offset(made.region, nearer).contours;
        const OffsetResult again =
            settled(as_found(wrong), BoundedRegion(made.region), made.request);
        CHECK(again.second_method);
        CHECK(!again.unresolved);
        CHECK(std::abs(total_area(again.contours) - total_area(made.result)) <=
              2 * allowed_mm * total_length(made.result));
    }
}

TEST_CASE("offset 5: a region that crosses itself is cleaned for the second method") {
    // The section of a screw whose faces overlap a little: an arc runs past the line that it should end at, which goes
    // back to it. What they enclose has the material on its right.
    Path path{{0, 0}, {}};
    path.segments = {{{10, 0}},   {{10, 4}},  {{10.01, 5}}, {{9.99, 5}},
                     {{10, 4.1}}, {{10, 10}}, {{0, 10}},    {{0, 0}}};
    const Contours region{path};
    const OffsetResult result = offset(region, {-0.6, allowed_mm});
    CHECK(!result.unresolved);
    const Contours clean = cleaned(region, allowed_mm).contours;
    const Contours expected = offset(clean, {-0.6, allowed_mm}).contours;
    CHECK(std::abs(total_area(result.contours) - total_area(expected)) <
          allowed_mm * total_length(expected));
}

TEST_CASE("offset 5: numbers that are not finite are given back, and said so") {
    const Contours region{FullCircle{{0, 0}, std::numeric_limits<double>::quiet_NaN(), true}};
    const OffsetResult result = offset(region, {-1, allowed_mm});
    REQUIRE(result.unresolved);
    CHECK(result.unresolved->kind == OffsetFault::Kind::input);
    CHECK(result.contours.size() == 1);
    CHECK(offset({}, {1, 0}).unresolved);
    CHECK(offset({}, {std::numeric_limits<double>::infinity(), allowed_mm}).unresolved);
}

TEST_CASE("boundary: distances and windings are those of the contours, point by point") {
    Random random(37);
    for (int i = 0; i < 100; ++i) {
        const double size = std::pow(10.0, random.within(-0.5, 2));
        const Contours region = random_region(random, {0, 0}, size);
        const Boundary boundary(region);
        for (int k = 0; k < 30; ++k) {
            const Point2 point(size * random.within(-1.2, 1.2), size * random.within(-1.2, 1.2));
            const double distance = distance_to(region, point);
            CHECK(boundary.winding(point) == winding(region, point));
            CHECK(std::abs(boundary.distance_mm(point, 3 * size) - distance) < 1e-9 * size);
            CHECK(boundary.distance_mm(point, distance / 2) == distance / 2);
            CHECK(boundary.is_near(point, distance * 1.001));
            CHECK(!boundary.is_near(point, distance * 0.999));
        }
        for (const BoundaryPiece& piece : boundary.pieces()) {
            CHECK((piece.at(0).point - piece.start).norm() < 1e-9 * size);
            CHECK((piece.at(1).point - piece.end).norm() < 1e-9 * size);
            CHECK((piece.at(1).tangent - piece.end_tangent).norm() < 1e-9);
            CHECK(distance_to(region, piece.at(0.3).point) < 1e-9 * size);
        }
    }
}

TEST_CASE(
    "boundary 1: an arc that ends at its circle's lowest point is met by a ray in that height") {
    Random random(38);
    for (int i = 0; i < 500; ++i) {
        const Point2 centre(random.within(-50, 50), random.within(-50, 50));
        const double radius = random.within(0.1, 20), sweep = pi * random.within(0.6, 0.99);
        const Point2 lowest = centre - Vector2(0, radius);
        const Point2 end = centre + Eigen::Rotation2Dd(-sweep) * Vector2(0, -radius);
        Path path{lowest, {{lowest + Vector2(1, 0)}, {centre + Vector2(1, 2 * radius)}, {end}}};
        path.segments.push_back(arc_with_sweep(end, lowest, sweep));
        const Boundary boundary(Contours{path});
        CHECK(boundary.winding({centre.x() - 2 * radius, lowest.y()}) == 0);
    }
}

TEST_CASE(
    "offset: a region without contours has none offset by any distance, and nothing is wrong") {
    for (const double distance : {-1.0, 0.0, 2.0}) {
        const OffsetResult result = offset({}, {distance, allowed_mm});
        CHECK(result.contours.empty());
        CHECK(!result.second_method);
        CHECK(!result.unresolved);
    }
}
