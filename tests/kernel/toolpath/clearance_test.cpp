#include "kernel/toolpath/clearance.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"
#include "kernel/toolpath/offset.h"
#include "kernel/toolpath/strip_area.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

double narrow(const Contours& region, double width_mm, double mitre_limit = 0) {
    return narrow_mm2(Boundary(region), width_mm, mitre_limit);
}

// Two plates with a bridge between them.
Contours bridged(double wide_mm, double long_mm) {
    const double half = wide_mm / 2, x = 5 + long_mm;
    return {Path{{0, -3},
                 {{{5, -3}},
                  {{5, -half}},
                  {{x, -half}},
                  {{x, -3}},
                  {{x + 5, -3}},
                  {{x + 5, 3}},
                  {{x, 3}},
                  {{x, half}},
                  {{5, half}},
                  {{5, 3}},
                  {{0, 3}},
                  {{0, -3}}}}};
}

}  // namespace

TEST_CASE("clearance: a bridge is narrow if the disc is wider, by about its area") {
    for (int turn = 0; turn < 4; ++turn) {
        const Motion motion{0.8 * turn, {3, -turn * 2.0}, turn % 2 == 1};
        CHECK(narrow(moved(bridged(1, 4), motion), 0.99) == 0);
        const double lost = narrow(moved(bridged(1, 4), motion), 1.1);
        CHECK(lost > 2);
        CHECK(lost < 5);
        // What discs from both ends reach is not lost, but for little.
        CHECK(narrow(moved(bridged(1, 0.8), motion), 1.1) < 0.15);
    }
}

// Two plates with a waist between them, bounded by arcs of a radius.
Contours waisted(double wide_mm, double radius_mm) {
    const double reach = 2, rise = radius_mm - std::sqrt(radius_mm * radius_mm - reach * reach);
    const double half = wide_mm / 2 + rise;
    return {Path{{-6, -4},
                 {{{-reach, -4}},
                  {{-reach, -half}},
                  {{reach, -half}, -rise},
                  {{reach, -4}},
                  {{6, -4}},
                  {{6, 4}},
                  {{reach, 4}},
                  {{reach, half}},
                  {{-reach, half}, -rise},
                  {{-reach, 4}},
                  {{-6, 4}},
                  {{-6, -4}}}}};
}

TEST_CASE("clearance: in a waist, mitred tips reach nearly all that discs do not") {
    for (int turn = 0; turn < 4; ++turn) {
        const Motion motion{0.8 * turn, {3, -turn * 2.0}, turn % 2 == 1};
        const Contours region = moved(waisted(0.9, 2.5), motion);
        CHECK(narrow(region, 0.89, 5) == 0);
        const double discs = narrow(region, 1.1), mitred = narrow(region, 1.1, 5);
        CHECK(mitred > 0);
        CHECK(mitred < discs / 2);
        // What an opening with mitres leaves out is estimated from above, but for little.
        const OffsetRequest in{-0.55, 1e-4, Corner::mitre, 5}, out{0.55, 1e-4, Corner::mitre, 5};
        const double left = total_area(offset(offset(region, in).contours, out).contours);
        CHECK(total_area(region) - left < mitred + 0.02);
    }
}

TEST_CASE("clearance: corners are not narrow, needles are") {
    CHECK(narrow({rectangle(0, 0, 10, 10)}, 3) == 0);
    CHECK(narrow({FullCircle{{0, 0}, 1, true}}, 3) == 0);
    CHECK(narrow({Path{{0, 0}, {{{10, 0}}, {{10, 6}}, {{0, 0}}}}}, 1) == 0);
    CHECK(narrow({Path{{0, 0}, {{{10, 0}}, {{10, 1}}, {{0, 0}}}}}, 1) > 1);
}

TEST_CASE("clearance: a wall between hole and edge is narrow on both sides of it") {
    const Contours plate{FullCircle{{0, 0}, 10, true}, FullCircle{{0, 0}, 9.5, false}};
    CHECK(narrow(plate, 0.49) == 0);
    CHECK(narrow(plate, 0.6) == doctest::Approx(19.5 * pi * 2 * 0.3).epsilon(0.05));
}

TEST_CASE("strips: where none overlap they are what an offset adds or takes away") {
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        const Contours region = random_region(random, {3, random.within(-20, 20)}, 10);
        const Boundary boundary(region);
        const double area = total_area(region);
        for (const double distance : {-0.2, -0.05, 0.05, 0.2}) {
            CAPTURE(i);
            CAPTURE(distance);
            for (const Corner corner : {Corner::round, Corner::mitre}) {
                const double mitred = corner == Corner::mitre ? 5 * std::abs(distance) : 0;
                const double strip = strip_mm2(boundary, distance, mitred);
                const Contours result = offset(region, {distance, 1e-5, corner, 5}).contours;
                const double change = std::abs(total_area(result) - area);
                // At corners the offset does not go round, strips overlap by a kite each.
                CHECK(change <= strip + 1e-3);
                CHECK(change >= strip - 40 * distance * distance);
            }
        }
    }
    const Contours square{rectangle(0, 0, 10, 10)};
    CHECK(strip_mm2(Boundary(square), 1, 0) == doctest::Approx(40 + pi));
    CHECK(strip_mm2(Boundary(square), 1, 2) == doctest::Approx(44));
    CHECK(strip_mm2(Boundary(square), -1, 2) == doctest::Approx(40));
    CHECK(strip_mm2(Boundary(Contours{FullCircle{{0, 0}, 3, true}}), -1, 0) ==
          doctest::Approx(5 * pi));
    CHECK(strip_mm2(Boundary(Contours{FullCircle{{0, 0}, 3, true}}), -4, 0) ==
          doctest::Approx(9 * pi));
}
