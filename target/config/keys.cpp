// The table of keys: the machine's, the axes', and heater_keys.cpp's.

#include "target/config/keys.h"

#include <cmath>

#include "base/constants.h"
#include "target/config/heater_keys.h"
#include "target/config/homing_keys.h"
#include "target/config/key_rules.h"
#include "target/config/life_keys.h"
#include "target/config/machine_keys.h"

namespace lyr::config {
namespace {

Key nanoseconds(std::string path, Range range, double ns_per_unit,
                std::int64_t PulseTiming::*field) {
    return number(std::move(path), range, [=](Draft& draft, double value) {
        draft.printer.pulse.*field = std::llround(value * ns_per_unit);
    });
}

constexpr Range positions_mm{-10'000, 10'000};

Key start_key() {
    return {"start_mm", false, false, [](const toml::node& node, Draft& draft) -> Complaint {
                const auto values = numbers_in<3>(node, positions_mm);
                if (!values) return "expected a list [x, y, z] of " + text_of(positions_mm);
                draft.printer.start_mm = *values;
                return std::nullopt;
            }};
}

Key range_key(const std::string& axis, std::size_t number) {
    return required(
        {axis + "range_mm", false, false,
         [number](const toml::node& node, Draft& draft) -> Complaint {
             const auto values = numbers_in<2>(node, positions_mm);
             if (!values || !((*values)[0] < (*values)[1]))
                 return "expected a list [lowest, highest] of two numbers from -10000 to "
                        "10000, the first below the second";
             draft.printer.axes[number].min_mm = (*values)[0];
             draft.printer.axes[number].max_mm = (*values)[1];
             return std::nullopt;
         }});
}

void append_axis(std::vector<Key>& keys, std::size_t i) {
    const std::string axis = "axis." + std::string(axis_names[i]) + '.';
    const auto axis_number = [&](const char* name, Range range, double Axis::*field) {
        keys.push_back(required(number(axis + name, range, [i, field](Draft& draft, double v) {
            draft.printer.axes[i].*field = v;
        })));
    };
    // Below, a move of a hand's width takes minutes: no machine, but a slip of the pen.
    axis_number("steps_per_mm", {0.1, 1e5}, &Axis::steps_per_mm);
    axis_number("max_speed_mm_s", {0.1, 1e4}, &Axis::max_speed_mm_s);
    axis_number("max_acceleration_mm_s2", {1, 1e6}, &Axis::max_acceleration_mm_s2);
    if (i != axis_e) keys.push_back(range_key(axis, i));
    keys.push_back(flag(axis + "invert",
                        [i](Draft& draft, bool value) { draft.printer.axes[i].invert = value; }));
    const auto line = [i](std::optional<Pin> Axis::*field) {
        return [i, field](Draft& draft) -> std::optional<Pin>& {
            return draft.printer.axes[i].*field;
        };
    };
    append_output(keys, axis + "step", line(&Axis::step));
    append_output(keys, axis + "direction", line(&Axis::direction));
    append_output(keys, axis + "enable", line(&Axis::enable));
}

Key cpu_key() {
    return {"timing.cpu", false, false, [](const toml::node& node, Draft& draft) -> Complaint {
                // The kernel's mask of processors has so many.
                constexpr std::int64_t most = 1'024;
                const auto* cpu = node.as_integer();
                if (!cpu || cpu->get() < 0 || cpu->get() >= most)
                    return expected("a whole number from 0 to 1023", node);
                draft.printer.timing.cpu = static_cast<unsigned>(cpu->get());
                return std::nullopt;
            }};
}

}  // namespace

std::vector<Key> printer_keys() {
    std::vector<Key> keys;
    keys.push_back(
        text("name", [](Draft& d, const std::string& value) { d.printer.name = value; }));
    append_machine_keys(keys);
    keys.push_back(text("chip", [](Draft& d, const std::string& value) { d.chip = value; }));
    keys.push_back(text("calibration_file", [](Draft& d, const std::string& value) {
        d.printer.calibration_file = value;
    }));
    keys.push_back(start_key());
    keys.push_back(number("junction_deviation_mm", {0, 1},
                          [](Draft& d, double v) { d.printer.junction_deviation_mm = v; }));
    keys.push_back(number("filament_diameter_mm", {0.1, 10},
                          [](Draft& d, double v) { d.printer.filament_diameter_mm = v; }));
    const Range edge_us{0.05, 1'000};
    keys.push_back(nanoseconds("pulse.high_us", edge_us, ns_per_us, &PulseTiming::high_ns));
    keys.push_back(nanoseconds("pulse.low_us", edge_us, ns_per_us, &PulseTiming::low_ns));
    keys.push_back(nanoseconds("pulse.direction_setup_us", edge_us, ns_per_us,
                               &PulseTiming::direction_setup_ns));
    keys.push_back(nanoseconds("pulse.direction_hold_us", edge_us, ns_per_us,
                               &PulseTiming::direction_hold_ns));
    keys.push_back(
        nanoseconds("pulse.late_limit_ms", {0.01, 10'000}, ns_per_ms, &PulseTiming::late_limit_ns));
    keys.push_back(number("timing.late_us", {0, 1e6}, [](Draft& draft, double value) {
        draft.printer.timing.late_ns = std::llround(value * ns_per_us);
    }));
    keys.push_back(number("timing.write_us", {0, 1e4}, [](Draft& draft, double value) {
        draft.printer.timing.write_ns = std::llround(value * ns_per_us);
    }));
    keys.push_back(cpu_key());
    for (std::size_t i = 0; i < axis_count; ++i) append_axis(keys, i);
    append_heat_keys(keys);
    append_homing_keys(keys);
    append_life_keys(keys);
    return keys;
}

}  // namespace lyr::config
