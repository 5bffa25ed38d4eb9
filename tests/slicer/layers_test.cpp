#include <doctest/doctest.h>

#include <fstream>
#include <thread>

#include "slicer/layers.h"

using namespace lyr;
using namespace lyr::slicer;

TEST_CASE("slicer 3: layers of whole and broken parts of a layer") {
    CHECK(layer_middles(30, 0.2).size() == 150);
    CHECK(layer_middles(19.6, 0.1).size() == 196);
    CHECK(layer_middles(0.3, 0.1).size() == 3);
    CHECK(layer_middles(30.09, 0.2).size() == 150);
    CHECK(layer_middles(30.11, 0.2).size() == 151);
    CHECK(layer_middles(0.05, 0.2).empty());
    const auto middles = layer_middles(1, 0.2);
    CHECK(middles.front() == doctest::Approx(0.1));
    CHECK(middles.back() == doctest::Approx(0.9));
}

TEST_CASE("slicer 2: work on any number of threads is taken in order") {
    for (const unsigned threads : {1u, 2u, 7u}) {
        std::vector<std::size_t> taken;
        const bool all = in_order(
            500, threads, [](std::size_t i) { return i * i; },
            [&](std::size_t i, std::size_t square) {
                CHECK(square == i * i);
                taken.push_back(i);
                return true;
            });
        CHECK(all);
        REQUIRE(taken.size() == 500);
        for (std::size_t i = 0; i < taken.size(); ++i) CHECK(taken[i] == i);
        CHECK(!in_order(
            500, threads, [](std::size_t i) { return i; },
            [](std::size_t i, std::size_t) { return i < 100; }));
    }
}

TEST_CASE("slicer: heights are read line by line and a wrong one is named with its line") {
    const std::string path = std::string(LYR_BUILD) + "/heights.txt";
    std::ofstream(path) << "# heights\n1.5\n\n  -2e-3\t\r\n7\n";
    const auto good = read_heights(path);
    REQUIRE(good);
    CHECK(*good == std::vector<double>{1.5, -0.002, 7});
    std::ofstream(path) << "1\n2 mm\n";
    const auto bad = read_heights(path);
    REQUIRE(!bad);
    CHECK(bad.error().where.line == 2);
    CHECK(!read_heights(path + ".missing"));
}
