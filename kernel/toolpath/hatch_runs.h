// Hatches in the order in which they are printed: runs of rows, one interval a row, there and back, from row to row by
// straight links along the boundary. That is how a file stores fill most compactly (HatchRun of format/writer.h).
//
// Contract
//  1. Every interval of the rows is in just one run; a run's rows follow each other on the grid.
//  2. A run goes on where the boundary leads from its end to an interval of the next row, or where two intervals have
//     nobody but each other beside them. A region that every row meets once is one run.
//  3. A linked row is reached in a straight line that does not leave the region by more than `stray_mm`, nor is longer
//     than `longest_link_mm`.
//  4. Rows shorter than `shortest_mm` are left out.

#pragma once

#include <vector>

#include "kernel/toolpath/rows.h"

namespace lyr {

// Along the run's direction, from the foot of the origin's perpendicular; start < end.
struct HatchRow {
    double start_mm, end_mm;
    bool linked;  // printed on from the row before, not reached by travel
};

// Row k is at offset_mm + k * pitch_mm to the left of the direction. Rows 0, 2, 4... are run along the direction, rows
// 1, 3, 5... against it.
struct HatchRun {
    Vector2 direction;
    double offset_mm = 0;
    double pitch_mm = 0;  // signed
    std::vector<HatchRow> rows{};
};

Point2 start_of(const HatchRun& run);
Point2 end_of(const HatchRun& run);
HatchRun reversed(const HatchRun& run);
// What is printed: rows and links.
double length_mm(const HatchRun& run);

struct LinkLimits {
    double stray_mm = 0;
    double longest_link_mm = 0;
    double shortest_mm = 0;
};

std::vector<HatchRun> hatch_runs(const Rows& rows, const LinkLimits& limits);

}  // namespace lyr
