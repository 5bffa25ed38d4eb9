// Where the copies of a part lie on the plate, and in which order they are printed.
//
// Contract
//  1. Copies lie in rows and columns of one pitch, the first with its box's lower left corner at plate.at, the others
//     right of it and behind. Between their boxes is plate.spacing, more where brims need room: those are as far apart.
//     Pitches are whole micrometres, so that copies are rounded alike.
//  2. On a plate whose size is stated all boxes lie within it, or the error says how many would. Of the grids that fit,
//     the one is taken that is next to a square.
//  3. Layer by layer, each copy follows a neighbour of it, and the next layer goes the same way back.
//  4. Sequential: boxes are so far apart that the head, which reaches plate.clearance_radius around the nozzle, meets no
//     finished copy while the nozzle is at work on another one, its brim included. Copies that are higher than
//     plate.clearance_height lie one behind the other and are printed from the front, so that the gantry never passes
//     over a finished one.

#pragma once

#include "kernel/contour/contour.h"
#include "slicer/slicer.h"

namespace lyr::slicer {

// What fits on a plate but for the rounding of a box fits.
inline constexpr double plate_slack_mm = 1e-6;

struct PlateLayout {
    std::size_t columns = 1, rows = 1;
    double gap_mm = 0;                   // between the boxes
    std::vector<Vector2> shifts{};       // from the first copy, by number; in rows from the front
    std::vector<std::uint32_t> order{};  // of copies that are printed layer by layer
    std::vector<Contour> outline{};      // around the boxes of all copies
    double lift_mm = 0;                  // over a finished copy, to the next one; 0: not sequential

    bool is_sequential() const { return lift_mm > 0; }
};

// `box`: of the first copy, on its place. Errors (status geometry): 2.
Result<PlateLayout> lay_out(const Eigen::AlignedBox3d& box, const profile::Profile& profile);

// "12 copies in 4 rows, 6 mm apart, ..."; nothing of a single one.
std::string layout_text(const PlateLayout& layout);

}  // namespace lyr::slicer
