// What straight ways cross, beside windings counted by angles.

#include "kernel/toolpath/boundary.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

// The windings at the middles between crossings are those that the crossings say.
void check_crossings(const Contours& region, const Point2& from, const Point2& to) {
    const Boundary boundary(region);
    std::vector<BoundaryCrossing> crossings;
    boundary.crossings(from, to, crossings);
    const Vector2 along = (to - from).normalized();
    int inside = winding(region, from);
    double at = 0;
    for (const BoundaryCrossing& crossing : crossings) {
        CHECK(crossing.along_mm >= at);
        CHECK(distance_to(region, from + crossing.along_mm * along) < 1e-8);
        // Where two lie side by side, an angle does not tell what is between them.
        if (crossing.along_mm > at + 1e-6)
            CHECK(winding(region, from + (at + crossing.along_mm) / 2 * along) == inside);
        inside += crossing.leaves ? -1 : 1;
        at = crossing.along_mm;
    }
    CHECK(winding(region, to) == inside);
}

}  // namespace

TEST_CASE("boundary 3: crossings of random ways agree with windings counted by angles") {
    Random random(1);
    for (int i = 0; i < 300; ++i) {
        const double size = std::pow(10.0, random.within(-0.5, 2));
        const Contours region = random_region(random, {random.within(-100, 100), 3}, size);
        const Eigen::AlignedBox2d box = box_of(region);
        const auto point = [&] {
            return Point2(random.within(box.min().x() - 1, box.max().x() + 1),
                          random.within(box.min().y() - 1, box.max().y() + 1));
        };
        for (int k = 0; k < 10; ++k) check_crossings(region, point(), point());
    }
}

TEST_CASE(
    "boundary 3: wide arcs, and ways through corners and along edges, cross as often in as out") {
    const Path keyhole{
        {3, -4}, {arc_with_sweep({3, -4}, {-3, -4}, 1.6 * pi), {{-3, -12}}, {{3, -12}}, {{3, -4}}}};
    const Contours region{keyhole, FullCircle{{0, -1}, 1, false}};
    std::vector<BoundaryCrossing> crossings;
    const Boundary boundary(region);
    Random random(2);
    for (int i = 0; i < 500; ++i) {
        const double angle = random.within(0, 2 * pi);
        const Vector2 away = 60 * Vector2(std::cos(angle), std::sin(angle));
        const Point2 through = i % 2 == 0 ? Point2(3, -4) : Point2(random.within(-5, 5), -4);
        boundary.crossings(through - away, through + away, crossings);
        int sum = 0;
        for (const BoundaryCrossing& crossing : crossings) {
            sum += crossing.leaves ? -1 : 1;
            CHECK(sum >= 0);
        }
        CHECK(sum == 0);
        check_crossings(region, {random.within(-8, 8), 9}, {random.within(-8, 8), -14});
    }
    boundary.crossings({-20, -12}, {20, -12}, crossings);
    CHECK(crossings.size() % 2 == 0);
}

TEST_CASE("boundary 2: the nearest piece is as near as the boundary is") {
    Random random(3);
    const Contours region = random_region(random, {0, 0}, 20);
    const Boundary boundary(region);
    for (int i = 0; i < 300; ++i) {
        const Point2 point(random.within(-25, 25), random.within(-25, 25));
        const double distance = distance_to(region, point);
        const auto nearest = boundary.nearest(point, 3);
        CHECK(nearest.has_value() == (distance <= 3));
        if (nearest)
            CHECK(boundary.pieces()[*nearest].distance_mm(point) == doctest::Approx(distance));
    }
}

TEST_CASE("boundary 1: arcs that begin or end at their circle's lowest point count at its height") {
    Random random(4);
    for (int i = 0; i < 500; ++i) {
        const double radius = random.within(0.1, 20), sweep = random.within(1.8, 3.1);
        const Point2 bottom(random.within(-50, 50), random.within(-50, 50));
        const Point2 centre = bottom + Vector2(0, radius);
        const double end_angle = sweep - pi / 2;
        const Point2 end = centre + radius * Vector2(std::cos(end_angle), std::sin(end_angle));
        // From the bottom up on the right, to the left, and straight down and back.
        const Point2 left(bottom.x() - 2 * radius, end.y()), corner(left.x(), bottom.y() - radius);
        const Path path{bottom,
                        {arc_with_sweep(bottom, end, sweep),
                         {left},
                         {corner},
                         {{bottom.x(), corner.y()}},
                         {bottom}}};
        for (const bool mirrored : {false, true}) {
            const Motion motion{.angle_rad = 0, .shift = {0.3, 0.1}, .mirrored = mirrored};
            const Boundary boundary(Contours{moved(Contour(path), motion)});
            CHECK(boundary.winding(motion(bottom - Vector2(radius, 0))) == 1);
            CHECK(boundary.winding(motion(bottom + Vector2(radius, 0))) == 0);
        }
    }
}
