// Contract of base/nearest_name.h, by number.

#include "base/nearest_name.h"

#include <doctest/doctest.h>

#include <vector>

using lyr::nearest_name;

static const std::vector<std::string> known{"steps_per_mm", "step", "invert", "range_mm", "x", "y"};

TEST_CASE("nearest name 1: the name with the fewest edits, or none") {
    CHECK(nearest_name("steps_per_mn", known) == "steps_per_mm");
    CHECK(nearest_name("stepspermm", known) == "steps_per_mm");
    CHECK(nearest_name("stp", known) == "step");
    CHECK(nearest_name("Invert", known) == "invert");
    CHECK(nearest_name("colour", known).empty());
    CHECK(nearest_name("", known).empty());
    CHECK(nearest_name(std::string(100'000, 'a'), known).empty());
    CHECK(nearest_name("anything", {}).empty());
}

TEST_CASE("nearest name 1: a one-letter name does not stand for another one-letter name") {
    CHECK(nearest_name("q", known).empty());
}

TEST_CASE("nearest name 2: swapped neighbours are one edit") {
    const std::vector<std::string> pair{"abcd", "acbd"};
    CHECK(nearest_name("bacd", pair) == "abcd");
    CHECK(nearest_name("ivnert", known) == "invert");
}
