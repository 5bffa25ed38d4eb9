// The kinds of rule that the table of keys is built from: number in a range, list of numbers, switch, text,
// line of a chip. Private to this room.

#pragma once

#include <array>

#include "target/config/keys.h"

namespace lyr::config {

struct Range {
    double low, high;
    bool open_low = false;  // low itself is not allowed
};

std::string text_of(Range range);
Complaint expected(const std::string& what, const toml::node& node);
// None: no number, or not in the range.
std::optional<double> number_in(const toml::node& node, Range range);

Key number(std::string path, Range range, const std::function<void(Draft&, double)>& store);
Key text(std::string path, const std::function<void(Draft&, const std::string&)>& store);
Key flag(std::string path, const std::function<void(Draft&, bool)>& store);
Key required(Key key);

// A line as number, name or table.
using PinPlace = std::function<std::optional<Pin>&(Draft&)>;
void append_output(std::vector<Key>& keys, const std::string& path, const PinPlace& place);
// With its pull.
void append_input(std::vector<Key>& keys, const std::string& path, const PinPlace& place);

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

// One of a few names, stored as its number.
template <std::size_t N>
Key choice(std::string path, const std::array<std::string_view, N>& names,
           const std::function<void(Draft&, std::size_t)>& store) {
    return {std::move(path), false, false,
            [&names, store](const toml::node& node, Draft& draft) -> Complaint {
                const std::optional<std::string> value = node.value<std::string>();
                std::string expected = "expected ";
                for (std::size_t i = 0; i < N; ++i) {
                    if (value && *value == names[i]) {
                        store(draft, i);
                        return std::nullopt;
                    }
                    expected += (i == 0      ? "\""
                                 : i + 1 < N ? "\", \""
                                             : "\" or \"") +
                                std::string(names[i]);
                }
                return expected + '"';
            }};
}

}  // namespace lyr::config
