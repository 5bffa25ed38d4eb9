// Seams of random and of telling contours.

#include "kernel/toolpath/seam.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"
#include "kernel/toolpath/offset.h"
#include "kernel/toolpath/sizes.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

// Round-off of coordinates up to some hundred millimetres.
constexpr double same_mm = 1e-9;

constexpr SeamChoice all_choices[] = {SeamChoice::nearest, SeamChoice::rear, SeamChoice::aligned,
                                      SeamChoice::sharp};

Seam seam_for(const Contour& contour, SeamChoice choice, const Point2& head = origin,
              std::span<const Point2> below = {}) {
    return seam_of(contour, {choice, width_mm, head, below});
}

// Starts at another of its segments.
Path rotated_by(const Path& path, std::size_t first) {
    return std::get<Path>(
        started_at(path, {first == 0 ? path.start : path.segments[first - 1].end, first, 0.0}));
}

double least_distance(const Contour& contour, const Point2& point) {
    return distance_to({contour}, point);
}

// A square with a notch in its right side; the notch's two inner corners are concave.
Path notched() {
    return {
        {0, 0},
        {{{20, 0}}, {{20, 8}}, {{15, 8}}, {{15, 12}}, {{20, 12}}, {{20, 20}}, {{0, 20}}, {{0, 0}}}};
}

Path polygon(int corners, double radius_mm, double turn_rad, const Point2& centre) {
    Path path{centre, {}};
    for (int i = 1; i <= corners; ++i) {
        const double angle = turn_rad + 2 * pi * i / corners;
        path.segments.push_back({centre + radius_mm * Vector2(std::cos(angle), std::sin(angle))});
    }
    path.start = path.segments.back().end;
    return path;
}

}  // namespace

TEST_CASE("seam 3: a contour started elsewhere has the same shape, and one segment more at most") {
    Random random(1);
    for (int i = 0; i < 300; ++i) {
        Contour contour = random_ring(random, {random.within(-50, 50), 3}, random.within(1, 30));
        if (random.coin()) contour = reversed(contour);
        const Path& path = std::get<Path>(contour);
        for (const SeamChoice choice : all_choices) {
            const Seam seam =
                seam_for(contour, choice, {random.within(-60, 60), random.within(-30, 30)});
            const Path started = std::get<Path>(started_at(contour, seam));
            CHECK(started.start == seam.point);
            CHECK(is_closed(started));
            CHECK(started.segments.size() <= path.segments.size() + 1);
            CHECK(area_mm2(Contour(started)) == doctest::Approx(area_mm2(contour)).epsilon(1e-12));
            CHECK(length_mm(Contour(started)) ==
                  doctest::Approx(length_mm(contour)).epsilon(1e-12));
            CHECK(least_distance(contour, seam.point) < same_mm);
            Point2 from = started.start;
            for (const Segment& segment : started.segments) {
                for (const double share : {0.3, 0.5, 0.9}) {
                    CHECK(least_distance(contour, point_at(from, segment, share)) < same_mm);
                }
                CHECK(length_mm(from, segment) > width_mm / 20);
                from = segment.end;
            }
        }
    }
}

TEST_CASE("seam 3: both parts of a split arc are on its circle, about the same centre") {
    const Path disc_part{{5, 0}, {arc_with_sweep({5, 0}, {0, -5}, 1.5 * pi), {{5, 0}}}};
    const Seam seam = seam_for(disc_part, SeamChoice::nearest, {-30, 3});
    CHECK(seam.segment == 0);
    const Path started = std::get<Path>(started_at(Contour(disc_part), seam));
    REQUIRE(started.segments.size() == 3);
    const auto first = circle_of(started.start, started.segments[0]);
    const auto last = circle_of(started.segments[1].end, started.segments[2]);
    REQUIRE((first && last));
    CHECK(first->centre.norm() < same_mm);
    CHECK(last->centre.norm() < same_mm);
    CHECK(first->radius_mm == doctest::Approx(5).epsilon(1e-12));
}

TEST_CASE("seam 3: the widths of a strand go with its segments") {
    Strand strand{notched(), 0, {1, 2, 3, 4, 5, 6, 7, 8}};
    const Strand whole = started_at(strand, {{15, 8}, 3, 0});
    CHECK(whole.widths_mm == std::vector<double>{4, 5, 6, 7, 8, 1, 2, 3});
    const Strand split = started_at(strand, {{15, 10}, 3, 0.5});
    CHECK(split.widths_mm == std::vector<double>{4, 5, 6, 7, 8, 1, 2, 3, 4});
    CHECK(std::get<Path>(split.path).segments.size() == split.widths_mm.size());
}

TEST_CASE("seam 1: it does not depend on where the contour started") {
    Random random(2);
    for (int i = 0; i < 100; ++i) {
        const Path path = random_ring(random, {1, 2}, random.within(1, 20));
        const std::vector<Point2> below{{random.within(-20, 20), random.within(-20, 20)},
                                        path.segments[2].end};
        const Point2 head(random.within(-30, 30), random.within(-30, 30));
        for (const SeamChoice choice : all_choices) {
            const Seam seam = seam_for(path, choice, head, below);
            for (std::size_t first = 0; first < path.segments.size(); first += 3) {
                const Seam other = seam_for(rotated_by(path, first), choice, head, below);
                CHECK((other.point - seam.point).norm() < same_mm);
            }
        }
    }
}

TEST_CASE("seam: what is turned, moved and mirrored has its seam turned, moved and mirrored") {
    Random random(3);
    for (int i = 0; i < 100; ++i) {
        const Contour contour = random_ring(random, {1, 2}, random.within(1, 20));
        const Motion motion{random.within(-3, 3), {random.within(-90, 90), 7}, random.coin()};
        const std::vector<Point2> below{std::get<Path>(contour).segments[3].end};
        const std::vector<Point2> moved_below{motion(below[0])};
        const Point2 head(random.within(-30, 30), random.within(-30, 30));
        for (const SeamChoice choice :
             {SeamChoice::nearest, SeamChoice::aligned, SeamChoice::sharp}) {
            const Seam seam = seam_for(contour, choice, head, below);
            const Seam other = seam_for(moved(contour, motion), choice, motion(head), moved_below);
            CHECK((other.point - motion(seam.point)).norm() < 1e-7);
        }
    }
}

TEST_CASE("seam 2: nearest is as near as any point, but for corners that are nearly as near") {
    Random random(4);
    for (int i = 0; i < 200; ++i) {
        const Path path = random_ring(random, {0, 0}, random.within(2, 20));
        const Point2 head(random.within(-30, 30), random.within(-30, 30));
        const double least = least_distance(path, head);
        const double away = (seam_for(path, SeamChoice::nearest, head).point - head).norm();
        CHECK(away >= least - same_mm);
        CHECK(away <= least + 2 * width_mm + same_mm);
    }
    const Path square = rectangle(0, 0, 10, 10);
    CHECK(seam_for(square, SeamChoice::nearest, {5, -3}).point == Point2(5, 0));
    CHECK(seam_for(square, SeamChoice::nearest, {0.6, -3}).point == Point2(0, 0));
}

TEST_CASE("seam 2: sharp is in a concave corner, of an outside and of a hole") {
    const Point2 upper(15, 12);
    CHECK(seam_for(notched(), SeamChoice::sharp).point == upper);
    const std::vector<Point2> below{{15, 8.2}};
    CHECK(seam_for(notched(), SeamChoice::sharp, origin, below).point == Point2(15, 8));
    // All corners of a square hole are concave; the rear one that is least in x is taken.
    CHECK(seam_for(reversed(rectangle(0, 0, 10, 10)), SeamChoice::sharp).point == Point2(0, 10));
    // Sharper than the square's corners.
    const Path kite{{0, 0}, {{{9, -3}}, {{30, 0}}, {{9, 3}}, {{0, 0}}}};
    CHECK(seam_for(kite, SeamChoice::sharp).point == Point2(30, 0));
}

TEST_CASE("seam 2: a concave corner that the offset rounded is still one") {
    const OffsetResult wall = offset(Contours{notched()}, {-width_mm / 2, 1e-4});
    REQUIRE(wall.contours.size() == 1);
    const Seam seam = seam_for(wall.contours[0], SeamChoice::sharp);
    CHECK((seam.point - Point2(15, 12)).norm() == doctest::Approx(width_mm / 2).epsilon(1e-3));
    // A fillet that one can see is a smooth wall.
    Path filleted = slot(0, 0, 20, 10);
    CHECK(seam_for(filleted, SeamChoice::sharp).point.y() == doctest::Approx(10));
}

TEST_CASE("seam 2: rear is the rearmost point; a corner nearly as far is preferred") {
    CHECK((seam_for(polygon(6, 10, 0, {3, 4}), SeamChoice::rear).point -
           Point2(-2, 4 + 10 * std::sin(pi / 3)))
              .norm() < same_mm);
    const Path disc_part{{5, 0}, {arc_with_sweep({5, 0}, {0, -5}, 1.5 * pi), {{5, 0}}}};
    CHECK((seam_for(disc_part, SeamChoice::rear).point - Point2(0, 5)).norm() < same_mm);
    Random random(5);
    for (int i = 0; i < 100; ++i) {
        const Path path = random_ring(random, {0, 0}, random.within(2, 20));
        const double top = region::box_of(Contour(path)).max().y();
        CHECK(seam_for(path, SeamChoice::rear).point.y() >= top - 2 * width_mm - same_mm);
    }
}

TEST_CASE("seam 2: a full circle starts towards the head, the seam below, or the rear") {
    const FullCircle circle{{10, 20}, 4, false};
    const std::vector<Point2> below{{10.1, 16.3}, {60, 20}};
    const auto at = [&](SeamChoice choice) {
        return seam_for(circle, choice, {30, 20}, below).point;
    };
    CHECK((at(SeamChoice::nearest) - Point2(14, 20)).norm() < same_mm);
    CHECK((at(SeamChoice::rear) - Point2(10, 24)).norm() < same_mm);
    CHECK((at(SeamChoice::aligned) - below[0]).norm() < 0.4);
    CHECK((at(SeamChoice::sharp) - below[0]).norm() < 0.4);
    CHECK((seam_for(circle, SeamChoice::aligned).point - Point2(10, 24)).norm() < same_mm);
    CHECK((seam_for(circle, SeamChoice::nearest, circle.centre).point - Point2(10, 24)).norm() <
          same_mm);
    CHECK(started_at(circle, seam_for(circle, SeamChoice::rear)) == Contour(circle));
}

TEST_CASE("seam 2: aligned stays at its corner while the wall twists and narrows") {
    std::vector<Point2> below;
    for (int layer = 0; layer < 100; ++layer) {
        const Path path = polygon(6, 20 - 0.1 * layer, 0.005 * layer, {0, 0});
        const Seam seam = seam_for(path, SeamChoice::aligned, origin, below);
        if (layer > 0) CHECK((seam.point - below[0]).norm() < 0.3);
        CHECK(seam.fraction == 0);
        below = {seam.point};
    }
}

TEST_CASE("seam 2: aligned on a cone with two holes keeps each contour's own seam") {
    std::vector<Point2> below;
    for (int layer = 0; layer < 50; ++layer) {
        const double slope = 0.1 * layer;
        const Contours contours{FullCircle{{0, 0}, 30 - slope, true},
                                FullCircle{{-10, 0}, 3 + slope / 2, false},
                                FullCircle{{10, 0}, 3 + slope / 2, false}};
        std::vector<Point2> seams;
        for (const Contour& contour : contours)
            seams.push_back(seam_for(contour, SeamChoice::aligned, origin, below).point);
        for (std::size_t i = 0; i < below.size(); ++i)
            CHECK((seams[i] - below[i]).norm() < 0.1 + same_mm);
        below = seams;
    }
}

TEST_CASE("seam: contours of no length and of one point have one") {
    for (const SeamChoice choice : all_choices) {
        const Path point{{1, 2}, {{{1, 2}}}};
        const Seam seam = seam_for(point, choice);
        CHECK(seam.point == Point2(1, 2));
        CHECK(is_closed(started_at(Contour(rectangle(0, 0, 0.01, 0.01)),
                                   seam_for(rectangle(0, 0, 0.01, 0.01), choice))));
    }
}
