// Where the nozzle wipes when it retracts: back over what it has just printed.
//
// Contract
//  1. A wipe begins where the strand or run has ended and stays on it: back along what has ends, on along the beginning
//     of what is closed, as lines and arcs.
//  2. It is `length_mm` long, or as long as what was printed in one go: over a travel between hatch rows it does not go.
//  3. The filament is drawn back evenly along the wipe, no faster than `retract_speed_mm_s` at travel speed; what that
//     leaves, and at least the profile's share (travel.retract_before_wipe), is drawn back before.

#pragma once

#include <vector>

#include "format/writer.h"
#include "kernel/toolpath/hatch_runs.h"
#include "kernel/toolpath/strand.h"
#include "profile/profile.h"

namespace lyr::slicer {

// `start`: where a closed strand was begun.
Path wipe_along(const Strand& printed, const Point2& start, double length_mm);
Path wipe_along(const HatchRun& printed, double length_mm);

// To which depth the filament is drawn back before the wipe; 0: not at all.
double depth_before_wipe_mm(const Path& wipe, const profile::Profile& profile);

// Moved by `shift`. Arcs of more than half a turn come in two.
std::vector<format::WipePiece> wipe_pieces(const Path& wipe,
                                           const Vector2& shift = Vector2::Zero());

}  // namespace lyr::slicer
