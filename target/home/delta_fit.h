// A delta's frame from where its carriages stood when the nozzle met a flat bed.
//
// Method. Six things are not known exactly: the three endstops, how far from the middle the towers are, and the angles
// of two of them (the third says where the angles count from). A frame is right when all places where the bed was touched
// lie in one plane at z = 0. That is a least-squares problem in the heights, with the head's place from the carriages in
// closed form. The length of the arms cannot be told from heights over a flat bed; measure it.
//
// Contract
//  1. fit_delta() gives `printer` with radius_mm (all changed by the same), tower_angle_deg of the first two towers,
//     and endstop_mm of all three, such that the touches come closest to z = 0. None: fewer than 7 touches, or
//     touches that do not tell the frame.
//  2. heights_of() are where the touches are with the printer's frame.

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "target/config/printer.h"

namespace lyr::home {

// How high the carriages stood, from their endstops down, and how high the nozzle is over the bed when the probe
// triggers.
struct Touch {
    std::array<double, 3> below_endstop_mm{};
    double nozzle_mm = 0;
};

// Height of a delta's endstop over the bed, as a carriage's.
double carriage_endstop_mm(const config::Printer& printer, std::size_t tower);

std::vector<double> heights_of(const config::Printer& printer, const std::vector<Touch>& touches);

std::optional<config::Printer> fit_delta(const config::Printer& printer,
                                         const std::vector<Touch>& touches);

}  // namespace lyr::home
