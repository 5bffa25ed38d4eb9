// Numbers; numbers in brackets are those of the contract in number.h.

#include <array>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>

#include "parser/part21/number.h"
#include "parser/part21/step_text.h"

namespace lyr::part21 {
namespace {

std::string verdict(const std::string& token, double& number) {
    const auto file = File::parse("test.stp", step("#1=A(" + token + ");"));
    REQUIRE(file.ok());
    const auto arguments = file->arguments(InstanceIndex(0));
    if (!arguments) return arguments.error().message;
    const auto real = (*arguments)[0].as_real();
    if (!real) return real.error().message;
    number = *real;
    return "";
}

double real(const std::string& token) {
    double number = std::numeric_limits<double>::quiet_NaN();
    CHECK(verdict(token, number) == "");
    return number;
}

TEST_CASE("forms of reals that are read [3]") {
    CHECK(real("1.") == 1.0);
    CHECK(real("-1.E-3") == -1e-3);
    CHECK(real("+1.5E+2") == 150.0);
    CHECK(real("1.5E2") == 150.0);
    CHECK(real("25") == 25.0);
    CHECK(real("1e5") == 1e5);
    CHECK(real("1E5") == 1e5);
    CHECK(real(".5") == 0.5);
    CHECK(real("-.5E1") == -5.0);
    CHECK(real("1.0D0") == 1.0);
    CHECK(real("-2.5d-3") == -2.5e-3);
    CHECK(real("0.") == 0.0);
    CHECK(std::signbit(real("-0.")));
    CHECK(real("00012.50") == 12.5);
}

TEST_CASE("reals are the nearest double, whatever the digits [2]") {
    std::mt19937_64 random(20);
    for (int i = 0; i < 20000; ++i) {
        const double value = std::bit_cast<double>(random());
        if (!std::isfinite(value)) continue;
        char text[64];
        std::snprintf(text, sizeof text, "%.*E", i % 2 ? 16 : 20, value);
        const auto read = real_of(text);
        REQUIRE(read);
        CHECK(std::bit_cast<std::uint64_t>(*read) == std::bit_cast<std::uint64_t>(value));
    }
    // Half-way between two doubles: to even; a digit beyond: up.
    CHECK(real("9007199254740993.") == 9007199254740992.0);
    CHECK(real("9007199254740993.00000000000000000000000000000001") == 9007199254740994.0);
    CHECK(real("0.1") == 0.1);
    CHECK(real("0." + std::string(400, '0') + "1E401") == 1.0);
    CHECK(real("1" + std::string(400, '0') + ".E-400") == 1.0);
}

TEST_CASE("a real out of range is an error, one too small is zero [2]") {
    double ignored = 0;
    for (const char* token : {"1e999", "-1.E309", "1.8E308", "1.E99999999999999999999", "12D400"}) {
        CAPTURE(token);
        CHECK(verdict(token, ignored) ==
              "A argument 1: expected a number below 1.8e308, found " + std::string(token));
    }
    CHECK(verdict("1" + std::string(400, '0') + ".", ignored) != "");
    CHECK(real("1.7976931348623157E308") == std::numeric_limits<double>::max());
    CHECK(real("1e-999") == 0.0);
    CHECK(real("1.E-99999999999999999999") == 0.0);
    CHECK(std::signbit(real("-1e-999")));
    CHECK(real("0.E99999999999999999999") == 0.0);
    CHECK(real("4.9406564584124654E-324") == std::numeric_limits<double>::denorm_min());
    CHECK(real("2.5E-324") == std::numeric_limits<double>::denorm_min());
    CHECK(real("0." + std::string(400, '0') + "1") == 0.0);
}

TEST_CASE("integers: 64 bits and no more [1]") {
    const auto integer = [](const std::string& token) {
        const File file = with_instances("#1=A(" + token + ");");
        const auto arguments = file.arguments(InstanceIndex(0));
        REQUIRE(arguments.ok());
        const auto result = (*arguments)[0].as_integer();
        return result ? std::to_string(*result) : result.error().message;
    };
    CHECK(integer("0") == "0");
    CHECK(integer("-12") == "-12");
    CHECK(integer("+12") == "12");
    CHECK(integer("007") == "7");
    CHECK(integer("9223372036854775807") == "9223372036854775807");
    CHECK(integer("-9223372036854775808") == "-9223372036854775808");
    CHECK(integer("9223372036854775808") ==
          "A argument 1: expected an integer of at most 64 bits, found 9223372036854775808");
    CHECK(integer("5.") == "A argument 1: expected an integer, found 5.");
}

TEST_CASE("what is no number is an error") {
    double ignored = 0;
    for (const char* token : {"1.#IND", "-1.#INF", "nan", "-inf", "1.E", "1.E+", "-", "+", ".",
                              "-.", "1,5.6.7", "0x10", "1 2", "--1", "1.5.2", "1E5.5", "1_000"}) {
        CAPTURE(token);
        CHECK(verdict(token, ignored) != "");
    }
}

}  // namespace
TEST_CASE(
    "plain reals: what is written plainly reads as the general way reads it, all else is left to "
    "that") {
    std::array<double, 3> values{};
    const auto read = [&](const std::string& text) {
        return plain_reals(text.data(), text.data() + text.size(), values);
    };
    CHECK(read("('',(1.,-2.5E-3,.5));") == 3);
    CHECK(values == std::array<double, 3>{1, -2.5e-3, 0.5});
    CHECK(read("( 'it''s' /* c */ ,\n( 7 ,\t1e3 ) ) ;") == 2);
    CHECK(values[0] == 7);
    CHECK(values[1] == 1000);
    for (const char* other : {"",
                              "(",
                              "(''",
                              "('',",
                              "('',(",
                              "('',(1.",
                              "('',(1.)",
                              "('',(1.))",
                              "('',(1.,))",
                              "('',());",
                              "($,(1.));",
                              "('',(1.,2.,3.,4.));",
                              "('',(+1.));",
                              "('',(1D5));",
                              "('',(1.E));",
                              "('',(1.5.2));",
                              "('',(-inf));",
                              "('',(-nan(0)));",
                              "('',(inf));",
                              "('',(1e999));",
                              "('',(#5));",
                              "('',(1.),2);",
                              "('',(1. 2.));",
                              "('open,(1.));",
                              "('',((1.)));"}) {
        CAPTURE(other);
        CHECK_FALSE(read(other));
    }
}

}  // namespace lyr::part21
