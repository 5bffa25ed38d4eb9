// Strings; numbers in brackets are those of the contract in text.h.

#include <algorithm>
#include <vector>

#include "parser/part21/decode_all.h"
#include "parser/part21/step_text.h"
#include "parser/part21/text.h"

namespace lyr::part21 {
namespace {

// By way of a whole file, so that the indexer sees the string too.
std::string decoded(const std::string& content) {
    const File file = with_instances("#1=A('" + content + "',7);\n#2=B();");
    REQUIRE(file.instance_count() == 2);
    const auto arguments = file.arguments(file.find(1));
    REQUIRE(arguments.ok());
    REQUIRE(arguments->count() == 2);
    CHECK(*(*arguments)[1].as_integer() == 7);
    const auto text = (*arguments)[0].as_string();
    return text ? *text : "error: " + text.error().message;
}

TEST_CASE("plain strings, and what in them looks like structure") {
    CHECK(decoded("") == "");
    CHECK(decoded("plain text") == "plain text");
    CHECK(decoded("a;b") == "a;b");
    CHECK(decoded("/* not a comment */") == "/* not a comment */");
    CHECK(decoded("/*") == "/*");
    CHECK(decoded("*/") == "*/");
    CHECK(decoded("),#3=C(") == "),#3=C(");
    CHECK(decoded("\"quoted\"") == "\"quoted\"");
    CHECK(decoded("ENDSEC;") == "ENDSEC;");
}

TEST_CASE("quotes and backslashes [2]") {
    CHECK(decoded("it''s") == "it's");
    CHECK(decoded("''") == "'");
    CHECK(decoded("''''") == "''");
    CHECK(decoded("a\\\\b") == "a\\b");
    CHECK(decoded("\\\\") == "\\");
    CHECK(decoded("\\\\S\\\\") == "\\S\\");
}

TEST_CASE("one byte by number, \\X\\ [2]") {
    CHECK(decoded("caf\\X\\E9") == "caf\xC3\xA9");
    CHECK(decoded("\\X\\41\\X\\7a") == "Az");
    CHECK(decoded("\\X\\00") == std::string(1, '\0'));
    CHECK(decoded("\\X\\27") == "'");
}

TEST_CASE("wide characters, \\X2\\ and \\X4\\ [2]") {
    CHECK(decoded("\\X2\\03C0\\X0\\=3") == "\xCF\x80=3");
    CHECK(decoded("\\X2\\03B103B2\\X0\\") == "\xCE\xB1\xCE\xB2");
    CHECK(decoded("\\X2\\4e2d\\X0\\") == "\xE4\xB8\xAD");
    CHECK(decoded("\\X2\\D83DDE00\\X0\\") == "\xF0\x9F\x98\x80");
    CHECK(decoded("\\X4\\0001F600\\X0\\") == "\xF0\x9F\x98\x80");
    CHECK(decoded("\\X4\\00000041000000E9\\X0\\!") == "A\xC3\xA9!");
    CHECK(decoded("\\X2\\\\X0\\") == "");
}

TEST_CASE("alphabets, \\S\\ and \\P?\\ [2]") {
    CHECK(decoded("\\S\\i") == "\xC3\xA9");                      // 8859-1: e acute
    CHECK(decoded("\\PB\\\\S\\1") == "\xC4\x85");                // 8859-2: a ogonek
    CHECK(decoded("\\PE\\\\S\\0\\S\\1") == "\xD0\x90\xD0\x91");  // 8859-5: Cyrillic A, B
    CHECK(decoded("\\PG\\\\S\\p") == "\xCF\x80");                // 8859-7: pi
    CHECK(decoded("\\PH\\\\S\\`") == "\xD7\x90");                // 8859-8: alef
    CHECK(decoded("\\PI\\\\S\\}") == "\xC4\xB1");                // 8859-9: dotless i
    CHECK(decoded("\\PG\\\\S\\p\\PA\\\\S\\i") == "\xCF\x80\xC3\xA9");
}

TEST_CASE("a quote behind \\S\\ is a character and does not close the string [2]") {
    CHECK(decoded("\\S\\'") == "\xC2\xA7");
    CHECK(decoded("a\\S\\'b") ==
          "a\xC2\xA7"
          "b");
}

TEST_CASE("every alphabet maps each byte once") {
    for (int part = 1; part <= 9; ++part) {
        CAPTURE(part);
        std::vector<char32_t> met;
        for (int i = 0; i < 96; ++i) {
            const char32_t c = latin_character(part, i);
            if (c == 0) continue;
            CHECK(std::find(met.begin(), met.end(), c) == met.end());
            met.push_back(c);
        }
        CHECK(met.size() > 40);
        CHECK(latin_character(part, 0) == 0xA0);  // the hard space is everywhere
    }
}

TEST_CASE("line breaks and print directives leave nothing [2]") {
    CHECK(decoded("one \ntwo") == "one two");
    CHECK(decoded("one \r\n two") == "one  two");
    CHECK(decoded("a\\N\\b\\F\\c") == "abc");
    CHECK(decoded("wrapped\n #12 is not a start of an instance") ==
          "wrapped #12 is not a start of an instance");
}

TEST_CASE("bytes beyond ASCII are UTF-8 where they can be, else ISO 8859-1 [3]") {
    CHECK(decoded("\xC3\xA9") == "\xC3\xA9");
    CHECK(decoded("\xE9") == "\xC3\xA9");
    CHECK(decoded("\xE4\xB8\xAD") == "\xE4\xB8\xAD");
    CHECK(decoded("\xF0\x9F\x98\x80") == "\xF0\x9F\x98\x80");
    CHECK(decoded("\xC0\x80") == "\xC3\x80\xC2\x80");                          // overlong
    CHECK(decoded("\xED\xA0\x80") == "\xC3\xAD\xC2\xA0\xC2\x80");              // a surrogate
    CHECK(decoded("\xF4\x90\x80\x80") == "\xC3\xB4\xC2\x90\xC2\x80\xC2\x80");  // beyond U+10FFFF
}

TEST_CASE("a lone backslash stands for itself, as in Windows paths [4]") {
    CHECK(decoded("C:\\Users\\me\\part.stp") == "C:\\Users\\me\\part.stp");
    CHECK(decoded("C:\\Parts\\X2 part") == "C:\\Parts\\X2 part");
    CHECK(decoded("end\\") == "end\\");
}

TEST_CASE("an escape with missing or wrong digits is an error [4]") {
    for (const char* content : {"\\X\\G0", "\\X\\1", "\\X2\\03C\\X0\\", "\\X2\\03C0",
                                "\\X2\\D83D\\X0\\", "\\X2\\DE00\\X0\\", "\\X4\\00110000\\X0\\",
                                "\\X4\\0001F60\\X0\\", "\\X4\\0000D800\\X0\\", "\\PC\\\\S\\%"}) {
        CAPTURE(content);
        CHECK(decoded(content).starts_with(
            "error: A argument 1: expected a string with well-formed"));
        const Text text = decode_text(content);
        CHECK(text.malformed);
        CHECK(text.utf8.find("\xEF\xBF\xBD") != std::string::npos);
    }
}

}  // namespace
}  // namespace lyr::part21
