// Runs of hatches, by what must hold for all of them.

#include "kernel/toolpath/hatch_runs.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"
#include "kernel/toolpath/fills.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

constexpr LinkLimits limits{.stray_mm = 0.02, .longest_link_mm = 6, .shortest_mm = 0};

struct Filled {
    Rows rows;
    std::vector<HatchRun> runs;
};

Filled fill(const Contours& region, double angle_rad, double pitch_mm) {
    const auto boundary = boundary_pieces(region);
    Filled filled{rows_across(boundary, {.angle_rad = angle_rad, .pitch_mm = pitch_mm}), {}};
    filled.runs = hatch_runs(filled.rows, limits);
    return filled;
}

std::size_t links(const std::vector<HatchRun>& runs) {
    std::size_t count = 0;
    for (const HatchRun& run : runs) {
        for (const HatchRow& row : run.rows) count += row.linked;
    }
    return count;
}

std::size_t row_count(const std::vector<HatchRun>& runs) {
    std::size_t count = 0;
    for (const HatchRun& run : runs) count += run.rows.size();
    return count;
}

// How far a straight line leaves the region.
double line_stray_mm(const Contours& region, const Point2& from, const Point2& to) {
    double stray = 0;
    for (int i = 1; i < 40; ++i) {
        const Point2 at = from + i / 40.0 * (to - from);
        if (winding(region, at) <= 0) stray = std::max(stray, distance_to(region, at));
    }
    return stray;
}

void check_runs(const Contours& region, const Filled& filled) {
    double rows_mm = 0, runs_mm = 0;
    for (const RowSpan& span : filled.rows.spans) rows_mm += span.end.x_mm - span.start.x_mm;
    for (const HatchRun& run : filled.runs) {
        CHECK(!run.rows.empty());
        CHECK(!run.rows.front().linked);
        for (std::size_t i = 0; i < run.rows.size(); ++i) {
            CHECK(run.rows[i].end_mm > run.rows[i].start_mm);
            runs_mm += run.rows[i].end_mm - run.rows[i].start_mm;
            CHECK(distance_to(region, row_end(run, i, false)) < 1e-9);
            CHECK(distance_to(region, row_end(run, i, true)) < 1e-9);
            if (!run.rows[i].linked) continue;
            const Point2 from = row_end(run, i - 1, true), to = row_end(run, i, false);
            CHECK((to - from).norm() <= limits.longest_link_mm);
            CHECK(line_stray_mm(region, from, to) <= limits.stray_mm);
        }
    }
    CHECK(row_count(filled.runs) == filled.rows.spans.size());
    CHECK(runs_mm == doctest::Approx(rows_mm));
}

}  // namespace

TEST_CASE("hatch_runs 1, 3: every interval is in one run, links stay in the region") {
    Random random(3);
    for (int i = 0; i < 60; ++i) {
        CAPTURE(i);
        const Contours region =
            random_region(random, {random.within(-50, 50), random.within(-50, 50)}, 12);
        check_runs(region, fill(region, random.within(-4, 4), random.within(0.3, 1.5)));
    }
}

TEST_CASE("hatch_runs 2: a convex region is one run in which every row is linked") {
    const Contours square{rectangle(-20, -20, 20, 20)};
    const Contours circle{FullCircle{{3, 1}, 25, true}};
    const Contours rounded{slot(-30, -5, 10, 5)};
    for (const Contours& region : {square, circle, rounded}) {
        for (double angle = 0.02; angle < 2 * pi; angle += 0.41) {
            const Filled filled = fill(region, angle, 0.4);
            CAPTURE(angle);
            CHECK(filled.runs.size() == 1);
            // Where rows are nearly parallel to the boundary, links would be too long.
            CHECK(links(filled.runs) + 5 > filled.rows.count());
        }
    }
    CHECK(links(fill(square, pi / 4, 0.4).runs) + 1 == fill(square, pi / 4, 0.4).rows.count());
}

TEST_CASE("hatch_runs 2: around a hole there are two runs") {
    const Contours region{rectangle(-20, -20, 20, 20), FullCircle{{1, 2}, 6, false}};
    for (const double angle : {0.3, pi / 4, 2.0, 3 * pi / 4}) {
        const Filled filled = fill(region, angle, 0.4);
        CHECK(filled.runs.size() <= 3);
        check_runs(region, filled);
    }
}

TEST_CASE("hatch_runs 3: no link goes through a hole that lies between two rows") {
    // Rows at 0.5, 1.5, ...; the holes lie on the links between the first two, at either end.
    const Filled open = fill({slot(0, 0, 10, 6)}, 0, 1);
    REQUIRE(open.runs.size() == 1);
    REQUIRE(links(open.runs) == 5);
    const Contours region{slot(0, 0, 10, 6), FullCircle{{12.13, 1}, 0.08, false},
                          FullCircle{{-2.13, 1}, 0.08, false}};
    const Filled filled = fill(region, 0, 1);
    check_runs(region, filled);
    CHECK(links(filled.runs) == 4);
}

TEST_CASE("hatch_runs 3: no link goes through an opposite wall that bulges between two rows") {
    // The hole touches the rounded end from inside, halfway between two rows.
    for (const double gap : {1e-3, 0.05, 0.2}) {
        const Contours region{FullCircle{{0, 0}, 1, true}, FullCircle{{-0.5 + gap, 0}, 0.5, false}};
        for (int i = 0; i < 12; ++i) {
            const Contours turned = moved(region, {.angle_rad = i * pi / 6 + 0.01});
            for (const double pitch : {0.2, 0.5, 0.7}) check_runs(turned, fill(turned, 0, pitch));
        }
    }
}

TEST_CASE(
    "hatch_runs 3: no link goes through a half circle between two rows, whose centre is on the "
    "link") {
    for (const bool mirrored : {false, true}) {
        for (int quarter = 0; quarter < 4; ++quarter) {
            const Motion motion{.angle_rad = quarter * pi / 2, .mirrored = mirrored};
            Path path{{0, 0}, {{{4, 0}}}};
            path.segments.push_back({{4, 1}});
            path.segments.push_back(arc_with_sweep({4, 1}, {4, 1.5}, -pi));
            path.segments.push_back({{4, 4}});
            path.segments.push_back({{0, 4}});
            path.segments.push_back({{0, 0}});
            const Contours region{moved(Contour(path), motion)};
            for (const double pitch : {0.5, 1.0}) {
                check_runs(region, fill(region, quarter * pi / 2, pitch));
                check_runs(region, fill(region, 0, pitch));
            }
        }
    }
}

TEST_CASE("hatch_runs: a run that is reversed is the same rows and links the other way round") {
    const Contours region{rectangle(-20, -20, 20, 20), FullCircle{{1, 2}, 6, false}};
    for (const double pitch : {0.4, 0.41, 0.9}) {
        for (const HatchRun& run : fill(region, 0.7, pitch).runs) {
            const HatchRun back = reversed(run);
            REQUIRE(back.rows.size() == run.rows.size());
            CHECK((start_of(back) - end_of(run)).norm() < 1e-9);
            CHECK((end_of(back) - start_of(run)).norm() < 1e-9);
            for (std::size_t i = 0; i < run.rows.size(); ++i) {
                const std::size_t j = run.rows.size() - 1 - i;
                CHECK((row_end(run, i, true) - row_end(back, j, false)).norm() < 1e-9);
                CHECK((row_end(run, i, false) - row_end(back, j, true)).norm() < 1e-9);
                if (i > 0) CHECK(run.rows[i].linked == back.rows[j + 1].linked);
            }
        }
    }
}

TEST_CASE("hatch_runs: nothing of nothing") {
    CHECK(fill({}, 0.3, 0.4).runs.empty());
}
