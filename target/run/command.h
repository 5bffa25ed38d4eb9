// What a user may ask of a print while it runs, as values; and a script of them for the simulator.
//
//     # time in s   command
//     60            pause
//     90.5          resume
//     100           set tool 215
//     110           fan 0.4
//     120           speed 0.8
//     130           change_filament
//     200           cancel
//
// Contract
//  1. parse_command() takes a command's words and refuses, with a complaint and no place, what is unknown, has too
//     many or too few words, or a value out of its range.
//  2. text_of() gives words that parse_command() reads as the same command.
//  3. A line of a script is a time from the start of the print and a command; what stands after # is a comment.
//     Anything else is an error (status input) with its line. Commands come out in the order of time.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/diagnostic.h"

namespace lyr::run {

// The head comes to rest on its path and parks; heat stays for the time that printer.toml says.
struct Pause {
    friend bool operator==(const Pause&, const Pause&) = default;
};
// Heats again what was let go cold, and goes on exactly where the path was left.
struct Resume {
    friend bool operator==(const Resume&, const Resume&) = default;
};
// A pause in which the filament is drawn out; the next one is pushed in before the print goes on.
struct ChangeFilament {
    friend bool operator==(const ChangeFilament&, const ChangeFilament&) = default;
};
// The head comes to rest and parks, all heaters go off, and the print is over.
struct Cancel {
    friend bool operator==(const Cancel&, const Cancel&) = default;
};
// Steps and heaters stop at once; where the head is, nobody knows then.
struct EmergencyStop {
    bool by_line = false;  // input.emergency
    friend bool operator==(const EmergencyStop&, const EmergencyStop&) = default;
};
// Until the file itself sets this heater again.
struct SetTemperature {
    std::size_t heater = 0;  // of config
    double target_c = 0;     // 0: off
    friend bool operator==(const SetTemperature&, const SetTemperature&) = default;
};
// Of the part fan, until the file itself sets it again.
struct SetFan {
    double duty = 0;  // 0..1
    friend bool operator==(const SetFan&, const SetFan&) = default;
};
inline constexpr double least_speed_factor = 0.1, most_speed_factor = 3;
// Multiplies the speeds of the file, from the next moves on that are not planned yet where it grows.
struct SetSpeedFactor {
    double factor = 1;
    friend bool operator==(const SetSpeedFactor&, const SetSpeedFactor&) = default;
};

using Command = std::variant<Pause, Resume, ChangeFilament, Cancel, EmergencyStop, SetTemperature,
                             SetFan, SetSpeedFactor>;

// A command, or what is wrong with the words.
using ParsedCommand = std::variant<Command, std::string>;
ParsedCommand parse_command(const std::vector<std::string>& words);
std::string text_of(const Command& command);

struct TimedCommand {
    double time_s = 0;
    Command command;
};

Result<std::vector<TimedCommand>> parse_script(std::string_view text, const std::string& file);

}  // namespace lyr::run
