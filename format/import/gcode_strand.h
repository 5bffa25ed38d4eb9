// The strand that a motion of G-code lays: width, height and flow that give the amount it pushes. Private to this room.
//
// Contract
//  1. Length times cross-section of the style is the amount within `kept` of it or within rounding of the file's E.
//  2. A flow of 1 goes first, then that of the motion before, so that rounding does not change the style from motion to
//     motion.

#pragma once

#include "format/import/gcode_items.h"

namespace lyr::format {

// Relative; most of what is promised, as slicers reckon with more digits of a way than they write. The rounding of width
// and flow comes on top.
inline constexpr double kept = 0.0008;
// Of E, in mm: a digit of 0.00001 and a half of the one before, which carried rounding.
inline constexpr double filament_rounding_mm = 1.5e-5;

// The style of a motion `length_mm` long. `last` is the one before it.
PathStyle style_of(const GcodeGo& go, double length_mm, double layer_height_mm,
                   double filament_area_mm2, const PathStyle& last);

double length_mm(const GcodeGo& go);

}  // namespace lyr::format
