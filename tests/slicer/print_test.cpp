// Prints of real files: whole, repeatable, and nothing left behind when they fail.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "format/reader.h"
#include "slicer/scene.h"
#include "slicer/slicer.h"

using namespace lyr;
using namespace lyr::slicer;
using lyr::testing::bytes_of;
using lyr::testing::parts;
using lyr::testing::scratch;

namespace {

Result<Summary> print_part(const std::string& file, const std::string& lyr, Options options,
                           const std::string& report = "") {
    Diagnostics diagnostics;
    auto model = load(parts + file, options, diagnostics);
    if (!model) return model.error();
    return print(
        std::move(*model), file, lyr, report, options, [](const char*, std::size_t, std::size_t) {},
        diagnostics);
}

}  // namespace

TEST_CASE("the gearbox base is 150 layers, and every vertical bore a circle in each") {
    const std::string lyr = scratch("gearbox.lyr"), report = scratch("gearbox.jsonl");
    const auto summary = print_part("gearbox_base.step", lyr, {}, report);
    REQUIRE(summary);
    CHECK(summary->layers == 150);
    CHECK(summary->bytes == std::filesystem::file_size(lyr));
    std::ifstream lines(report);
    CHECK(std::count(std::istreambuf_iterator<char>(lines), {}, '\n') == 150);

    auto reader = format::Reader::open(lyr);
    REQUIRE(reader);
    std::size_t layers = 0;
    // By centre: the circles of one layer about it, which are walls of one bore.
    std::map<std::pair<std::int64_t, std::int64_t>, std::size_t> circles_below;
    for (;;) {
        auto operation = reader->next();
        REQUIRE(operation);
        if (!*operation) break;
        if (std::holds_alternative<format::LayerStart>(**operation)) ++layers;
        const auto* circle = std::get_if<format::Circle>(&**operation);
        if (layers == 10 && circle) ++circles_below[{circle->center_x, circle->center_y}];
    }
    CHECK(layers == 150);
    // Seven of the eight loops at z = 1.9 are bores.
    CHECK(circles_below.size() == 7);
    for (const auto& [centre, walls] : circles_below) CHECK(walls == profile::Perimeters{}.count);
}

TEST_CASE("slicer 2: the same bytes for one, two and five threads") {
    for (const char* file : {"gearbox_base.step", "foot_structure.step"}) {
        std::set<std::string> results;
        for (const unsigned threads : {1u, 2u, 5u}) {
            Options options;
            options.profile.layer.height_mm = options.profile.layer.first_height_mm = 0.5;
            options.threads = threads;
            REQUIRE(print_part(file, scratch("threads.lyr"), options));
            results.insert(bytes_of(scratch("threads.lyr")));
        }
        CHECK(results.size() == 1);
    }
}

TEST_CASE("slicer 4: the part stands on the bed at its place, whichever side is up") {
    for (const Vector3& up :
         {Vector3(0, 0, 1), Vector3(0, 0, -1), Vector3(1, 0, 0), Vector3(0, -1, 0)}) {
        Options options;
        options.up = up;
        options.profile.layer.height_mm = options.profile.layer.first_height_mm = 1;
        options.profile.plate.at_mm = {20, 30};
        const auto summary = print_part("gearbox_base.step", scratch("up.lyr"), options);
        REQUIRE(summary);
        CHECK((summary->box.min() - Vector3(20, 30, 0)).norm() < 1e-6);
        CHECK(summary->box.sizes().prod() == doctest::Approx(136 * 64.5 * 30));
    }
}

TEST_CASE("slicer 1: a print that fails leaves the old file and nothing else") {
    const std::string folder = scratch("fails/");
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    const std::string lyr = folder + "part.lyr";
    std::ofstream(lyr) << "old";
    Diagnostics diagnostics;
    auto model = load(parts + "cuboid.step", {}, diagnostics);
    REQUIRE(model);
    // An upright face goes missing: every layer is open there.
    const auto upright =
        std::find_if(model->faces.begin(), model->faces.end(), [](const Face& face) {
            const auto* plane = std::get_if<Plane>(&face.surface);
            return plane && std::abs(plane->frame.z.z()) < 0.5;
        });
    REQUIRE(upright != model->faces.end());
    std::iter_swap(upright, model->faces.end() - 1);
    model->shells[0].face_count -= 1;
    model->faces.pop_back();
    const auto failed = print(
        std::move(*model), "cuboid.step", lyr, folder + "report.jsonl", {},
        [](const char*, std::size_t, std::size_t) {}, diagnostics);
    REQUIRE(!failed);
    CHECK(failed.error().status == ExitStatus::geometry);
    CHECK(bytes_of(lyr) == "old");
    const auto entries = std::filesystem::directory_iterator(folder);
    CHECK(std::distance(begin(entries), end(entries)) == 1);
}

TEST_CASE("slicer: a print has its settings within it, and those of the material in its metadata") {
    Options options;
    options.profile.layer.height_mm = options.profile.layer.first_height_mm = 1;
    options.profile.filament = {"ABS", 2.85, 1.04, 0, 12, 1};
    options.profile.temperature = {230, 240, 100, 110, 0};
    options.profile.speed.travel_mm_s = 123;
    options.profile_name = "abs";
    options.configuration = "[layer]\nheight = 1\n";
    CHECK(options.tolerance().total_mm == Tolerance{}.total_mm);
    REQUIRE(print_part("cuboid.step", scratch("settings.lyr"), options));
    auto reader = format::Reader::open(scratch("settings.lyr"));
    REQUIRE(reader);
    const format::Metadata& data = reader->header().metadata;
    CHECK(data.material == "ABS");
    CHECK(data.profile == "abs");
    CHECK(data.filament_diameter_mm == 2.85);
    CHECK(data.filament_density_g_cm3 == 1.04);
    CHECK(data.configuration == options.configuration);
    std::vector<std::pair<double, double>> bed_and_nozzle_c;
    for (;;) {
        auto operation = reader->next();
        REQUIRE(operation);
        if (!*operation) break;
        if (!std::holds_alternative<format::LayerStart>(**operation)) continue;
        const format::LayerState& state = reader->layer().state;
        CHECK(state.travel_speed_mm_s == 123);
        REQUIRE(state.temperatures.size() == 2);
        bed_and_nozzle_c.emplace_back(state.temperatures[0].target_c,
                                      state.temperatures[1].target_c);
    }
    REQUIRE(bed_and_nozzle_c.size() == 76);
    CHECK(bed_and_nozzle_c.front() == std::pair(110.0, 240.0));
    for (std::size_t i = 1; i < bed_and_nozzle_c.size(); ++i)
        CHECK(bed_and_nozzle_c[i] == std::pair(100.0, 230.0));
}

TEST_CASE("slicer: a place that cannot be written is an error of output") {
    const auto failed = print_part("cuboid.step", scratch("no/such/folder/x.lyr"), {});
    REQUIRE(!failed);
    CHECK(failed.error().status == ExitStatus::output);
}

TEST_CASE(
    "slicer: supports and adaptive layers that change nothing say nothing, and a part beside its "
    "plate is refused") {
    Options options;
    options.profile.layer.height_mm = options.profile.layer.first_height_mm = 0.4;
    options.profile.support.kind = profile::SupportKind::tree;
    options.profile.layer.adaptive = true;
    Diagnostics diagnostics;
    const auto model = load(parts + "cuboid.step", options, diagnostics);
    REQUIRE(model);
    diagnostics.clear();
    const auto print_it = [&] {
        return print(
            *model, "cuboid.step", scratch("asked.lyr"), "", options,
            [](const char*, std::size_t, std::size_t) {}, diagnostics);
    };
    REQUIRE(print_it());
    CHECK(diagnostics.empty());
    options.profile.plate.size_mm = {10, 10};
    const auto refused = print_it();
    REQUIRE(!refused);
    CHECK(refused.error().message.find("does not lie on the plate") != std::string::npos);
    options.profile.plate.size_mm = {1000, 1000};
    CHECK(print_it());
}

TEST_CASE("without walls, fill reached out of the part by its overlap with walls") {
    for (const double overlap : {0.0, 0.25, 1.0}) {
        CAPTURE(overlap);
        Options options;
        options.profile.perimeters.count = 0;
        options.profile.infill.density = 1;
        options.profile.infill.overlap = overlap;
        const auto printed = print_part("cuboid.step", scratch("bare.lyr"), options);
        REQUIRE(printed);
        const auto reader = format::Reader::open(scratch("bare.lyr"));
        REQUIRE(reader);
        const format::Summary& summary = reader->header().summary;
        const double inset_mm = options.profile.skin.width_mm / 2 - 0.002;
        const Vector3 size = printed->box.sizes();
        CHECK(summary.low_x_mm >= inset_mm);
        CHECK(summary.low_y_mm >= inset_mm);
        CHECK(summary.high_x_mm <= size.x() - inset_mm);
        CHECK(summary.high_y_mm <= size.y() - inset_mm);
        CHECK(summary.low_x_mm < inset_mm + 0.3);
    }
}

TEST_CASE("slicer: skirt and brim go around the part on the first layer, and come first") {
    for (const auto& [kind, role, reach_mm] :
         {std::tuple(profile::AdhesionKind::skirt, format::Role::skirt, 6.225),
          {profile::AdhesionKind::brim, format::Role::brim, 5.11}}) {
        Options options;
        options.profile.adhesion.kind = kind;
        options.profile.plate.at_mm = {20, 20};
        const auto summary = print_part("cuboid.step", scratch("adhesion.lyr"), options);
        REQUIRE(summary);
        auto reader = format::Reader::open(scratch("adhesion.lyr"));
        REQUIRE(reader);
        CHECK(reader->header().summary.low_x_mm == doctest::Approx(20 - reach_mm).epsilon(0.02));
        std::vector<format::Role> roles;
        std::uint32_t layer = 0, last = 0;
        for (;;) {
            auto operation = reader->next();
            REQUIRE(operation);
            if (!*operation) break;
            if (const auto* start = std::get_if<format::LayerStart>(&**operation))
                layer = start->index;
            const auto* path = std::get_if<format::PathStart>(&**operation);
            if (!path) continue;
            roles.push_back(path->style.role);
            if (path->style.role == role) last = layer;
        }
        CHECK(roles.front() == role);
        CHECK(last == 0);
    }
}

TEST_CASE(
    "slicer: of a part that is thinner than any line nothing is printed, and that is an error") {
    const std::string lyr = scratch("thin.lyr");
    std::filesystem::remove(lyr);
    Options options;
    options.profile.perimeters.min_width_mm = options.profile.perimeters.max_width_mm = 19.9;
    options.profile.perimeters.width_mm = 19.9;
    options.profile.perimeters.min_gap_mm = 19.9;
    const auto summary = print_part("cube_hole.step", lyr, options);
    REQUIRE(!summary);
    CHECK(summary.error().message.find("nothing to print") != std::string::npos);
    CHECK(!std::filesystem::exists(lyr));
}
