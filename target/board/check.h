// Whether this board has what printer.toml names, and whether its kernel keeps time: looked at without touching
// anything that moves or heats.
//
// Contract
//  1. Every line, sensor and PWM channel of the printer is looked up, and what stands in the way of a print is an error;
//     what makes a print worse or a guard weaker is a warning. Both say what to do.
//  2. No line is held, no file is written, no channel is switched.
//  3. A line, channel or sensor that two keys lead to by different names is an error.
//  4. Files of /sys, /proc and /dev are looked for below Board::root, so that any board can be described by a folder.
//  5. A single processor is a warning, and an error where the kernel lets a real-time thread have all of it.
//  6. Whatever is in those files, there is no crash.

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "target/config/printer.h"
#include "target/gpio/gpiod_chip.h"

namespace lyr::board {

struct Finding {
    Severity severity = Severity::note;  // a note: as it should be
    std::string subject;                 // a key of printer.toml, or what of the board it is about
    std::string message;
};

struct Board {
    std::string root;
    std::function<Result<gpio::FoundLine>(const gpio::LineRequest&)> look_up_line;
    // What the kernel refuses a print's threads.
    std::function<Diagnostics()> privileges;
};

Board this_board();

std::vector<Finding> check(const config::Printer& printer, const Board& board);

Severity worst(const std::vector<Finding>& findings);
std::string text_of(const std::vector<Finding>& findings);
std::string json_of(const std::string& printer, const std::vector<Finding>& findings);

}  // namespace lyr::board
