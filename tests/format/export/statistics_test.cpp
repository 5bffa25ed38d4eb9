// The figures of a file add up.

#include "format/export/statistics.h"

#include <doctest/doctest.h>

#include "../files.h"
#include "../sample.h"
#include "../worked_example.h"

using namespace lyr;
using namespace lyr::format;

namespace {

Statistics statistics_of_file(const std::string& path) {
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    const auto statistics = statistics_of(*reader);
    REQUIRE_MESSAGE(statistics.ok(), to_string(statistics.error()));
    return *statistics;
}

}  // namespace

TEST_CASE("statistics 1: all operations and all bytes are counted once") {
    const Quantum quantum{1000};
    std::vector<EncodedLayer> layers;
    for (std::uint32_t i = 0; i < 4; ++i) {
        test::RandomLayer layer(i, 0.2 * (i + 1), quantum, i == 2 ? 20000 : 300);
        auto encoded = layer.finish();
        REQUIRE(encoded.ok());
        layers.push_back(std::move(*encoded));
    }
    const std::string path = test::scratch("statistics");
    test::write_layers(path, quantum, {}, layers);
    const Statistics s = statistics_of_file(path);
    CHECK(s.layers == 4);
    CHECK(s.layer_heads.count == 4);
    CHECK(s.bytes == std::filesystem::file_size(path));
    std::uint64_t bytes = 0, given = 0;
    for (const KindStatistics* kind : {&s.lines, &s.arcs, &s.circles, &s.hatch_lines, &s.travels,
                                       &s.wipes, &s.paths, &s.settings, &s.layer_heads, &s.rest}) {
        bytes += kind->bytes;
        given += kind->count;
    }
    CHECK(bytes == s.bytes);
    CHECK(given + s.hatch_runs + s.hatch_travels == test::read_file(path).given.size());
    RoleStatistics sum;
    for (const RoleStatistics& role : s.roles) {
        sum.paths += role.paths;
        sum.lines += role.lines;
        sum.arcs += role.arcs;
        sum.circles += role.circles;
        sum.hatch_lines += role.hatch_lines;
        sum.length_mm += role.length_mm;
        sum.volume_mm3 += role.volume_mm3;
    }
    CHECK(sum.paths == s.paths.count);
    CHECK(sum.lines == s.lines.count);
    CHECK(sum.arcs == s.arcs.count);
    CHECK(sum.circles == s.circles.count);
    CHECK(sum.hatch_lines == s.hatch_lines.count);
    // The writer counted the same.
    double extruded = 0, travelled = 0;
    std::uint64_t operations = 0;
    for (const EncodedLayer& layer : layers) {
        extruded += static_cast<double>(layer.totals.extruded_quanta) * quantum.mm(1);
        travelled += static_cast<double>(layer.totals.travel_quanta) * quantum.mm(1);
        operations += layer.totals.operations;
    }
    CHECK(sum.length_mm == doctest::Approx(extruded));
    CHECK(s.travel_mm == doctest::Approx(travelled));
    CHECK(sum.volume_mm3 == doctest::Approx(s.header.summary.volume_mm3));
    CHECK(s.operations == operations);
}

TEST_CASE("statistics 2: the figures of the worked example, and its text") {
    const std::string path = test::scratch("statistics_example");
    REQUIRE(test::write_worked_example(path).ok());
    const Statistics s = statistics_of_file(path);
    CHECK(s.lines.count == 6);
    CHECK(s.arcs.count == 5);
    CHECK(s.circles.count == 1);
    CHECK(s.hatch_lines.count == 5);
    CHECK(s.hatch_runs == 1);
    CHECK(s.retractions == 1);
    CHECK(s.hottest_tool_c == 210);
    CHECK(s.hottest_bed_c == 60);
    const double wall = 10 + 5 * std::numbers::pi + 10 + 10 + 2 * std::numbers::pi;
    const RoleStatistics& outer = s.roles[static_cast<std::size_t>(Role::outer_wall)];
    CHECK(outer.length_mm == doctest::Approx(wall));
    const PathStyle style{Role::outer_wall, 0.45, 0.2, 1, 60, 0};
    CHECK(outer.volume_mm3 == doctest::Approx(wall * cross_section_mm2(style)));
    const std::string text = to_text(s, "part.lyr");
    for (const char* part : {"part.lyr: .lyr 1.0, 462 bytes, whole\n", "plate.step",
                             "layers        1, z 0.200 to 0.200 mm, 0.2 mm thick",
                             "x 10.000 to 25.000, y 10.000 to 20.000", "outer wall", "solid infill",
                             "nozzle 210, bed 60", "3 hatch intervals of "})
        CHECK_MESSAGE(text.find(part) != std::string::npos, text);
}

TEST_CASE("a strand's cross-section: a circle where it is as wide as high, continuous there") {
    PathStyle style;
    style.height_mm = 0.4;
    style.width_mm = 0.4;
    CHECK(cross_section_mm2(style) == doctest::Approx(std::numbers::pi / 4 * 0.16));
    style.width_mm = 0.4 - 1e-9;
    CHECK(cross_section_mm2(style) == doctest::Approx(std::numbers::pi / 4 * 0.16));
    style.width_mm = 0.6;
    CHECK(cross_section_mm2(style) == doctest::Approx(0.2 * 0.4 + std::numbers::pi / 4 * 0.16));
    style.flow = 0.5;
    CHECK(cross_section_mm2(style) == doctest::Approx(0.04 + std::numbers::pi / 8 * 0.16));
}
