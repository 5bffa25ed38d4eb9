// Contract of bench/arc_share.h, by number, on prints of real parts and on files that are not as they should be.

#include "bench/arc_share.h"

#include <doctest/doctest.h>

#include <filesystem>

#include "format/arc.h"
#include "format/reader.h"
#include "format/writer.h"
#include "scratch.h"

using namespace lyr;
using namespace lyr::bench;

namespace {

struct Part {
    Model model;
    slicer::Options options;
    std::string lyr;
};

Part printed(const std::string& file, const Vector3& up = Vector3::UnitZ(),
             std::array<double, 2> at_mm = {0, 0}) {
    Part part;
    part.lyr = lyr::tests::scratch("part.lyr");
    part.options.up = up;
    part.options.profile.layer.height_mm = part.options.profile.layer.first_height_mm = 0.4;
    part.options.profile.infill.density = 0;
    part.options.profile.plate.at_mm = at_mm;
    Diagnostics diagnostics;
    auto model =
        slicer::load(std::string(LYR_FIXTURES) + "/parts/" + file, part.options, diagnostics);
    REQUIRE(model);
    part.model = std::move(*model);
    REQUIRE(slicer::print(
        part.model, file, part.lyr, "", part.options, [](const char*, std::size_t, std::size_t) {},
        diagnostics));
    return part;
}

ArcShares shares_of(const Part& part, std::size_t most_layers = 8) {
    const auto shares = arc_shares(part.model, part.lyr, part.options, most_layers);
    REQUIRE(shares);
    return *shares;
}

// The print with each arc and circle of a wall as that many chords.
void cut_into_chords(const Part& part, int chords) {
    auto reader = format::Reader::open(part.lyr);
    REQUIRE(reader);
    auto writer = format::Writer::create(part.lyr, reader->header().quantum, {});
    REQUIRE(writer);
    std::optional<format::LayerEncoder> layer;
    const double mm = reader->header().quantum.mm(1);
    const auto finish = [&] {
        if (!layer) return;
        const auto encoded = layer->finish();
        REQUIRE(encoded);
        REQUIRE(writer->append(*encoded));
    };
    const auto along = [&](const format::ArcShape& shape) {
        for (int i = 1; i <= chords; ++i) {
            const double angle = shape.start_angle_rad + shape.sweep_rad * i / chords;
            layer->line_to(mm * (shape.center_x + shape.radius * std::cos(angle)),
                           mm * (shape.center_y + shape.radius * std::sin(angle)));
        }
    };
    while (const format::Operation* operation = reader->read()) {
        if (std::holds_alternative<format::LayerStart>(*operation)) {
            finish();
            layer.emplace(reader->header().quantum, reader->layer().state);
        }
        if (const auto* path = std::get_if<format::PathStart>(operation))
            layer->begin_path(path->style);
        const auto go = [&](const format::Point& to, bool extrudes) {
            const double x = mm * static_cast<double>(to.x), y = mm * static_cast<double>(to.y);
            extrudes ? layer->line_to(x, y) : layer->travel_to(x, y);
        };
        if (const auto* line = std::get_if<format::Line>(operation)) go(line->to, true);
        if (const auto* travel = std::get_if<format::Travel>(operation)) go(travel->to, false);
        if (const auto* arc = std::get_if<format::Arc>(operation)) along(format::arc_shape(*arc));
        if (const auto* circle = std::get_if<format::Circle>(operation)) {
            const auto x = static_cast<double>(circle->from.x - circle->center_x);
            const auto y = static_cast<double>(circle->from.y - circle->center_y);
            along({static_cast<double>(circle->center_x), static_cast<double>(circle->center_y),
                   std::hypot(x, y), std::atan2(y, x), 2 * std::numbers::pi});
        }
    }
    finish();
    REQUIRE(writer->finish());
}

}  // namespace

TEST_CASE("issue 4: 95 % of what is curved in mechanical parts is printed as arcs, on any side") {
    for (const char* file : {"gearbox_base.step", "foot_structure.step", "cube_hole.step",
                             "transmission_pulley_at3_t10_center.step"})
        for (const Vector3& up : {Vector3(0, 0, 1), Vector3(0, -1, 0)}) {
            CAPTURE(file);
            const ArcShares shares = shares_of(printed(file, up));
            CHECK(shares.outlines.value() >= 0.95);
            CHECK(shares.walls.value() >= 0.95);
            CHECK(shares.flat_mm <= shares.walls.all_mm);
        }
}

TEST_CASE("issue 4: arcs of a cylinder are concentric circles through all walls") {
    for (const auto& at_mm : {std::array{0.0, 0.0}, std::array{13.7, -4.123456}}) {
        const Part part = printed("gearbox_base.step", Vector3::UnitZ(), at_mm);
        const ArcShares shares = shares_of(part);
        // Seven bores and four corners, with three walls each.
        CHECK(shares.cylinders.all_mm > 1'000);
        CHECK(shares.cylinders.value() > 0.999);
        CHECK(shares.worst_off_quanta < rounding_quanta);
        CHECK(shares.worst_centre_quanta < 0.71);
    }
}

TEST_CASE("arc share 1, 2, 3: chords in place of arcs are found, few and many") {
    for (const int chords : {3, 40}) {
        const Part part = printed("cube_hole.step");
        const ArcShares arcs = shares_of(part, 4);
        REQUIRE(arcs.walls.value() == doctest::Approx(1));
        cut_into_chords(part, chords);
        const ArcShares lines = shares_of(part, 4);
        CHECK(lines.walls.part_mm == 0);
        CHECK(lines.cylinders.part_mm == 0);
        CHECK(lines.walls.all_mm > 0.4 * arcs.walls.all_mm);
        CHECK(lines.flat_mm == 0);
    }
}

TEST_CASE("arc share: a part of planes has nothing curved") {
    const ArcShares shares = shares_of(printed("cuboid.step"), 5);
    CHECK(shares.layers > 0);
    CHECK(shares.outlines.all_mm == 0);
    CHECK(shares.walls.all_mm == 0);
}
