#include "kernel/toolpath/walls.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"
#include "kernel/toolpath/sizes.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

const double spacing_mm = width_mm - height_mm * (1 - pi / 4);

FullCircle circle(double x, double y, double radius_mm, bool hole = false) {
    return {{x, y}, radius_mm, !hole};
}

// What walls and their narrow parts stand for: each wall a band of the spacing beside its middle, the outermost to its
// outer flank.
double accounted_mm2(const Walls& made) {
    double area = total_area(made.inside) + total_area(made.thin) + total_area(made.gaps);
    for (std::size_t i = 0; i < made.strands.size(); ++i)
        area += length_mm(made.strands[i].path) *
                (made.depths[i] == 0 ? (width_mm + spacing_mm) / 2 : spacing_mm);
    return area + made.left_out_mm2;
}

}  // namespace

TEST_CASE(
    "walls 1: a hole of 10 mm measures 10 mm between its wall's flanks, and all walls are about "
    "its centre") {
    const Contours plate{rectangle(0, 0, 40, 30), circle(20, 15, 5, true)};
    const Walls made = walls(plate, wall_request(3));
    REQUIRE(made.strands.size() == 6);
    CHECK(made.thin.empty());
    CHECK(made.gaps.empty());
    CHECK(made.unresolved == 0);
    std::size_t circles = 0;
    for (std::size_t i = 0; i < made.strands.size(); ++i) {
        const auto* round = std::get_if<FullCircle>(&made.strands[i].path);
        if (!round) continue;
        ++circles;
        CHECK(round->centre == Point2(20, 15));
        CHECK(!round->counter_clockwise);
        CHECK(round->radius_mm ==
              doctest::Approx(5 + width_mm / 2 + made.depths[i] * spacing_mm).epsilon(1e-12));
    }
    CHECK(circles == 3);
    CHECK(total_area(made.inside) ==
          doctest::Approx((40 - 2 * (width_mm / 2 + 2.5 * spacing_mm)) *
                              (30 - 2 * (width_mm / 2 + 2.5 * spacing_mm)) -
                          pi * std::pow(5 + width_mm / 2 + 2.5 * spacing_mm, 2)));
}

TEST_CASE(
    "walls 2: where a rib is too thin for two lines there is no wall, and where it is too thin for "
    "four a gap") {
    for (const auto& [rib_mm, thin, gap] : {std::tuple(0.5, true, false),
                                            {0.7, true, false},
                                            {0.85, false, false},
                                            {1.3, false, true},
                                            {1.5, false, true},
                                            {1.75, false, false}}) {
        CAPTURE(rib_mm);
        const Walls made = walls(Contours{rectangle(0, 0, 30, rib_mm)}, wall_request(2));
        CHECK(made.thin.empty() == !thin);
        CHECK(made.gaps.empty() == !gap);
        CHECK(made.strands.empty() == thin);
        CHECK(made.unresolved == 0);
        if (thin) CHECK(total_area(made.thin) == doctest::Approx(30 * rib_mm).epsilon(0.002));
    }
}

TEST_CASE(
    "walls 2: a rib is left out below the least width, and not at it, and gaps have their own") {
    const auto made_of = [](double rib_mm) {
        return walls(Contours{rectangle(0, 0, 30, rib_mm)}, wall_request(2));
    };
    for (const double rib_mm : {0.2, 0.21}) {
        CHECK(total_area(made_of(rib_mm).thin) == doctest::Approx(30 * rib_mm).epsilon(0.002));
        CHECK(made_of(rib_mm).too_thin_mm2 < 0.02);
    }
    CHECK(made_of(0.19).thin.empty());
    CHECK(made_of(0.19).too_thin_mm2 == doctest::Approx(30 * 0.19).epsilon(0.01));
    // Between the walls of a rib of 1 mm there is less than 0.2 mm.
    const double gap_mm = 1 - width_mm - spacing_mm;
    CHECK(total_area(made_of(1).gaps) == doctest::Approx(29 * gap_mm).epsilon(0.02));
    const Walls close = made_of(width_mm + spacing_mm + 0.09);
    CHECK(close.gaps.empty());
    CHECK(close.left_out_mm2 > 1);
    CHECK(close.too_thin_mm2 < 0.02);
}

TEST_CASE(
    "walls 2: what shrinks to a point is thin if no wall fits, however many there are of it") {
    for (const double size_mm : {0.25, 0.3, 0.4, 0.44, 0.46, 0.6, 0.7})
        for (const int count : {1, 2, 3, 7})
            for (const bool on_plate : {false, true}) {
                CAPTURE(size_mm);
                CAPTURE(count);
                Contours region;
                for (int i = 0; i < count; ++i)
                    region.push_back(i % 2 == 0
                                         ? Contour(rectangle(2 * i, 0, 2 * i + size_mm, size_mm))
                                         : Contour(circle(2 * i, 0, size_mm / 2)));
                if (on_plate) region.push_back(rectangle(0, 10, 20, 30));
                const double area = total_area(Contours(region.begin(), region.begin() + count));
                const Walls made = walls(region, wall_request(2));
                CHECK(made.strands.size() == (on_plate ? 2 : 0));
                CHECK(total_area(made.thin) + made.left_out_mm2 ==
                      doctest::Approx(area).epsilon(0.01));
                CHECK(made.left_out_mm2 < 0.05 * area);
            }
}

TEST_CASE(
    "walls 2: a tip that is too sharp for walls is thin up to the least width, with gaps behind") {
    for (const double rise_mm : {3.0, 6.0, 12.0})
        for (int turn = 0; turn < 3; ++turn) {
            CAPTURE(rise_mm);
            const Motion motion{turn * 0.9, {1, 2}, turn == 1};
            const Contours upright{Path{{0, 0}, {{{40, 0}}, {{40, rise_mm}}, {{0, 0}}}}};
            const Contours wedge = lyr::testing::moved(upright, motion);
            const Walls made = walls(wedge, wall_request(3));
            CHECK(made.unresolved == 0);
            CHECK(accounted_mm2(made) == doctest::Approx(total_area(wedge)).epsilon(0.02));
            // The tip from where it is 0.2 mm wide to where a wall begins; how much of that is left out besides, corners.
            const double slope = rise_mm / 40;
            CHECK(total_area(made.thin) > 0.5 * (0.45 * 0.45 - 0.2 * 0.2) / slope / 2);
            CHECK(made.too_thin_mm2 < 1.5 * 0.2 * 0.2 / slope / 2);
            if (rise_mm < 5) CHECK(!made.gaps.empty());
        }
}

TEST_CASE("walls 2: a thin rib on a plate leaves the plate's walls as they are") {
    const Path shape{{0, 0},
                     {{{30, 0}},
                      {{30, 20}},
                      {{15.3, 20}},
                      {{15.3, 35}},
                      {{14.7, 35}},
                      {{14.7, 20}},
                      {{0, 20}},
                      {{0, 0}}}};
    const Walls made = walls(Contours{shape}, wall_request(3));
    REQUIRE(made.strands.size() == 3);
    CHECK(total_area(made.thin) == doctest::Approx(15 * 0.6).epsilon(0.03));
    for (std::size_t i = 0; i < 3; ++i) {
        const double inset = width_mm / 2 + static_cast<double>(i) * spacing_mm;
        const double around = 2 * (30 - 2 * inset) + 2 * (20 - 2 * inset);
        CHECK(length_mm(made.strands[i].path) == doctest::Approx(around).epsilon(0.01));
    }
}

TEST_CASE("walls: their bands, the narrow parts and the inside are the region") {
    for (std::uint32_t count = 0; count <= 4; ++count) {
        for (int turn = 0; turn < 5; ++turn) {
            const Motion motion{turn * 0.7, {3.0 * turn, -2.0 * turn}, turn % 2 == 1};
            CAPTURE(count);
            CAPTURE(turn);
            const Contours shapes[] = {
                {slot(0, 0, 30, 8), circle(8, 4, 2, true), circle(20, 4, 3.2, true)},
                {rectangle(0, 0, 30, 20), reversed(Contour(rectangle(1.2, 1.2, 20, 18)))},
                {Path{{0, 0}, {{{20, 0}}, {{0, 5}}, {{0, 0}}}}},
                {circle(0, 0, 10), circle(1.0, 0, 8.5, true)}};
            for (const Contours& shape : shapes) {
                const Contours region = lyr::testing::moved(shape, motion);
                const Walls made = walls(region, wall_request(count));
                CHECK(made.unresolved == 0);
                CHECK(made.strands.size() == made.depths.size());
                for (const Strand& strand : made.strands) CHECK(is_closed(strand));
                const double area = total_area(region);
                CHECK(accounted_mm2(made) == doctest::Approx(area).epsilon(0.02));
            }
        }
    }
}

TEST_CASE(
    "walls 4: no walls leave everything inside, and a region in which nothing fits is left out") {
    const Contours plate{rectangle(0, 0, 40, 30)};
    CHECK(total_area(walls(plate, wall_request(0)).inside) == 1200);
    const Walls none = walls(Contours{rectangle(0, 0, 40, 0.15)}, wall_request(2));
    CHECK(none.strands.empty());
    CHECK(none.thin.empty());
    CHECK(none.left_out_mm2 == doctest::Approx(6).epsilon(0.01));
    CHECK(walls(Contours{}, wall_request(2)).strands.empty());
}
