// Contract 4 of slicer/plate.h, and copies that are printed one after the other.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "format/reader.h"
#include "scratch.h"
#include "slicer/plate.h"

using namespace lyr;
using namespace lyr::slicer;

namespace {

using Box2 = Eigen::AlignedBox2d;

constexpr double copy_width_mm = 30, copy_depth_mm = 20;

profile::Profile sequential(std::uint32_t copies) {
    profile::Profile profile;
    profile.plate.sequential = true;
    profile.plate.copies = copies;
    return profile;
}

Result<PlateLayout> layout_of(const profile::Profile& profile, double height_mm) {
    return lay_out({Vector3(0, 0, 0), Vector3(copy_width_mm, copy_depth_mm, height_mm)}, profile);
}

double distance_mm(const Vector2& a, const Vector2& b) {
    const Box2 box(Point2(0, 0), Point2(copy_width_mm, copy_depth_mm));
    return box.translated(a).exteriorDistance(box.translated(b));
}

double least_distance_mm(const PlateLayout& layout) {
    double least_mm = 1e9;
    for (std::size_t i = 0; i < layout.shifts.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            least_mm = std::min(least_mm, distance_mm(layout.shifts[i], layout.shifts[j]));
    return least_mm;
}

}  // namespace

TEST_CASE("plate 4: the head at work on a copy or its brim reaches no other") {
    for (const double radius_mm : {5.0, 20.0, 45.0})
        for (const double spacing_mm : {0.0, 30.0})
            for (const bool has_brim : {false, true}) {
                profile::Profile profile = sequential(7);
                profile.plate.clearance_radius_mm = radius_mm;
                profile.plate.spacing_mm = spacing_mm;
                if (has_brim) profile.adhesion.kind = profile::AdhesionKind::brim;
                const auto layout = layout_of(profile, 10);
                REQUIRE(layout);
                const double least_mm = least_distance_mm(*layout);
                // 5 mm in whole lines.
                CHECK(least_mm > radius_mm + (has_brim ? 5 : 0) - 1e-5);
                CHECK(least_mm > spacing_mm + (has_brim ? 10 : 0) - 1e-5);
                CHECK(layout->is_sequential());
                CHECK(layout->columns > 1);
            }
}

TEST_CASE("plate 4: copies that meet the gantry lie one behind the other, from the front") {
    const profile::Profile profile = sequential(6);
    const auto low = layout_of(profile, 25), high = layout_of(profile, 25.1);
    REQUIRE(low);
    REQUIRE(high);
    CHECK(low->columns > 1);
    CHECK(high->columns == 1);
    for (std::size_t i = 1; i < high->shifts.size(); ++i)
        CHECK(high->shifts[i].y() >= high->shifts[i - 1].y() + copy_depth_mm + 45 - 1e-5);
    // What stands on a raft is as much higher (its box begins there).
    const auto raised =
        lay_out({Vector3(0, 0, 2), Vector3(copy_width_mm, copy_depth_mm, 26)}, profile);
    REQUIRE(raised);
    CHECK(raised->columns == 1);
    // Layer by layer nothing stands higher than the nozzle.
    profile::Profile by_layer = profile;
    by_layer.plate.sequential = false;
    CHECK(layout_of(by_layer, 100)->columns > 1);
    CHECK(!layout_of(by_layer, 100)->is_sequential());
    CHECK(!layout_of(sequential(1), 100)->is_sequential());
}

TEST_CASE(
    "plate 2, 4: a plate without room for the head is refused, with how many would fit and why") {
    profile::Profile profile = sequential(9);
    profile.plate.size_mm = {200, 210};
    const auto low = layout_of(profile, 10);
    CHECK(low);
    const auto high = layout_of(profile, 60);
    REQUIRE(!high);
    CHECK(high.error().status == ExitStatus::geometry);
    const std::string& text = high.error().message;
    for (const char* part : {"9 copies of 30 x 20 mm", "45 mm apart and one behind the other",
                             "plate.clearance_height", "at most 3 would", "plate.clearance_radius"})
        CHECK_MESSAGE(text.find(part) != std::string::npos, text);
    profile.plate.copies = 3;
    CHECK(layout_of(profile, 60));
    profile.plate.copies = 4;
    CHECK(!layout_of(profile, 60));
}

namespace {

Summary printed(const std::string& name, const Options& options) {
    Diagnostics diagnostics;
    auto model = load(std::string(LYR_FIXTURES) + "/parts/cube_hole.step", options, diagnostics);
    REQUIRE(model);
    const auto summary = print(
        std::move(*model), "cube_hole.step", lyr::tests::scratch(name), "", options,
        [](const char*, std::size_t, std::size_t) {}, diagnostics);
    REQUIRE(summary);
    CHECK(diagnostics.empty());
    return *summary;
}

Options three_copies() {
    Options options;
    options.profile = sequential(3);
    options.profile.layer.height_mm = options.profile.layer.first_height_mm = 0.4;
    options.profile.travel.wipe_mm = 1;
    options.profile.adhesion.kind = profile::AdhesionKind::brim;
    return options;
}

// What is printed of a layer, and how high the head was before it went there.
struct Layer {
    std::uint32_t object = 0;
    double z_mm = 0, came_from_mm = 0;
    Box2 box;
};

std::vector<Layer> layers_of(const std::string& name) {
    auto reader = format::Reader::open(lyr::tests::scratch(name));
    REQUIRE(reader);
    std::vector<Layer> layers;
    double head_mm = 0;
    while (const format::Operation* operation = reader->read()) {
        if (std::holds_alternative<format::LayerStart>(*operation)) {
            const format::Layer& layer = reader->layer();
            const format::Bounds& motion = layer.totals.motion;
            const auto mm = [](std::int64_t quanta) { return static_cast<double>(quanta) * 1e-3; };
            layers.push_back({layer.state.object, layer.state.z_mm, head_mm,
                              Box2(Point2(mm(motion.low.x), mm(motion.low.y)),
                                   Point2(mm(motion.high.x), mm(motion.high.y)))});
            head_mm = layer.state.z_mm;
        }
        if (const auto* travel = std::get_if<format::Travel>(operation))
            head_mm = static_cast<double>(travel->to.z) * 1e-3;
        CHECK(!std::holds_alternative<format::Object>(*operation));
    }
    CHECK(!reader->error());
    return layers;
}

}  // namespace

TEST_CASE("sequence: copies come whole, one after the other, and the head rises over what stands") {
    Options options = three_copies();
    const Summary summary = printed("three.lyr", options);
    CHECK(summary.placed.find("one after the other") != std::string::npos);
    const auto layers = layers_of("three.lyr");
    REQUIRE(layers.size() == 3 * summary.layers);
    const double top_mm = layers[summary.layers - 1].z_mm;
    std::vector<Box2> copies(3), parts(3);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const std::size_t copy = i / summary.layers, own = i % summary.layers;
        CHECK(layers[i].object == copy + 1);
        CHECK(layers[i].z_mm == doctest::Approx(0.4 * static_cast<double>(own + 1)));
        if (own == 0 && copy > 0) CHECK(layers[i].came_from_mm == doctest::Approx(top_mm + 2));
        copies[copy].extend(layers[i].box);
        if (own > 0) parts[copy].extend(layers[i].box);
    }
    // The head's reach around all that it does for a copy, its brim included, is clear of the others.
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < i; ++j) CHECK(copies[i].exteriorDistance(parts[j]) > 45);
}

TEST_CASE("sequence: a copy costs what one part costs, and the same bytes on any thread") {
    Options options = three_copies();
    std::set<std::string> results;
    Summary three;
    for (const unsigned threads : {1u, 4u}) {
        options.threads = threads;
        three = printed("threads.lyr", options);
        std::ifstream file(lyr::tests::scratch("threads.lyr"), std::ios::binary);
        results.insert({std::istreambuf_iterator<char>(file), {}});
    }
    CHECK(results.size() == 1);
    options.profile.plate.copies = 1;
    const Summary one = printed("single.lyr", options);
    CHECK(three.filament_mm == doctest::Approx(3 * one.filament_mm).epsilon(1e-4));
    CHECK(three.layers == one.layers);
    // The ways between copies, over their tops, are new.
    CHECK(three.estimate.time_s() > 3 * one.estimate.time_s());
    CHECK(three.estimate.time_s() < 3 * one.estimate.time_s() + 60);
}

TEST_CASE("sequence: a skirt is printed once, before everything, around all copies") {
    Options options = three_copies();
    options.profile.adhesion.kind = profile::AdhesionKind::skirt;
    printed("skirt.lyr", options);
    auto reader = format::Reader::open(lyr::tests::scratch("skirt.lyr"));
    REQUIRE(reader);
    Box2 skirt, all;
    std::set<std::uint32_t> with_skirt;
    while (const format::Operation* operation = reader->read()) {
        const auto* line = std::get_if<format::Line>(operation);
        if (!line) continue;
        const Point2 to(static_cast<double>(line->to.x) * 1e-3,
                        static_cast<double>(line->to.y) * 1e-3);
        all.extend(to);
        if (reader->path().role != format::Role::skirt) continue;
        skirt.extend(to);
        with_skirt.insert(reader->layer().index);
    }
    CHECK(with_skirt == std::set<std::uint32_t>{0});
    CHECK(skirt.min() == all.min());
    CHECK(skirt.max() == all.max());
}
