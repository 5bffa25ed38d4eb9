// Prints of real files: whole, repeatable, and nothing left behind when they fail.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "format/reader.h"
#include "slicer/slicer.h"

using namespace lyr;
using namespace lyr::slicer;

namespace {

const std::string parts = std::string(LYR_FIXTURES) + "/parts/";

std::string scratch(const std::string& name) {
    const std::string folder = std::string(LYR_BUILD) + "/test-print/";
    std::filesystem::create_directories(folder);
    return folder + name;
}

std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

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
    std::size_t layers = 0, circles_below = 0;
    for (;;) {
        auto operation = reader->next();
        REQUIRE(operation);
        if (!*operation) break;
        if (std::holds_alternative<format::LayerStart>(**operation)) ++layers;
        if (layers == 10 && std::holds_alternative<format::Circle>(**operation)) ++circles_below;
    }
    CHECK(layers == 150);
    // Seven of the eight loops at z = 1.9 are bores.
    CHECK(circles_below == 7);
}

TEST_CASE("slicer 2: the same bytes for one, two and five threads") {
    for (const char* file : {"gearbox_base.step", "foot_structure.step"}) {
        std::set<std::string> results;
        for (const unsigned threads : {1u, 2u, 5u}) {
            Options options;
            options.layer_height_mm = 0.5;
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
        options.layer_height_mm = 1;
        options.bed_position_mm = {20, 30};
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

TEST_CASE("slicer: a place that cannot be written is an error of output") {
    const auto failed = print_part("cuboid.step", scratch("no/such/folder/x.lyr"), {});
    REQUIRE(!failed);
    CHECK(failed.error().status == ExitStatus::output);
}
