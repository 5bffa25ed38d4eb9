// Rafts: what is printed below the part, and that the part is the same on it.

#include "slicer/raft.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "format/reader.h"
#include "kernel/brep/assembly.h"
#include "kernel/brep/placement.h"
#include "kernel/solids.h"
#include "scratch.h"
#include "slicer/scene.h"
#include "slicer/slicer.h"

using namespace lyr;
using namespace lyr::slicer;
using namespace lyr::testing;

namespace {

Options with_raft(std::uint32_t layers) {
    Options options;
    options.threads = 1;
    options.profile.adhesion.kind = profile::AdhesionKind::raft;
    options.profile.adhesion.raft_layers = layers;
    return options;
}

struct LayerRoles {
    format::LayerState state;
    std::set<format::Role> roles{};
};

std::vector<LayerRoles> printed(const Model& model, const Options& options, Summary* summary) {
    Diagnostics diagnostics;
    const auto done = print(
        model, "part", lyr::tests::scratch("part.lyr"), "", options,
        [](const char*, std::size_t, std::size_t) {}, diagnostics);
    REQUIRE(done);
    CHECK(diagnostics.empty());
    *summary = *done;
    auto reader = format::Reader::open(lyr::tests::scratch("part.lyr"));
    REQUIRE(reader);
    std::vector<LayerRoles> layers;
    for (;;) {
        const auto next = reader->next();
        REQUIRE(next);
        if (!*next) return layers;
        if (std::holds_alternative<format::LayerStart>(**next))
            layers.push_back({reader->layer().state});
        if (const auto* start = std::get_if<format::PathStart>(&**next))
            layers.back().roles.insert(start->style.role);
    }
}

double volume_of(const Summary& summary, format::Role role) {
    return summary.estimate.roles[static_cast<std::size_t>(role)].volume_mm3;
}

}  // namespace

TEST_CASE("raft 2, 3: the part is raised by the raft and the gap, and as high as without") {
    for (const std::uint32_t count : {1u, 2u, 3u, 7u}) {
        Options options = with_raft(count);
        options.profile.adhesion.raft_gap_mm = 0.15;
        const auto spans = on_raft(layer_spans(4, part_layers(options.profile)), options.profile);
        REQUIRE(spans.size() == count + 20);
        CHECK(spans[0].bottom_mm == 0);
        for (std::size_t i = 1; i < spans.size(); ++i) {
            const double gap = i == count ? 0.15 : 0;
            CHECK(spans[i].bottom_mm == doctest::Approx(spans[i - 1].top_mm + gap));
        }
        CHECK(spans[count].bottom_mm == doctest::Approx(raised_mm(options.profile)));
        CHECK(spans.back().top_mm == doctest::Approx(raised_mm(options.profile) + 4));
    }
    CHECK(raised_mm({}) == 0);
    CHECK(on_raft(layer_spans(4, {}), {}).size() == 20);
}

TEST_CASE("raft 1, 2: layers of the raft, then those of the part as they are without it") {
    const Model part = drilled_box(20, 12, 4, 3);
    Summary without, with;
    const auto plain = printed(part, {}, &without);
    const Options options = with_raft(3);
    const auto layers = printed(part, options, &with);
    REQUIRE(layers.size() == plain.size() + 3);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const bool is_raft = layers[i].roles == std::set{format::Role::raft};
        CHECK(is_raft == (i < 3));
        if (i < 3) continue;
        CHECK(layers[i].roles == plain[i - 3].roles);
        CHECK(layers[i].state.z_mm - plain[i - 3].state.z_mm ==
              doctest::Approx(raised_mm(options.profile)));
    }
    for (const format::Role role : {format::Role::outer_wall, format::Role::bottom_skin,
                                    format::Role::top_skin, format::Role::sparse_infill})
        CHECK(volume_of(with, role) == doctest::Approx(volume_of(without, role)).epsilon(1e-3));
    // The first layer's settings are the raft's, who is printed first.
    CHECK(layers[0].state.fans[0].duty == 0);
    CHECK(layers[3].state.fans[0].duty > 0);
    // Of 26 x 18 mm with round corners; the bore is closed. One layer half full, 0.3 mm thick, two dense ones.
    const double area = 26 * 18 - (4 - pi) * 9;
    CHECK(volume_of(with, format::Role::raft) ==
          doctest::Approx(area * (0.3 * 0.5 + 2 * 0.2)).epsilon(0.04));
}

TEST_CASE("raft: support stands on it") {
    const Model ball = sphere(4, true);
    Options options = with_raft(2);
    options.profile.support.kind = profile::SupportKind::grid;
    Summary summary;
    const auto layers = printed(ball, options, &summary);
    CHECK(layers[1].roles == std::set{format::Role::raft});
    CHECK(layers[2].roles.contains(format::Role::support));
    CHECK(layers[2].roles.contains(format::Role::outer_wall));
    CHECK(volume_of(summary, format::Role::support) > 5);
}

TEST_CASE("raft: a part lower than half of its layers on the raft is refused, not printed empty") {
    for (const auto& [layer_mm, first_mm, is_refused] :
         {std::tuple(0.3, 0.2, true), {0.3, 0.1, true}, {0.1, 0.3, false}}) {
        CAPTURE(layer_mm);
        CAPTURE(first_mm);
        Options options = with_raft(3);
        options.profile.layer.height_mm = layer_mm;
        options.profile.layer.first_height_mm = first_mm;
        const std::string path = lyr::tests::scratch("low.lyr");
        Diagnostics diagnostics;
        const auto done = print(
            box(20, 20, 0.12), "low", path, "", options,
            [](const char*, std::size_t, std::size_t) {}, diagnostics);
        CHECK(!done == is_refused);
        if (!done) CHECK(done.error().status == ExitStatus::geometry);
    }
}

TEST_CASE("raft: it lies under what hangs over so low that its support would begin within it") {
    // A plate on two feet of a layer each.
    Model feet = at(box(3, 20, 0.3), -15.5, 0, 0.15);
    append(feet, at(box(3, 20, 0.3), 15.5, 0, 0.15));
    append(feet, at(box(34, 20, 2), 0, 0, 1.2));
    Options options = with_raft(3);
    options.profile.support.kind = profile::SupportKind::grid;
    Summary summary;
    printed(feet, options, &summary);
    Options of_feet = with_raft(3);
    Summary without;
    printed(feet, of_feet, &without);
    CHECK(volume_of(summary, format::Role::raft) > 2 * volume_of(without, format::Role::raft));
}
