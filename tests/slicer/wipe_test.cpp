// Contract of slicer/wipe.h, by number, and wipes in prints.

#include "slicer/wipe.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "format/arc.h"
#include "format/reader.h"
#include "kernel/contour/turned_round.h"
#include "scratch.h"
#include "slicer/slicer.h"

using namespace lyr;
using namespace lyr::slicer;

namespace {

using std::numbers::pi;

double distance_to(const Path& path, const Point2& point) {
    double nearest_mm = 1e9;
    Point2 from = path.start;
    for (const Segment& segment : path.segments) {
        nearest_mm = std::min(nearest_mm, distance_mm(from, segment, point));
        from = segment.end;
    }
    return nearest_mm;
}

// The wipe begins there, stays on what was printed and has the length.
void check_along(const Path& wipe, const Path& printed, const Point2& begin, double expected_mm) {
    CHECK((wipe.start - begin).norm() < 1e-9);
    CHECK(length_mm(Contour(wipe)) == doctest::Approx(expected_mm));
    Point2 from = wipe.start;
    for (const Segment& segment : wipe.segments) {
        for (const double share : {0.0, 0.3, 0.5, 0.8, 1.0})
            CHECK(distance_to(printed, point_at(from, segment, share)) < 1e-9);
        from = segment.end;
    }
}

// An arm with a bend, turned and mirrored.
Path arm(double angle_rad, bool mirrored) {
    const auto at = [&](double x, double y) {
        return Point2(Eigen::Rotation2Dd(angle_rad) * Point2(mirrored ? -x : x, y));
    };
    return {at(0, 0),
            {{at(10, 0), 0},
             {at(12, 2), (mirrored ? -1 : 1) * 2 * (1 - std::sqrt(0.5))},
             {at(12, 3), 0}}};
}

Path closed_arm(double angle_rad, bool mirrored) {
    Path path = arm(angle_rad, mirrored);
    path.segments.push_back({path.start, 0});
    return path;
}

}  // namespace

TEST_CASE("wipe 1, 2: back along what has ends, on along the beginning of what is closed") {
    for (const bool mirrored : {false, true})
        for (const double angle_rad : {0.0, 0.7, 3.0}) {
            const Path open = arm(angle_rad, mirrored), closed = closed_arm(angle_rad, mirrored);
            const double open_mm = 11 + pi;
            for (const double most_mm : {0.5, 2.0, 5.0, 12.0, 100.0}) {
                check_along(wipe_along(Strand{open, 0.4}, {}, most_mm), open,
                            open.segments.back().end, std::min(most_mm, open_mm));
                check_along(wipe_along(Strand{closed, 0.4}, {}, most_mm), closed, closed.start,
                            std::min(most_mm, open_mm + std::hypot(12, 3)));
            }
            const Path back = turned_round(open);
            check_along(wipe_along(Strand{back, 0.4}, {}, 3), open, open.start, 3);
        }
}

TEST_CASE("wipe 1, 2: round a full circle, the way it was printed, once at most") {
    const Point2 centre(3, -1);
    for (const bool counter_clockwise : {false, true})
        for (const double most_mm : {0.1, 5.0, 9.0, 100.0}) {
            const Point2 start = centre + 2 * Vector2(std::cos(1), std::sin(1));
            const Path wipe =
                wipe_along(Strand{FullCircle{centre, 2, counter_clockwise}, 0.4}, start, most_mm);
            CHECK(wipe.start == start);
            CHECK(length_mm(Contour(wipe)) == doctest::Approx(std::min(most_mm, 4 * pi)));
            Point2 from = wipe.start;
            for (const Segment& segment : wipe.segments) {
                const auto circle = circle_of(from, segment);
                REQUIRE(circle);
                CHECK((circle->centre - centre).norm() < 1e-9);
                CHECK((segment.sagitta_mm > 0) == counter_clockwise);
                from = segment.end;
            }
        }
}

TEST_CASE("wipe 1, 2: back along the rows of a hatch and their links, not over its travels") {
    HatchRun run{{std::cos(0.4), std::sin(0.4)}, 5, -0.5, {}};
    run.rows = {{0, 10, false}, {1, 9, true}, {0.5, 4, false}, {0, 8, true}};
    // The last row from 8 back to 0, the link, the row before it, then a travel.
    const double rows_mm = 8 + std::hypot(4, 0.5) + 3.5;
    for (const double most_mm : {1.0, 7.9, 9.0, 14.0, 50.0}) {
        const Path wipe = wipe_along(run, most_mm);
        CHECK((wipe.start - end_of(run)).norm() < 1e-9);
        CHECK(length_mm(Contour(wipe)) == doctest::Approx(std::min(most_mm, rows_mm)));
    }
    const Vector2 left(-run.direction.y(), run.direction.x());
    CHECK((wipe_along(run, 50).segments.back().end - (0.5 * run.direction + 4 * left)).norm() <
          1e-9);
    const HatchRun turned = lyr::reversed(run);
    CHECK((wipe_along(turned, 1).start - start_of(run)).norm() < 1e-9);
    CHECK(length_mm(Contour(wipe_along(turned, 100))) ==
          doctest::Approx(10 + 8 + std::hypot(1, 0.5)));
}

TEST_CASE(
    "wipe 3: what the way is too short for is drawn back before, and the share of the profile") {
    profile::Profile profile;
    profile.travel.retract_length_mm = 0.8;
    profile.travel.retract_speed_mm_s = 40;
    profile.speed.travel_mm_s = 100;
    const Path way{{0, 0}, {{{1, 0}, 0}}};  // 10 ms: 0.4 mm
    CHECK(depth_before_wipe_mm(way, profile) == doctest::Approx(0.4));
    profile.travel.retract_before_wipe = 0.25;
    CHECK(depth_before_wipe_mm(way, profile) == doctest::Approx(0.4));
    profile.travel.retract_before_wipe = 0.7;
    CHECK(depth_before_wipe_mm(way, profile) == doctest::Approx(0.56));
    profile.travel.retract_before_wipe = 0;
    CHECK(depth_before_wipe_mm({{0, 0}, {{{5, 0}, 0}}}, profile) <= 0);
}

TEST_CASE("wipe: pieces are moved, and arcs of more than half a turn come in two") {
    const Path way{{0, 0}, {{{1, 1}, 0}, arc_with_sweep({1, 1}, {3, 1}, 1.4 * pi)}};
    const auto pieces = wipe_pieces(way, {10, 20});
    REQUIRE(pieces.size() == 3);
    CHECK(pieces[0].x_mm == doctest::Approx(11));
    CHECK(pieces[2].x_mm == doctest::Approx(13));
    CHECK(pieces[2].y_mm == doctest::Approx(21));
    CHECK(pieces[1].sagitta_mm == doctest::Approx(pieces[2].sagitta_mm));
    const auto shape = format::arc_shape(pieces[0].x_mm, pieces[0].y_mm, pieces[1].x_mm,
                                         pieces[1].y_mm, pieces[1].sagitta_mm);
    CHECK(shape.sweep_rad == doctest::Approx(0.7 * pi));
}

namespace {

// A motion that extrudes, as a segment.
struct PrintedSegment {
    Point2 from;
    Segment segment;
};

Point2 mm_of(const format::Point& point) {
    return {static_cast<double>(point.x) * 1e-3, static_cast<double>(point.y) * 1e-3};
}

std::vector<PrintedSegment> printed_of(const format::Operation& operation) {
    if (const auto* line = std::get_if<format::Line>(&operation))
        return {{mm_of(line->from), {mm_of(line->to), 0}}};
    if (const auto* arc = std::get_if<format::Arc>(&operation))
        return {{mm_of(arc->from), {mm_of(arc->to), static_cast<double>(arc->sagitta) * 1e-3}}};
    if (const auto* circle = std::get_if<format::Circle>(&operation)) {
        const Point2 centre(static_cast<double>(circle->center_x) * 1e-3,
                            static_cast<double>(circle->center_y) * 1e-3);
        const Point2 from = mm_of(circle->from), across = 2 * centre - from;
        return {{from, arc_with_sweep(from, across, pi)},
                {across, arc_with_sweep(across, from, pi)}};
    }
    return {};
}

}  // namespace

TEST_CASE("wipe: in a print every retraction wipes along what was printed since the last one") {
    const std::string lyr = lyr::tests::scratch("wiped.lyr");
    Options options;
    options.profile.layer.height_mm = options.profile.layer.first_height_mm = 0.35;
    options.profile.adhesion.kind = profile::AdhesionKind::skirt;
    options.profile.travel.wipe_mm = 3;
    options.profile.travel.z_hop_mm = 0.2;
    Diagnostics diagnostics;
    auto model = load(std::string(LYR_FIXTURES) + "/parts/gearbox_base.step", options, diagnostics);
    REQUIRE(model);
    REQUIRE(print(
        std::move(*model), "gearbox_base.step", lyr, "", options,
        [](const char*, std::size_t, std::size_t) {}, diagnostics));
    CHECK(diagnostics.empty());
    auto reader = format::Reader::open(lyr);
    REQUIRE(reader);
    std::vector<PrintedSegment> printed;
    std::size_t wipes = 0, bent = 0, retractions = 0;
    double worst_mm = 0, depth_mm = 0;
    while (const format::Operation* operation = reader->read()) {
        for (const PrintedSegment& one : printed_of(*operation)) printed.push_back(one);
        if (const auto* retract = std::get_if<format::Retract>(operation)) {
            retractions += retract->depth_mm > 0 && depth_mm == 0;
            depth_mm = retract->depth_mm;
            if (depth_mm == 0) printed.clear();
        }
        const auto* wipe = std::get_if<format::Wipe>(operation);
        if (!wipe) continue;
        retractions += depth_mm == 0;
        depth_mm = wipe->depth_mm;
        ++wipes;
        bent += wipe->sagitta != 0;
        CHECK(wipe->left_mm < 3.01);
        double nearest_mm = 1e9;
        const Segment piece{mm_of(wipe->to), static_cast<double>(wipe->sagitta) * 1e-3};
        for (const PrintedSegment& one : printed)
            nearest_mm = std::min(nearest_mm, distance_mm(one.from, one.segment,
                                                          point_at(mm_of(wipe->from), piece, 0.5)));
        worst_mm = std::max(worst_mm, nearest_mm);
    }
    CHECK(retractions > 100);
    CHECK(wipes >= retractions);
    CHECK(bent > 10);
    // Rounding of ends to quanta.
    CHECK(worst_mm < 0.003);
}
