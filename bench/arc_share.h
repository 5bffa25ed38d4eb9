// How much of what is curved in a part is printed as arcs, and whether the walls of a cylinder are concentric: measured on
// the printed file, against the model's own surfaces.
//
// Method. The layer's outline is cut again, and each of its pieces is curved or not. A piece that is an arc is. A line is
// curved if it is a chord of something round: it lies on no planar face, and the surface that it lies along has other
// normals at its one end than at its other (a ruling of a cylinder has not). Walls are looked at every 0.1 mm: a place
// belongs to the piece of the outline on which it has its foot. Where that is a corner, none: arcs that an offset draws
// around corners do not count, neither as curved nor as arcs.
//
// Contract
//  1. Walls are motions of the roles outer wall and inner wall. Shares are of lengths along them.
//  2. Places that follow each other along a wall beside one arc of the outline are left out (`flat_mm`) where the
//     whole arc through them would be less than half a quantum over its chord: the file has no other arc for it than a
//     line. Nothing is left out where several short chords run along one arc.
//  3. A wall is on a cylinder, upright in the print, where its foot lies on the circle in which the cylinder is cut. It
//     is concentric if it is an arc or circle whose ends and quarter points are as far from the axis as each other, but
//     for `rounding_quanta`, which the format's rounding of ends and sagittas may make (format/writer.h, 1).

#pragma once

#include <string>

#include "kernel/brep/model.h"
#include "slicer/slicer.h"

namespace lyr::bench {

inline constexpr double rounding_quanta = 3;

struct Share {
    double all_mm = 0, part_mm = 0;

    double value() const { return all_mm > 0 ? part_mm / all_mm : 1; }
    void operator+=(const Share& other) {
        all_mm += other.all_mm;
        part_mm += other.part_mm;
    }
};

struct ArcShares {
    std::size_t layers = 0;
    Share outlines;                  // arcs of what is curved
    Share walls;                     // the same
    double flat_mm = 0;              // of walls; see 2
    Share cylinders;                 // concentric of what lies on cylinders
    double worst_off_quanta = 0;     // of concentric arcs, from one circle about the axis
    double worst_centre_quanta = 0;  // of full circles on cylinders, from the axis
};

// No free-form surface.
bool is_elementary(const Model& model);

// `lyr` is the print of the model with these options; at most so many of its layers are looked at, evenly spread.
Result<ArcShares> arc_shares(const Model& model, const std::string& lyr,
                             const slicer::Options& options, std::size_t most_layers);

}  // namespace lyr::bench
