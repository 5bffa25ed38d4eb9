#include "base/text.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

using namespace lyr;

TEST_CASE("text: escaped has no control byte and no stray byte, whatever came in") {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> byte(0, 255);
    for (int round = 0; round < 2000; ++round) {
        std::string text;
        for (int i = 0; i < 24; ++i) text += static_cast<char>(byte(random));
        const std::string out = escaped(text);
        for (const char c : out) {
            CHECK(static_cast<unsigned char>(c) >= 0x20);
            CHECK(c != 0x7f);
        }
        // What is left is clean: escaping it again changes nothing.
        CHECK(escaped(out) == out);
    }
}

TEST_CASE("text: escaped leaves what can be shown as it is") {
    const std::string shown = "C:\\parts\\\"Getriebe\" \xc3\xbc \xe2\x82\xac \xf0\x9f\x94\xa7";
    CHECK(escaped(shown) == shown);
    CHECK(escaped("") == "");
    CHECK(escaped("a\n\t\r") == "a\\n\\t\\r");
    CHECK(escaped("\x1b[31m") == "\\x1b[31m");
    CHECK(escaped(std::string_view("\0", 1)) == "\\x00");
    CHECK(escaped("\xc2\x9b") == "\\xc2\\x9b");           // CSI as a character
    CHECK(escaped("\xe9t\xe9") == "\\xe9t\\xe9");         // Latin-1
    CHECK(escaped("\xe0\x82\x9b") == "\\xe0\\x82\\x9b");  // longer than it need be
    CHECK(escaped("\xed\xa0\x80") == "\\xed\\xa0\\x80");  // half of a pair of UTF-16
    CHECK(escaped("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");
    CHECK(escaped("\xf4\x8f\xbf\xbd") == "\xf4\x8f\xbf\xbd");
    CHECK(escaped("\xe2\x82") == "\\xe2\\x82");  // cut short
}

TEST_CASE("text: in_quotes is bounded and never cuts a character") {
    CHECK(in_quotes("12 mm") == "\"12 mm\"");
    std::string text;
    for (int i = 0; i < 1000; ++i) text += "\xe2\x82\xac";
    for (int shift = 0; shift < 3; ++shift) {
        const std::string out = in_quotes(std::string(static_cast<std::size_t>(shift), 'x') + text);
        CHECK(out.size() < 80);
        CHECK(out.ends_with("...\""));
        CHECK(out.find('\\') == std::string::npos);
    }
}

TEST_CASE("text: one is singular") {
    CHECK(counted(0, "section") == "0 sections");
    CHECK(counted(1, "section") == "1 section");
    CHECK(counted(2, "section") == "2 sections");
}

TEST_CASE("text: a finite number is finite, and the whole text") {
    for (const char* good : {"0", "-1.5", "1e-3", ".5", "5.", "1E3"}) CHECK(finite_number(good));
    for (const char* bad : {"", " ", "nan", "-nan", "inf", "-inf", "infinity", "1e400", "0x10",
                            "1 ", " 1", "1,0", "--1", "abc", "1e", "NaN(1)"}) {
        CAPTURE(bad);
        CHECK_FALSE(finite_number(bad));
    }
}

TEST_CASE("text: the shortest form reads back as the same number") {
    CHECK(shortest(25.4) == "25.4");
    CHECK(shortest(0.1 + 0.2) == "0.30000000000000004");
    std::mt19937_64 random(2);
    for (int round = 0; round < 2000; ++round) {
        const double value =
            std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 200) - 100);
        CHECK(std::strtod(shortest(value).c_str(), nullptr) == value);
    }
}

TEST_CASE("text: a number that JSON does not know is null") {
    CHECK(in_json(1.25, 1) == "1.2");
    CHECK(in_json(-0.5, 3) == "-0.500");
    CHECK(in_json(std::numeric_limits<double>::infinity(), 3) == "null");
    CHECK(in_json(std::numeric_limits<double>::quiet_NaN(), 3) == "null");
}
