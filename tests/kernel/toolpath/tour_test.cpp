// Tours of random stops beside the shortest ones, where these can be found, and beside lower bounds.

#include "kernel/toolpath/tour.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "kernel/region/regions.h"
#include "kernel/toolpath/point_tree.h"
#include "kernel/toolpath/sizes.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

using Stops = std::vector<Stop>;

// Half of them closed, or all.
Stops random_stops(Random& random, int count, double size_mm, bool all_closed = false) {
    Stops stops;
    for (int i = 0; i < count; ++i) {
        const Point2 first(random.within(0, size_mm), random.within(0, size_mm));
        const Vector2 way(random.within(-1, 1), random.within(-1, 1));
        const bool closed = all_closed || random.coin();
        stops.push_back({first, closed ? first : Point2(first + 0.15 * size_mm * way)});
    }
    return stops;
}

double tour_mm(const Stops& stops, const Point2& from = origin) {
    return travel_mm(stops, tour(stops, from), from);
}

bool is_complete(const Stops& stops, const std::vector<Visit>& visits) {
    std::vector<bool> seen(stops.size());
    for (const Visit& visit : visits) {
        if (visit.index >= stops.size() || seen[visit.index]) return false;
        if (visit.reversed && is_closed(stops[visit.index])) return false;
        seen[visit.index] = true;
    }
    return visits.size() == stops.size();
}

// The shortest of all tours.
double shortest_mm(const Stops& stops, const Point2& head, std::vector<bool>& seen) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < stops.size(); ++i) {
        if (seen[i]) continue;
        seen[i] = true;
        const Stop& stop = stops[i];
        least = std::min(least, (stop.first - head).norm() + shortest_mm(stops, stop.last, seen));
        if (!is_closed(stop)) {
            least =
                std::min(least, (stop.last - head).norm() + shortest_mm(stops, stop.first, seen));
        }
        seen[i] = false;
    }
    return std::isfinite(least) ? least : 0;
}

double nearest_first_mm(const Stops& stops, Point2 head) {
    std::vector<bool> seen(stops.size());
    double travel = 0;
    for (std::size_t step = 0; step < stops.size(); ++step) {
        double least = std::numeric_limits<double>::infinity();
        std::size_t best = 0;
        Point2 left = head;
        for (std::size_t i = 0; i < stops.size(); ++i) {
            if (seen[i]) continue;
            for (const bool reversed : {false, true}) {
                const Point2& entry = reversed ? stops[i].last : stops[i].first;
                if ((entry - head).norm() >= least) continue;
                least = (entry - head).norm();
                best = i;
                left = reversed ? stops[i].first : stops[i].last;
            }
        }
        seen[best] = true;
        travel += least;
        head = left;
    }
    return travel;
}

struct Tree {
    double length_mm = 0;
    std::vector<int> degree{};
};

// The shortest tree that connects all points, a link being longer by the weights of its ends.
Tree shortest_tree(const std::vector<Point2>& points, const std::vector<double>& weight) {
    const std::size_t count = points.size();
    Tree tree{0, std::vector<int>(count)};
    std::vector<double> near(count, std::numeric_limits<double>::infinity());
    std::vector<std::size_t> parent(count), rest(count - 1);
    std::iota(rest.begin(), rest.end(), std::size_t{1});
    for (std::size_t last = 0; !rest.empty();) {
        for (const std::size_t i : rest) {
            const double away = (points[i] - points[last]).norm() + weight[i] + weight[last];
            if (away >= near[i]) continue;
            near[i] = away;
            parent[i] = last;
        }
        const auto next = std::min_element(rest.begin(), rest.end(),
                                           [&](auto a, auto b) { return near[a] < near[b]; });
        last = *next;
        rest.erase(next);
        tree.length_mm += near[last];
        ++tree.degree[last];
        ++tree.degree[parent[last]];
    }
    return tree;
}

// A tour of points that starts at the head is a tree in which each has two links, if one counts the head's and one
// without length at its end. So no tour is shorter than the shortest tree with two such links, however the points are
// weighted (Held and Karp).
double tree_bound_mm(const std::vector<Point2>& points, const Point2& head) {
    std::vector<double> weight(points.size(), 0.0);
    double best = 0, step = 2;
    for (int round = 0; round < 250; ++round, step *= 0.98) {
        Tree tree = shortest_tree(points, weight);
        std::size_t first = 0, last = 0;
        const auto first_mm = [&](std::size_t i) { return (points[i] - head).norm() + weight[i]; };
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (first_mm(i) < first_mm(first)) first = i;
            if (weight[i] < weight[last]) last = i;
        }
        ++tree.degree[first];
        ++tree.degree[last];
        const double twice = 2 * std::accumulate(weight.begin(), weight.end(), 0.0);
        best = std::max(best, tree.length_mm + first_mm(first) + weight[last] - twice);
        for (std::size_t i = 0; i < points.size(); ++i) weight[i] += step * (tree.degree[i] - 2);
    }
    return best;
}

}  // namespace

TEST_CASE("tour 1: every stop is visited once") {
    Random random(1);
    for (int i = 0; i < 200; ++i) {
        Stops stops = random_stops(random, random.whole(0, 40), 100);
        for (Stop& stop : stops) {
            stop.island = static_cast<std::uint32_t>(random.whole(0, 3));
            stop.stage = static_cast<std::uint32_t>(random.whole(0, 2));
        }
        CHECK(is_complete(stops, tour(stops, {random.within(-10, 110), 5})));
    }
}

TEST_CASE(
    "tour: as short as the shortest for up to seven stops, but for half a percent on average") {
    Random random(2);
    double sum = 0, worst = 1;
    constexpr int rounds = 60;
    for (int i = 0; i < rounds; ++i) {
        const Stops stops = random_stops(random, random.whole(2, 6) + i % 2, 100);
        std::vector<bool> seen(stops.size());
        const double ratio = tour_mm(stops) / shortest_mm(stops, origin, seen);
        CHECK(ratio >= 1 - 1e-12);
        sum += ratio;
        worst = std::max(worst, ratio);
    }
    CHECK(sum / rounds < 1.005);
    CHECK(worst < 1.05);
}

TEST_CASE("tour 3: never longer than always going to the nearest end") {
    Random random(3);
    for (int i = 0; i < 100; ++i) {
        const Stops stops = random_stops(random, random.whole(1, 120), 100);
        CHECK(tour_mm(stops) <= nearest_first_mm(stops, origin) * (1 + 1e-12));
    }
}

TEST_CASE("tour: 200 random points are within 5 % of a lower bound") {
    Random random(4);
    for (int i = 0; i < 3; ++i) {
        const Stops stops = random_stops(random, 200, 100, true);
        std::vector<Point2> points;
        for (const Stop& stop : stops) points.push_back(stop.first);
        const double ratio = tour_mm(stops) / tree_bound_mm(points, origin);
        CHECK(ratio >= 1);
        CHECK(ratio < 1.05);
    }
}

TEST_CASE("tour: a grid of points, whose shortest tour is known") {
    Stops stops;
    for (int x = 0; x < 15; ++x) {
        for (int y = 0; y < 14; ++y) stops.push_back({Point2(x, y), Point2(x, y)});
    }
    // Every step is 1, the first nothing.
    const double best = static_cast<double>(stops.size()) - 1;
    CHECK(tour_mm(stops) >= best - 1e-9);
    CHECK(tour_mm(stops) < 1.05 * best);
}

TEST_CASE("tour: lines side by side are run to and fro") {
    Stops stops;
    for (int i = 0; i < 40; ++i) stops.push_back({Point2(0, 0.4 * i), Point2(30, 0.4 * i)});
    Random random(5);
    for (std::size_t i = stops.size() - 1; i > 0; --i)
        std::swap(stops[i], stops[static_cast<std::size_t>(random.whole(0, static_cast<int>(i)))]);
    CHECK(tour_mm(stops) == doctest::Approx(39 * 0.4));
}

TEST_CASE("tour: turned, mirrored and moved stops have as long a tour") {
    Random random(6);
    for (int i = 0; i < 30; ++i) {
        const Stops stops = random_stops(random, random.whole(5, 80), 100);
        const Motion motion{random.within(-3, 3), {random.within(-200, 200), 50}, random.coin()};
        Stops other = stops;
        for (Stop& stop : other)
            stop = {motion(stop.first), is_closed(stop) ? motion(stop.first) : motion(stop.last)};
        CHECK(tour_mm(other, motion(origin)) == doctest::Approx(tour_mm(stops)).epsilon(1e-9));
    }
}

TEST_CASE("tour 4: the same stops have the same tour") {
    Random random(7);
    const Stops stops = random_stops(random, 150, 100);
    CHECK(tour(stops, origin) == tour(stops, origin));
}

TEST_CASE("tour 2: islands come together, stages in their order") {
    Random random(8);
    for (int i = 0; i < 50; ++i) {
        Stops stops = random_stops(random, 60, 100);
        for (Stop& stop : stops) {
            stop.island = static_cast<std::uint32_t>(stop.first.x() / 25);
            stop.stage = static_cast<std::uint32_t>(random.whole(0, 2));
        }
        std::vector<bool> left(5);
        const Stop* before = nullptr;
        for (const Visit& visit : tour(stops, origin)) {
            const Stop& stop = stops[visit.index];
            if (before && before->island != stop.island) left[before->island] = true;
            CHECK(!left[stop.island]);
            if (before && before->island == stop.island) CHECK(before->stage <= stop.stage);
            before = &stop;
        }
    }
}

TEST_CASE("tour: a row of islands is gone along once") {
    Stops stops;
    for (std::uint32_t island = 0; island < 8; ++island) {
        const std::uint32_t at = (island * 5) % 8;
        for (const double y : {0.0, 1.0, 2.0})
            stops.push_back({Point2(20 * at, y), Point2(20 * at, y), island, y > 1 ? 1u : 0u});
    }
    CHECK(tour_mm(stops, {-1, 0}) < 7 * 20 + 8 * 5);
}

TEST_CASE("tour: the island that the head is at comes first, though its middle is far away") {
    Stops stops;
    for (int i = 0; i < 40; ++i) stops.push_back({Point2(2 * i, 0), Point2(2 * i, 1), 0});
    for (int i = 0; i < 3; ++i) stops.push_back({Point2(70 + i, 9), Point2(70 + i, 10), 1});
    const std::vector<Visit> visits = tour(stops, {-1, 0});
    CHECK(stops[visits.front().index].island == 0);
}

TEST_CASE("tour: many stops in one place, and none") {
    CHECK(tour({}, origin).empty());
    const Stops same(50, Stop{{1, 1}, {1, 1}});
    CHECK(is_complete(same, tour(same, origin)));
    CHECK(tour_mm(same) == doctest::Approx(std::sqrt(2.0)));
}

TEST_CASE("point tree: finds the nearest of those that are left") {
    Random random(9);
    for (const int count : {0, 1, 6, 7, 200}) {
        std::vector<Point2> points;
        for (int i = 0; i < count; ++i)
            points.emplace_back(random.whole(0, 20), random.within(0, 20));
        PointTree tree(points);
        std::vector<bool> removed(points.size());
        std::vector<PointTree::Found> found;
        for (int i = 0; i < 100; ++i) {
            const Point2 place(random.whole(-5, 25), random.within(-5, 25));
            std::vector<std::uint32_t> expected;
            for (std::uint32_t k = 0; k < points.size(); ++k)
                if (!removed[k]) expected.push_back(k);
            const auto square = [&](std::uint32_t k) { return (points[k] - place).squaredNorm(); };
            std::stable_sort(expected.begin(), expected.end(),
                             [&](auto a, auto b) { return square(a) < square(b); });
            expected.resize(std::min<std::size_t>(expected.size(), 9));
            tree.nearest(place, 9, found);
            REQUIRE(found.size() == expected.size());
            for (std::size_t k = 0; k < found.size(); ++k) CHECK(found[k].index == expected[k]);
            if (!expected.empty()) {
                tree.remove(expected.back());
                removed[expected.back()] = true;
            }
        }
    }
}
