// A file's operations, one after the other, as instructions for the planner. What an operation means
// is target/moves's; whether the machine can do what they ask has been decided before (check_demands).
//
// Contract
//  1. The instructions are those of MoveMaker for the file's operations in their order, from the
//     printer's start on.
//  2. Memory is bounded: it does not grow with the file.
//  3. Orders for heaters and fans stand before the instructions of the operation that gives them.

#pragma once

#include <cstddef>
#include <optional>

#include "format/reader.h"
#include "target/moves/move_maker.h"
#include "target/run/heat_order.h"

namespace lyr::run {

using moves::motion_limits;
using moves::Rest;

using Instruction = std::variant<motion::Move, Rest, HeatOrder>;

class Interpreter {
public:
    Interpreter(format::Reader reader, const config::Printer& printer, double filament_diameter_mm);

    // The next instruction, or none at the end of the file.
    Result<std::optional<Instruction>> next();
    // Before that.
    void begin_drawn_back(double mm) { maker_.begin_drawn_back(mm); }
    // Of the filament, when the instruction is carried out.
    double drawn_back_mm() const { return maker_.head().drawn_back_mm.value_or(0); }

private:
    format::Reader reader_;
    moves::MoveMaker maker_;
    HeatOrders orders_;
    std::size_t given_ = 0;  // of what the operation read last made
};

}  // namespace lyr::run
