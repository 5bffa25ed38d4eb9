// What the reader promises beyond operations: pipes, seeking, memory, header and totals.

#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <thread>

#include "files.h"
#include "sample.h"
#include "worked_example.h"

using namespace lyr;
using namespace lyr::format;

namespace {

std::atomic<std::uint64_t> allocations{0};

}  // namespace

// Counted for the whole test program; only the difference over a stretch of code is looked at.
// Not inlined: the compiler would take malloc and free apart from new and delete.
[[gnu::noinline]] void* operator new(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace {

Metadata rich_metadata() {
    Metadata metadata;
    metadata.generator = "stepc 1.2.3";
    metadata.source_name = "a=b\\n\nc.step";
    metadata.source_sha256 = std::string(64, 'e');
    metadata.printer = "big one";
    metadata.material = "ABS";
    metadata.profile = "\xc3\xa4quator \\";
    metadata.tolerance_mm = 0.1 + 0.2;
    metadata.filament_diameter_mm = 2.85;
    metadata.filament_density_g_cm3 = 1.04;
    metadata.objects = {"left", "", "right\n"};
    metadata.extra = {{"x.note", "1"}, {"x.note", "="}};
    metadata.configuration = std::string(100000, '#') + "\nend = true\n";
    metadata.thumbnails.push_back({32, 16, std::vector<std::byte>(70000, std::byte{0x77})});
    metadata.thumbnails.push_back({1, 1, {}});
    return metadata;
}

// Several layers of random operations, one of them of many chunks.
std::string random_file(const std::string& name, int layers) {
    const Quantum quantum{1000};
    std::vector<EncodedLayer> encoded;
    for (int i = 0; i < layers; ++i) {
        test::RandomLayer layer(static_cast<std::uint32_t>(i), 0.2 * (i + 1), quantum,
                                i == 3 ? 30000 : 500);
        auto one = layer.finish();
        REQUIRE(one.ok());
        encoded.push_back(std::move(*one));
    }
    const std::string path = test::scratch(name);
    test::write_layers(path, quantum, rich_metadata(), encoded);
    return path;
}

bool same(const test::Reading& a, const test::Reading& b) {
    if (a.given.size() != b.given.size()) return false;
    for (std::size_t i = 0; i < a.given.size(); ++i)
        if (!(a.given[i].operation == b.given[i].operation)) return false;
    return true;
}

// The read end of a pipe into which a thread writes the bytes, in pieces of odd sizes.
class Pipe {
public:
    explicit Pipe(test::FileBytes bytes) : bytes_(std::move(bytes)) {
        int ends[2];
        REQUIRE(::pipe2(ends, O_CLOEXEC) == 0);
        read_end = ends[0];
        writer_ = std::thread([this, out = ends[1]] {
            // A reader that stops early closes its end; then write() fails, and that is enough.
            sigset_t broken_pipe;
            ::sigemptyset(&broken_pipe);
            ::sigaddset(&broken_pipe, SIGPIPE);
            ::pthread_sigmask(SIG_BLOCK, &broken_pipe, nullptr);
            std::size_t piece = 1;
            for (std::size_t at = 0; at < bytes_.size();) {
                const std::size_t size = std::min(piece, bytes_.size() - at);
                const ssize_t written = ::write(out, bytes_.data() + at, size);
                if (written <= 0) break;
                at += static_cast<std::size_t>(written);
                piece = piece * 7 % 50021 + 1;
            }
            ::close(out);
        });
    }
    ~Pipe() { writer_.join(); }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    int read_end = -1;

private:
    test::FileBytes bytes_;
    std::thread writer_;
};

}  // namespace

TEST_CASE("reader 6: a pipe gives what the file gives, and seeking reads on" *
          doctest::test_suite("long")) {
    const std::string path = random_file("pipe", 6);
    const test::Reading whole = test::read_file(path);
    REQUIRE(!whole.error);
    {
        Pipe pipe(test::load(path));
        const test::Reading piped = test::read_all(Reader::from_descriptor(pipe.read_end, "pipe"));
        CHECK(!piped.error);
        CHECK(same(piped, whole));
    }
    Pipe pipe(test::load(path));
    auto reader = Reader::from_descriptor(pipe.read_end, "pipe");
    REQUIRE(reader.ok());
    REQUIRE(reader->seek_layer(4).ok());
    const Operation* first = reader->read();
    REQUIRE(first);
    CHECK(std::get<LayerStart>(*first).index == 4);
    CHECK(!reader->seek_layer(2).ok());
    while (reader->read()) {
    }
}

TEST_CASE("reader: a print can be taken up at any layer, in any order" *
          doctest::test_suite("long")) {
    const std::string path = random_file("seek", 6);
    const test::Reading whole = test::read_file(path);
    REQUIRE(!whole.error);
    std::vector<std::size_t> starts;
    for (std::size_t i = 0; i < whole.given.size(); ++i)
        if (std::holds_alternative<LayerStart>(whole.given[i].operation)) starts.push_back(i);
    REQUIRE(starts.size() == 6);
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    for (const std::uint32_t layer : {5u, 0u, 3u, 3u, 1u}) {
        REQUIRE(reader->seek_layer(layer).ok());
        std::size_t i = starts[layer];
        while (const Operation* operation = reader->read()) {
            REQUIRE(*operation == whole.given[i].operation);
            REQUIRE(reader->position().offset == whole.given[i].position.offset);
            ++i;
        }
        CHECK(!reader->error());
        CHECK(i == whole.given.size());
    }
    CHECK(!reader->seek_layer(6).ok());
    CHECK(reader->error()->message.find("no layer 7") != std::string::npos);
    // An error does not outlast the next seek.
    CHECK(reader->seek_layer(2).ok());
    CHECK(reader->read() != nullptr);
}

TEST_CASE("reader 2: nothing is taken from the heap after opening") {
    const std::string path = random_file("allocation", 6);
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    const std::uint64_t before = allocations;
    std::uint64_t operations = 0;
    while (reader->read()) ++operations;
    const std::uint64_t after_reading = allocations;
    const bool sought = reader->seek_layer(4).ok();
    while (reader->read()) ++operations;
    const std::uint64_t after_seeking = allocations;
    CHECK(after_reading == before);
    CHECK(after_seeking == before);
    CHECK(sought);
    CHECK(!reader->error());
    CHECK(operations > 30000);
}

TEST_CASE("metadata 1: what the slicer states comes back, and what the writer counted") {
    const std::string path = random_file("metadata", 4);
    const auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    const Metadata wanted = rich_metadata(), &got = reader->header().metadata;
    CHECK(got.generator == wanted.generator);
    CHECK(got.source_name == wanted.source_name);
    CHECK(got.source_sha256 == wanted.source_sha256);
    CHECK(got.printer == wanted.printer);
    CHECK(got.material == wanted.material);
    CHECK(got.profile == wanted.profile);
    CHECK(got.tolerance_mm == wanted.tolerance_mm);
    CHECK(got.filament_diameter_mm == wanted.filament_diameter_mm);
    CHECK(got.filament_density_g_cm3 == wanted.filament_density_g_cm3);
    CHECK(got.objects == wanted.objects);
    CHECK(got.extra == wanted.extra);
    CHECK(got.configuration == wanted.configuration);
    REQUIRE(got.thumbnails.size() == 2);
    CHECK(got.thumbnails[0].width == 32);
    CHECK(got.thumbnails[0].height == 16);
    CHECK(got.thumbnails[0].png == wanted.thumbnails[0].png);
    CHECK(got.thumbnails[1].png.empty());
    const auto bare = Reader::open(path, {.keep_thumbnails = false, .keep_configuration = false});
    REQUIRE(bare.ok());
    CHECK(bare->header().metadata.thumbnails.empty());
    CHECK(bare->header().metadata.configuration.empty());

    const Summary& summary = reader->header().summary;
    CHECK(summary.layers == 4);
    CHECK(summary.estimated_time_s == doctest::Approx(4 * 12.345));
    const double area = std::numbers::pi / 4 * 2.85 * 2.85;
    CHECK(summary.filament_mm == doctest::Approx(summary.volume_mm3 / area).epsilon(1e-6));
    CHECK(summary.mass_g == doctest::Approx(summary.volume_mm3 / 1000 * 1.04).epsilon(1e-3));
}

TEST_CASE("reader: a layer's state and totals are those of its operations") {
    const std::string path = random_file("totals", 4);
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    const Quantum quantum = reader->header().quantum;
    Bounds box;
    double extruded = 0, travelled = 0, volume = 0;
    Layer layer;
    int layers = 0;
    const auto reach = [&](const Point& point) {
        box.low = {std::min(box.low.x, point.x), std::min(box.low.y, point.y),
                   std::min(box.low.z, point.z)};
        box.high = {std::max(box.high.x, point.x), std::max(box.high.y, point.y),
                    std::max(box.high.z, point.z)};
    };
    const auto check = [&] {
        if (layers == 0) return;
        CHECK(layer.index + 1 == static_cast<std::uint32_t>(layers));
        CHECK(layer.state.z_mm == doctest::Approx(0.2 * layers));
        CHECK(layer.state.height_mm == 0.2);
        CHECK(layer.state.retract_length_mm == 0.8);
        CHECK(layer.state.retract_speed_mm_s == 35);
        CHECK(layer.state.unretract_speed_mm_s == 20);
        CHECK(layer.state.travel_speed_mm_s == 180);
        CHECK(layer.state.travel_acceleration_mm_s2 == 3000);
        REQUIRE(layer.state.temperatures.size() == 2);
        CHECK(layer.state.temperatures[1].target_c == 230.5);
        REQUIRE(layer.state.fans.size() == 1);
        CHECK(layer.state.fans[0].duty == 0.35);
        CHECK(layer.state.estimated_time_s == 12.345);
        const LayerTotals& totals = layer.totals;
        CHECK(totals.extruded_quanta == doctest::Approx(extruded));
        CHECK(totals.travel_quanta == doctest::Approx(travelled));
        CHECK(totals.volume_mm3 == doctest::Approx(volume));
        CHECK(totals.motion.low == box.low);
        CHECK(totals.motion.high == box.high);
    };
    const auto extrude = [&](double flat, const Point& from, const Point& to) {
        const double length = std::hypot(flat, static_cast<double>(to.z - from.z));
        extruded += length;
        volume += length * quantum.mm(1) * cross_section_mm2(reader->path());
    };
    // Its end and its outermost points, by its angles.
    const auto reach_round = [&](const Arc& arc) {
        reach(arc.to);
        const ArcShape shape = arc_shape(arc);
        for (int side = -8; side <= 8; ++side) {
            const double angle = side * std::numbers::pi / 2;
            const double along = (angle - shape.start_angle_rad) / shape.sweep_rad;
            if (along < 0 || along > 1) continue;
            const double x = shape.center_x + shape.radius * std::round(std::cos(angle));
            const double y = shape.center_y + shape.radius * std::round(std::sin(angle));
            const bool across = side % 2 == 0;
            reach({across ? std::llround(x) : arc.from.x, across ? arc.from.y : std::llround(y),
                   arc.from.z});
        }
    };
    while (const Operation* operation = reader->read()) {
        if (const auto* start = std::get_if<LayerStart>(operation)) {
            check();
            ++layers;
            layer = reader->layer();
            box = {start->start, start->start};
            extruded = travelled = volume = 0;
        } else if (const auto* line = std::get_if<Line>(operation)) {
            extrude(std::hypot(line->to.x - line->from.x, line->to.y - line->from.y), line->from,
                    line->to);
            reach(line->to);
        } else if (const auto* travel = std::get_if<Travel>(operation)) {
            travelled += std::hypot(travel->to.x - travel->from.x, travel->to.y - travel->from.y,
                                    travel->to.z - travel->from.z);
            reach(travel->to);
        } else if (const auto* arc = std::get_if<Arc>(operation)) {
            extrude(arc_shape(*arc).length(), arc->from, arc->to);
            reach_round(*arc);
        } else if (const auto* wipe = std::get_if<Wipe>(operation)) {
            const Arc bent{wipe->from, wipe->to, wipe->sagitta};
            const bool is_line = wipe->sagitta == 0;
            travelled += is_line ? std::hypot(wipe->to.x - wipe->from.x, wipe->to.y - wipe->from.y)
                                 : arc_shape(bent).length();
            is_line ? reach(wipe->to) : reach_round(bent);
        } else if (const auto* circle = std::get_if<Circle>(operation)) {
            const double radius =
                std::hypot(circle->from.x - circle->center_x, circle->from.y - circle->center_y);
            extrude(2 * std::numbers::pi * radius, circle->from, circle->to);
            const std::int64_t x = circle->center_x, y = circle->center_y, z = circle->from.z;
            const auto cx = static_cast<double>(x), cy = static_cast<double>(y);
            reach({std::llround(cx - radius), circle->from.y, z});
            reach({std::llround(cx + radius), circle->from.y, z});
            reach({circle->from.x, std::llround(cy - radius), z});
            reach({circle->from.x, std::llround(cy + radius), z});
        }
    }
    check();
    CHECK(!reader->error());
    CHECK(layers == 4);
}
