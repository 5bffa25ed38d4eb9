// A line of G-code, taken apart. Private to this room.
//
// Contract
//  1. Letters of any case, with or without spaces between words; a line's number (N) and checksum (*) and comments in
//     brackets are passed over; what follows a semicolon is the comment.
//  2. A command is a letter and a number ("G1", "M486") or, as of Klipper, a name ("SET_FAN_SPEED"); `rest` is what
//     follows it, verbatim.
//  3. words() refuses what is no letter and finite number, and letters that come twice.

#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace lyr::format {

// The values of the letters A to Z, where they stand.
class GcodeWords {
public:
    std::optional<double>& at(char letter) {
        return values_[static_cast<std::size_t>(letter - 'A')];
    }
    std::optional<double> operator[](char letter) const {
        return values_[static_cast<std::size_t>(letter - 'A')];
    }

private:
    std::array<std::optional<double>, 26> values_{};
};

struct GcodeLine {
    std::string command{};  // upper case; empty: none
    std::string_view rest{};
    std::string_view comment{};  // without the semicolon and spaces at its ends
};

GcodeLine gcode_line(std::string_view text);

// None: `why` says what is wrong. Letters without a number, as in "G28 X", have 0 where `flags` allows them.
std::optional<GcodeWords> gcode_words(std::string_view rest, bool flags, std::string& why);

// The value of KEY=VALUE, as of Klipper's commands; empty: not there.
std::string_view gcode_parameter(std::string_view rest, std::string_view key);

std::string_view trimmed(std::string_view text);

}  // namespace lyr::format
