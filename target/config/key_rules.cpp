// Each rule is a function that reads the node and stores, or complains.

#include "target/config/key_rules.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

namespace lyr::config {
namespace {

// No chip of any board has more lines.
constexpr std::int64_t last_line = 65'535;

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
    else if (const auto* written = node.as_string())
        text << (written->get().empty() ? "an empty text" : "a text");
    else if (node.is_boolean())
        text << "true or false";
    else
        text << "a value of type " << node.type();
    return text.str();
}

}  // namespace

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

namespace {

Complaint apply_line(const toml::node& node, Pin& pin) {
    const auto* number = node.as_integer();
    const auto* name = node.as_string();
    if (number && number->get() >= 0 && number->get() <= last_line)
        pin.line = static_cast<std::uint32_t>(number->get());
    else if (name && !name->get().empty())
        pin.line = name->get();
    else
        return expected("the number (0 to 65535) or the name of a line", node);
    return std::nullopt;
}

Pin& pin_in(Draft& draft, const PinPlace& place) {
    std::optional<Pin>& pin = place(draft);
    if (!pin) pin.emplace();
    return *pin;
}

void append_pin(std::vector<Key>& keys, const std::string& path, const PinPlace& place) {
    const auto pin_of = [place](Draft& draft) -> Pin& { return pin_in(draft, place); };
    const auto line = [pin_of](const toml::node& node, Draft& draft) {
        return apply_line(node, pin_of(draft));
    };
    keys.push_back({path, false, true, line});
    keys.push_back({path + ".line", false, false, line});
    keys.push_back(text(path + ".chip", [pin_of](Draft& draft, const std::string& value) {
        pin_of(draft).chip = value;
    }));
    keys.push_back(flag(path + ".active_low",
                        [pin_of](Draft& draft, bool value) { pin_of(draft).active_low = value; }));
}

}  // namespace

void append_output(std::vector<Key>& keys, const std::string& path, const PinPlace& place) {
    append_pin(keys, path, place);
    keys.push_back(flag(path + ".open_drain", [place](Draft& draft, bool value) {
        pin_in(draft, place).open_drain = value;
    }));
}

void append_input(std::vector<Key>& keys, const std::string& path, const PinPlace& place) {
    static constexpr std::array<std::string_view, 4> pulls{"as_is", "up", "down", "none"};
    append_pin(keys, path, place);
    keys.push_back(choice(path + ".pull", pulls, [place](Draft& draft, std::size_t pull) {
        pin_in(draft, place).pull = static_cast<Pull>(pull);
    }));
}

}  // namespace lyr::config
