// Layers that are too quick.

#include "slicer/cooling.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace lyr::slicer;

namespace {

constexpr double least_speed_mm_s = 15;

std::vector<Timed> slowed(std::vector<Timed> pieces, double factor) {
    for (Timed& piece : pieces)
        piece.speed_mm_s =
            std::max(std::min(piece.speed_mm_s, least_speed_mm_s), piece.speed_mm_s * factor);
    return pieces;
}

}  // namespace

TEST_CASE("cooling: a layer takes the time asked for, or its least speeds") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> length(0.1, 200), speed(5, 120), share(0.05, 1.5);
    for (int i = 0; i < 500; ++i) {
        CAPTURE(i);
        std::vector<Timed> pieces;
        for (int k = 0; k <= i % 12; ++k) pieces.push_back({length(random), speed(random)});
        const double own_s = time_s(pieces), asked_s = own_s / share(random);
        const double most_s = time_s(slowed(pieces, 0));
        const double factor = slowing(pieces, asked_s, least_speed_mm_s);
        CHECK(factor > 0);
        CHECK(factor <= 1);
        CHECK(time_s(slowed(pieces, factor)) ==
              doctest::Approx(std::clamp(asked_s, own_s, std::max(own_s, most_s))));
    }
}

TEST_CASE("cooling: layers with slow walls were not slowed down to the time asked for") {
    // The walls come to the least speed, and the fill has to give the rest.
    const std::vector<Timed> pieces{{60, 30}, {100, 80}};
    const double factor = slowing(pieces, 8, least_speed_mm_s);
    CHECK(time_s(slowed(pieces, factor)) == doctest::Approx(8));
    CHECK(slowed(pieces, factor)[0].speed_mm_s == least_speed_mm_s);
    CHECK(slowed(pieces, factor)[1].speed_mm_s == doctest::Approx(25));
}

TEST_CASE("cooling: nothing to print, or as slow as asked for") {
    CHECK(slowing({}, 10, least_speed_mm_s) <= 1);
    CHECK(slowing(std::vector<Timed>{{100, 10}}, 10, least_speed_mm_s) == 1);
    CHECK(slowing(std::vector<Timed>{{100, 10}}, 0, least_speed_mm_s) == 1);
}
