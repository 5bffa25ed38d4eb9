// Wipes: what a reader makes of them, and what is no wipe.

#include <doctest/doctest.h>

#include <functional>
#include <numbers>

#include "files.h"
#include "format/arc.h"

using namespace lyr;
using namespace lyr::format;
using test::FileBytes;
using test::micrometres;
using test::wall_style;

namespace {

using Draw = std::function<void(LayerEncoder&)>;

Result<EncodedLayer> layer_of(const Draw& draw) {
    LayerState state;
    state.retract_length_mm = 0.8;
    LayerEncoder encoder(micrometres, state);
    encoder.begin_path(wall_style);
    draw(encoder);
    return encoder.finish();
}

test::Reading reading_of(const Draw& draw) {
    const auto layer = layer_of(draw);
    REQUIRE_MESSAGE(layer.ok(), to_string(layer.error()));
    const std::string path = test::scratch("wipe");
    test::write_layers(path, micrometres, {}, {*layer});
    return test::read_file(path);
}

template <class T>
std::vector<T> all(const test::Reading& reading) {
    std::vector<T> found;
    for (const test::Given& given : reading.given)
        if (const auto* one = std::get_if<T>(&given.operation)) found.push_back(*one);
    return found;
}

// A wall, a wipe back along it, the way to the next wall.
void draw_wiped(LayerEncoder& layer, bool wipes) {
    layer.line_to(10, 0);
    layer.line_to(10, 10);
    const WipePiece back[] = {{10, 2, 0}, {8, 0, -0.585786}};
    if (wipes) layer.wipe(back, 0.8);
    layer.retract();
    layer.travel_to(30, 5);
    layer.unretract();
    layer.line_to(40, 5);
}

}  // namespace

TEST_CASE("wipe: its pieces come one by one, and the travel begins where it has ended") {
    const test::Reading reading = reading_of([](LayerEncoder& l) { draw_wiped(l, true); });
    REQUIRE(!reading.error);
    const auto wipes = all<Wipe>(reading);
    REQUIRE(wipes.size() == 2);
    CHECK(wipes[0].from == Point{10000, 10000, 0});
    CHECK(wipes[0].to == Point{10000, 2000, 0});
    CHECK(wipes[0].sagitta == 0);
    CHECK(wipes[1].to == Point{8000, 0, 0});
    CHECK(wipes[1].sagitta == -586);
    for (const Wipe& wipe : wipes) CHECK(wipe.depth_mm == 0.8);
    // A quarter of a circle of 2 mm.
    CHECK(wipes[1].left_mm == doctest::Approx(std::numbers::pi).epsilon(1e-3));
    CHECK(wipes[0].left_mm == doctest::Approx(8 + wipes[1].left_mm));
    const auto travels = all<Travel>(reading);
    REQUIRE(travels.size() == 1);
    CHECK(travels[0].from == Point{8000, 0, 0});
    CHECK(travels[0].to == Point{30000, 5000, 0});
    CHECK(all<Line>(reading).back().to == Point{40000, 5000, 0});
}

TEST_CASE("wipe: it changes nothing but the ways without extrusion") {
    const auto wiped = layer_of([](LayerEncoder& l) { draw_wiped(l, true); });
    const auto plain = layer_of([](LayerEncoder& l) { draw_wiped(l, false); });
    REQUIRE((wiped.ok() && plain.ok()));
    CHECK(wiped->totals.operations == plain->totals.operations + 1);
    CHECK(wiped->totals.extruded_quanta == plain->totals.extruded_quanta);
    // 8 and a quarter of a circle of 2 mm, then 22.56 mm instead of 20.62.
    const double more_mm = 8 + std::numbers::pi + std::hypot(22, 5) - std::hypot(20, 5);
    CHECK(static_cast<double>(wiped->totals.travel_quanta - plain->totals.travel_quanta) ==
          doctest::Approx(1000 * more_mm).epsilon(1e-3));
}

TEST_CASE("wipe: a long one comes in several operations, drawn back evenly over all of them") {
    const double total_mm = 1000 * 0.05;
    const test::Reading reading = reading_of([&](LayerEncoder& layer) {
        layer.line_to(60, 0);
        layer.retract_to(0.2);
        std::vector<WipePiece> pieces;
        for (int i = 1; i <= 1000; ++i) pieces.push_back({60 - 0.05 * i, 0, 0});
        layer.wipe(pieces, 0.8);
        layer.travel_to(0, 50);
    });
    REQUIRE(!reading.error);
    const auto wipes = all<Wipe>(reading);
    REQUIRE(wipes.size() == 1000);
    double depth_mm = 0.2;
    for (std::size_t i = 0; i < wipes.size(); ++i) {
        const double length_mm = 0.05;
        depth_mm += (wipes[i].depth_mm - depth_mm) * std::min(1.0, length_mm / wipes[i].left_mm);
        const double share = length_mm * static_cast<double>(i + 1) / total_mm;
        REQUIRE(std::abs(depth_mm - (0.2 + 0.6 * share)) < 1e-3);
    }
    CHECK(depth_mm == doctest::Approx(0.8));
    CHECK(all<Travel>(reading).back().from == Point{10000, 0, 0});
}

TEST_CASE("wipe: one that ends where it began needs no travel, one of no length is a retraction") {
    const test::Reading reading = reading_of([](LayerEncoder& layer) {
        layer.circle(5, 0, true);
        const WipePiece turn[] = {{10, 0, 5}, {0, 0, 5}};
        layer.wipe(turn, 0.8);
        layer.unretract();
        layer.line_to(0, 5);
        const WipePiece none[] = {{0, 5.0004, 0}};
        layer.wipe(none, 0.8);
        layer.unretract();
        layer.line_to(0, 9);
    });
    CHECK(!reading.error);
    CHECK(all<Wipe>(reading).size() == 2);
    const auto retractions = all<Retract>(reading);
    REQUIRE(retractions.size() == 3);
    CHECK(retractions[1].depth_mm == 0.8);
    CHECK(all<Line>(reading).size() == 2);
}

TEST_CASE("wipe: what is extruded behind it begins where it has ended") {
    const test::Reading reading = reading_of([](LayerEncoder& layer) {
        layer.line_to(10, 0);
        const WipePiece back{5, 0, 0};
        layer.wipe({&back, 1}, 0.8);
        layer.arc_to(5, 2, 1);
    });
    REQUIRE(!reading.error);
    CHECK(all<Arc>(reading).front() == Arc{{5000, 0, 0}, {5000, 2000, 0}, 1000});
}

TEST_CASE("writer 4: wipes out of range are mistakes") {
    const WipePiece back{5, 0, 0};
    for (const double bad : {-1.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
        const WipePiece far{bad * 1e9, 0, 0};
        CHECK(!layer_of([&](LayerEncoder& l) { l.wipe({&back, 1}, bad); }).ok());
        CHECK(!layer_of([&](LayerEncoder& l) { l.wipe({&far, 1}, 0.8); }).ok());
    }
}

TEST_CASE("reader 5: wipes that make no sense are errors with a place") {
    const auto message = [](std::vector<int> bytes, std::uint32_t operations) {
        FileBytes raw{std::byte{0x50}, std::byte{1}, std::byte{0}};
        for (const int byte : bytes) raw.push_back(static_cast<std::byte>(byte));
        const test::Reading reading = test::read_bytes(test::raw_file(raw, operations + 1));
        REQUIRE(reading.error.has_value());
        CHECK(reading.error->message.find("in layer 1, chunk 1 of 1") != std::string::npos);
        return reading.error->message;
    };
    const auto has = [](const std::string& text, const char* part) {
        CHECK_MESSAGE(text.find(part) != std::string::npos, text);
    };
    has(message({0x4b, 1, 9, 2, 2, 0}, 1), "a wipe is cut short");
    has(message({0x4b, 1, 1, 2, 2}, 1), "a wipe is cut short");
    has(message({0x4b, 1, 1, 2, 130, 130}, 1), "cut short");
    has(message({0x4b, 1}, 1), "cut short");
    has(message({0x4b, 1, 1, 2, 2, 100}, 1), "sagitta");
    has(message({0x4b, 1, 1, 0, 0, 2}, 1), "sagitta");
    has(message({0x4b, 1, 1, 255, 255, 255, 255, 31, 0, 0}, 1), "out of range");
}
