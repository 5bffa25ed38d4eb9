#include "base/diagnostic.h"

#include <doctest/doctest.h>

#include "base/typed_index.h"

using namespace lyr;

TEST_CASE("diagnostic 3: one line with every part of the place that is known") {
    CHECK(to_string({Severity::error,
                     ExitStatus::input,
                     "expected ';'",
                     {.file = "a.step", .line = 3, .column = 14, .entity = 12}}) ==
          "a.step:3:14: error: #12: expected ';'");
    CHECK(to_string({Severity::warning, ExitStatus::geometry, "gap", {.file = "a.step"}}) ==
          "a.step: warning: gap");
    CHECK(to_string({Severity::note,
                     ExitStatus::ok,
                     "healed",
                     {.entity = 7, .layer = 4, .x_mm = 1.25, .z_mm = -0.5}}) ==
          "note: #7: healed (at layer 4 x=1.250 z=-0.500)");
    CHECK(to_string({Severity::error, ExitStatus::usage, "no", {}}) == "error: no");
}

TEST_CASE("diagnostic 3: control bytes of the input do not reach the terminal") {
    CHECK(to_string({Severity::error,
                     ExitStatus::input,
                     "found \"\x1b[2J\"",
                     {.file = "a\nb.step", .line = 3}}) ==
          "a\\nb.step:3: error: found \"\\x1b[2J\"");
}

TEST_CASE("diagnostic 1: a result is a value or an error") {
    const Result<int> value = 5;
    CHECK(value.ok());
    CHECK(*value == 5);
    const Result<int> error = Diagnostic{Severity::error, ExitStatus::output, "full", {}};
    CHECK(!error);
    CHECK(error.error().status == ExitStatus::output);
}

TEST_CASE("diagnostic: what a temporary result holds outlives it") {
    const auto letters = [](bool good) -> Result<std::vector<std::string>> {
        if (!good) return Diagnostic{Severity::error, ExitStatus::input, std::string(100, 'e'), {}};
        return std::vector<std::string>{std::string(100, 'a'), std::string(100, 'b')};
    };
    std::string all;
    for (const std::string& letter : *letters(true)) all += letter;
    CHECK(all == std::string(100, 'a') + std::string(100, 'b'));
    const auto& held = letters(true).value();
    CHECK(held.size() == 2);
    const Diagnostic& error = letters(false).error();
    CHECK(error.message == std::string(100, 'e'));
}

TEST_CASE("typed index: none by default, ordered by value") {
    using Id = TypedIndex<struct Tag>;
    CHECK(!Id{}.valid());
    CHECK(Id{3}.valid());
    CHECK(Id{3} < Id{4});
    CHECK(Id{3} == Id{3});
}
