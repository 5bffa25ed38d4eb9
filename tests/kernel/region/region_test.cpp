// Unions, intersections and differences of random regions, by what must hold for all of them.

#include "kernel/region/region.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

// Areas agree to round-off: of the crossings found, not of anything snapped.
constexpr double area_slack_mm2 = 1e-9;

void check_sound(const RegionResult& result) {
    CHECK(result.unresolved == 0);
    for (const Contour& contour : result.contours) CHECK(is_closed(contour));
}

// Two regions that overlap as a rule.
template <class Check>
void for_random_pairs(int count, unsigned seed, Check check) {
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        const double size = std::pow(10.0, random.within(-1, 2));
        const Point2 centre(random.within(-100, 100), random.within(-100, 100));
        const Vector2 apart(random.within(-1.2, 1.2), random.within(-1.2, 1.2));
        CAPTURE(i);
        check(random_region(random, centre, size),
              random_region(random, centre + size * apart, size * random.within(0.3, 1)), random);
    }
}

}  // namespace

TEST_CASE("region: area of union and intersection is that of the two regions") {
    for_random_pairs(600, 1, [](const Contours& a, const Contours& b, Random&) {
        const auto all = combined(a, b, Operation::unite, fine_mm);
        const auto both = combined(a, b, Operation::intersect, fine_mm);
        const auto rest = combined(a, b, Operation::subtract, fine_mm);
        for (const auto* result : {&all, &both, &rest}) check_sound(*result);
        const double in_a = total_area(a), in_b = total_area(b), scale = in_a + in_b;
        CHECK(std::abs(total_area(all.contours) + total_area(both.contours) - in_a - in_b) <
              area_slack_mm2 * scale);
        CHECK(std::abs(total_area(rest.contours) + total_area(both.contours) - in_a) <
              area_slack_mm2 * scale);
        CHECK(std::abs(total_area(unite_all({a, b}, fine_mm).contours) - total_area(all.contours)) <
              area_slack_mm2 * scale);
    });
}

TEST_CASE("region: a point is in the result if the windings around it say so") {
    for_random_pairs(60, 2, [](const Contours& a, const Contours& b, Random& random) {
        const auto all = combined(a, b, Operation::unite, fine_mm);
        const auto both = combined(a, b, Operation::intersect, fine_mm);
        const auto rest = combined(a, b, Operation::subtract, fine_mm);
        Contours lines(a);
        lines.insert(lines.end(), b.begin(), b.end());
        const Eigen::AlignedBox2d box = box_of(lines);
        for (int i = 0; i < 60; ++i) {
            const Point2 point(random.within(box.min().x(), box.max().x()),
                               random.within(box.min().y(), box.max().y()));
            if (distance_to(lines, point) < fine_mm) continue;
            const bool in_a = winding(a, point) > 0, in_b = winding(b, point) > 0;
            CHECK(winding(all.contours, point) == (in_a || in_b));
            CHECK(winding(both.contours, point) == (in_a && in_b));
            CHECK(winding(rest.contours, point) == (in_a && !in_b));
        }
    });
}

TEST_CASE(
    "region 3, 5: a region and itself are itself, bit for bit; so is a copy that is off by "
    "round-off") {
    for_random_pairs(200, 3, [](const Contours& a, const Contours&, Random& random) {
        CHECK(same_set(combined(a, a, Operation::unite, fine_mm).contours, a));
        CHECK(same_set(combined(a, a, Operation::intersect, fine_mm).contours, a));
        CHECK(combined(a, a, Operation::subtract, fine_mm).contours.empty());
        CHECK(same_set(unite_all({a, a, a}, fine_mm).contours, a));
        const Motion nudge{.shift = {random.within(-1e-7, 1e-7), random.within(-1e-7, 1e-7)}};
        const auto twice = unite_all({a, moved(a, nudge)}, fine_mm);
        CHECK(twice.contours.size() == a.size());
        CHECK(std::abs(total_area(twice.contours) - total_area(a)) < 1e-7 * total_length(a));
    });
}

TEST_CASE("region 5: the result is the same in whatever order the regions come") {
    for_random_pairs(200, 4, [](const Contours& a, const Contours& b, Random& random) {
        const Contours c = random_region(random, {0, 0}, 50);
        const auto first = unite_all({a, b, c}, fine_mm).contours;
        for (const auto& order :
             std::vector<std::vector<Contours>>{{c, b, a}, {b, c, a}, {a, c, b}}) {
            CHECK(first == unite_all(order, fine_mm).contours);
        }
        for (const Operation operation : {Operation::unite, Operation::intersect}) {
            CHECK(combined(a, b, operation, fine_mm).contours ==
                  combined(b, a, operation, fine_mm).contours);
        }
    });
}

TEST_CASE("region: the complement of the union is the intersection of the complements") {
    for_random_pairs(150, 5, [](const Contours& a, const Contours& b, Random&) {
        const Contours frame{rectangle(-1000, -1000, 1000, 1000)};
        const auto outside = [&](const Contours& region) {
            return combined(frame, region, Operation::subtract, fine_mm).contours;
        };
        const auto one = outside(combined(a, b, Operation::unite, fine_mm).contours);
        const auto other = combined(outside(a), outside(b), Operation::intersect, fine_mm);
        check_sound(other);
        CHECK(one.size() == other.contours.size());
        CHECK(total_area(one) == doctest::Approx(total_area(other.contours)).epsilon(1e-12));
        CHECK(total_length(one) == doctest::Approx(total_length(other.contours)).epsilon(1e-9));
    });
}

TEST_CASE("region: turned and mirrored regions give the turned and mirrored result") {
    for_random_pairs(150, 6, [](const Contours& a, const Contours& b, Random& random) {
        const auto plain = unite_all({a, b}, fine_mm).contours;
        for (const bool mirrored : {false, true}) {
            const Motion motion{random.within(-pi, pi), {3, -7}, mirrored};
            const auto result = unite_all({moved(a, motion), moved(b, motion)}, fine_mm);
            check_sound(result);
            CHECK(result.contours.size() == plain.size());
            CHECK(total_area(result.contours) == doctest::Approx(total_area(plain)).epsilon(1e-10));
            CHECK(total_length(result.contours) ==
                  doctest::Approx(total_length(plain)).epsilon(1e-9));
        }
    });
}

TEST_CASE("region 3: arcs are pieces of the circles they come from") {
    for_random_pairs(200, 7, [](const Contours& a, const Contours& b, Random&) {
        std::vector<ArcCircle> circles;
        const auto collect = [&](const Contours& contours, auto take) {
            for (const Contour& contour : contours) {
                const auto* path = std::get_if<Path>(&contour);
                if (!path) {
                    const auto& circle = std::get<FullCircle>(contour);
                    take(ArcCircle{circle.centre, circle.radius_mm});
                    continue;
                }
                Point2 from = path->start;
                for (const Segment& segment : path->segments) {
                    if (const auto circle = circle_of(from, segment)) take(*circle);
                    from = segment.end;
                }
            }
        };
        for (const Contours* input : {&a, &b}) {
            collect(*input, [&](const ArcCircle& circle) { circles.push_back(circle); });
        }
        collect(unite_all({a, b}, fine_mm).contours, [&](const ArcCircle& circle) {
            double least = 1e300;
            for (const ArcCircle& other : circles) {
                least = std::min(least, (circle.centre - other.centre).norm() +
                                            std::abs(circle.radius_mm - other.radius_mm));
            }
            CHECK(least < 1e-6 * (1 + circle.radius_mm));
        });
    });
}

TEST_CASE("region 2: a boundary that crosses itself is cleaned") {
    // A bow tie: one half winds the wrong way round.
    const Contours bow{Path{{0, 0}, {{{4, 4}}, {{4, 0}}, {{0, 4}}, {{0, 0}}}}};
    const auto cut = cleaned(bow, fine_mm);
    check_sound(cut);
    REQUIRE(cut.contours.size() == 1);
    CHECK(total_area(cut.contours) == doctest::Approx(4));
    // A ring whose end runs over its start, as an offset's does: what it winds around twice is one.
    Path ring{{10, 0}, {}};
    const auto on = [](double radius, double angle) {
        return Point2(radius * std::cos(angle), radius * std::sin(angle));
    };
    ring.segments.push_back(arc_with_sweep(on(10, 0), on(10, pi), pi));
    ring.segments.push_back(arc_with_sweep(on(10, pi), on(10, 2 * pi - 0.1), pi - 0.1));
    ring.segments.push_back({on(12, 0.2)});
    ring.segments.push_back({on(9, 0.3)});
    ring.segments.push_back({{10, 0}});
    const auto once = cleaned(Contours{ring}, fine_mm);
    check_sound(once);
    REQUIRE(once.contours.size() == 1);
    CHECK(total_area(once.contours) > 100 * pi);
    for (const double angle : {0.1, 1.0, 2.0, 4.0})
        CHECK(winding(once.contours, on(9.5, angle)) == 1);
    CHECK(same_set(cleaned(once.contours, fine_mm).contours, once.contours));
}

TEST_CASE("region 3: what nothing touches passes untouched, nested or not") {
    const Contours housing{rectangle(0, 0, 20, 10), FullCircle{{5, 5}, 3, false}};
    const Contours pin{FullCircle{{5, 5}, 2, true}, FullCircle{{5, 5}, 1, false}};
    const Contours apart{slot(30, 1, 33, 4)};
    const Contours buried{slot(12, 2, 15, 6), FullCircle{{13, 4}, 0.5, false}};
    Contours expected(housing);
    expected.insert(expected.end(), pin.begin(), pin.end());
    expected.insert(expected.end(), apart.begin(), apart.end());
    const auto whole = unite_all({housing, pin, apart}, fine_mm);
    CHECK(!whole.changed);
    CHECK(same_set(whole.contours, expected));
    // A solid within another's material vanishes, with the hole that it has there.
    const auto without = unite_all({housing, buried, pin, apart}, fine_mm);
    CHECK(without.changed);
    CHECK(same_set(without.contours, expected));
    CHECK(!unite_all({}, fine_mm).changed);
    CHECK(unite_all({{}, {}}, fine_mm).contours.empty());
}

TEST_CASE(
    "region 6: parts of an operand that lie over each other are no reason to refuse a result") {
    Contours pile;
    for (int i = 0; i < 5; ++i) pile.push_back(rectangle(0.1 * i, 0, 10 + 0.1 * i, 10));
    const Contours other{rectangle(5, 5, 20, 8)};
    for (const auto& [operation, area] :
         {std::pair{Operation::unite, 104.0 + 9.6 * 3}, std::pair{Operation::intersect, 5.4 * 3},
          std::pair{Operation::subtract, 104.0 - 5.4 * 3}}) {
        const RegionResult result = combined(pile, other, operation, fine_mm);
        CHECK(result.unresolved == 0);
        CHECK(total_area(result.contours) == doctest::Approx(area).epsilon(1e-9));
    }
    const RegionResult exchanged = combined(other, pile, Operation::unite, fine_mm);
    CHECK(exchanged.unresolved == 0);
}
