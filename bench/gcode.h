// What is measured of PrusaSlicer's G-code: the volume that it extrudes, and where its outermost walls end.
//
// Contract
//  1. Absolute coordinates and absolute filament lengths, as PrusaSlicer writes them by default.
//  2. Volume is that of motions in x and y; drawing the filament back and forth extrudes nothing.
//  3. An outermost wall is a run of motions of the type "External perimeter". Its outer flank lies half its width beside
//     its middle: outside the wall if it lies in an even number of other outermost walls of its layer, else inside.
//  4. What another part of the same wall covers is no flank: at corners that look outward the flanks of two motions cross.

#pragma once

#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "kernel/geometry/vector.h"

namespace lyr::bench {

struct GcodeWall {
    std::vector<Point2> middle;  // closes; the gap at the seam is no part of it
    double top_mm = 0, width_mm = 0;
};

struct Gcode {
    std::vector<GcodeWall> walls;  // of one layer beside each other
    double volume_mm3 = 0;
};

Result<Gcode> read_gcode(const std::string& path, double filament_diameter_mm);

// So many points at equal distances along all walls' middles together, moved out to the flank, less those of 4. Half a
// layer below the layers' tops.
std::vector<Point3> flank_points(const std::vector<GcodeWall>& walls, double layer_height_mm,
                                 std::size_t count);

}  // namespace lyr::bench
