// Regions that touch, coincide and graze: on a grid, turned, and off by a little.

#include <doctest/doctest.h>

#include "kernel/contour/fit.h"
#include "kernel/region/regions.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

// A quarter of a ring about a point: two lines and two arcs.
Path quarter_ring(const Point2& centre, double inner, double outer, int quarter) {
    const auto on = [&](double radius, int q) {
        const Vector2 axis[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
        return Point2(centre + radius * axis[q % 4]);
    };
    Path path{on(inner, quarter), {}};
    path.segments.push_back({on(outer, quarter)});
    path.segments.push_back(arc_with_sweep(on(outer, quarter), on(outer, quarter + 1), pi / 2));
    path.segments.push_back({on(inner, quarter + 1)});
    path.segments.push_back(arc_with_sweep(on(inner, quarter + 1), on(inner, quarter), -pi / 2));
    return path;
}

// On a coarse grid, so that walls coincide, corners lie on walls and arcs are tangent all the time.
Contours grid_shape(Random& random) {
    const double x = random.whole(0, 6), y = random.whole(0, 6);
    const double w = random.whole(1, 4), h = random.whole(1, 4);
    switch (random.whole(0, 5)) {
        case 0:
            return {rectangle(x, y, x + w, y + h)};
        case 1:
            return {slot(x, y, x + w, y + 2)};
        case 2:
            return {FullCircle{{x, y}, w, true}};
        case 3:
            return {quarter_ring({x, y}, w, w + h, random.whole(0, 3))};
        case 4:
            return {rectangle(x, y, x + 4, y + 4),
                    FullCircle{{x + 2, y + 2}, w > 2 ? 2.0 : 1.0, false}};
        default:
            return {FullCircle{{x, y}, w + 1, true}, FullCircle{{x, y}, w, false}};
    }
}

// Every corner moved a little by itself; coincidences are no longer exact.
Contour jittered(const Contour& contour, double by_mm, Random& random) {
    const auto step = [&] {
        return Vector2(random.within(-by_mm, by_mm), random.within(-by_mm, by_mm));
    };
    if (const auto* circle = std::get_if<FullCircle>(&contour)) {
        return FullCircle{circle->centre + step(), circle->radius_mm + step().x(),
                          circle->counter_clockwise};
    }
    Path path = std::get<Path>(contour);
    for (Segment& segment : path.segments) segment.end += step();
    path.start = path.segments.back().end;
    return path;
}

Contours joined(const std::vector<Contours>& regions) {
    Contours all;
    for (const Contours& region : regions) all.insert(all.end(), region.begin(), region.end());
    return all;
}

// Points along contours.
template <class Take>
void for_points_on(const Contours& contours, Take take) {
    for (const Contour& contour : contours) {
        region::for_monotone_curves(contour, [&](const region::Curve& curve, std::size_t) {
            for (const double share : {-0.9, -0.4, 0.0, 0.5, 1.0}) {
                take(region::point_on(curve, share * curve.half_mm));
            }
        });
    }
}

void check_union(const std::vector<Contours>& regions, double within_mm, Random& random) {
    const auto result = unite_all(regions, within_mm);
    REQUIRE(result.unresolved == 0);
    const Contours lines = joined(regions);
    for (const Contour& contour : result.contours) REQUIRE(is_closed(contour));
    for_points_on(result.contours,
                  [&](const Point2& point) { REQUIRE(distance_to(lines, point) <= within_mm); });
    const auto box = box_of(lines);
    for (int i = 0; i < 40; ++i) {
        const Point2 point(random.within(box.min().x(), box.max().x()),
                           random.within(box.min().y(), box.max().y()));
        if (distance_to(lines, point) <= within_mm) continue;
        REQUIRE(winding(result.contours, point) == (winding(lines, point) > 0));
    }
}

// Turned, mirrored, and every corner off by a little.
template <class Check>
void for_variants(const std::vector<Contours>& regions, Check check) {
    Random random(12);
    for (const double jitter : {0.0, 1e-7, 1e-6, 1e-5}) {
        for (int i = 0; i < 12; ++i) {
            CAPTURE(jitter);
            CAPTURE(i);
            const Motion motion{i == 0 ? 0 : random.within(-pi, pi), {3, -8}, i % 2 == 1};
            std::vector<Contours> variant;
            for (const Contours& region : regions) {
                variant.push_back(moved(region, motion));
                for (Contour& contour : variant.back()) contour = jittered(contour, jitter, random);
            }
            const auto result = unite_all(variant, 1e-3);
            REQUIRE(result.unresolved == 0);
            check(result.contours);
        }
    }
}

bool is_circle(const Contour& contour, double radius) {
    const auto* circle = std::get_if<FullCircle>(&contour);
    return circle && std::abs(circle->radius_mm - radius) < 1e-4;
}

}  // namespace

TEST_CASE("region: shapes on a grid, turned and jittered, are united as their windings say") {
    Random random(11);
    for (const double jitter : {0.0, 1e-12, 1e-9, 1e-7, 1e-6, 3e-6, 1e-5, 1e-4}) {
        for (int i = 0; i < 300; ++i) {
            CAPTURE(jitter);
            CAPTURE(i);
            const Motion motion{i % 3 == 0 ? 0 : random.within(-pi, pi), {0, 0}, i % 2 == 0};
            std::vector<Contours> regions;
            const int count = random.whole(2, i % 20 == 0 ? 40 : 9);
            for (int r = 0; r < count; ++r) {
                regions.push_back(moved(grid_shape(random), motion));
                for (Contour& contour : regions.back()) contour = jittered(contour, jitter, random);
            }
            check_union(regions, fine_mm, random);
            check_union(regions, 100 * fine_mm, random);
        }
    }
}

TEST_CASE("region 1: boxes that share a wall are one box; a shorter wall leaves corners") {
    for_variants({{rectangle(0, 0, 4, 3)}, {rectangle(4, 0, 7, 3)}}, [](const Contours& result) {
        REQUIRE(result.size() == 1);
        CHECK(total_area(result) == doctest::Approx(21).epsilon(1e-5));
        CHECK(total_length(result) == doctest::Approx(20).epsilon(1e-5));
    });
    for_variants({{rectangle(0, 0, 4, 3)}, {rectangle(4, 1, 7, 2)}}, [](const Contours& result) {
        REQUIRE(result.size() == 1);
        CHECK(total_length(result) == doctest::Approx(20).epsilon(1e-5));
        CHECK(count(result[0]).lines == 8);
    });
    // Four that surround a square leave it free.
    for_variants({{rectangle(0, 0, 4, 1)},
                  {rectangle(4, 0, 5, 4)},
                  {rectangle(1, 4, 5, 5)},
                  {rectangle(0, 1, 1, 5)}},
                 [](const Contours& result) {
                     REQUIRE(result.size() == 2);
                     CHECK(total_area(result) == doctest::Approx(16).epsilon(1e-5));
                     CHECK(total_length(result) == doctest::Approx(32).epsilon(1e-5));
                 });
}

TEST_CASE("region 3: a box that shares a wall exactly is one box of four lines") {
    const auto result = unite_all({{rectangle(0, 0, 4, 3)}, {rectangle(4, 0, 7, 3)}}, 1e-3);
    REQUIRE(result.contours.size() == 1);
    CHECK(count(result.contours[0]).lines == 4);
    CHECK(total_area(result.contours) == 21);
}

TEST_CASE("region 3: quarters of a ring are a ring of two whole circles") {
    std::vector<Contours> quarters;
    for (int q = 0; q < 4; ++q) quarters.push_back({quarter_ring({1, 2}, 2, 5, q)});
    for_variants(quarters, [](const Contours& result) {
        REQUIRE(result.size() == 2);
        CHECK(std::count_if(result.begin(), result.end(),
                            [](const Contour& c) { return is_circle(c, 5); }) == 1);
        CHECK(std::count_if(result.begin(), result.end(),
                            [](const Contour& c) { return is_circle(c, 2); }) == 1);
        CHECK(total_area(result) == doctest::Approx(21 * pi).epsilon(1e-4));
    });
}

TEST_CASE("region 1: a pin that fills its bore makes it vanish") {
    const Contours plate{rectangle(0, 0, 9, 6), FullCircle{{4, 3}, 2, false}};
    for_variants({plate, {FullCircle{{4, 3}, 2, true}}}, [](const Contours& result) {
        REQUIRE(result.size() == 1);
        CHECK(total_area(result) == doctest::Approx(54).epsilon(1e-5));
    });
    // A hollow one leaves its own hole only.
    const Contours bush{FullCircle{{4, 3}, 2, true}, FullCircle{{4, 3}, 1, false}};
    for_variants({plate, bush}, [](const Contours& result) {
        REQUIRE(result.size() == 2);
        CHECK(std::any_of(result.begin(), result.end(),
                          [](const Contour& c) { return is_circle(c, 1); }));
    });
}

TEST_CASE("region 2: what touches in a point are contours that touch, inside and outside") {
    // Two boxes at a corner; a disc on a wall; a bore that touches the outside.
    for (const std::vector<Contours>& regions : std::vector<std::vector<Contours>>{
             {{rectangle(0, 0, 2, 2)}, {rectangle(2, 2, 4, 4)}},
             {{rectangle(0, 0, 4, 2)}, {FullCircle{{2, 3}, 1, true}}},
             {{FullCircle{{0, 0}, 2, true}}, {FullCircle{{5, 0}, 3, true}}}}) {
        double area = 0;
        for (const Contours& region : regions) area += total_area(region);
        const auto result = unite_all(regions, 1e-3);
        CHECK(result.unresolved == 0);
        CHECK(result.contours.size() == 2);
        CHECK(total_area(result.contours) == doctest::Approx(area));
    }
    const Contours disc{FullCircle{{0, 0}, 3, true}}, bore{FullCircle{{2, 0}, 1, true}};
    const auto rest = combined(disc, bore, Operation::subtract, 1e-3);
    CHECK(rest.unresolved == 0);
    CHECK(rest.contours.size() == 2);
    CHECK(total_area(rest.contours) == doctest::Approx(8 * pi));
}

TEST_CASE("region 1: a slot that ends in a disc of its own width") {
    for_variants({{rectangle(0, -1, 5, 1)}, {FullCircle{{5, 0}, 1, true}}},
                 [](const Contours& result) {
                     REQUIRE(result.size() == 1);
                     CHECK(total_area(result) == doctest::Approx(10 + pi / 2).epsilon(1e-4));
                     CHECK(count(result[0]).arcs == 1);
                     CHECK(count(result[0]).lines == 3);
                 });
}

TEST_CASE(
    "region 4: a gap that is narrower than a sliver is left out and counted, a wider one stays") {
    const double gap = 8e-4;  // wider than the snap
    const Contours left{rectangle(0, 0, 3, 3)}, right{rectangle(3 + gap, 0.5, 6, 2.5)};
    const Contours bottom{rectangle(2, 0, 4, 0.5)}, top{rectangle(2, 2.5, 4, 3)};
    const auto closed = unite_all({left, right, bottom, top}, 1e-3);
    CHECK(closed.unresolved == 0);
    CHECK(closed.slivers == 1);
    CHECK(closed.contours.size() == 1);
    const auto open = unite_all({left, right, bottom, top}, 1e-4);
    CHECK(open.slivers == 0);
    CHECK(open.contours.size() == 2);
    const auto by_choice = unite_all({left, right, bottom, top}, 1e-4, 1e-3);
    CHECK(by_choice.slivers == 1);
    CHECK(by_choice.contours.size() == 1);
    // A gap that widens to a bore somewhere is no sliver, long as it may be.
    const Contours notched{rectangle(0, 0, 3, 3), rectangle(3, 0, 4, 0.5), rectangle(3, 2.5, 4, 3)};
    const Contours pierced{rectangle(3 + gap, 0.4, 6, 2.6),
                           FullCircle{{3.1, 1.5}, 0.1 - 1e-6, false}};
    const auto bore = unite_all({notched, pierced}, 1e-4, 1e-3);
    CHECK(bore.slivers == 0);
}

TEST_CASE(
    "region 4: walls that two curves share only within the tolerance leave no contours between "
    "them") {
    // An ellipse for a bore and its pin, each with arcs of its own.
    const auto ring = [](double from, double allowed) {
        const auto ellipse = [](double t) {
            return CurvePoint{{10 * std::cos(t), 7 * std::sin(t)},
                              Vector2(-10 * std::sin(t), 7 * std::cos(t)).normalized()};
        };
        Path path{ellipse(from).point, {}};
        fit_arcs(ellipse, from, from + 2 * pi, path.start, path.start, allowed, path.segments);
        return path;
    };
    const Contours plate{rectangle(-20, -20, 20, 20), reversed(ring(0, 0.0025))};
    for (const double from : {0.0, 0.3, 1.0, 2.2}) {
        const auto result = unite_all({plate, {ring(from, 0.002)}}, 3e-4, 0.005);
        CHECK(result.unresolved == 0);
        CHECK(result.contours.size() == 1);
        CHECK(total_area(result.contours) == doctest::Approx(1600));
    }
}

TEST_CASE("region 6: numbers that are none are given back and reported") {
    const double nan = std::nan("");
    const Contours good{rectangle(0, 0, 1, 1)}, bad{FullCircle{{0, 0}, nan, true}};
    CHECK(unite_all({good, bad}, 1e-3).unresolved == 1);
    CHECK(unite_all({good, bad}, 1e-3).contours.size() == 2);
    CHECK(combined(good, bad, Operation::subtract, 1e-3).unresolved == 1);
}

TEST_CASE("region: an arc of almost a whole turn over a chord of a snap stays on its circle") {
    Random random(13);
    check_union({{FullCircle{{5.00000019, -3.999999911}, 3.999999631, true},
                  FullCircle{{5.00000068, -2.0000009}, 1.999999337, false}},
                 {}},
                fine_mm, random);
    const auto result =
        combined(Contours{FullCircle{{5.00000019, -3.999999911}, 3.999999631, true}},
                 Contours{FullCircle{{5.00000068, -2.0000009}, 1.999999337, true}},
                 Operation::subtract, fine_mm);
    REQUIRE(result.unresolved == 0);
    CHECK(total_area(result.contours) == doctest::Approx(12 * pi).epsilon(1e-5));
    CHECK(winding(result.contours, {5, -7.9}) == 1);
    CHECK(winding(result.contours, {1.1, -4}) == 1);
    CHECK(winding(result.contours, {5, -3.9}) == 0);
}

TEST_CASE("region: a corner just outside a circle that its side is tangent to") {
    // Bending to each other's vertices, side and circle change places where they leave them.
    const Path square{{-1.958180855, -0.406854652},
                      {{{-5.874540474, -1.220564421}},
                       {{-5.060831817, -5.136924603}},
                       {{-1.144471053, -4.323215242}},
                       {{-1.958180855, -0.406854652}}}};
    const Contours disc{FullCircle{{-5.874540594, -1.220563444}, 3.999999238, true}};
    Random random(14);
    check_union({{square}, disc}, fine_mm, random);
    const auto result = unite_all({{square}, disc}, fine_mm);
    CHECK(total_area(result.contours) == doctest::Approx(12 * pi + 16).epsilon(1e-5));
}

TEST_CASE("region: an arc whose first bit beyond its circle's top is shorter than the snap") {
    Path slot_end{{4.00000255, -4.999998097}, {}};
    slot_end.segments.push_back({{4.000000561, -6.999997577}, 1});
    slot_end.segments.push_back({{7.00000046, -7.00000208}});
    slot_end.segments.push_back({{7.000002179, -5.000001091}, 1});
    slot_end.segments.push_back({slot_end.start});
    const Contours box{rectangle(3.9999996, -8.0000024, 8.0000017, -3.9999995)};
    Random random(15);
    check_union({{slot_end}, box}, fine_mm, random);
    const auto result = unite_all({{slot_end}, box}, fine_mm);
    CHECK(winding(result.contours, {3.9, -5.5}) == 1);
}
