#include "kernel/toolpath/uncross.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"
#include "kernel/toolpath/offset_check.h"
#include "kernel/toolpath/offset_curve.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

constexpr double clear_mm = 1e-4;

std::optional<Contours> uncrossed_of(const Contours& curves) {
    return uncrossed(BoundedRegion(curves), clear_mm);
}

void check_same_region(const Contours& found, const Contours& expected) {
    CHECK(std::abs(total_area(found) - total_area(expected)) <= 1e-6 * total_length(expected));
    CHECK(std::abs(total_length(found) - total_length(expected)) <= 1e-3);
}

}  // namespace

TEST_CASE("uncross: random regions over each other are what the region operations unite") {
    Random random(1);
    int found = 0, crossing = 0;
    for (int i = 0; i < 400; ++i) {
        Contours curves;
        for (int k = random.whole(1, 4); k > 0; --k) {
            const Point2 centre(random.within(-5, 5), random.within(-5, 5));
            const Contours region = random_region(random, centre, random.within(1, 5));
            curves.insert(curves.end(), region.begin(), region.end());
        }
        const RegionResult expected = cleaned(curves, 1e-6);
        REQUIRE(expected.unresolved == 0);
        const auto result = uncrossed_of(curves);
        if (!result) continue;
        ++found;
        crossing += expected.changed;
        CAPTURE(i);
        check_same_region(*result, expected.contours);
        for (const Contour& contour : *result) CHECK(is_closed(contour));
    }
    CHECK(found > 380);
    CHECK(crossing > 200);
}

TEST_CASE(
    "uncross: a contour that crosses nothing is returned as it was, one that winds the wrong way "
    "is not") {
    const Contours plate{rectangle(0, 0, 10, 8), FullCircle{{4, 4}, 1, false}};
    const auto same = uncrossed_of(plate);
    REQUIRE(same);
    REQUIRE(same->size() == 2);
    CHECK(std::get<FullCircle>((*same)[1]).radius_mm == 1);
    // An island in nothing, and a hole that has outgrown its part.
    CHECK(uncrossed_of({reversed(Contour(rectangle(0, 0, 1, 1)))})->empty());
    CHECK(uncrossed_of({FullCircle{{0, 0}, 4.4, true}, FullCircle{{0, 0}, 4.6, false}})->empty());
}

TEST_CASE("uncross: gives up where contours touch, share a side, or cross in a corner") {
    const Contours cases[] = {{FullCircle{{0, 0}, 1, true}, FullCircle{{2, 0}, 1, true}},
                              {rectangle(0, 0, 1, 1), rectangle(1, 0, 2, 1)},
                              {rectangle(0, 0, 2, 2), rectangle(1, 1, 3, 2)},
                              {rectangle(0, 0, 2, 2), Path{{1, 1}, {{{3, 3}}, {{0, 3}}, {{1, 1}}}}},
                              {rectangle(0, 0, 2, 2), rectangle(0.5, 1.99995, 1, 3)}};
    for (const Contours& curves : cases)
        for (int turn = 0; turn < 4; ++turn) {
            const Motion motion{0.9 * turn, {turn * 3.0, 1}, turn % 2 == 1};
            CHECK(!uncrossed_of(moved(curves, motion)));
        }
}

TEST_CASE(
    "offset curves: trimmed ones that are uncrossed are the offset, but where a hole is turned "
    "inside out, which the check finds") {
    Random random(3);
    int found = 0, turned = 0;
    for (int i = 0; i < 300; ++i) {
        const Contours region = random_region(random, {random.within(-50, 50), 7}, 10);
        const OffsetRequest request{.distance_mm = random.within(-1.5, 1.5),
                                    .allowed_mm = clear_mm,
                                    .corner = random.coin() ? Corner::round : Corner::mitre};
        const auto curves = trimmed_curves(region, request);
        if (!curves) continue;
        const auto result = uncrossed_of(*curves);
        if (!result) continue;
        ++found;
        CAPTURE(i);
        CAPTURE(request.distance_mm);
        if (fault_of(BoundedRegion(*result), BoundedRegion(region), request)) {
            ++turned;
            continue;
        }
        const RegionResult expected = cleaned(offset_curves(region, request), 1e-6);
        CHECK(std::abs(total_area(*result) - total_area(expected.contours)) <=
              1e-5 * total_length(region));
    }
    CHECK(found > 230);
    CHECK(turned < 5);
}
