// The table of keys, built from a few kinds of rule: number in a range, list of numbers, switch, text,
// line of a chip.

#include "target/config/keys.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

#include "target/config/machine_keys.h"

namespace lyr::config {
namespace {

constexpr double ns_per_us = 1e3;
constexpr double ns_per_ms = 1e6;
// No chip of any board has more lines.
constexpr std::int64_t last_line = 65'535;

struct Range {
    double low, high;
    bool open_low = false;  // low itself is not allowed
};

std::string plain(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.15g", value);
    return text.data();
}

std::string found(const toml::node& node) {
    std::ostringstream text;
    if (const auto* number = node.as_floating_point())
        text << plain(number->get());
    else if (const auto* integer = node.as_integer())
        text << integer->get();
    else if (node.is_string())
        text << "a text";
    else if (node.is_boolean())
        text << "true or false";
    else
        text << "a value of type " << node.type();
    return text.str();
}

Complaint expected(const std::string& what, const toml::node& node) {
    return "expected " + what + ", found " + found(node);
}

std::optional<double> number_in(const toml::node& node, Range range) {
    if (!node.is_number()) return std::nullopt;
    // None for an integer that a double cannot hold.
    const double value = node.value<double>().value_or(std::numeric_limits<double>::infinity());
    const bool in_range = range.open_low ? value > range.low : value >= range.low;
    if (!std::isfinite(value) || !in_range || value > range.high) return std::nullopt;
    return value;
}

std::string text_of(Range range) {
    return "a number " + std::string(range.open_low ? "above " : "from ") + plain(range.low) +
           (range.open_low ? " up to " : " to ") + plain(range.high);
}

Key number(std::string path, Range range, const std::function<void(Draft&, double)>& store) {
    return {std::move(path), false, false,
            [range, store](const toml::node& node, Draft& draft) -> Complaint {
                const std::optional<double> value = number_in(node, range);
                if (!value) return expected(text_of(range), node);
                store(draft, *value);
                return std::nullopt;
            }};
}

Key required(Key key) {
    key.required = true;
    return key;
}

Key text(std::string path, const std::function<void(Draft&, const std::string&)>& store) {
    return {std::move(path), false, false,
            [store](const toml::node& node, Draft& draft) -> Complaint {
                const auto* value = node.as_string();
                if (!value) return expected("a text in quotes", node);
                if (value->get().empty()) return "expected a text, found an empty one";
                store(draft, value->get());
                return std::nullopt;
            }};
}

Key flag(std::string path, const std::function<void(Draft&, bool)>& store) {
    return {std::move(path), false, false,
            [store](const toml::node& node, Draft& draft) -> Complaint {
                const auto* value = node.as_boolean();
                if (!value) return expected("true or false", node);
                store(draft, value->get());
                return std::nullopt;
            }};
}

Key nanoseconds(std::string path, Range range, double ns_per_unit,
                std::int64_t PulseTiming::*field) {
    return number(std::move(path), range, [=](Draft& draft, double value) {
        draft.printer.pulse.*field = std::llround(value * ns_per_unit);
    });
}

// A list of as many numbers as `values` has places; none if the node is anything else.
template <std::size_t N>
std::optional<std::array<double, N>> numbers_in(const toml::node& node, Range range) {
    const auto* list = node.as_array();
    if (!list || list->size() != N) return std::nullopt;
    std::array<double, N> values{};
    for (std::size_t i = 0; i < N; ++i) {
        const std::optional<double> value = number_in(*list->get(i), range);
        if (!value) return std::nullopt;
        values[i] = *value;
    }
    return values;
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

using PinField = std::optional<Pin> Axis::*;

Pin& pin_of(Draft& draft, std::size_t axis, PinField field) {
    std::optional<Pin>& pin = draft.printer.axes[axis].*field;
    if (!pin) pin.emplace();
    return *pin;
}

Complaint apply_line(const toml::node& node, Draft& draft, std::size_t axis, PinField field) {
    const auto* number = node.as_integer();
    const auto* name = node.as_string();
    if (number && number->get() >= 0 && number->get() <= last_line)
        pin_of(draft, axis, field).line = static_cast<std::uint32_t>(number->get());
    else if (name && !name->get().empty())
        pin_of(draft, axis, field).line = name->get();
    else
        return expected("the number (0 to 65535) or the name of a line", node);
    return std::nullopt;
}

void append_pin(std::vector<Key>& keys, const std::string& path, std::size_t axis, PinField field) {
    const auto line = [axis, field](const toml::node& node, Draft& draft) {
        return apply_line(node, draft, axis, field);
    };
    keys.push_back({path, false, true, line});
    keys.push_back({path + ".line", false, false, line});
    keys.push_back(text(path + ".chip", [axis, field](Draft& draft, const std::string& value) {
        pin_of(draft, axis, field).chip = value;
    }));
    keys.push_back(flag(path + ".active_low", [axis, field](Draft& draft, bool value) {
        pin_of(draft, axis, field).active_low = value;
    }));
}

void append_axis(std::vector<Key>& keys, std::size_t i) {
    const std::string axis = "axis." + std::string(axis_names[i]) + '.';
    const auto axis_number = [&](const char* name, double high, double Axis::*field) {
        keys.push_back(
            required(number(axis + name, {0, high, true}, [i, field](Draft& draft, double v) {
                draft.printer.axes[i].*field = v;
            })));
    };
    axis_number("steps_per_mm", 1e5, &Axis::steps_per_mm);
    axis_number("max_speed_mm_s", 1e4, &Axis::max_speed_mm_s);
    axis_number("max_acceleration_mm_s2", 1e6, &Axis::max_acceleration_mm_s2);
    if (i != axis_e) keys.push_back(range_key(axis, i));
    keys.push_back(flag(axis + "invert",
                        [i](Draft& draft, bool value) { draft.printer.axes[i].invert = value; }));
    append_pin(keys, axis + "step", i, &Axis::step);
    append_pin(keys, axis + "direction", i, &Axis::direction);
    append_pin(keys, axis + "enable", i, &Axis::enable);
}

}  // namespace

std::vector<Key> printer_keys() {
    std::vector<Key> keys;
    keys.push_back(
        text("name", [](Draft& d, const std::string& value) { d.printer.name = value; }));
    append_machine_keys(keys);
    keys.push_back(text("chip", [](Draft& d, const std::string& value) { d.chip = value; }));
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
    for (std::size_t i = 0; i < axis_count; ++i) append_axis(keys, i);
    return keys;
}

}  // namespace lyr::config
