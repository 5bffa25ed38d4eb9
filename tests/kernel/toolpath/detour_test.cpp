// Detours in random plates with holes and in narrow regions, beside the shortest ways through all that can be seen.

#include "kernel/toolpath/detour.h"

#include <doctest/doctest.h>

#include <limits>

#include "kernel/region/regions.h"
#include "kernel/toolpath/sizes.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

constexpr double any_length_mm = 1e9;

double length_of(const Point2& from, const Travel& travel, const Point2& to) {
    double length = 0;
    Point2 at = from;
    for (const Point2& point : travel.via) {
        length += (point - at).norm();
        at = point;
    }
    return length + (to - at).norm();
}

// A square with holes that keep clear of each other.
Contours plate_with_holes(Random& random, int holes, double size_mm, bool with_circles = true) {
    Contours region{rectangle(0, 0, size_mm, size_mm)};
    std::vector<FullCircle> taken;
    for (int i = 0; i < 20 * holes && static_cast<int>(taken.size()) < holes; ++i) {
        const double radius = random.within(0.01, 0.07) * size_mm;
        const double margin = radius + 0.5;
        const Point2 centre(random.within(margin, size_mm - margin),
                            random.within(margin, size_mm - margin));
        bool is_clear = true;
        for (const FullCircle& other : taken)
            is_clear &= (other.centre - centre).norm() > other.radius_mm + margin;
        if (!is_clear) continue;
        taken.push_back({centre, radius, false});
        if (with_circles && random.coin()) {
            region.push_back(taken.back());
        } else {
            region.push_back(reversed(random_ring(random, centre, radius)));
        }
    }
    return region;
}

// Teeth that point up, one beside the other on a back of 5 mm.
Path comb(int teeth) {
    Path path{{0, 0}, {}};
    path.segments.push_back({{10.0 * teeth, 0}});
    for (int i = teeth - 1; i >= 0; --i) {
        path.segments.push_back({{10.0 * i + 10, 50}});
        path.segments.push_back({{10.0 * i + 4, 50}});
        if (i == 0) break;
        path.segments.push_back({{10.0 * i + 4, 5}});
        path.segments.push_back({{10.0 * i, 5}});
    }
    path.segments.push_back({{4, 5}});
    path.segments.push_back({{0, 5}});
    path.segments.push_back({{0, 0}});
    return path;
}

Point2 point_inside(const Contours& region, Random& random) {
    const Eigen::AlignedBox2d box = box_of(region);
    while (true) {
        const Point2 point(random.within(box.min().x(), box.max().x()),
                           random.within(box.min().y(), box.max().y()));
        if (winding(region, point) > 0) return point;
    }
}

// No point of it is outside by more than allowed.
void check_inside(const Contours& region, const Point2& from, const Travel& travel,
                  const Point2& to) {
    Point2 at = from;
    for (std::size_t i = 0; i <= travel.via.size(); ++i) {
        const Point2& next = i < travel.via.size() ? travel.via[i] : to;
        constexpr int samples = 60;
        for (int k = 0; k <= samples; ++k) {
            const Point2 point = at + k / double{samples} * (next - at);
            if (winding(region, point) > 0) continue;
            CHECK(distance_to(region, point) < infill_allowed_mm);
        }
        at = next;
    }
}

// Just inside the corners and the arcs of the contours.
std::vector<Point2> places_to_bend(const Contours& region) {
    std::vector<Point2> places;
    const auto add = [&](const Point2& point, const Vector2& tangent) {
        places.push_back(point + 0.01 * Vector2(-tangent.y(), tangent.x()).normalized());
    };
    for (const Contour& contour : region) {
        if (const auto* circle = std::get_if<FullCircle>(&contour)) {
            for (int i = 0; i < 24; ++i) {
                const Vector2 out(std::cos(i * pi / 12), std::sin(i * pi / 12));
                places.push_back(circle->centre +
                                 (circle->radius_mm + 0.01) / std::cos(pi / 24) * out);
            }
            continue;
        }
        const Path& path = std::get<Path>(contour);
        const std::size_t count = path.segments.size();
        Point2 before = path.segments[(count + count - 2) % count].end, start = path.start;
        for (std::size_t i = 0; i < count; ++i) {
            const Segment& last = path.segments[(i + count - 1) % count];
            add(start, start_tangent(start, path.segments[i]) + end_tangent(before, last));
            before = start;
            for (int k = 1; k < 5 && path.segments[i].sagitta_mm != 0; ++k) {
                const Point2 point = point_at(start, path.segments[i], k / 5.0);
                const Segment rest =
                    arc_with_sweep(point, path.segments[i].end,
                                   sweep_rad(start, path.segments[i]) * (1 - k / 5.0));
                add(point, start_tangent(point, rest));
            }
            start = path.segments[i].end;
        }
    }
    return places;
}

// The shortest way over all places that see each other.
double shortest_mm(const Contours& region, const Point2& from, const Point2& to) {
    const Boundary boundary(region);
    std::vector<Point2> places = places_to_bend(region);
    places.push_back(from);
    places.push_back(to);
    constexpr double never = std::numeric_limits<double>::infinity();
    std::vector<double> way(places.size(), never);
    std::vector<bool> done(places.size());
    way[places.size() - 2] = 0;
    std::vector<BoundaryCrossing> crossings;
    while (true) {
        std::size_t nearest = places.size();
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (!done[i] && way[i] < never && (nearest == places.size() || way[i] < way[nearest]))
                nearest = i;
        }
        if (nearest >= places.size() - 1) return way.back();
        done[nearest] = true;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const double length = way[nearest] + (places[i] - places[nearest]).norm();
            if (done[i] || length >= way[i]) continue;
            boundary.crossings(places[nearest], places[i], crossings);
            if (crossings.empty()) way[i] = length;
        }
    }
}

}  // namespace

TEST_CASE("detour 1: ways in random plates stay inside") {
    Random random(1);
    for (int i = 0; i < 12; ++i) {
        const Contours region =
            i % 2 == 0 ? plate_with_holes(random, 25, 60) : random_region(random, {5, 5}, 30);
        const Detours detours(region, infill_allowed_mm, any_length_mm);
        for (int k = 0; k < 25; ++k) {
            const Point2 from = point_inside(region, random), to = point_inside(region, random);
            const Travel travel = detours.way(from, to);
            CHECK(!travel.crosses);
            check_inside(region, from, travel, to);
        }
    }
}

TEST_CASE("detour 3: within half a percent of the shortest on average, in random plates") {
    Random random(2);
    double sum = 0;
    int count = 0;
    for (int i = 0; i < 6; ++i) {
        const Contours region = plate_with_holes(random, 12, 60);
        const Detours detours(region, infill_allowed_mm, any_length_mm);
        for (int k = 0; k < 12; ++k) {
            const Point2 from = point_inside(region, random), to = point_inside(region, random);
            const double ratio =
                length_of(from, detours.way(from, to), to) / shortest_mm(region, from, to);
            // The places that it is compared with are not all.
            CHECK(ratio > 0.995);
            CHECK(ratio < 1.1);
            sum += ratio;
            ++count;
        }
    }
    CHECK(sum / count < 1.005);
}

TEST_CASE("detour 2: straight where that is inside, and along the tangents of a hole where not") {
    const Contours region{rectangle(-50, -50, 50, 50), FullCircle{{0, 0}, 10, false}};
    const Detours detours(region, infill_allowed_mm, any_length_mm);
    const Travel beside = detours.way({-30, 11}, {30, 11});
    CHECK(beside.via.empty());
    CHECK(!beside.crosses);
    const Travel around = detours.way({-30, 1}, {30, 0});
    CHECK(!around.crosses);
    CHECK(around.via.size() > 2);
    const double tangents = std::sqrt(901.0 - 100) + std::sqrt(900.0 - 100);
    const double turn =
        pi - std::atan2(1, 30) - std::acos(10 / std::sqrt(901.0)) - std::acos(10 / 30.0);
    CHECK(length_of({-30, 1}, around, {30, 0}) / (tangents + 10 * turn) ==
          doctest::Approx(1).epsilon(0.002));
    for (const Point2& point : around.via) CHECK(point.y() > 0);
}

TEST_CASE("detour 2: no longer than what it may take more") {
    const Contours region{comb(6)};
    Random random(3);
    int crossing = 0;
    for (const double extra : {5.0, 20.0, 60.0}) {
        const Detours detours(region, infill_allowed_mm, extra);
        for (int i = 0; i < 60; ++i) {
            const Point2 from = point_inside(region, random), to = point_inside(region, random);
            const Travel travel = detours.way(from, to);
            const double shortest = shortest_mm(region, from, to), straight = (to - from).norm();
            if (travel.crosses) {
                ++crossing;
                CHECK(travel.via.empty());
                CHECK(shortest > straight + extra - 0.1);
            } else {
                CHECK(length_of(from, travel, to) <= straight + extra + 0.1);
                CHECK(length_of(from, travel, to) < 1.01 * shortest);
            }
        }
    }
    CHECK(crossing > 20);
}

TEST_CASE("detour 2: ways ran on the walls that they go around, with room beside them") {
    constexpr double clear_mm = 0.8;
    Random random(6);
    std::size_t bends = 0, clear = 0;
    for (int i = 0; i < 12; ++i) {
        const Contours region = plate_with_holes(random, 10, 60);
        const Boundary boundary(region);
        for (const double extra : {2.0, 20.0}) {
            const Detours detours(region, infill_allowed_mm, extra, clear_mm);
            const Detours tight(region, infill_allowed_mm, extra);
            for (int k = 0; k < 25; ++k) {
                const Point2 from = point_inside(region, random), to = point_inside(region, random);
                const Travel travel = detours.way(from, to);
                CHECK(travel.crosses == tight.way(from, to).crosses);
                if (!travel.crosses) check_inside(region, from, travel, to);
                CHECK(length_of(from, travel, to) <= (to - from).norm() + extra + 1e-9);
                for (const Point2& bend : travel.via) {
                    ++bends;
                    clear += boundary.distance_mm(bend, clear_mm) > clear_mm / 2;
                }
            }
        }
    }
    CHECK(bends > 200);
    CHECK(clear > bends * 9 / 10);
}

TEST_CASE("detour: turned and mirrored regions have ways as long") {
    Random random(4);
    for (int i = 0; i < 10; ++i) {
        // Bends around a full circle are where it starts, wherever that is.
        const Contours region =
            i == 0 ? Contours{comb(5)} : plate_with_holes(random, 15, 60, false);
        const Motion motion{random.within(-3, 3), {random.within(-90, 90), 20}, random.coin()};
        const Detours detours(region, infill_allowed_mm, any_length_mm);
        const Contours other_region = moved(region, motion);
        const Detours other(other_region, infill_allowed_mm, any_length_mm);
        for (int k = 0; k < 20; ++k) {
            const Point2 from = point_inside(region, random), to = point_inside(region, random);
            const double length = length_of(from, detours.way(from, to), to);
            const Point2 other_from = motion(from), other_to = motion(to);
            CHECK(length_of(other_from, other.way(other_from, other_to), other_to) ==
                  doctest::Approx(length).epsilon(1e-6));
        }
    }
}

TEST_CASE("detour 3: between separate parts, and from outside, ways go straight and cross") {
    const Contours region{rectangle(0, 0, 10, 10), rectangle(20, 0, 30, 10),
                          FullCircle{{5, 5}, 3, false}, FullCircle{{5, 5}, 1, true}};
    const Detours detours(region, infill_allowed_mm, any_length_mm);
    for (const auto& [from, to] : {std::pair<Point2, Point2>{{1, 1}, {25, 5}},
                                   {{1, 1}, {5, 5}},
                                   {{15, 5}, {1, 1}},
                                   {{1, 1}, {15, 5}},
                                   {{15, 1}, {15, 5}}}) {
        const Travel travel = detours.way(from, to);
        CHECK(travel.crosses);
        CHECK(travel.via.empty());
    }
    CHECK(!detours.way({1, 5}, {9, 5}).crosses);
    CHECK(!detours.way({1, 5}, {1, 5}).crosses);
}

TEST_CASE("detour 1: from the boundary to the boundary, along edges and from corners") {
    const Contours region{
        comb(3),
    };
    const Detours detours(region, infill_allowed_mm, any_length_mm);
    const Path path = comb(3);
    std::vector<Point2> places;
    Point2 start = path.start;
    for (const Segment& segment : path.segments) {
        for (const double share : {0.0, 0.3}) places.push_back(point_at(start, segment, share));
        start = segment.end;
    }
    for (const Point2& from : places) {
        for (const Point2& to : places) {
            const Travel travel = detours.way(from, to);
            CHECK(!travel.crosses);
            check_inside(region, from, travel, to);
        }
    }
    // Around a hole from its wall to its wall.
    const Contours ring{FullCircle{{0, 0}, 20, true}, FullCircle{{0, 0}, 10, false}};
    const Detours around(ring, infill_allowed_mm, any_length_mm);
    for (int i = 1; i < 12; ++i) {
        const Point2 from(10, 0), to(10 * std::cos(i * pi / 6), 10 * std::sin(i * pi / 6));
        const Travel travel = around.way(from, to);
        CHECK(!travel.crosses);
        check_inside(ring, from, travel, to);
        CHECK(length_of(from, travel, to) < 10 * std::min(i, 12 - i) * pi / 6 * 1.02);
    }
}

TEST_CASE("detour: nothing is inside an empty region") {
    CHECK(Detours({}, infill_allowed_mm).way({0, 0}, {1, 1}).crosses);
}
