// Solid fill over sparse fill or over nothing, in prints of a cube: its role, its direction, how much it is.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "format/reader.h"
#include "kernel/brep/placement.h"
#include "kernel/solids.h"
#include "scratch.h"
#include "slicer/slicer.h"

using namespace lyr;
using namespace lyr::slicer;
using namespace lyr::testing;

namespace {

using format::Role;

// By role: lengths, volumes and lengths by direction in whole degrees, of [0, 180).
struct LayerFigures {
    std::map<Role, double> length_mm, volume_mm3;
    std::map<Role, std::map<int, double>> by_degree;
    std::map<Role, double> speed_mm_s;
    std::set<Role> with_fan;
};

struct Printed {
    std::vector<LayerFigures> layers;
    Diagnostics diagnostics;
    std::string bytes;

    double volume_mm3() const {
        double volume = 0;
        for (const LayerFigures& layer : layers)
            for (const auto& [role, mm3] : layer.volume_mm3) volume += mm3;
        return volume;
    }
    std::vector<std::size_t> layers_with(Role role) const {
        std::vector<std::size_t> with;
        for (std::size_t i = 0; i < layers.size(); ++i)
            if (layers[i].length_mm.contains(role)) with.push_back(i);
        return with;
    }
};

void add(const format::Operation& operation, format::Quantum quantum, Printed& printed,
         format::PathStyle& style, double& fan) {
    if (std::holds_alternative<format::LayerStart>(operation)) printed.layers.emplace_back();
    if (const auto* set = std::get_if<format::Fan>(&operation)) fan = set->duty;
    if (const auto* path = std::get_if<format::PathStart>(&operation)) {
        style = path->style;
        LayerFigures& layer = printed.layers.back();
        layer.speed_mm_s[style.role] = style.speed_mm_s;
        if (fan == 1) layer.with_fan.insert(style.role);
    }
    if (const auto* line = std::get_if<format::Line>(&operation)) {
        LayerFigures& layer = printed.layers.back();
        const double x = quantum.mm(line->to.x - line->from.x);
        const double y = quantum.mm(line->to.y - line->from.y);
        const double length = std::hypot(x, y);
        layer.length_mm[style.role] += length;
        layer.volume_mm3[style.role] += length * format::cross_section_mm2(style);
        const double degrees = std::atan2(y, x) * 180 / pi;
        layer.by_degree[style.role][(static_cast<int>(std::lround(degrees)) + 360) % 180] += length;
    }
}

Printed printed(const Model& model, const Options& options) {
    Printed result;
    REQUIRE(print(
        model, "cube", lyr::tests::scratch("cube.lyr"), "", options,
        [](const char*, std::size_t, std::size_t) {}, result.diagnostics));
    auto reader = format::Reader::open(lyr::tests::scratch("cube.lyr"));
    REQUIRE(reader);
    format::PathStyle style;
    double fan = 0;
    for (;;) {
        const auto operation = reader->next();
        REQUIRE(operation);
        if (!*operation) break;
        add(**operation, reader->header().quantum, result, style, fan);
    }
    std::ifstream file(lyr::tests::scratch("cube.lyr"), std::ios::binary);
    result.bytes.assign(std::istreambuf_iterator<char>(file), {});
    return result;
}

Options filled(double density) {
    Options options;
    options.profile.infill.density = density;
    options.profile.fan.min = options.profile.fan.max = 0.5;
    return options;
}

// The direction of most of what has the role.
int direction_deg(const LayerFigures& layer, Role role) {
    const auto& lengths = layer.by_degree.at(role);
    return std::max_element(lengths.begin(), lengths.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
}

}  // namespace

TEST_CASE("internal bridge: the roof of an empty cube spans it from wall to wall") {
    const Options options = filled(0);
    const Printed cube = printed(box(20, 20, 20), options);
    REQUIRE(cube.layers.size() == 100);
    CHECK(cube.diagnostics.empty());
    // Five top layers.
    CHECK(cube.layers_with(Role::internal_bridge) == std::vector<std::size_t>{95});
    const LayerFigures& roof = cube.layers[95];
    CHECK(!roof.length_mm.contains(Role::solid_infill));
    CHECK(roof.length_mm.at(Role::internal_bridge) > 700);
    CHECK(direction_deg(roof, Role::internal_bridge) % 90 == 0);
    CHECK(roof.speed_mm_s.at(Role::internal_bridge) == options.profile.speed.bridge_mm_s);
    CHECK(roof.with_fan == std::set<Role>{Role::internal_bridge});
}

TEST_CASE("internal bridge: of an empty block along its shorter side, however it lies") {
    for (const double turn : {0.0, 0.3, pi / 2}) {
        Options options = filled(0);
        options.profile.layer.height_mm = options.profile.layer.first_height_mm = 0.3;
        const Printed block = printed(
            transformed(box(30, 10, 6), Eigen::Affine3d(Eigen::AngleAxisd(turn, Vector3::UnitZ()))),
            options);
        REQUIRE(block.layers_with(Role::internal_bridge) == std::vector<std::size_t>{15});
        const double across = 90 + turn * 180 / pi;
        const int off = std::abs(direction_deg(block.layers[15], Role::internal_bridge) -
                                 static_cast<int>(std::lround(across)) % 180);
        CHECK(std::min(off, 180 - off) <= 1);
    }
}

TEST_CASE("internal bridge: over sparse lines across them, and no more material than solid fill") {
    Options options = filled(0.15);
    const Printed grid = printed(box(20, 20, 20), options);
    CHECK(grid.diagnostics.empty());
    CHECK(grid.layers_with(Role::internal_bridge) == std::vector<std::size_t>{95});
    const double bridge_mm3 = grid.layers[95].volume_mm3.at(Role::internal_bridge);
    CHECK(bridge_mm3 ==
          doctest::Approx(grid.layers[97].volume_mm3.at(Role::solid_infill)).epsilon(0.01));
    options.profile.infill.pattern = profile::InfillPattern::aligned;
    options.profile.infill.angle_deg = 20;
    const Printed lines = printed(box(20, 20, 20), options);
    CHECK(direction_deg(lines.layers[94], Role::sparse_infill) == 20);
    CHECK(std::abs(direction_deg(lines.layers[95], Role::internal_bridge) - 110) <= 20);
}

TEST_CASE("internal bridge: none in a solid part") {
    const Printed cube = printed(box(10, 10, 4), filled(1));
    CHECK(cube.layers_with(Role::internal_bridge).empty());
}

TEST_CASE("internal bridge: the same bytes for any number of threads") {
    for (const double density : {0.0, 0.15}) {
        std::set<std::string> results;
        for (const unsigned threads : {1u, 2u, 5u}) {
            Options options = filled(density);
            options.threads = threads;
            results.insert(printed(box(20, 20, 20), options).bytes);
        }
        CHECK(results.size() == 1);
    }
}

TEST_CASE("sparse fill so thin that no line of it fits is said once") {
    const Printed cube = printed(box(20, 20, 20), filled(0.01));
    REQUIRE(cube.diagnostics.size() == 1);
    CHECK(cube.diagnostics[0].severity == Severity::warning);
    CHECK(cube.diagnostics[0].message ==
          "no line of the sparse fill fits into the part (infill.density = 1%)");
    CHECK(cube.layers_with(Role::sparse_infill).empty());
    CHECK(cube.layers_with(Role::internal_bridge) == std::vector<std::size_t>{95});
}

TEST_CASE(
    "solid fill that lies on nothing within reach of a wall is said once, with its first layer") {
    // The floor of the box is far from the walls of the plate below.
    Options options = filled(0);
    options.profile.layer.height_mm = options.profile.layer.first_height_mm = 0.4;
    Diagnostics diagnostics;
    const auto gearbox =
        load(std::string(LYR_FIXTURES) + "/parts/gearbox_base.step", options, diagnostics);
    REQUIRE(gearbox);
    const Printed empty = printed(*gearbox, options);
    REQUIRE(empty.diagnostics.size() == 1);
    const Diagnostic& warning = empty.diagnostics[0];
    CHECK(warning.severity == Severity::warning);
    CHECK(warning.message.starts_with("solid fill lies on nothing that holds it in "));
    REQUIRE(warning.where.layer.has_value());
    const LayerFigures& layer = empty.layers[static_cast<std::size_t>(*warning.where.layer - 1)];
    CHECK(layer.length_mm.contains(Role::solid_infill));
    options.profile.infill.density = 0.15;
    CHECK(printed(*gearbox, options).diagnostics.empty());
}
