// What a print extrudes is one amount, whoever adds it up: the layers' totals, the operations, the sums of E of the
// G-code, and of the print that is made of that.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "../files.h"
#include "../gcode_of.h"
#include "format/arc.h"
#include "format/c/lyr.h"
#include "format/export/gcode.h"
#include "format/import/gcode_import.h"
#include "gcode_machine.h"

using namespace lyr;
using namespace lyr::format;
using test::gcode_of;
using test::GcodeMachine;
using test::GcodeMove;

namespace {

constexpr Quantum quantum{1000};

// Walls whose pieces go on smoothly, walls beside them and the same again, fill, circles; wipes and retractions between.
class RandomPart {
public:
    explicit RandomPart(std::uint32_t seed, LayerEncoder& layer) : random_(seed), layer_(layer) {
        for (int i = 0; i < 12; ++i) {
            path();
            const double x = uniform(-40, 40), y = uniform(-40, 40);
            switch (pick(4)) {
                case 0:
                    hatch(x, y);
                    break;
                case 1:
                    layer_.travel_to(x, y);
                    layer_.circle(x + uniform(1, 5), y, pick(2) == 0);
                    break;
                default:
                    walls(x, y);
            }
            if (pick(2)) leave();
        }
    }

private:
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }

    void path() {
        layer_.begin_path({.role = static_cast<Role>(1 + pick(9)),
                           .width_mm = uniform(0.2, 0.8),
                           .height_mm = 0.2,
                           .flow = pick(2) ? 1 : uniform(0.8, 1.2),
                           .speed_mm_s = 50});
    }

    void walls(double x, double y) {
        const std::uint32_t shape = static_cast<std::uint32_t>(random_());
        const int rings = 1 + pick(3);
        const double apart = pick(2) ? 0.45 : 0;  // or the same wall again, elsewhere
        for (int ring = 0; ring < rings; ++ring) {
            wall(shape, x + (apart == 0 ? 9 * ring : 0), y, ring * apart);
            if (pick(3) == 0) layer_.width(uniform(0.3, 0.6));
        }
    }

    // Arcs and lines, each in the direction in which the one before ends.
    void wall(std::uint32_t shape, double x, double y, double inset_mm) {
        std::mt19937 random(shape);
        const auto of_shape = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        double heading = of_shape(0, 6);
        x -= inset_mm * std::sin(heading);
        y += inset_mm * std::cos(heading);
        layer_.travel_to(x, y);
        for (int i = 0; i < 20; ++i) {
            const double length = of_shape(0.5, 3), turn = i % 3 == 2 ? 0 : of_shape(-0.8, 0.8);
            const double radius = turn == 0 ? 0 : length / turn - inset_mm;
            const double chord = turn == 0 ? length : 2 * radius * std::sin(turn / 2);
            x += chord * std::cos(heading + turn / 2);
            y += chord * std::sin(heading + turn / 2);
            heading += turn;
            if (turn == 0)
                layer_.line_to(x, y);
            else
                layer_.arc_to(x, y, radius * (1 - std::cos(turn / 2)));
        }
    }

    void hatch(double x, double y) {
        const double angle = uniform(0, 6);
        std::vector<HatchRow> rows;
        std::vector<HatchInterval> intervals;
        for (int row = 0; row < 15; ++row) {
            rows.push_back({1, pick(3) > 0});
            intervals.push_back({x - uniform(2, 3), x + uniform(2, 3)});
        }
        HatchRun run;
        run.direction_x = std::cos(angle);
        run.direction_y = std::sin(angle);
        run.offset_mm = y;
        run.pitch_mm = 0.45;
        run.rows = rows;
        run.intervals = intervals;
        layer_.hatch(run);
    }

    void leave() {
        if (pick(2)) {
            const double x = uniform(-40, 40), y = uniform(-40, 40);
            layer_.travel_to(x, y);
            const WipePiece pieces[] = {{x + 1, y, 0}, {x + 1, y + 1, 0.2}};
            layer_.wipe(pieces, uniform(0.2, 0.8));
        }
        layer_.retract();
        layer_.travel_to(uniform(-40, 40), uniform(-40, 40));
        layer_.unretract();
    }

    std::mt19937 random_;
    LayerEncoder& layer_;
};

std::string random_print(std::uint32_t seed) {
    std::vector<EncodedLayer> layers;
    for (std::uint32_t i = 0; i < 3; ++i) {
        LayerState state;
        state.z_mm = 0.2 * (i + 1);
        state.height_mm = 0.2;
        state.travel_speed_mm_s = 150;
        state.retract_length_mm = 0.8;
        state.retract_speed_mm_s = 35;
        LayerEncoder layer(quantum, state);
        RandomPart(seed + i, layer);
        auto encoded = layer.finish();
        REQUIRE(encoded.ok());
        layers.push_back(std::move(*encoded));
    }
    const std::string path = test::scratch("amounts");
    test::write_layers(path, quantum, {}, layers);
    return path;
}

struct Amounts {
    std::vector<double> stated_mm3, added_mm3;  // of layers: as they say, and by their operations
    double filament_mm2 = 0;
};

Amounts amounts_of(const std::string& path) {
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    const double diameter_mm = reader->header().metadata.filament_diameter_mm;
    const double mm = reader->header().quantum.mm(1);
    Amounts amounts;
    amounts.filament_mm2 = std::numbers::pi / 4 * diameter_mm * diameter_mm;
    while (const Operation* operation = reader->read()) {
        double length = 0;
        if (const auto* line = std::get_if<Line>(operation))
            length = std::hypot(static_cast<double>(line->to.x - line->from.x),
                                static_cast<double>(line->to.y - line->from.y));
        if (const auto* arc = std::get_if<Arc>(operation)) length = arc_shape(*arc).length();
        if (const auto* circle = std::get_if<Circle>(operation))
            length = 2 * std::numbers::pi *
                     std::hypot(static_cast<double>(circle->from.x - circle->center_x),
                                static_cast<double>(circle->from.y - circle->center_y));
        if (std::holds_alternative<LayerStart>(*operation)) {
            amounts.stated_mm3.push_back(reader->layer().totals.volume_mm3);
            amounts.added_mm3.push_back(0);
        }
        amounts.added_mm3.back() += mm * length * cross_section_mm2(reader->path());
    }
    REQUIRE(!reader->error());
    return amounts;
}

// Which ways of packing motions the file has.
std::set<int> packed_codes(const std::string& path) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    REQUIRE(file);
    const lyr_source source{[](void* user, std::uint8_t* bytes, std::uint32_t count) {
                                return static_cast<std::int32_t>(
                                    std::fread(bytes, 1, count, static_cast<std::FILE*>(user)));
                            },
                            nullptr, file};
    std::vector<std::byte> buffer(65536);
    lyr_reader reader;
    lyr_operation operation;
    REQUIRE(lyr_open(&reader, &source, buffer.data(), 65536));
    std::set<int> codes;
    while (lyr_next(&reader, &operation))
        if (operation.kind == LYR_LINE || operation.kind == LYR_ARC)
            codes.insert(reader.decoder.code);
    std::fclose(file);
    CHECK(reader.status == LYR_END);
    return codes;
}

void check_alike(const std::vector<double>& some, const std::vector<double>& others, double share) {
    REQUIRE(some.size() == others.size());
    for (std::size_t i = 0; i < some.size(); ++i) {
        CAPTURE(i);
        CHECK(std::abs(some[i] - others[i]) <= share * others[i]);
    }
}

}  // namespace

TEST_CASE("exports: what each layer extrudes is one amount in the print, its G-code and back") {
    constexpr double rounding = 1e-5, of_import = 1e-3;
    std::set<int> codes;
    for (std::uint32_t seed = 0; seed < 45; seed += 3) {
        CAPTURE(seed);
        const std::string path = random_print(seed);
        codes.merge(packed_codes(path));
        const Amounts print = amounts_of(path);
        check_alike(print.added_mm3, print.stated_mm3, rounding);
        for (const GcodeFlavor flavor : {GcodeFlavor::marlin, GcodeFlavor::klipper})
            for (const bool relative : {true, false}) {
                const std::string text =
                    gcode_of(path, {.flavor = flavor, .relative_extrusion = relative});
                std::vector<double> along_mm3(print.stated_mm3.size());
                double beside_mm = 0;  // drawn back and pushed forward again
                for (const GcodeMove& move : GcodeMachine(text).moves) {
                    if (move.moves() && !move.wipes && move.layer > 0)
                        along_mm3[static_cast<std::size_t>(move.layer) - 1] +=
                            move.filament_mm * print.filament_mm2;
                    else
                        beside_mm += move.filament_mm;
                }
                check_alike(along_mm3, print.stated_mm3, rounding);
                CHECK(std::abs(beside_mm) < 1e-4);
                const std::string back = test::scratch("amounts_back");
                Diagnostics diagnostics;
                const auto imported = import_gcode(text, "a.gcode", "a", back, {}, diagnostics);
                REQUIRE_MESSAGE(imported.ok(), to_string(imported.error()));
                check_alike(amounts_of(back).stated_mm3, print.stated_mm3, of_import);
            }
    }
    // Smooth, parallel and repeated runs, hatches (which the C reader gives out as lines), plain motions.
    for (const int code : {0x47, 0x48, 0x49, 0x4a}) CHECK(codes.contains(code));
}
