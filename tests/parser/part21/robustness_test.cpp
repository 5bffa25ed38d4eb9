// Whatever the bytes, reading ends with a file or an error; part21.h, contracts 1 and 2.

#include <random>

#include "parser/part21/decode_all.h"
#include "parser/part21/step_text.h"

namespace lyr::part21 {
namespace {

TEST_CASE("a file cut anywhere is whole, or an error, and never less than whole") {
    const std::string text = step(good_instances);
    const std::size_t data_closed = text.rfind("ENDSEC;") + 7;
    const Decoded whole = decode_all(parsed(text));
    for (std::size_t size = 0; size < text.size(); ++size) {
        CAPTURE(size);
        // In a buffer of exactly this size, so that a sanitizer sees what reads beyond it.
        const auto file = File::parse("test.stp", text.substr(0, size));
        REQUIRE(file.ok() == (size >= data_closed));
        if (!file) {
            CHECK(file.error().message.size() > 10);
            continue;
        }
        CHECK(decode_all(*file) == whole);
        CHECK(file->diagnostics().size() == (size < text.size() - 1));
    }
}

TEST_CASE("a file that starts anywhere is no file") {
    const std::string text = step(good_instances);
    const std::size_t header = text.find("HEADER");
    for (std::size_t start = 1; start < text.size(); ++start) {
        CAPTURE(start);
        CHECK(File::parse("test.stp", text.substr(start)).ok() == (start == 13 || start == header));
        if (start == 13) ++start;
    }
}

// One to four bytes changed, left out or put in.
std::string mutated(std::string text, std::mt19937& random) {
    constexpr std::string_view telling = "'\"()#;,.*$/\\=&!@<>E+-09AZaz_ \n\r\0\x1A\xE9";
    const auto below = [&](std::size_t n) { return random() % n; };
    for (std::size_t i = 0, count = 1 + below(4); i < count; ++i) {
        const std::size_t at = below(text.size());
        const char c = below(2) ? telling[below(telling.size())] : static_cast<char>(random());
        switch (below(5)) {
            case 0:
                text.erase(at, 1 + below(8));
                break;
            case 1:
                text.insert(at, 1, c);
                break;
            case 2:
                text.insert(at, text.substr(below(text.size()), 1 + below(40)));
                break;
            default:
                text[at] = c;
        }
    }
    return text;
}

TEST_CASE("fifty thousand damaged files, and nothing but files and errors") {
    const std::string text = step(good_instances);
    std::mt19937 random(21);
    std::size_t read = 0;
    for (int i = 0; i < 50000; ++i) {
        const auto file = File::parse("test.stp", mutated(text, random));
        if (!file) {
            REQUIRE_FALSE(file.error().message.empty());
            REQUIRE(to_string(file.error()).find('\n') == std::string::npos);
            continue;
        }
        ++read;
        const Decoded decoded = decode_all(*file);
        REQUIRE(decoded.records >= file->instance_count());
        for (const Diagnostic& error : decoded.first_errors) REQUIRE(error.where.line > 0);
    }
    CHECK(read > 1000);
    CHECK(read < 49000);
}

TEST_CASE("the same file renumbered has the same structure") {
    const auto renumbered = [](std::uint64_t factor, std::uint64_t offset) {
        std::string text;
        bool in_string = false;
        for (std::size_t i = 0; i < good_instances.size(); ++i) {
            text += good_instances[i];
            if (good_instances[i] == '\'') in_string = !in_string;
            if (in_string || good_instances[i] != '#') continue;
            std::size_t length = 0;
            text += std::to_string(std::stoull(good_instances.substr(i + 1), &length) * factor +
                                   offset);
            i += length;
        }
        return text;
    };
    const File plain = with_instances(good_instances);
    const Decoded expected = decode_all(plain);
    CHECK(expected.errors == 0);
    for (const auto& [factor, offset] : {std::pair<std::uint64_t, std::uint64_t>{1, 1000},
                                         {1ull << 50, 3},
                                         {10, 637538559},
                                         {7919, 0}}) {
        const File file = with_instances(renumbered(factor, offset));
        CHECK(decode_all(file) == expected);
        REQUIRE(file.instance_count() == plain.instance_count());
        for (std::size_t i = 0; i < file.instance_count(); ++i) {
            CHECK(file.id(InstanceIndex(i)) == plain.id(InstanceIndex(i)) * factor + offset);
            CHECK(file.type_name(InstanceIndex(i)) == plain.type_name(InstanceIndex(i)));
        }
    }
}

TEST_CASE("time grows with the size only, for input made to provoke the opposite") {
    constexpr std::size_t size = 2'000'000;
    const auto repeated = [](std::string_view piece) {
        std::string text;
        while (text.size() < size) text += piece;
        return text;
    };
    const std::string string_of = good_header + "DATA;\n#1=A('";
    CHECK_FALSE(File::parse("x", string_of + repeated("\n")).ok());
    CHECK_FALSE(File::parse("x", string_of + repeated("\n#1")).ok());
    CHECK_FALSE(File::parse("x", string_of + repeated("\n ")).ok());
    CHECK_FALSE(File::parse("x", string_of + repeated("\\")).ok());
    CHECK_FALSE(File::parse("x", good_header + "DATA;\n#1=A(" + repeated("/*/")).ok());
    CHECK_FALSE(File::parse("x", "ISO-10303-21;HEADER;X(1,;" + repeated(";/*")).ok());
    CHECK_FALSE(File::parse("x", "ISO-10303-21;HEADER;X(1,;" + repeated(";a ")).ok());
    CHECK_FALSE(File::parse("x", "ISO-10303-21;HEADER;" + repeated("X(1,;A(")).ok());
    CHECK_FALSE(File::parse("x", repeated("\n")).ok());
    CHECK_FALSE(File::parse("x", repeated("/*")).ok());
    CHECK(decode_all(with_instances("#1=A((" + repeated("1,") + "1));")).values > size / 2);
    CHECK(decode_all(with_instances("#1=A(" + repeated("$,") + "1);")).values > size / 2);
}

}  // namespace
}  // namespace lyr::part21
