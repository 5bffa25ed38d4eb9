// Finding chips and lines, and saying why they cannot be had. Private to this room.
//
// Contract
//  1. open_chip() takes a chip by its path, device name, number or label.
//  2. find_line() fails where there is no such line, and free_line() also where somebody holds it.

#pragma once

#include "target/gpio/gpiod_calls.h"
#include "target/gpio/gpiod_chip.h"

namespace lyr::gpio {

inline constexpr const char* line_consumer = "lyrrun";

struct OpenChip {
    calls::ChipHandle handle;
    calls::ChipFacts facts;
};

// "axis.x.step: line 17 of gpiochip0"
std::string line_text(const LineRequest& request);
Result<OpenChip> open_chip(const LineRequest& request, const std::string& devices = "/dev");
Result<FoundLine> find_line(const OpenChip& chip, const LineRequest& request);
Result<std::uint32_t> free_line(const OpenChip& chip, const LineRequest& request);

}  // namespace lyr::gpio
