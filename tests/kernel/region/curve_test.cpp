#include "kernel/region/curve.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"

using namespace lyr;
using namespace lyr::region;
using namespace lyr::testing;

namespace {

// Lines and arcs of all sizes, from flat to almost full.
Segment random_segment(Random& random, const Point2& start) {
    const double chord = std::pow(10.0, random.within(-3, 2)), angle = random.within(-pi, pi);
    const Point2 end = start + chord * Vector2(std::cos(angle), std::sin(angle));
    const int kind = random.whole(0, 3);
    if (kind == 0) return {end, 0};
    const double sweep =
        kind == 1 ? random.within(-1e-6, 1e-6) : random.within(-1.9 * pi, 1.9 * pi);
    return arc_with_sweep(start, end, sweep);
}

}  // namespace

TEST_CASE("curve 1: points, feet and distances agree with the segment's") {
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        const Point2 start(random.within(-100, 100), random.within(-100, 100));
        const Segment segment = random_segment(random, start);
        const Curve curve = curve_of(start, segment);
        const double length = length_mm(start, segment), bound = 1e-12 * (100 + length);
        for (const double share : {0.0, 0.2, 0.5, 0.7, 1.0}) {
            const double along = (2 * share - 1) * curve.half_mm;
            const Point2 point = point_on(curve, along);
            CHECK((point - point_at(start, segment, share)).norm() < bound);
            const Point2 beside = point + 1e-3 * std::min(1.0, length) * Vector2(0.6, 0.8);
            CHECK(std::abs(across_mm(curve, beside) - offset_mm(start, segment, beside)) < bound);
            if (std::abs(sweep_rad(start, segment)) < 1.8 * pi) {
                CHECK(std::abs(along_mm(curve, point) - along) < bound);
                CHECK((tangent_beside(curve, beside) - tangent_at(curve, along_mm(curve, beside)))
                          .norm() < 1e-11);
            }
        }
    }
}

TEST_CASE("curve 2: a contour is cut into curves that only rise or only fall, end to end") {
    Random random(2);
    for (int i = 0; i < 300; ++i) {
        for (const Contour& contour : random_region(random, {3, 4}, 10)) {
            std::vector<Curve> curves;
            for_monotone_curves(contour, [&](const Curve& c, std::size_t) { curves.push_back(c); });
            double length = 0;
            for (std::size_t c = 0; c < curves.size(); ++c) {
                const Curve& curve = curves[c];
                CHECK(curve.end == curves[(c + 1) % curves.size()].start);
                length += 2 * curve.half_mm;
                const double up = curve.end.y() > curve.start.y() ? 1 : -1;
                double before = up * curve.start.y();
                for (int s = 1; s <= 20; ++s) {
                    const Point2 point = point_on(curve, (s / 10.0 - 1) * curve.half_mm);
                    CHECK(up * point.y() > before - 1e-12);
                    before = up * point.y();
                    CHECK(box_of(curve).exteriorDistance(point) < 1e-12);
                    CHECK(bounds_of(curve).exteriorDistance(point) < 1e-12);
                    CHECK(box_of(contour).exteriorDistance(point) < 1e-12);
                }
            }
            CHECK(length == doctest::Approx(length_mm(contour)));
        }
    }
}

TEST_CASE("curve 3: where two curves meet, both pass") {
    Random random(3);
    int met = 0;
    for (int i = 0; i < 4000; ++i) {
        const Point2 start(random.within(-1, 1), random.within(-1, 1));
        const Segment one = random_segment(random, start);
        const double share = random.within(0.1, 0.9);
        const Point2 common = point_at(start, one, share);
        // Another curve through a point of the first, at an angle.
        const Segment shape = random_segment(random, {0, 0});
        const double place = random.within(0.1, 0.9);
        const Vector2 shift = common - point_at({0, 0}, shape, place);
        const Segment other{shape.end + shift, shape.sagitta_mm};
        const Curve a = curve_of(start, one), b = curve_of(shift, other);
        const Vector2 dir_a = point_on(a, along_mm(a, common) + 1e-4 * a.half_mm) - common;
        const Vector2 dir_b = point_on(b, along_mm(b, common) + 1e-4 * b.half_mm) - common;
        const double angle = std::abs(cross(dir_a, dir_b)) / (dir_a.norm() * dir_b.norm());
        if (!(angle > 0.01)) continue;
        const Meetings found = meetings(a, b);
        double off = 1e300;
        for (int m = 0; m < found.count; ++m) {
            off = std::min(off, (found.points[static_cast<std::size_t>(m)] - common).norm());
        }
        CHECK(off < 1e-9);
        ++met;
    }
    CHECK(met > 3000);
}

TEST_CASE("curve 3: a circle that a line touches gives the point of contact") {
    const Curve line = curve_of({-5, 2}, {{5, 2}});
    for (const double gap : {0.0, 1e-12, 1e-7}) {
        for_monotone_curves(FullCircle{{1, -1 - gap}, 3, true},
                            [&](const Curve& half, std::size_t) {
                                const Meetings found = meetings(line, half);
                                REQUIRE(found.count > 0);
                                CHECK((found.points[0] - Point2(1, 2)).norm() < 1e-5);
                                CHECK(std::abs(found.points[0].y() - 2) <= gap + 1e-11);
                            });
    }
}
