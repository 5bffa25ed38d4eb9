#include "kernel/contour/contour.h"

#include <doctest/doctest.h>

#include <numbers>

using namespace lyr;

namespace {

using std::numbers::pi;
constexpr double allowed_mm = 1e-4;

Path square() {
    return {{0, 0}, {{{4, 0}}, {{4, 4}}, {{0, 4}}, {{0, 0}}}};
}

Point2 on(double angle) {
    return {5 + 3 * std::cos(angle), -2 + 3 * std::sin(angle)};
}

Path circle_in(const std::vector<double>& cuts, double turn) {
    Path path{on(turn * cuts.front()), {}};
    for (std::size_t i = 1; i <= cuts.size(); ++i) {
        const double from = cuts[i - 1];
        const double to = i < cuts.size() ? cuts[i] : cuts.front() + 2 * pi;
        path.segments.push_back(arc_with_sweep(on(turn * from), on(turn * to), turn * (to - from)));
    }
    path.segments.back().end = path.start;
    return path;
}

}  // namespace

TEST_CASE("contour 3: area and length of lines and arcs") {
    CHECK(area_mm2(square()) == doctest::Approx(16));
    CHECK(length_mm(Contour(square())) == doctest::Approx(16));
    CHECK(area_mm2(FullCircle{{7, 7}, 2, true}) == doctest::Approx(4 * pi));
    CHECK(area_mm2(FullCircle{{7, 7}, 2, false}) == doctest::Approx(-4 * pi));
    CHECK(area_mm2(circle_in({0, 1, 3}, 1)) == doctest::Approx(9 * pi));
    CHECK(area_mm2(circle_in({0, 1, 3}, -1)) == doctest::Approx(-9 * pi));
}

TEST_CASE("contour 4: arcs of one circle become one circle, whichever way and however cut") {
    for (const auto& cuts : std::vector<std::vector<double>>{
             {0, pi}, {0.3, 0.4, 3}, {1, 2, 2.5, 4, 5, 6}, {0, 1e-3}, {0.5, 6.0}}) {
        for (const double turn : {1.0, -1.0}) {
            const auto result = simplified(circle_in(cuts, turn), allowed_mm);
            REQUIRE(result);
            const auto* circle = std::get_if<FullCircle>(&*result);
            REQUIRE(circle);
            CHECK((circle->centre - Point2(5, -2)).norm() < 1e-9);
            CHECK(circle->radius_mm == doctest::Approx(3).epsilon(1e-9));
            CHECK(circle->counter_clockwise == (turn > 0));
        }
    }
}

TEST_CASE("contour 4: lines in line become one, also over the path's start") {
    const Path cut{{2, 0}, {{{3, 0}}, {{4, 0}}, {{4, 4}}, {{1, 4}}, {{0, 4}}, {{0, 0}}, {{2, 0}}}};
    const auto result = simplified(cut, allowed_mm);
    REQUIRE(result);
    CHECK(count(*result).lines == 4);
    CHECK(area_mm2(*result) == doctest::Approx(16));
    const Path& path = std::get<Path>(*result);
    CHECK((path.segments.back().end - path.start).norm() == 0);
}

TEST_CASE("contour 4: a fillet cut in two is one arc; arcs of different circles stay") {
    const double h = 1 / std::sqrt(2.0);
    Path path{{4, 0}, {}};
    path.segments.push_back(arc_with_sweep({4, 0}, {4 + h, 1 - h}, pi / 4));
    path.segments.push_back(arc_with_sweep({4 + h, 1 - h}, {5, 1}, pi / 4));
    path.segments.push_back(arc_with_sweep({5, 1}, {3, 3}, pi / 2));
    path.segments.push_back({{0, 3}});
    path.segments.push_back({{0, 0}});
    path.segments.push_back({{4, 0}});
    const auto result = simplified(path, allowed_mm);
    REQUIRE(result);
    CHECK(count(*result).arcs == 2);
    CHECK(count(*result).lines == 3);
    CHECK(area_mm2(*result) == doctest::Approx(area_mm2(path)));
}

TEST_CASE("contour 4: what encloses nothing is none") {
    CHECK(!simplified(Path{{1, 1}, {{{1 + 1e-9, 1}}, {{1, 1}}}}, allowed_mm));
    CHECK(!simplified(Path{{1, 1}, {{{5, 1}}, {{1, 1}}}}, allowed_mm));
    CHECK(!simplified(Path{{1, 1}, {}}, allowed_mm));
}
