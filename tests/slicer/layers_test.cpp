#include "slicer/layers.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <new>

#include "scratch.h"

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

TEST_CASE("slicer: what a thread throws is thrown on, on any number of threads") {
    for (const unsigned threads : {1u, 2u, 7u, 1024u}) {
        std::atomic<int> made = 0;
        CHECK_THROWS_AS(in_order(
                            500, threads,
                            [&](std::size_t i) {
                                ++made;
                                if (i % 50 == 49) throw std::bad_alloc();
                                return i;
                            },
                            [](std::size_t, std::size_t) { return true; }),
                        std::bad_alloc);
        CHECK(made >= 1);
        CHECK(made <= 500);
    }
}

TEST_CASE("slicer: heights are read line by line and a wrong one is named with its line") {
    const std::string path = lyr::tests::scratch("heights.txt");
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

TEST_CASE("slicer: the bytes of a wrong height do not reach the terminal, nor all of a long line") {
    const std::string path = lyr::tests::scratch("heights.txt");
    for (const std::string& line :
         {std::string("\x1b]0;title\x07"), std::string(1'000'000, '\xff'), std::string("nan"),
          std::string("1e999"), std::string(1, '\0')}) {
        std::ofstream(path, std::ios::binary) << line << '\n';
        const auto bad = read_heights(path);
        REQUIRE(!bad);
        CHECK(bad.error().where.line == 1);
        CHECK(bad.error().message.size() < 400);
        for (const char c : bad.error().message) CHECK(static_cast<unsigned char>(c) >= 0x20);
    }
}

TEST_CASE("slicer: a report has the heights as short as they read back") {
    CHECK(to_json({.z_mm = 25.4}).starts_with("{\"z\":25.4,"));
    CHECK(to_json({.z_mm = 0.1 + 0.2}).starts_with("{\"z\":0.30000000000000004,"));
    CHECK(to_json({.z_mm = -2e-300}).starts_with("{\"z\":-2e-300,"));
}

TEST_CASE("slicer: a height that is no number has no layers") {
    CHECK(layer_middles(NAN, 0.2).empty());
    CHECK(layer_middles(1, NAN).empty());
}
