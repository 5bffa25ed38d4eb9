// The small parts: CRC, varints, the hatch grid.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "files.h"
#include "format/bytes.h"
#include "format/grid.h"

using namespace lyr;
using namespace lyr::format;

TEST_CASE("crc32c 1 and 2: the standard's check value; pieces add up; all lengths agree") {
    test::FileBytes digits;
    for (const char c : std::string("123456789")) digits.push_back(static_cast<std::byte>(c));
    CHECK(crc32c(digits) == 0xe3069283u);
    CHECK(crc32c({}) == 0);
    std::mt19937 random(1);
    test::FileBytes bytes(257);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random() & 0xff);
    // Bit by bit, as the definition says.
    std::uint32_t plain = 0xffffffffu;
    for (std::size_t size = 0; size <= bytes.size(); ++size) {
        const std::span<const std::byte> all(bytes.data(), size);
        CHECK(crc32c(all) == ~plain);
        CHECK(crc32c_by_tables(all) == ~plain);
        const std::size_t cut = size / 3;
        CHECK(crc32c(all.subspan(cut), crc32c(all.first(cut))) == ~plain);
        if (size == bytes.size()) break;
        plain ^= static_cast<std::uint32_t>(bytes[size]);
        for (int bit = 0; bit < 8; ++bit) plain = (plain >> 1) ^ ((plain & 1) ? 0x82f63b78u : 0);
    }
}

TEST_CASE("bytes 1 and 2: numbers come back; nothing is read behind the end") {
    std::vector<std::int64_t> values{0,   1,    -1,   63,    64,        -64,
                                     -65, 8191, 8192, -8193, INT64_MAX, INT64_MIN};
    for (int bit = 0; bit < 63; ++bit) values.push_back(std::int64_t{1} << bit);
    for (const std::int64_t value : values) {
        Bytes bytes;
        put_signed(bytes, value);
        Cursor cursor(bytes);
        CHECK(cursor.signed_varint() == value);
        CHECK(cursor.at_end());
        CHECK(!cursor.bad());
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            Cursor cut(std::span<const std::byte>(bytes).first(size));
            CHECK(cut.varint() == 0);
            CHECK(cut.bad());
            CHECK(cut.at_end());
        }
    }
    CHECK(zigzag(-1) == 1);
    CHECK(zigzag(1) == 2);
    CHECK(zigzag(-2) == 3);
}

TEST_CASE("grid: points are where real numbers put them") {
    std::mt19937 random(3);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int i = 0; i < 20000; ++i) {
        const double angle = uniform(0, 2 * std::numbers::pi), c = std::cos(angle),
                     s = std::sin(angle);
        Grid grid;
        grid.a = std::llround(c * (1 << 30));
        grid.b = std::llround(s * (1 << 30));
        CHECK(grid.direction_is_unit());
        const double offset = uniform(-1e6, 1e6), pitch = uniform(-2000, 2000);
        grid.offset = std::llround(offset * (1 << 24));
        grid.pitch = std::llround(pitch * (1 << 24));
        const auto k = static_cast<std::int64_t>(uniform(-1000, 1000));
        const auto w = grid.row(k);
        REQUIRE(w.has_value());
        CHECK(std::abs(static_cast<double>(*w) - (offset + static_cast<double>(k) * pitch)) <=
              0.501);
        const auto u = static_cast<std::int64_t>(uniform(-1e6, 1e6));
        const auto du = static_cast<double>(u), dw = static_cast<double>(*w);
        CHECK(std::abs(static_cast<double>(grid.x(u, *w)) - (du * c - dw * s)) <= 0.51);
        CHECK(std::abs(static_cast<double>(grid.y(u, *w)) - (du * s + dw * c)) <= 0.51);
    }
    Grid far;
    far.pitch = offset_limit;
    CHECK(far.row(1).has_value());
    CHECK(!far.row(2).has_value());
    CHECK(!far.row(INT64_MAX).has_value());
    CHECK(!far.row(INT64_MIN).has_value());
    Grid skew;
    skew.b = 1 << 20;
    CHECK(!skew.direction_is_unit());
}
