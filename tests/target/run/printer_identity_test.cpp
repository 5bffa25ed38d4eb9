// Contract of target/run/printer_identity.h, by number.

#include "target/run/printer_identity.h"

#include <doctest/doctest.h>

#include <functional>

#include "target/run/resumption.h"

using namespace lyr;
using namespace lyr::run;

namespace {

using Change = std::function<void(config::Printer&)>;

config::Printer delta_printer() {
    config::Printer printer = config::generic_printer();
    printer.kinematics = config::Kinematics::delta;
    printer.delta = {{250, 250, 250}, {120, 120, 120}, {210, 330, 90}, 120};
    printer.mesh.area_mm = {0, 0, 100, 100};
    printer.mesh.heights_mm = {{0, 0.1}, {0.2, 0.3}};
    printer.axes[0].step = config::Pin{"gpiochip0", 4u};
    return printer;
}

std::string difference_by(const Change& change) {
    config::Printer changed = delta_printer();
    change(changed);
    return difference(identity_of(delta_printer()), identity_of(changed));
}

}  // namespace

TEST_CASE("printer identity 1, 3: what places and moves the head counts, and is told by name") {
    CHECK(difference_by([](config::Printer&) {}).empty());
    const auto differs = [](const std::string& name, const Change& change) {
        CHECK(difference_by(change) == name);
    };
    differs("name", [](auto& printer) { printer.name = "other"; });
    differs("kinematics", [](auto& printer) { printer.kinematics = config::Kinematics::corexy; });
    differs("kinematics", [](auto& printer) { printer.delta.arm_mm[1] += 1e-9; });
    differs("kinematics", [](auto& printer) { printer.delta.radius_mm[2] -= 1; });
    differs("kinematics", [](auto& printer) { printer.delta.tower_angle_deg[0] = 211; });
    differs("motors' lines", [](auto& printer) { printer.axes[2].invert = true; });
    differs("motors' lines", [](auto& printer) { printer.axes[0].step->chip = "gpiochip1"; });
    differs("motors' lines", [](auto& printer) { printer.axes[0].step->line = "4"; });
    differs("motors' lines", [](auto& printer) { printer.axes[0].step->line = 5u; });
    differs("motors' lines", [](auto& printer) { printer.axes[0].step->active_low = true; });
    differs("motors' lines",
            [](auto& printer) { std::swap(printer.axes[0].step, printer.axes[1].step); });
    differs("motors' lines",
            [](auto& printer) { std::swap(printer.axes[0].step, printer.axes[0].direction); });
    differs("steps_per_mm", [](auto& printer) { printer.axes[2].steps_per_mm *= 2; });
    differs("range_mm", [](auto& printer) { printer.axes[1].max_mm += 1; });
    differs("range_mm", [](auto& printer) { printer.axes[0].min_mm -= 1; });
    differs("height map", [](auto& printer) { printer.mesh.heights_mm.clear(); });
    differs("height map", [](auto& printer) { printer.mesh.heights_mm[1][0] = 0.21; });
    differs("height map", [](auto& printer) { printer.start_mm[0] += 1; });
    differs("name, steps_per_mm", [](auto& printer) {
        printer.name = "other";
        printer.axes[0].steps_per_mm = 7;
    });
}

TEST_CASE("printer identity 2: what a user mends before a print goes on does not count") {
    const auto same = [](const Change& change) { CHECK(difference_by(change).empty()); };
    for (std::size_t i = 0; i < config::axis_count; ++i) {
        same([i](auto& printer) { printer.axes[i].max_speed_mm_s = 17; });
        same([i](auto& printer) { printer.axes[i].max_acceleration_mm_s2 = 17; });
        same([i](auto& printer) { printer.axes[i].enable = config::Pin{"gpiochip0", 40u}; });
    }
    same([](auto& printer) { printer.axes[config::axis_e].steps_per_mm = 1; });
    same([](auto& printer) { printer.axes[config::axis_e].step = config::Pin{"gpiochip0", 9u}; });
    same([](auto& printer) { printer.heaters = {}; });
    same([](auto& printer) { printer.pause.lift_mm = 1; });
    same([](auto& printer) { printer.filament.load_mm = 1; });
    same([](auto& printer) { printer.recovery_folder = "/elsewhere"; });
    same([](auto& printer) { printer.endstops[0].fast_mm_s = 1; });
    same([](auto& printer) { printer.start_mm[2] += 1; });
    same([](auto& printer) { printer.start_mm[2] = -printer.start_mm[2]; });
    // The same printer with its head lifted.
    Resumption resumption;
    resumption.stopped_z_mm = 20;
    CHECK(identity_of(lifted(delta_printer(), resumption)) == identity_of(delta_printer()));
    // Where nothing is measured, neither does the place that heights would count from.
    config::Printer flat = config::generic_printer(), moved = flat;
    moved.start_mm = {10, 20, 0.3};
    CHECK(identity_of(flat) == identity_of(moved));
}
