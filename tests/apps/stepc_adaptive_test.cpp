// stepc --cusp: what it says, what the file has, and that the printer's controller takes it.

#include <cmath>

#include "apps/program.h"
#include "format/reader.h"

using namespace lyr;
using namespace lyr::tests;

namespace {

// The file's own rounding of a height.
constexpr double quantum_mm = 1e-3;

// What coordinates may be off a flow's limit: a rounded width or height.
constexpr double rounding = 1.01;

struct Layers {
    std::vector<double> top_mm, height_mm;
    std::size_t off_height = 0;  // paths of another height than their layer
    double most_mm3_s = 0;
    double print_s = 0;
};

Layers layers_of(const fs::path& path) {
    auto reader = format::Reader::open(path);
    REQUIRE(reader.ok());
    Layers layers;
    layers.print_s = reader->header().summary.estimated_time_s;
    for (;;) {
        const auto next = reader->next();
        REQUIRE(next.ok());
        if (!*next) return layers;
        if (std::holds_alternative<format::LayerStart>(**next)) {
            layers.top_mm.push_back(reader->layer().state.z_mm);
            layers.height_mm.push_back(reader->layer().state.height_mm);
        } else if (const auto* start = std::get_if<format::PathStart>(&**next)) {
            const format::PathStyle& style = start->style;
            layers.off_height += std::abs(style.height_mm - layers.height_mm.back()) > quantum_mm;
            layers.most_mm3_s =
                std::max(layers.most_mm3_s, style.speed_mm_s * cross_section_mm2(style));
        }
    }
}

}  // namespace

TEST_CASE("stepc --cusp: layers lie on each other, are as thick as allowed, and end at the top") {
    const Folder folder("stepc-cusp");
    folder.copy("parts/gearbox_base.step", "p.step");
    const Ended sliced = folder.run("stepc p.step --cusp 0.05 --at 40,40");
    CAPTURE(sliced.err);
    REQUIRE(sliced.status == 0);
    CHECK(sliced.err.empty());
    CHECK(sliced.out.find(" in a first layer of 0.2 mm and others of 0.1 to 0.3 mm") !=
          sliced.out.npos);
    CHECK(sliced.out.find("uniform layers would be 299 of 0.1 mm") != sliced.out.npos);
    const Layers layers = layers_of(folder / "p.lyr");
    REQUIRE(layers.top_mm.size() > 100);
    double below_mm = 0;
    for (std::size_t i = 0; i < layers.top_mm.size(); ++i) {
        CHECK(std::abs(layers.top_mm[i] - below_mm - layers.height_mm[i]) <= 2 * quantum_mm);
        CHECK(layers.height_mm[i] >= 0.1 - quantum_mm);
        CHECK(layers.height_mm[i] <= 0.3 + quantum_mm);
        below_mm = layers.top_mm[i];
    }
    CHECK(below_mm == doctest::Approx(30));
    CHECK(layers.off_height == 0);
    CHECK(folder.run("lyrview p.lyr --info").out.find("0.1 to 0.3 mm thick") != std::string::npos);
}

TEST_CASE("stepc --cusp: the printer's controller takes as long as stepc says") {
    const Folder folder("stepc-cusp-time");
    folder.copy("parts/cube_hole.step", "p.step");
    REQUIRE(folder.run("stepc p.step --cusp 0.1 --at 40,40").status == 0);
    const Ended simulated = folder.run("lyrrun p.lyr --simulate --json");
    REQUIRE(simulated.status == 0);
    const std::string key = "\"print_time_s\":";
    const double time_s = std::stod(simulated.out.substr(simulated.out.find(key) + key.size()));
    CHECK(layers_of(folder / "p.lyr").print_s == doctest::Approx(time_s).epsilon(0.01));
}

TEST_CASE("stepc --cusp: what the hot end melts limits the thick layers too") {
    const Folder folder("stepc-cusp-flow");
    folder.copy("parts/cube_hole.step", "p.step");
    const std::string slice = "stepc p.step --cusp 0.05 --set filament.max_volumetric_speed=";
    REQUIRE(folder.run(slice + "0 -o free.lyr").status == 0);
    REQUIRE(folder.run(slice + "4 -o limited.lyr").status == 0);
    CHECK(layers_of(folder / "free.lyr").most_mm3_s > 8);
    CHECK(layers_of(folder / "limited.lyr").most_mm3_s <= 4 * rounding);
}

TEST_CASE("stepc --cusp: the same bytes for any number of threads") {
    const Folder folder("stepc-cusp-threads");
    folder.copy("parts/transmission_pulley_at3_t10_center.step", "p.step");
    REQUIRE(folder.run("stepc p.step --cusp 0.02 -o one.lyr --threads 1").status == 0);
    REQUIRE(folder.run("stepc p.step --cusp 0.02 -o five.lyr --threads 5").status == 0);
    CHECK(text_of(folder / "one.lyr") == text_of(folder / "five.lyr"));
}

TEST_CASE("stepc --cusp is short for two keys; a wrong one is told") {
    const Folder folder("stepc-cusp-keys");
    folder.copy("parts/cuboid.step", "p.step");
    const std::string shown = folder.run("stepc --cusp 0.02 --print-config").out;
    CHECK(shown.find("\nadaptive = true ") != shown.npos);
    CHECK(shown.find("\ncusp = 0.02 ") != shown.npos);
    CHECK(shown.find("# --cusp") != shown.npos);
    REQUIRE(folder.run("stepc p.step --cusp 0.02 -o short.lyr").status == 0);
    REQUIRE(folder.run("stepc p.step --set layer.adaptive=true --set layer.cusp=0.02 -o long.lyr")
                .status == 0);
    CHECK(layers_of(folder / "short.lyr").top_mm == layers_of(folder / "long.lyr").top_mm);
    check_failure(folder.run("stepc p.step --cusp 0"), "stepc", 2, "layer.cusp");
    check_failure(folder.run("stepc p.step --cusp x"), "stepc", 2, "layer.cusp");
    check_failure(folder.run("stepc p.step --cusp 0.02 --set layer.cusp=0.03"), "stepc", 2,
                  "layer.cusp is given by");
    check_failure(folder.run("stepc p.step --cusp 0.02 --set perimeters.width=0.25"), "stepc", 2,
                  "layer.max_height");
}
