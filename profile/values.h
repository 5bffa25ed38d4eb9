// Values as they are given, read and shown, before any key says what it takes. Private to this room.
//
// Contract
//  1. Numbers are finite. A text may follow them with their unit ("0.2mm", "60 mm/s"), and with no other.
//  2. A fraction is a number (0.15, "0.15") or a percentage ("15%"), which is read as the number nearest to its
//     hundredth: "7%" is 0.07.
//  3. What show_...() gives is TOML that reads back as the same value, bit for bit.

#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lyr::profile {

// Text of the command line, where nothing tells 0.2 from "0.2" or true from "true".
struct Bare {
    std::string text;
};

// A single value: a number, a switch, a text in quotes, bare text or, as monostate, what no key takes (a date).
using Scalar = std::variant<std::monostate, double, bool, std::string, Bare>;
using List = std::vector<Scalar>;
using Given = std::variant<Scalar, List>;

// The name of a unit, and what else people write for it.
struct Unit {
    std::string_view name;
    std::span<const std::string_view> also{};
};

// For messages: 0.2, "a text", true, a list.
std::string found(const Scalar& scalar);
std::string found(const Given& given);

std::optional<double> number_in(const Scalar& scalar, const Unit& unit);
std::optional<double> fraction_in(const Scalar& scalar);
std::optional<bool> switch_in(const Scalar& scalar);
// UTF-8, not empty and without control characters: what TOML, a terminal and a print's metadata can all take.
std::optional<std::string> text_in(const Scalar& scalar);
// As a file gives it, or as the command line does, with commas between the entries.
std::optional<List> list_in(const Given& given);

std::string show_fraction(double value);
std::string show_text(const std::string& text);

}  // namespace lyr::profile
