#include "kernel/toolpath/fitted_walls.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"
#include "kernel/toolpath/sizes.h"
#include "kernel/toolpath/walls.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

const double round_mm = height_mm * (1 - pi / 4);

// Without corners, where strands cover a little twice or not at all.
double filled_mm2(const Walls& made) {
    double area = total_area(made.gaps);
    for (const Strand& strand : made.strands) {
        const auto* path = std::get_if<Path>(&strand.path);
        if (!path || strand.widths_mm.empty()) {
            area += length_mm(strand.path) * (strand.width_mm - round_mm);
            continue;
        }
        REQUIRE(strand.widths_mm.size() == path->segments.size());
        Point2 from = path->start;
        for (std::size_t i = 0; i < path->segments.size(); ++i) {
            area += length_mm(from, path->segments[i]) * (strand.widths_mm[i] - round_mm);
            from = path->segments[i].end;
        }
    }
    return area;
}

}  // namespace

TEST_CASE("fitted walls 1, 2: a tube's walls are two circles about its centre that fill it") {
    for (int i = 0; i <= 12; ++i) {
        const double wall_mm = 0.77 + 0.015 * i;
        CAPTURE(wall_mm);
        const Contours tube{FullCircle{{3, 4}, 10, true}, FullCircle{{3, 4}, 10 - wall_mm, false}};
        const Walls made = walls(tube, wall_request(3));
        REQUIRE(made.strands.size() == 2);
        for (const Strand& strand : made.strands) {
            const auto* circle = std::get_if<FullCircle>(&strand.path);
            REQUIRE(circle);
            CHECK(circle->centre == Point2(3, 4));
            // The outer flanks are the outline.
            const double outline_mm = circle->counter_clockwise ? 10 : 10 - wall_mm;
            CHECK(std::abs(circle->radius_mm - outline_mm) ==
                  doctest::Approx(strand.width_mm / 2).epsilon(1e-6));
        }
        const double middle_mm = 2 * pi * (10 - wall_mm / 2);
        CHECK(filled_mm2(made) == doctest::Approx(middle_mm * (wall_mm - round_mm)).epsilon(0.001));
    }
}

TEST_CASE("fitted walls 1: ribs of 0.9 mm on a plate are full, and the plate's walls stay") {
    const Path shape{{0, 0},
                     {{{30, 0}},
                      {{30, 20}},
                      {{15.45, 20}},
                      {{15.45, 50}},
                      {{14.55, 50}},
                      {{14.55, 20}},
                      {{0, 20}},
                      {{0, 0}}}};
    for (int turn = 0; turn < 4; ++turn) {
        const Motion motion{turn * 0.9, {1, 2}, turn % 2 == 1};
        const Walls made = walls(lyr::testing::moved(Contours{shape}, motion), wall_request(2));
        REQUIRE(made.strands.size() == 2);
        const Strand& wall = made.strands[0];
        CHECK(is_closed(wall));
        REQUIRE(!wall.widths_mm.empty());
        double wide_mm = 0, all_mm = 0;
        const Path& path = std::get<Path>(wall.path);
        Point2 from = path.start;
        for (std::size_t i = 0; i < path.segments.size(); ++i) {
            const double length = length_mm(from, path.segments[i]);
            if (wall.widths_mm[i] > width_mm) wide_mm += length;
            all_mm += length;
            from = path.segments[i].end;
            CHECK(wall.widths_mm[i] <= width_mm + 0.05 + 1e-9);
        }
        CHECK(wide_mm == doctest::Approx(2 * 30).epsilon(0.03));
        CHECK(all_mm == doctest::Approx(100 + 60).epsilon(0.02));
    }
}

TEST_CASE("fitted walls 3: of walls that nothing is beside no bit changes") {
    const Contours plate{rectangle(0, 0, 40, 30), FullCircle{{20, 15}, 5, false}};
    std::vector<Strand> strands;
    for (const Contour& contour : plate) strands.push_back({contour, width_mm});
    std::vector<Strand> fitted = strands;
    fit_side_by_side(fitted, {.spacing_mm = 0.4, .least_mm = 0.3, .greatest_mm = 0.5});
    REQUIRE(fitted.size() == 2);
    const Path &before = std::get<Path>(strands[0].path), &after = std::get<Path>(fitted[0].path);
    REQUIRE(after.segments.size() == before.segments.size());
    for (std::size_t i = 0; i < before.segments.size(); ++i)
        CHECK(after.segments[i].end == before.segments[i].end);
    CHECK(fitted[0].widths_mm.empty());
    CHECK(std::get<FullCircle>(fitted[1].path).radius_mm == 5);
}

TEST_CASE("walls: a strip within the walls that no line of the fill fits into stayed empty") {
    for (const double strip_mm : {0.12, 0.2, 0.26, 0.35}) {
        CAPTURE(strip_mm);
        const double spacing_mm = width_mm - round_mm;
        const double rib_mm = width_mm + spacing_mm + strip_mm;
        const Walls made = walls(Contours{rectangle(0, 0, 30, rib_mm)}, wall_request(1));
        CHECK(made.inside.empty());
        CHECK(total_area(made.gaps) == doctest::Approx(strip_mm * 29).epsilon(0.03));
    }
}
