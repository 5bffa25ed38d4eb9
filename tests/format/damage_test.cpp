// Damaged and malicious files: found out before the damaged part is used, and never a crash.

#include <doctest/doctest.h>

#include <algorithm>

#include "damages.h"
#include "files.h"
#include "format/bytes.h"
#include "format/layout.h"
#include "small_file.h"

using namespace lyr;
using namespace lyr::format;
using test::FileBytes;

namespace {

// What was given out is what the undamaged file gives, from the start.
bool is_prefix(const test::Reading& reading, const test::Reading& whole) {
    if (reading.given.size() > whole.given.size()) return false;
    for (std::size_t i = 0; i < reading.given.size(); ++i)
        if (!(reading.given[i].operation == whole.given[i].operation)) return false;
    return true;
}

struct Span {
    std::size_t begin = 0, end = 0;
};

// The block that holds a byte.
Span block_around(const FileBytes& file, std::size_t at) {
    if (at < 16) return {0, 16};
    for (std::size_t begin = 16;;) {
        const std::size_t end =
            begin + 8 + static_cast<std::size_t>(test::get_little(file, begin + 1, 3));
        if (at < end) return {begin, end};
        begin = end;
    }
}

}  // namespace

TEST_CASE(
    "reader 1: a flipped bit anywhere is found before an operation of its block is given out") {
    const FileBytes file = test::small_file();
    const test::Reading whole = test::read_bytes(file);
    REQUIRE(!whole.error);
    test::with_each_bit_flipped(file, [&](const FileBytes& damaged, std::size_t at) {
        const test::Reading reading = test::read_bytes(damaged);
        REQUIRE(reading.error.has_value());
        REQUIRE(is_prefix(reading, whole));
        if (reading.given.empty()) return;
        REQUIRE(reading.given.back().position.end <= block_around(file, at).begin);
    });
}

TEST_CASE("reader 3: a file that is cut at any byte is an error that names the last whole layer") {
    const FileBytes file = test::small_file();
    const test::Reading whole = test::read_bytes(file);
    REQUIRE(!whole.error);
    // Where each layer's last block ends.
    std::vector<std::size_t> layer_ends;
    std::size_t first_layer = 0;
    for (std::size_t at = 16; at < file.size();) {
        const Span block = block_around(file, at);
        const int type = std::to_integer<int>(file[at]);
        if (type == 2) layer_ends.push_back(0);
        if (type == 2 && first_layer == 0) first_layer = at;
        if (type == 3) layer_ends.back() = block.end;
        at = block.end;
    }
    test::with_each_cut(file, [&](const FileBytes& cut) {
        const std::size_t size = cut.size();
        const test::Reading reading = test::read_bytes(cut);
        REQUIRE(reading.error.has_value());
        CHECK(reading.error->status == ExitStatus::input);
        REQUIRE(is_prefix(reading, whole));
        const auto layers = static_cast<std::size_t>(std::count_if(
            layer_ends.begin(), layer_ends.end(), [&](std::size_t end) { return end <= size; }));
        const std::string& message = reading.error->message;
        const std::string wanted = "the last whole layer is " + std::to_string(layers);
        if (layers > 0) CHECK_MESSAGE(message.find(wanted) != std::string::npos, message);
        if (layers == 0) CHECK(message.find("the last whole layer") == std::string::npos);
        if (size > 4) CHECK_MESSAGE(message.find("cut short") != std::string::npos, message);
    });
}

TEST_CASE("reader 3: chunks that are missing, doubled or swapped, and bytes behind the end") {
    const FileBytes file = test::small_file();
    const test::Reading whole = test::read_bytes(file);
    const std::vector<test::Block> blocks = test::split(file);
    REQUIRE(test::join(file, blocks) == file);
    test::with_each_block_missing_or_doubled(
        file, [](const FileBytes& bytes, const test::Block& block) {
            CHECK(test::read_bytes(bytes).error.has_value() == (block.type < 0x80));
        });
    test::with_each_two_blocks_swapped(file, [&](const FileBytes& bytes, std::size_t second) {
        const test::Reading reading = test::read_bytes(bytes);
        CHECK(is_prefix(reading, whole));
        // What may be skipped may stand anywhere behind the metadata.
        const bool skippable = blocks[second].type >= 0x80 || blocks[second - 1].type >= 0x80;
        CHECK(reading.error.has_value() != (skippable && second > 1));
    });
    FileBytes longer = file;
    longer.push_back(std::byte{0});
    const test::Reading reading = test::read_bytes(longer);
    REQUIRE(reading.error.has_value());
    CHECK(reading.given.size() == whole.given.size());
}

TEST_CASE("reader 4: unknown blocks are skipped if they may be, and their CRC is checked") {
    const FileBytes file = test::small_file();
    const test::Reading whole = test::read_bytes(file);
    const std::vector<test::Block> blocks = test::split(file);
    // Longer than the buffer.
    const test::Block skippable{0xc7, FileBytes(200000, std::byte{0x5a})};
    const test::Block required{0x47, {std::byte{1}}};
    for (std::size_t i = 1; i < blocks.size(); ++i) {
        INFO("before block " << i);
        const auto place = static_cast<std::ptrdiff_t>(i);
        auto changed = blocks;
        changed.insert(changed.begin() + place, skippable);
        FileBytes bytes = test::join(file, changed);
        const test::Reading skipped = test::read_bytes(bytes);
        CHECK(!skipped.error);
        CHECK(is_prefix(skipped, whole));
        CHECK(skipped.given.size() == whole.given.size());

        bytes[static_cast<std::size_t>(std::find(bytes.begin(), bytes.end(), std::byte{0xc7}) -
                                       bytes.begin()) +
              100000] ^= std::byte{1};
        CHECK(test::read_bytes(bytes).error.has_value());

        changed = blocks;
        changed.insert(changed.begin() + place, required);
        const test::Reading refused = test::read_bytes(test::join(file, changed));
        REQUIRE(refused.error.has_value());
        CHECK(refused.error->status == ExitStatus::unsupported);
        CHECK(is_prefix(refused, whole));
    }
}

TEST_CASE("reader 4: versions") {
    FileBytes file = test::small_file();
    const auto with_version = [&](std::uint8_t major, std::uint8_t minor) {
        FileBytes changed = file;
        changed[4] = static_cast<std::byte>(major);
        changed[6] = static_cast<std::byte>(minor);
        const std::uint32_t crc = crc32c(std::span<const std::byte>(changed).first(12));
        for (std::size_t i = 0; i < 4; ++i)
            changed[12 + i] = static_cast<std::byte>((crc >> (8 * i)) & 0xff);
        return test::read_bytes(changed);
    };
    CHECK(!with_version(1, 7).error);
    const test::Reading newer = with_version(2, 0);
    REQUIRE(newer.error.has_value());
    CHECK(newer.error->status == ExitStatus::unsupported);
    CHECK(!newer.opened);
}

TEST_CASE("reader 5: operations that make no sense are errors with a place") {
    const auto message = [](std::vector<int> bytes, std::uint32_t operations) {
        FileBytes raw;
        for (const int byte : bytes) raw.push_back(static_cast<std::byte>(byte));
        const test::Reading reading = test::read_bytes(test::raw_file(raw, operations));
        REQUIRE(reading.error.has_value());
        CHECK(reading.error->status == ExitStatus::input);
        const std::string text = reading.error->message;
        CHECK_MESSAGE(text.find("in layer 1, chunk 1 of 1 at byte ") != std::string::npos, text);
        return text;
    };
    const auto has = [](const std::string& text, const char* part) {
        CHECK_MESSAGE(text.find(part) != std::string::npos, text);
    };
    const std::vector<int> path{0x50, 0, 0};
    const auto after_path = [&](std::vector<int> bytes) {
        bytes.insert(bytes.begin(), path.begin(), path.end());
        return bytes;
    };
    has(message({0x00, 2, 2}, 1), "before a path begins");
    has(message({0x6f}, 1), "unknown operation");
    has(message(after_path({0x00, 2}), 2), "cut short");
    has(message(after_path({0x00, 0x80}), 2), "cut short");
    has(message(after_path({0x00, 255, 255, 255, 255, 255, 255, 255, 255, 255, 2, 0}), 2),
        "too long");
    has(message(after_path({0x00, 2, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 1}), 2),
        "too long");
    has(message(after_path({0x00, 255, 255, 255, 255, 31, 0}), 2), "out of range");
    has(message(after_path({0x10, 20, 0, 0}), 2), "sagitta");
    has(message(after_path({0x10, 20, 0, 100}), 2), "sagitta");
    has(message(after_path({0x10, 0, 0, 2}), 2), "sagitta");
    has(message(after_path({0x42, 0, 0}), 2), "no radius");
    has(message(after_path({0x47, 0, 0, 1, 2, 1, 0, 4}), 2), "without a grid");
    const std::vector<int> grid{0x46, 0x80, 0x80, 0x80, 0x80, 8, 0, 0, 2};
    const auto after_grid = [&](std::vector<int> bytes) {
        bytes.insert(bytes.begin(), grid.begin(), grid.end());
        return after_path(bytes);
    };
    has(message(after_path({0x46, 2, 2, 0, 0}), 2), "a grid is out of range");
    has(message(after_grid({0x47, 4, 0, 1, 2, 1, 0, 4}), 3), "flag");
    has(message(after_grid({0x47, 0, 0, 1, 2, 2, 0, 4, 0, 4}), 3), "another number of rows");
    has(message(after_grid({0x47, 0, 0, 1, 2, 0}), 3), "another number of rows");
    has(message(after_grid({0x47, 0, 0, 1, 40, 1, 0, 4}), 3), "cut short");
    has(message(after_grid({0x47, 0, 0, 1, 2, 1, 0}), 3), "cut short");
    has(message(after_path({}), 2), "another number of operations");
    has(message(after_path({0x5c, 1}), 1), "another number of operations");
    has(message({0xf0, 200, 1}, 1), "cut short");
}

TEST_CASE("reader 4: operations of later minor versions are passed over") {
    const FileBytes raw{std::byte{0x5c}, std::byte{1},    std::byte{0xf3}, std::byte{2},
                        std::byte{9},    std::byte{0xff}, std::byte{0x5c}, std::byte{2}};
    const test::Reading reading = test::read_bytes(test::raw_file(raw, 3));
    CHECK(!reading.error);
    REQUIRE(reading.given.size() == 3);
    CHECK(reading.given[2].operation == Operation(Object{2}));
}

TEST_CASE("reader 5: an absurd number of empty hatch rows takes no time") {
    FileBytes raw;
    for (const int byte : {0x50, 0, 0, 0x46, 0x80, 0x80, 0x80, 0x80, 8, 0, 0, 2, 0x47, 0, 0})
        raw.push_back(static_cast<std::byte>(byte));
    const auto put = [&](std::uint64_t value) { put_varint(raw, value); };
    const std::uint64_t rows = std::uint64_t{1} << 32;
    put(rows), put(0), put(rows);
    const test::Reading reading = test::read_bytes(test::raw_file(raw, 3));
    CHECK(!reading.error);
    CHECK(reading.given.size() == 3);
}

TEST_CASE("reader 5: random bytes as operations never leave the limits" *
          doctest::test_suite("long")) {
    std::uint64_t given = 0;
    test::with_random_operations([&](const FileBytes& file) {
        for (const test::Given& one : test::read_bytes(file).given) {
            ++given;
            std::visit(
                [](const auto& o) {
                    if constexpr (requires { o.to; }) {
                        CHECK(std::abs(o.to.x) <= coordinate_limit);
                        CHECK(std::abs(o.to.y) <= coordinate_limit);
                        CHECK(std::abs(o.to.z) <= coordinate_limit);
                    }
                },
                one.operation);
        }
    });
    CHECK(given > 60000);
}

TEST_CASE("files that are no .lyr file are refused in one line") {
    const auto message = [](const std::string& text) {
        FileBytes bytes;
        for (const char c : text) bytes.push_back(static_cast<std::byte>(c));
        const test::Reading reading = test::read_bytes(bytes);
        REQUIRE(reading.error.has_value());
        CHECK(!reading.opened);
        CHECK(reading.error->message.find('\n') == std::string::npos);
        return reading.error->message;
    };
    CHECK(message("").find("empty") != std::string::npos);
    CHECK(message("solid ascii").find("not a .lyr file") != std::string::npos);
    CHECK(message("ISO-10303-21;").find("not a .lyr file") != std::string::npos);
    CHECK(message("L").find("cut short") != std::string::npos);
    const Result<Reader> missing = Reader::open(test::scratch("there_is_no_such_file"));
    REQUIRE(!missing.ok());
    CHECK(missing.error().status == ExitStatus::input);
    CHECK(!Reader::open(std::string(LYR_BUILD)).ok());
}

TEST_CASE("metadata 2: lines that are no key=value and values that are no measure are refused") {
    const FileBytes file = test::small_file();
    const auto with_metadata = [&](const std::string& text) {
        std::vector<test::Block> blocks = test::split(file);
        blocks[0].payload.clear();
        for (const char c : text) blocks[0].payload.push_back(static_cast<std::byte>(c));
        return test::read_bytes(test::join(file, blocks));
    };
    CHECK(!with_metadata("").error);
    CHECK(!with_metadata("layers=3\ntime_s=1e12\nunknown=\n=").error);
    for (const char* bad : {"layers", "time_s=", "time_s=1e13", "time_s=-2e12", "time_s=nan",
                            "time_s=inf", "time_s=1 ", "layers=-1", "layers=3.0", "a=b\n\n"}) {
        const test::Reading reading = with_metadata(bad);
        INFO(bad);
        REQUIRE(reading.error.has_value());
        CHECK(!reading.opened);
        CHECK(reading.error->message.find("of the metadata") != std::string::npos);
    }
    // Stated otherwise than counted: found at the end.
    CHECK(with_metadata("layers=4").error.has_value());
}
