// Out as G-code and in again: the same print.

#include <doctest/doctest.h>

#include "../../target/run/print_files.h"
#include "../gcode_of.h"
#include "../sample.h"
#include "format/arc.h"
#include "format/export/gcode.h"
#include "imported.h"

using namespace lyr;
using namespace lyr::format;
using test::gcode_of;
using test::GivenOperation;
using test::Imported;

namespace {

// Motions of some length, hatches as lines and travels; a layer's start as the point that it is.
std::vector<GivenOperation> motions_of(const Imported& print) {
    std::vector<GivenOperation> motions;
    for (const GivenOperation& given : print.operations) {
        const Operation& one = given.operation;
        const auto* travel = std::get_if<Travel>(&one);
        const bool moves = std::holds_alternative<Line>(one) || std::holds_alternative<Arc>(one) ||
                           std::holds_alternative<Circle>(one) ||
                           std::holds_alternative<Wipe>(one) ||
                           (travel && travel->from != travel->to);
        if (moves || std::holds_alternative<LayerStart>(one)) motions.push_back(given);
    }
    return motions;
}

Point end_of(const Operation& operation) {
    if (const auto* one = std::get_if<Line>(&operation)) return one->to;
    if (const auto* one = std::get_if<Arc>(&operation)) return one->to;
    if (const auto* one = std::get_if<Circle>(&operation)) return one->to;
    if (const auto* one = std::get_if<Travel>(&operation)) return one->to;
    if (const auto* one = std::get_if<Wipe>(&operation)) return one->to;
    return std::get<LayerStart>(operation).start;
}

// As which flat and tiny arcs are written.
bool is_chords(const Operation& operation) {
    const auto* arc = std::get_if<Arc>(&operation);
    const double radius_mm = arc ? arc_shape(*arc).radius * Quantum{}.mm(1) : 1;
    return radius_mm > largest_arc_mm || radius_mm < smallest_arc_mm;
}

void check_same(const Imported& before, const Imported& after) {
    const auto a = motions_of(before), b = motions_of(after);
    REQUIRE(before.layers.size() == after.layers.size());
    std::size_t j = 0;
    for (std::size_t i = 0; i < a.size(); ++i, ++j) {
        // The end lifts the nozzle once more.
        REQUIRE(j < b.size());
        CAPTURE(i);
        CAPTURE(a[i].layer.index);
        CHECK(a[i].layer.index == b[j].layer.index);
        if (is_chords(a[i].operation))
            while (j + 1 < b.size() && end_of(b[j].operation) != end_of(a[i].operation)) ++j;
        else
            REQUIRE(a[i].operation.index() == b[j].operation.index());
        const Point p = end_of(a[i].operation), q = end_of(b[j].operation);
        CHECK(std::abs(p.x - q.x) <= 1);
        CHECK(std::abs(p.y - q.y) <= 1);
        CHECK(std::abs(p.z - q.z) <= 1);
        if (const auto* arc = std::get_if<Arc>(&a[i].operation); arc && !is_chords(a[i].operation))
            CHECK(std::abs(arc->sagitta - std::get<Arc>(b[j].operation).sagitta) <= 1);
        if (const auto* circle = std::get_if<Circle>(&a[i].operation)) {
            const Circle& other = std::get<Circle>(b[j].operation);
            CHECK(std::abs(circle->center_x - other.center_x) <= 1);
            CHECK(std::abs(circle->center_y - other.center_y) <= 1);
            CHECK(circle->counter_clockwise == other.counter_clockwise);
        }
        if (std::holds_alternative<Travel>(a[i].operation) ||
            std::holds_alternative<LayerStart>(a[i].operation))
            continue;
        if (const auto* wipe = std::get_if<Wipe>(&a[i].operation)) {
            CHECK(std::get<Wipe>(b[j].operation).depth_mm ==
                  doctest::Approx(wipe->depth_mm).epsilon(0.01));
            continue;
        }
        CHECK(a[i].style.role == b[j].style.role);
        CHECK(a[i].style.height_mm == b[j].style.height_mm);
        CHECK(a[i].style.speed_mm_s == doctest::Approx(b[j].style.speed_mm_s).epsilon(1e-4));
        CHECK(cross_section_mm2(a[i].style) ==
              doctest::Approx(cross_section_mm2(b[j].style)).epsilon(0.001));
    }
    CHECK(b.size() - j <= 1);
    for (std::size_t i = 0; i < before.layers.size(); ++i) {
        CAPTURE(i);
        const Layer& one = before.layers[i];
        const Layer& other = after.layers[i];
        CHECK(one.state.z_mm == doctest::Approx(other.state.z_mm));
        CHECK(one.state.height_mm == doctest::Approx(other.state.height_mm));
        CHECK(one.state.retracted_mm == doctest::Approx(other.state.retracted_mm));
        CHECK(one.totals.volume_mm3 == doctest::Approx(other.totals.volume_mm3).epsilon(0.001));
        CHECK(one.totals.travel_quanta <= other.totals.travel_quanta + 2);
    }
}

}  // namespace

TEST_CASE("gcode import 1, 2: what goes out comes in again, of either firmware and E") {
    for (const tests::Frame& frame :
         {tests::Frame{}, tests::Frame{0.7, false, 90, 80}, tests::Frame{2.1, true, 120, 60}})
        for (const tests::Case& drawn : tests::all_cases()) {
            CAPTURE(std::string(drawn.name));
            const std::string path = tests::write_print(
                "gcode_again", {drawn.drawing, drawn.drawing, drawn.drawing}, frame);
            const Imported before = test::read_print(path);
            for (const GcodeFlavor flavor : {GcodeFlavor::marlin, GcodeFlavor::klipper})
                for (const bool relative : {true, false}) {
                    const Imported after = test::imported(
                        gcode_of(path, {.flavor = flavor, .relative_extrusion = relative}));
                    CHECK(after.diagnostics.empty());
                    check_same(before, after);
                }
        }
}

TEST_CASE("gcode import: what comes in goes out as the same G-code again") {
    for (const tests::Case& drawn : tests::all_cases()) {
        CAPTURE(std::string(drawn.name));
        const std::string path = tests::write_print("gcode_twice", {drawn.drawing, drawn.drawing});
        const std::string once = gcode_of(path, {});
        const std::string print = test::scratch("gcode_twice");
        Diagnostics diagnostics;
        REQUIRE(import_gcode(once, "a", "a", print, {}, diagnostics).ok());
        const std::string twice = gcode_of(print, {});
        // Heads differ in what made them; the first layer's and the rest's motions do not.
        const auto moves = [](const std::string& text) {
            std::string kept;
            for (std::size_t at = text.find(";LAYER_CHANGE"); at < text.size();) {
                const std::size_t end = text.find('\n', at);
                const std::string line = text.substr(at, end - at);
                // The lift at the end stands in the print by now.
                if (line.starts_with("M107") || line.starts_with("M10") ||
                    line.starts_with("G0 Z")) {
                } else if (line.starts_with("G")) {
                    kept += line.substr(0, line.find(" F")) + '\n';
                }
                at = end + 1;
            }
            return kept;
        };
        CHECK(moves(once) == moves(twice));
    }
}

TEST_CASE("gcode import: temperatures, fans, tools, pauses and objects are those of the print") {
    LayerState state = test::RandomLayer::state(0.2);
    LayerEncoder layer(Quantum{}, state);
    layer.begin_path(
        {.role = Role::brim, .width_mm = 0.5, .height_mm = 0.2, .flow = 0.9, .speed_mm_s = 30});
    layer.line_to(10, 0);
    layer.temperature({HeaterKind::tool, 1}, 215, false);
    layer.temperature({HeaterKind::chamber, 0}, 45, true);
    layer.fan(0, 0.6);
    layer.dwell(1500);
    layer.tool(1);
    layer.pause(PauseReason::user);
    layer.pause(PauseReason::filament_change);
    layer.line_to(10, 10);
    auto encoded = layer.finish();
    REQUIRE(encoded.ok());
    const std::string path = test::scratch("machine");
    test::write_layers(path, {}, {}, {*encoded});
    for (const GcodeFlavor flavor : {GcodeFlavor::marlin, GcodeFlavor::klipper}) {
        const Imported print = test::imported(gcode_of(path, {.flavor = flavor}));
        CHECK(print.diagnostics.empty());
        const LayerState& begun = print.layers[0].state;
        REQUIRE(begun.temperatures.size() == 2);
        CHECK(begun.temperatures[1].target_c == 230.5);
        REQUIRE(begun.fans.size() == 1);
        CHECK(begun.fans[0].duty == doctest::Approx(0.35).epsilon(0.01));
        const auto heat = print.all<Temperature>();
        REQUIRE(heat.size() >= 2);
        CHECK(heat[0] == Temperature{{HeaterKind::tool, 1}, 215, false});
        CHECK(heat[1] == Temperature{{HeaterKind::chamber, 0}, 45, true});
        CHECK(print.all<Dwell>().at(0).time_ms == 1500);
        CHECK(print.all<Tool>().at(0).tool == 1);
        const auto pauses = print.all<Pause>();
        REQUIRE(pauses.size() == 2);
        CHECK(pauses[0].reason == PauseReason::user);
        CHECK(pauses[1].reason == PauseReason::filament_change);
        const auto lines = print.all<Line>();
        REQUIRE(lines.size() == 2);
        for (const GivenOperation& given : print.operations) {
            if (!std::holds_alternative<Line>(given.operation)) continue;
            CHECK(given.style.role == Role::brim);
            CHECK(given.style.flow == doctest::Approx(0.9).epsilon(0.001));
        }
    }
}
