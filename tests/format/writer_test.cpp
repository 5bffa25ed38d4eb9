// The writer's promises: the same bytes from any number of threads, mistakes reported, nothing left
// behind by failure.

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <filesystem>
#include <limits>
#include <thread>

#include "files.h"
#include "sample.h"
#include "scratch.h"
#include "worked_example.h"

using namespace lyr;
using namespace lyr::format;
using test::micrometres;
using test::timed_wall_style;

namespace {

EncodedLayer random_layer(std::uint32_t seed, int calls) {
    test::RandomLayer layer(seed, 0.2 * (seed + 1), micrometres, calls);
    auto encoded = layer.finish();
    REQUIRE(encoded.ok());
    return std::move(*encoded);
}

std::size_t files_in(const std::string& folder) {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        count += entry.is_regular_file();
    return count;
}

// What finish() says of a layer that one call has spoilt.
template <class Call>
std::string mistake(Call call) {
    LayerEncoder layer(micrometres, {});
    layer.begin_path(timed_wall_style);
    call(layer);
    layer.line_to(1, 1);
    const auto encoded = layer.finish();
    REQUIRE(!encoded.ok());
    CHECK(encoded.error().status == ExitStatus::internal);
    return encoded.error().message;
}

}  // namespace

TEST_CASE("writer 2: the bytes do not depend on threads") {
    constexpr std::uint32_t layers = 12;
    const auto bytes_with = [&](std::uint32_t threads) {
        std::vector<EncodedLayer> encoded(layers);
        std::vector<std::thread> running;
        for (std::uint32_t t = 0; t < threads; ++t)
            running.emplace_back([&, t] {
                for (std::uint32_t i = t; i < layers; i += threads)
                    encoded[i] = random_layer(i, 400);
            });
        for (std::thread& thread : running) thread.join();
        const std::string path = test::scratch("threads" + std::to_string(threads));
        test::write_layers(path, micrometres, {}, encoded);
        return test::load(path);
    };
    const test::FileBytes one = bytes_with(1);
    CHECK(one.size() > 10000);
    CHECK(bytes_with(4) == one);
}

TEST_CASE("writer 3: what rounds to no motion is left out, flat arcs are lines") {
    LayerEncoder layer(micrometres, {});
    layer.begin_path(timed_wall_style);
    layer.line_to(0.0004, -0.0004);
    layer.travel_to(0.0004, 0);
    layer.arc_to(0.0003, 0.0003, 0.0002);
    layer.circle(0.0001, 0.0001, true);
    layer.arc_to(10, 0, 0.0004);
    const HatchRow row{1, true};
    const HatchInterval none{5, 5.0004};
    HatchRun run;
    run.pitch_mm = 1;
    run.rows = {&row, 1};
    run.intervals = {&none, 1};
    layer.hatch(run);
    auto encoded = layer.finish();
    REQUIRE(encoded.ok());
    const std::string path = test::scratch("nothing");
    test::write_layers(path, micrometres, {}, {*encoded});
    const test::Reading reading = test::read_file(path);
    REQUIRE(!reading.error);
    std::size_t motions = 0;
    for (const test::Given& given : reading.given) {
        CHECK(!std::holds_alternative<Arc>(given.operation));
        CHECK(!std::holds_alternative<Circle>(given.operation));
        CHECK(!std::holds_alternative<Travel>(given.operation));
        motions += std::holds_alternative<Line>(given.operation);
    }
    CHECK(motions == 1);
}

TEST_CASE("writer 4: mistakes of the caller are kept until the layer is finished") {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const auto has = [](const std::string& message, const char* part) {
        CHECK_MESSAGE(message.find(part) != std::string::npos, message);
    };
    for (const double bad : {nan, infinite, -infinite, 3e6}) {
        has(mistake([&](LayerEncoder& l) { l.line_to(bad, 0); }), "position");
        has(mistake([&](LayerEncoder& l) { l.travel_to(0, bad); }), "position");
        has(mistake([&](LayerEncoder& l) { l.line_to(0, 0, bad); }), "position");
        has(mistake([&](LayerEncoder& l) { l.circle(0, bad, true); }), "position");
    }
    for (const double bad : {nan, infinite, -1.0}) {
        has(mistake([&](LayerEncoder& l) { l.speed(bad); }), "out of range");
        has(mistake([&](LayerEncoder& l) { l.width(bad); }), "out of range");
        has(mistake([&](LayerEncoder& l) { l.retract_to(bad); }), "out of range");
        has(mistake([&](LayerEncoder& l) { l.temperature({}, bad, true); }), "out of range");
        has(mistake([&](LayerEncoder& l) { l.fan(0, bad); }), "out of range");
    }
    has(mistake([](LayerEncoder& l) { l.fan(0, 1.1); }), "duty");
    has(mistake([](LayerEncoder& l) { l.arc_to(10, 0, 12.2); }), "3/2 pi");
    has(mistake([](LayerEncoder& l) { l.arc_to(0, 0, 5); }), "3/2 pi");
    HatchRun run;
    has(mistake([&](LayerEncoder& l) { run.direction_x = 0.9, l.hatch(run); }), "unit vector");
    const HatchRow row{1, false};
    const HatchInterval backwards{2, 1};
    run.direction_x = 1;
    run.rows = {&row, 1};
    has(mistake([&](LayerEncoder& l) { l.hatch(run); }), "add up");
    run.intervals = {&backwards, 1};
    has(mistake([&](LayerEncoder& l) { l.hatch(run); }), "before it starts");

    LayerEncoder no_path(micrometres, {});
    no_path.line_to(1, 0);
    CHECK(!no_path.finish().ok());
    CHECK(!LayerEncoder(Quantum{0}, {}).finish().ok());
    LayerState state;
    state.height_mm = nan;
    CHECK(!LayerEncoder(micrometres, state).finish().ok());
}

TEST_CASE("writer 1: arcs of the widest kind and their rounding stay what they are") {
    // Tiny to huge, in all directions; the sagitta of a turn by 3/2 pi exactly.
    for (const double radius : {0.002, 0.01, 0.3, 5.0, 400.0}) {
        LayerEncoder layer(micrometres, {});
        layer.begin_path(timed_wall_style);
        for (int i = 0; i < 360; ++i) {
            const double from = i * std::numbers::pi / 180, to = from + 1.5 * std::numbers::pi;
            layer.travel_to(radius * std::cos(from), radius * std::sin(from));
            const double sagitta = radius * (1 - std::cos(0.75 * std::numbers::pi));
            layer.arc_to(radius * std::cos(to), radius * std::sin(to), sagitta);
        }
        auto encoded = layer.finish();
        REQUIRE_MESSAGE(encoded.ok(), to_string(encoded.error()));
        const std::string path = test::scratch("widest");
        test::write_layers(path, micrometres, {}, {*encoded});
        const test::Reading reading = test::read_file(path);
        REQUIRE(!reading.error);
        for (const test::Given& given : reading.given) {
            const auto* arc = std::get_if<Arc>(&given.operation);
            if (!arc) continue;
            const ArcShape shape = arc_shape(*arc);
            // Contract 1: no point of it is further off the circle than 2 quanta.
            for (int k = 0; k <= 16; ++k) {
                const double angle = shape.start_angle_rad + shape.sweep_rad * k / 16;
                const double off = std::hypot(shape.center_x + shape.radius * std::cos(angle),
                                              shape.center_y + shape.radius * std::sin(angle)) -
                                   radius * 1000;
                REQUIRE(std::abs(off) <= 2);
            }
        }
    }
}

TEST_CASE("writer 5: the file is whole or as it was, and nothing else stays") {
    const std::string where = lyr::tests::scratch_folder("writer_failures");
    const std::string path = where + "/part.lyr";
    {
        auto writer = Writer::create(path, micrometres, {});
        REQUIRE(writer.ok());
        REQUIRE(writer->append(random_layer(1, 50)).ok());
        CHECK(!std::filesystem::exists(path));
    }
    CHECK(files_in(where) == 0);
    test::write_layers(path, micrometres, {}, {random_layer(2, 50)});
    const test::FileBytes before = test::load(path);
    {
        auto writer = Writer::create(path, micrometres, {});
        REQUIRE(writer.ok());
        REQUIRE(writer->append(random_layer(3, 50)).ok());
        auto other = random_layer(4, 50);
        other.quantum.nm = 500;
        CHECK(!writer->append(other).ok());
    }
    CHECK(test::load(path) == before);
    CHECK(files_in(where) == 1);
    const auto refused = [&](const std::string& to, Quantum q, const Metadata& metadata,
                             ExitStatus status) {
        const auto writer = Writer::create(to, q, metadata);
        REQUIRE(!writer.ok());
        CHECK(writer.error().status == status);
    };
    refused(where + "/no/such/folder/part.lyr", micrometres, {}, ExitStatus::output);
    refused(where, micrometres, {}, ExitStatus::output);
    refused(path, Quantum{0}, {}, ExitStatus::usage);
    refused(path, Quantum{1'000'001}, {}, ExitStatus::usage);
    Metadata metadata;
    metadata.source_name = std::string(70000, 'x');
    refused(path, micrometres, metadata, ExitStatus::usage);
    metadata.source_name.clear();
    metadata.extra = {{"layers", "7"}};
    refused(path, micrometres, metadata, ExitStatus::usage);
    CHECK(test::load(path) == before);
    CHECK(files_in(where) == 1);
}

TEST_CASE("writer 6: a print that does not fit the memory set aside is the same" *
          doctest::test_suite("long")) {
    // 30 layers of 1.5 MiB: the first ones go by the temporary file.
    const EncodedLayer layer = [] {
        LayerEncoder encoder(micrometres, test::RandomLayer::state(0.2));
        encoder.begin_path(timed_wall_style);
        for (int i = 0; i < 300000; ++i) encoder.travel_to(i % 2 ? 90 : -90, i % 3 ? 80 : -80.0);
        auto encoded = encoder.finish();
        REQUIRE(encoded.ok());
        return std::move(*encoded);
    }();
    CHECK(layer.bytes.size() > std::size_t{3} << 19);
    const std::string path = test::scratch("large");
    test::write_layers(path, micrometres, {}, std::vector<EncodedLayer>(30, layer));
    CHECK(std::filesystem::file_size(path) > std::size_t{40} << 20);
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    std::uint64_t travels = 0;
    while (const Operation* operation = reader->read())
        travels += std::holds_alternative<Travel>(*operation);
    CHECK(!reader->error());
    CHECK(travels == 30 * 300000);
    std::filesystem::remove(path);
}

TEST_CASE("writer: a print without layers, and layers without operations") {
    const std::string path = test::scratch("empty");
    test::write_layers(path, micrometres, {}, {});
    CHECK(test::read_file(path).given.empty());
    CHECK(!test::read_file(path).error);
    LayerEncoder layer(micrometres, {});
    auto encoded = layer.finish();
    REQUIRE(encoded.ok());
    test::write_layers(path, micrometres, {}, {*encoded, *encoded});
    const test::Reading reading = test::read_file(path);
    CHECK(!reading.error);
    CHECK(reading.given.size() == 2);
}
