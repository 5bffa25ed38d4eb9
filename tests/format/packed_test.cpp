// Packed runs: what is found beside earlier motions, that every motion comes back as it was, and what is no packed run.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "files.h"
#include "format/motion_packer.h"

using namespace lyr;
using namespace lyr::format;
using test::FileBytes;
using test::micrometres;
using test::wall_style;

namespace {

struct Motion {
    double x_mm = 0, y_mm = 0, sagitta_mm = 0;
};
using Wall = std::vector<Motion>;  // the first one is where it starts

// A winding way of lines and arcs, each beginning in the direction in which the one before ends, but for corners between
// lines; and the ways beside it.
struct Way {
    int motions = 60;
    double turned_rad = 0;
    bool mirrored = false, reversed = false;

    Wall wall(double inset_mm) const {
        std::mt19937 random(5);
        const auto uniform = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        Wall wall;
        double x = 0, y = 0, heading = turned_rad, before = heading;
        const auto put = [&](double sagitta) {
            // Where the ways beside what ends and what begins here meet.
            const double half = (heading - before) / 2;
            const double reach = inset_mm / std::cos(half), middle = before + half;
            const double side = y + reach * std::cos(middle);
            wall.push_back({x - reach * std::sin(middle), mirrored ? -side : side,
                            mirrored ? -sagitta : sagitta});
            before = heading;
        };
        const auto go = [&](double length, double direction) {
            x += length * std::cos(direction);
            y += length * std::sin(direction);
        };
        for (int i = 0; i < motions; ++i) {
            if (i == 0) put(0);
            if (i % 7 > 4) {
                go(uniform(1, 4), heading);
                if (i % 7 == 5) heading += uniform(-1, 1);
                put(0);
                continue;
            }
            // Back to where it came from, so that the way does not wind around itself.
            const double turn = (heading > turned_rad ? -1 : 1) * uniform(0.2, 1);
            const double radius = uniform(2, 5), side = radius - (turn > 0 ? inset_mm : -inset_mm);
            go(2 * radius * std::sin(std::abs(turn) / 2), heading + turn / 2);
            before = heading += turn;
            put(std::copysign(side * (1 - std::cos(turn / 2)), turn));
        }
        return reversed ? back(wall) : wall;
    }

    static Wall back(const Wall& wall) {
        Wall reverse;
        for (std::size_t i = wall.size(); i-- > 0;)
            reverse.push_back(
                {wall[i].x_mm, wall[i].y_mm, i + 1 < wall.size() ? -wall[i + 1].sagitta_mm : 0});
        return reverse;
    }
};

void draw(LayerEncoder& layer, const Wall& wall) {
    layer.travel_to(wall[0].x_mm, wall[0].y_mm);
    for (std::size_t i = 1; i < wall.size(); ++i)
        layer.arc_to(wall[i].x_mm, wall[i].y_mm, wall[i].sagitta_mm);
}

std::int64_t quanta(double mm) {
    return micrometres.quanta(mm);
}

// Reads the layers back and compares every end and sagitta with what was drawn.
void check_walls(const std::vector<Wall>& walls, const EncodedLayer& layer) {
    const std::string path = test::scratch("packed");
    test::write_layers(path, micrometres, {}, {layer});
    const test::Reading reading = test::read_file(path);
    REQUIRE_MESSAGE(!reading.error, to_string(*reading.error));
    std::size_t at = 0;
    std::uint64_t end = 0, motions = 0;
    for (const Wall& wall : walls) {
        for (std::size_t i = 1; i < wall.size(); ++i, ++at) {
            while (!std::holds_alternative<Line>(reading.given[at].operation) &&
                   !std::holds_alternative<Arc>(reading.given[at].operation))
                ++at;
            const Point from{quanta(wall[i - 1].x_mm), quanta(wall[i - 1].y_mm), 0};
            const Point to{quanta(wall[i].x_mm), quanta(wall[i].y_mm), 0};
            const std::int64_t sagitta = quanta(wall[i].sagitta_mm);
            const Operation wanted =
                sagitta == 0 ? Operation(Line{from, to, false}) : Operation(Arc{from, to, sagitta});
            REQUIRE(reading.given[at].operation == wanted);
            CHECK(reading.given[at].position.offset >= end);
            end = reading.given[at].position.end;
            ++motions;
        }
    }
    CHECK(motions > 0);
}

double bytes_per_motion(const std::vector<Wall>& walls) {
    LayerEncoder encoder(micrometres, {});
    encoder.begin_path(wall_style);
    std::size_t motions = 0;
    for (const Wall& wall : walls) {
        draw(encoder, wall);
        motions += wall.size() - 1;
    }
    const auto layer = encoder.finish();
    REQUIRE(layer.ok());
    check_walls(walls, *layer);
    return static_cast<double>(layer->bytes.size()) / static_cast<double>(motions);
}

}  // namespace

TEST_CASE(
    "packed: walls beside each other come back to the quantum, turned, mirrored and reversed") {
    for (const double turned_rad : {0.0, 0.3, 1.9, std::numbers::pi / 2, 4.0})
        for (const bool mirrored : {false, true})
            for (const bool reversed : {false, true}) {
                const Way way{60, turned_rad, mirrored, reversed};
                const double alone = bytes_per_motion({way.wall(0)});
                const double three = bytes_per_motion({way.wall(0.8), way.wall(0.4), way.wall(0)});
                INFO("turned by " << turned_rad << ", a motion alone " << alone << ", of three "
                                  << three);
                // A wall beside another takes a byte a motion, and its head.
                CHECK(three < (alone + 2 * 1.2) / 3);
            }
}

TEST_CASE("packed: a wall that starts elsewhere or misses pieces is still found beside the other") {
    const Way way;
    const Wall outer = way.wall(0), inner = way.wall(0.4);
    const double whole = bytes_per_motion({outer, inner});
    const Wall later(inner.begin() + 10, inner.end());
    CHECK(bytes_per_motion({outer, later}) < whole + 0.3);
    Wall missing = inner;
    for (const std::ptrdiff_t at : {50, 35, 20}) missing.erase(missing.begin() + at);
    CHECK(bytes_per_motion({outer, missing}) < whole + 0.5);
}

TEST_CASE("packed: walls as long as the history, and longer") {
    for (const int motions : {1021, 1022, 1023, 1024, 1025, 1026, 3000}) {
        const Way way{motions, 0.7, false, false};
        const double each = bytes_per_motion({way.wall(0.4), way.wall(0)});
        const double alone = bytes_per_motion({way.wall(0)});
        INFO(motions << " motions: " << each << ", alone " << alone);
        CHECK((each < 0.8 * alone) == (motions <= 1024));
    }
}

TEST_CASE("packed: runs go on from chunk to chunk" * doctest::test_suite("long")) {
    const Way way{1000, 0.2, false, false};
    std::vector<Wall> walls;
    for (int i = 0; i < 150; ++i) walls.push_back(way.wall(0.4 * (i % 3)));
    CHECK(bytes_per_motion(walls) < 1.1);
    LayerEncoder encoder(micrometres, {});
    encoder.begin_path(wall_style);
    for (const Wall& wall : walls) draw(encoder, wall);
    const auto layer = encoder.finish();
    REQUIRE(layer.ok());
    CHECK(layer->chunks.size() > 1);
}

TEST_CASE("packed: the turns of a fill repeat each other, all the way") {
    // To and fro between two sides; the arcs between the lines are alike as well.
    for (const double turned_rad : {0.0, 0.6, 2.5}) {
        Wall fill;
        const auto put = [&](double x, double y, double sagitta) {
            const double c = std::cos(turned_rad), s = std::sin(turned_rad);
            fill.push_back({x * c - y * s, x * s + y * c, sagitta});
        };
        put(0, 0, 0);
        for (int i = 0; i < 1500; ++i) {
            put(i % 2 ? 0 : 3.3, i * 2.1, 0);
            put(i % 2 ? 0.1 : 3.2, i * 2.1 + 2.1, i % 2 ? -0.3 : 0.3);
        }
        CHECK(bytes_per_motion({fill}) < 0.9);
    }
}

TEST_CASE("packed: any motions come back, however far apart and whatever they are beside") {
    std::mt19937 random(11);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int i = 0; i < 300; ++i) {
        const double size = std::pow(10, uniform(-2, 6));
        const auto near = [&](double from) {
            return std::clamp(std::round(1e3 * (from + size * uniform(-1, 1))) / 1e3, -2e6, 2e6);
        };
        const auto chord = [](const Motion& from, const Motion& to) {
            return std::hypot(to.x_mm - from.x_mm, to.y_mm - from.y_mm);
        };
        Wall wall{{near(0), near(0), 0}}, second;
        while (wall.size() < 40) {
            Motion next{near(wall.back().x_mm), near(wall.back().y_mm), 0};
            const double chord_mm = chord(wall.back(), next);
            if (wall.size() % 3)
                next.sagitta_mm = std::trunc(1e3 * chord_mm * uniform(-1, 1)) / 1e3;
            if (chord_mm > 0) wall.push_back(next);
        }
        // Almost beside it, with some ends elsewhere.
        for (Motion motion : wall) {
            if (uniform(0, 1) < 0.9) motion.x_mm = std::clamp(motion.x_mm + 0.4, -2e6, 2e6);
            const double chord_mm = second.empty() ? 0 : chord(second.back(), motion);
            if (std::abs(motion.sagitta_mm) > 1.2 * chord_mm) motion.sagitta_mm = 0;
            if (second.empty() || chord_mm > 0) second.push_back(motion);
        }
        second.front().sagitta_mm = 0;
        bytes_per_motion({wall, second});
    }
}

TEST_CASE("packed: a layer starts without a history") {
    const Way way;
    std::vector<EncodedLayer> layers;
    for (const double inset_mm : {0.8, 0.4}) {
        LayerEncoder encoder(micrometres, {});
        encoder.begin_path(wall_style);
        draw(encoder, way.wall(inset_mm));
        layers.push_back(*encoder.finish());
    }
    const std::string path = test::scratch("packed_layers");
    test::write_layers(path, micrometres, {}, layers);
    const test::Reading both = test::read_file(path);
    REQUIRE(!both.error);
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    REQUIRE(reader->seek_layer(1).ok());
    const test::Reading second = test::read_all(std::move(reader));
    REQUIRE(second.given.size() * 2 == both.given.size());
    for (std::size_t i = 0; i < second.given.size(); ++i)
        CHECK(second.given[i].operation == both.given[second.given.size() + i].operation);
}

TEST_CASE("packed: nearest whole numbers, the even one of two, and 0 for what is none") {
    const double limit = 1099511627776.0;
    const std::vector<std::pair<double, std::int64_t>> pairs{
        {0, 0},
        {0.5, 0},
        {1.5, 2},
        {2.5, 2},
        {-0.5, 0},
        {-1.5, -2},
        {0.51, 1},
        {-0.51, -1},
        {1e9 + 0.3, 1000000000},
        {limit, 0},
        {-limit, 0},
        {limit - 1, 1099511627775},
        {std::numeric_limits<double>::infinity(), 0},
        {std::numeric_limits<double>::quiet_NaN(), 0}};
    for (const auto& [value, whole] : pairs) CHECK(nearest(value) == whole);
    for (int i = -1000; i <= 1000; ++i)
        CHECK(nearest(i * 0.37) == static_cast<std::int64_t>(std::nearbyint(i * 0.37)));
}

TEST_CASE("bytes 3: numbers of every order come back; nothing is read behind the end") {
    std::mt19937_64 random(3);
    for (unsigned order = 0; order <= highest_order; ++order)
        for (const unsigned last_order : {0u, 7u, highest_order}) {
            std::vector<std::int64_t> values{0, 1, -1, (1LL << 39) - 1, -(1LL << 39)};
            while (values.size() % 3 != 0 || values.size() < 300)
                values.push_back(static_cast<std::int64_t>(random()) >> (24 + random() % 40));
            Bytes bytes;
            BitWriter writer(bytes);
            std::size_t bits = 0;
            for (std::size_t i = 0; i < values.size(); ++i) {
                writer.put_signed(values[i], i % 3 == 2 ? last_order : order);
                bits += bit_count(zigzag(values[i]), i % 3 == 2 ? last_order : order);
            }
            CHECK(bytes.size() == (bits + 7) / 8);
            Cursor cursor(bytes);
            for (std::size_t i = 0; i < values.size(); i += 3) {
                const auto [x, y, z] = cursor.bit_numbers(order, last_order);
                REQUIRE((x == values[i] && y == values[i + 1] && z == values[i + 2]));
            }
            cursor.end_bits();
            CHECK(cursor.at_end());
            CHECK(!cursor.bad());
            for (std::size_t size = 0; size < std::min<std::size_t>(bytes.size(), 40); ++size) {
                Cursor cut(std::span<const std::byte>(bytes).first(size));
                for (std::size_t i = 0; i < values.size(); i += 3)
                    cut.bit_numbers(order, last_order);
                CHECK(cut.bad());
                CHECK(cut.at_end());
            }
        }
}

TEST_CASE("reader 5: packed runs that make no sense are errors with a place") {
    const auto message = [](std::vector<int> bytes, std::uint32_t operations) {
        FileBytes raw;
        for (const int byte : bytes) raw.push_back(static_cast<std::byte>(byte));
        const test::Reading reading = test::read_bytes(test::raw_file(raw, operations));
        REQUIRE(reading.error.has_value());
        CHECK(reading.error->message.find("in layer 1, chunk 1 of 1") != std::string::npos);
        return reading.error->message;
    };
    const auto has = [](const std::string& text, const char* part) {
        CHECK_MESSAGE(text.find(part) != std::string::npos, text);
    };
    // A path and a motion before it. 0x7f: bits of 1, -1, 0 and more.
    const auto after_lines = [](std::vector<int> bytes) {
        std::vector<int> all{0x50, 1, 0, 0x02, 20, 0, 0, 20, 19, 0};
        all.insert(all.end(), bytes.begin(), bytes.end());
        return all;
    };
    has(message({0x48, 1, 0, 0x7f}, 1), "before a path");
    has(message({0x50, 1, 0, 0x49, 4, 16, 1, 0, 0x7f}, 2), "out of reach");
    has(message(after_lines({0x49, 2, 16, 1, 0, 0x7f}), 5), "out of reach");
    has(message(after_lines({0x49, 8, 16, 1, 0, 0x7f}), 5), "out of reach");
    has(message(after_lines({0x49, 0x83, 0x10, 16, 1, 0, 0x7f}), 5), "out of reach");
    has(message(after_lines({0x49, 6, 255, 255, 255, 255, 255, 255, 1, 1, 0, 0x7f}), 5), "too far");
    has(message(after_lines({0x4a, 0, 1, 0, 0x7f}), 5), "out of reach");
    has(message(after_lines({0x4a, 8, 1, 0, 0x7f}), 5), "out of reach");
    has(message(after_lines({0x4a, 1, 1, 0, 0x7f}), 5), "out of reach");
    has(message(after_lines({0x4a, 2, 9, 0, 0x7f}), 13), "cut short");
    has(message(after_lines({0x48, 0, 0, 0x7f}), 5), "no motions");
    has(message(after_lines({0x48, 3, 0, 0x7f}), 7), "cut short");
    has(message(after_lines({0x48, 1, 0x00, 0x00}), 5), "cut short");
    has(message(after_lines({0x48, 1, 0x00, 0, 0, 0, 0, 0, 0, 0, 0, 0}), 5),
        "cut short or too long");
    has(message(after_lines({0x48, 1, 0x00, 0x07}), 5), "has no length");
    // (1, 0) with a sagitta of 5 = 0001011: 10 is 1 to the power of 3 and 3.
    has(message(after_lines({0x48, 1, 0x00, 0x0e, 0x0d, 0}), 5), "sagitta");
    has(message(after_lines({0x48, 1, 0xff, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0,
                             0,    0, 4,    0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0}),
                5),
        "out of range");
    // The distance is that of the layer's last parallel run and more.
    const std::vector<int> far{0x80, 0x80, 0x80, 0x80, 0x80, 0x04};
    std::vector<int> twice{0x49, 6};
    twice.insert(twice.end(), far.begin(), far.end());
    has(message(after_lines(twice), 5), "cut short");
}

TEST_CASE("packed: a repeated run repeats itself, worked out by hand") {
    FileBytes raw;
    for (const int byte : {0x50, 1, 0, 0x01, 20, 0, 0, 20, 0x4a, 4, 4, 0})
        raw.push_back(static_cast<std::byte>(byte));
    BitWriter bits(raw);
    for (const int value : {0, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 1}) bits.put_signed(value, 0);
    const test::Reading reading = test::read_bytes(test::raw_file(raw, 7));
    REQUIRE_MESSAGE(!reading.error, to_string(*reading.error));
    REQUIRE(reading.given.size() == 8);
    CHECK(reading.given[4].operation == Operation(Line{{10, 10, 0}, {20, 10, 0}, false}));
    CHECK(reading.given[5].operation == Operation(Arc{{20, 10, 0}, {20, 20, 0}, 1}));
    CHECK(reading.given[6].operation == Operation(Line{{20, 20, 0}, {30, 19, 0}, false}));
    CHECK(reading.given[7].operation == Operation(Arc{{30, 19, 0}, {30, 29, 0}, 2}));
}

TEST_CASE("packed: a parallel run reads what the document says, worked out by hand") {
    // From (0, 0) to (10, 0), (10, 10), (0, 10) quanta; beside them, 2 to the left, from where the head is.
    FileBytes raw;
    for (const int byte : {0x50, 1, 0, 0x02, 20, 0, 0, 20, 19, 0, 0x40, 4, 15, 0x49, 6, 64, 2, 0})
        raw.push_back(static_cast<std::byte>(byte));
    // No differences but in the last sagitta: 1, which is `011`.
    BitWriter bits(raw);
    for (const int value : {0, 0, 0, 0, 0, 1}) bits.put_signed(value, 0);
    const test::Reading reading = test::read_bytes(test::raw_file(raw, 7));
    REQUIRE_MESSAGE(!reading.error, to_string(*reading.error));
    REQUIRE(reading.given.size() == 8);
    const Point start{2, 2, 0}, corner{8, 2, 0}, end{8, 8, 0};
    CHECK(reading.given[6].operation == Operation(Line{start, corner, false}));
    CHECK(reading.given[7].operation == Operation(Arc{corner, end, 1}));
}
