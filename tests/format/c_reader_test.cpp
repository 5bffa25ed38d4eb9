// The C reader: what it gives out and refuses is what the C++ reader does.

#include "c_reader.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "damages.h"
#include "files.h"
#include "sample.h"
#include "small_file.h"

using namespace lyr;
using namespace lyr::format;
using test::FileBytes;

extern "C" double lyr_square_root(double value);

namespace {

std::string difference(const FileBytes& bytes, std::size_t most = SIZE_MAX) {
    const ReadOptions options{.keep_thumbnails = false, .keep_configuration = false};
    return test::difference(bytes, test::open_bytes(bytes, options), most);
}

// Of random calls to the encoder: every operation, several quanta and layers of several chunks.
FileBytes random_file(std::uint32_t seed) {
    const Quantum quantum{seed % 3 == 0 ? 250u : 1000u};
    std::vector<EncodedLayer> layers;
    for (std::uint32_t i = 0; i < 3; ++i) {
        auto layer = test::RandomLayer(seed + i, 0.2 * (i + 1), quantum, 600).finish();
        REQUIRE(layer.ok());
        layers.push_back(*layer);
    }
    const std::string path = test::scratch("c_reader");
    test::write_layers(path, quantum, {}, layers);
    return test::load(path);
}

}  // namespace

TEST_CASE("C reader 3: the same operations as in C++, for random prints") {
    for (std::uint32_t seed = 0; seed < 60; seed += 3) {
        INFO("seed " << seed);
        const FileBytes file = random_file(seed);
        CHECK(difference(file) == "");
        // From a source that gives little at a time.
        if (seed == 0) CHECK(difference(file, 7) == "");
    }
}

TEST_CASE("C reader 1 and 3: the same verdict whatever bit is flipped") {
    const FileBytes file = test::small_file();
    CHECK(difference(file) == "");
    test::with_each_bit_flipped(
        file, [](const FileBytes& damaged, std::size_t) { REQUIRE(difference(damaged) == ""); });
}

TEST_CASE("C reader 2 and 3: the same verdict wherever the file is cut, and the last whole layer") {
    const FileBytes file = test::small_file();
    test::with_each_cut(file, [](const FileBytes& cut) { REQUIRE(difference(cut) == ""); });
    FileBytes longer = file;
    longer.push_back(std::byte{0});
    CHECK(difference(longer) == "");
}

TEST_CASE("C reader 3 and 4: the same verdict on any byte of any payload, with a right CRC" *
          doctest::test_suite("long")) {
    const FileBytes file = test::small_file();
    const std::vector<test::Block> blocks = test::split(file);
    std::mt19937 random(5);
    for (std::size_t i = 1; i < blocks.size(); ++i) {
        for (std::size_t at = 0; at < blocks[i].payload.size(); ++at) {
            for (int turn = 0; turn < 12; ++turn) {
                auto changed = blocks;
                const auto flip = static_cast<unsigned>(turn < 8 ? 1u << turn : 1 + random() % 255);
                changed[i].payload[at] ^= static_cast<std::byte>(flip);
                INFO("block " << i << " byte " << at << " flip " << flip);
                REQUIRE(difference(test::join(file, changed)) == "");
            }
        }
    }
}

TEST_CASE(
    "C reader 3 and 4: the same verdict on a payload that is cut or goes on, with a right CRC") {
    const FileBytes file = test::small_file();
    const std::vector<test::Block> blocks = test::split(file);
    for (std::size_t i = 1; i < blocks.size(); ++i) {
        const std::size_t size = blocks[i].payload.size();
        for (std::size_t other = 0; other < size + 20; ++other) {
            auto changed = blocks;
            changed[i].payload.resize(other, static_cast<std::byte>(other % 2 ? 0xff : 0));
            INFO("block " << i << " of " << other << " bytes");
            REQUIRE(difference(test::join(file, changed)) == "");
        }
    }
}

TEST_CASE("C reader 3: blocks that are missing, doubled, swapped or of another type") {
    const FileBytes file = test::small_file();
    const auto same = [](const FileBytes& bytes, const auto&) { CHECK(difference(bytes) == ""); };
    test::with_each_block_missing_or_doubled(file, same);
    test::with_each_two_blocks_swapped(file, same);
    const std::vector<test::Block> blocks = test::split(file);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        for (const int type : {0x00, 0x06, 0x47, 0x80, 0x81, 0x82, 0xff, 1, 2, 3, 4, 5}) {
            INFO("block " << i << " as type " << type);
            auto changed = blocks;
            changed[i].type = static_cast<std::uint8_t>(type);
            CHECK(difference(test::join(file, changed)) == "");
        }
    }
}

TEST_CASE("C reader 3 and 4: the same verdict on random operations" * doctest::test_suite("long")) {
    test::with_random_operations([](const FileBytes& file) { REQUIRE(difference(file) == ""); });
}

TEST_CASE("reader: a link of no length leaves the next gap of its row a travel") {
    FileBytes raw;
    for (const int byte : {0x50, 0, 0, 0x46, 0x80, 0x80, 0x80, 0x80, 8, 0, 0, 2})
        raw.push_back(static_cast<std::byte>(byte));
    // One row of two intervals, linked, that begins where the head is: u = 0, 5, 10, 15.
    for (const int byte : {0x47, 0, 0, 1, 5, 1, 0, 10, 10, 10})
        raw.push_back(static_cast<std::byte>(byte));
    const FileBytes file = test::raw_file(raw, 3);
    CHECK(difference(file) == "");
    const test::Reading reading = test::read_bytes(file);
    REQUIRE(!reading.error);
    REQUIRE(reading.given.size() == 6);
    CHECK(reading.given[3].operation == Operation(Line{{0, 0, 0}, {5, 0, 0}, true}));
    CHECK(reading.given[4].operation == Operation(Travel{{5, 0, 0}, {10, 0, 0}, true}));
    CHECK(reading.given[5].operation == Operation(Line{{10, 0, 0}, {15, 0, 0}, true}));
}

TEST_CASE("reader: the widest arc is told from one that is wider by a quantum, however large") {
    std::mt19937_64 random(9);
    const auto verdict = [](std::int64_t dx, std::int64_t dy, std::int64_t sagitta) {
        FileBytes raw{std::byte{0x50}, std::byte{0}, std::byte{0}};
        const std::int64_t x = dx / 2, y = dy / 2;
        for (const std::int64_t value : {std::int64_t{0x40}, std::int64_t{0x10}}) {
            raw.push_back(static_cast<std::byte>(value));
            put_signed(raw, value == 0x40 ? -x : dx);
            put_signed(raw, value == 0x40 ? -y : dy);
        }
        put_signed(raw, sagitta);
        const FileBytes file = test::raw_file(raw, 3);
        CHECK(difference(file) == "");
        return !test::read_bytes(file).error;
    };
    for (int i = 0; i < 300; ++i) {
        const auto limit = static_cast<std::int64_t>(random() >> (random() % 30 + 33));
        const std::int64_t dx = 2 * limit, dy = i % 3 == 0 ? 0 : 2 * (limit / (i % 7 + 1));
        if (dx == 0) continue;
        const long double most =
            1.25L * std::hypot(static_cast<long double>(dx), static_cast<long double>(dy));
        const auto widest = static_cast<std::int64_t>(std::floor(most));
        INFO("chord " << dx << ", " << dy << " widest " << widest);
        CHECK(verdict(dx, dy, i % 2 ? widest : -widest));
        CHECK_FALSE(verdict(dx, dy, i % 2 ? widest + 1 : -widest - 1));
    }
    for (const std::int64_t sagitta : {INT64_MAX, INT64_MIN, std::int64_t{1} << 35})
        CHECK_FALSE(verdict(100, 100, sagitta));
}

TEST_CASE("C reader 3: a buffer that a payload does not fit is said so, one that it fits does") {
    const FileBytes file = test::small_file();
    std::size_t longest = 0;
    for (const test::Block& block : test::split(file))
        if (block.type < 0x80) longest = std::max(longest, block.payload.size());
    for (const std::size_t size :
         {std::size_t{LYR_LEAST_BUFFER} - 1, longest - 1, longest, longest + 100, buffer_bytes}) {
        test::Memory memory{file};
        test::CReader c(memory, size);
        c.open();
        while (lyr_next(&c.reader, &c.operation)) {
        }
        CHECK(c.reader.status == (size < longest ? LYR_TOO_LONG : LYR_END));
    }
}

TEST_CASE("C reader: it starts at any layer, and goes back") {
    const FileBytes file = random_file(3);
    test::Memory memory{file};
    test::CReader c(memory);
    REQUIRE(c.open());
    std::vector<std::uint64_t> operations(3), offsets(3);
    while (lyr_next(&c.reader, &c.operation)) {
        if (c.operation.kind == LYR_LAYER) offsets[c.operation.number] = c.operation.offset;
        ++operations[c.reader.layer.index];
    }
    for (const std::uint32_t layer : {2u, 0u, 1u}) {
        REQUIRE(lyr_seek_layer(&c.reader, layer, offsets[layer]));
        CHECK(lyr_next(&c.reader, &c.operation));
        CHECK(c.operation.kind == LYR_LAYER);
        CHECK(c.operation.number == layer);
        std::uint64_t left = 1;
        while (lyr_next(&c.reader, &c.operation)) ++left;
        CHECK(c.reader.status == LYR_END);
        CHECK(left ==
              std::accumulate(operations.begin() + layer, operations.end(), std::uint64_t{0}));
    }
    // Another layer, no layer, and behind the end.
    const std::pair<std::uint64_t, lyr_status> wrong[] = {
        {offsets[1], LYR_NONSENSE}, {offsets[0] - 1, LYR_DAMAGED}, {file.size(), LYR_CUT_SHORT}};
    for (const auto& [offset, status] : wrong) {
        REQUIRE(lyr_seek_layer(&c.reader, 0, offset));
        CHECK_FALSE(lyr_next(&c.reader, &c.operation));
        CHECK(c.reader.status == status);
    }
    REQUIRE(lyr_seek_layer(&c.reader, 0, offsets[0]));
    CHECK(lyr_next(&c.reader, &c.operation));
    c.reader.source.seek = nullptr;
    CHECK_FALSE(lyr_seek_layer(&c.reader, 0, offsets[0]));
    CHECK(c.reader.status == LYR_UNREADABLE);
}

TEST_CASE("C reader: each piece of a wipe tells the way of all") {
    const FileBytes file = random_file(6);
    test::Memory memory{file};
    test::CReader c(memory);
    Result<Reader> reader = test::open_bytes(file, {});
    REQUIRE((c.open() && reader.ok()));
    const double mm = reader->header().quantum.mm(1);
    double left_mm = 0, way = 0;
    int wipes = 0, arcs = 0;
    while (lyr_next(&c.reader, &c.operation)) {
        const auto* wipe = std::get_if<Wipe>(reader->read());
        REQUIRE((wipe != nullptr) == (c.operation.kind == LYR_WIPE));
        if (!wipe) {
            left_mm = 0;
            CHECK(c.operation.way == 0);
            continue;
        }
        const bool begins = wipe->left_mm >= left_mm;
        wipes += begins;
        arcs += wipe->sagitta != 0;
        left_mm = wipe->left_mm;
        if (begins) way = c.operation.way;
        if (begins) CHECK(way * mm == doctest::Approx(left_mm).epsilon(1e-9));
        CHECK(c.operation.way == way);
    }
    CHECK(wipes > 50);
    CHECK(arcs > 50);
}

TEST_CASE("C reader: once it is open, the buffer holds the metadata's text") {
    const FileBytes file = test::small_file();
    test::Memory memory{file, 0, 50};
    test::CReader c(memory);
    REQUIRE(c.open());
    const std::string text(reinterpret_cast<const char*>(c.buffer.data()), c.reader.length);
    CHECK(text.starts_with("source=part.step\n"));
    CHECK(text.find("layers=3\n") != std::string::npos);
    CHECK(text.ends_with("\n"));
}

TEST_CASE("C reader: its square root is rounded as IEEE 754 says") {
    std::mt19937_64 random(1);
    const auto check = [](double value) {
        if (lyr_square_root(value) == std::sqrt(value)) return true;
        INFO("of " << value);
        CHECK(lyr_square_root(value) == std::sqrt(value));
        return false;
    };
    CHECK(lyr_square_root(0) == 0);
    for (int i = 0; i < 200000; ++i) {
        const auto x =
            static_cast<double>(static_cast<std::int64_t>(random() >> (1 + random() % 60)));
        const auto y =
            static_cast<double>(static_cast<std::int64_t>(random() >> (1 + random() % 60)));
        REQUIRE(check(x));
        REQUIRE(check(x * x + y * y));
        // Squares and their neighbours: where rounding is hardest.
        const double whole = static_cast<double>(random() >> 38), square = whole * whole;
        REQUIRE(check(square));
        REQUIRE(check(std::nextafter(square, 0)));
        REQUIRE(check(std::nextafter(square, 1e300)));
    }
}
