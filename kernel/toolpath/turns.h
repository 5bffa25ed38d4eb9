// How far contours turn, either way.
//
// A stretch is what lies along one contour from one piece to another; one that turns by less than half a circle in all
// crosses itself nowhere.

#pragma once

#include <algorithm>
#include <vector>

#include "kernel/toolpath/boundary.h"

namespace lyr {

class Turns {
public:
    // The pieces must outlive it.
    explicit Turns(const std::vector<BoundaryPiece>& pieces);

    // Whether the stretch with both pieces at its ends, the one way or the other, surely turns by less.
    bool is_stretch(std::size_t i, std::size_t j, double most_turn_rad) const {
        if (pieces_[i].contour != pieces_[j].contour) return false;
        const Turned &first = turned_[std::min(i, j)], &last = turned_[std::max(i, j)];
        return last.end_rad - first.start_rad < most_turn_rad ||
               first.round_rad - last.start_rad + first.end_rad < most_turn_rad;
    }

private:
    // From the contour's start to the piece's start and end, and all around; no less than that.
    struct Turned {
        double start_rad, end_rad, round_rad;
    };

    const std::vector<BoundaryPiece>& pieces_;
    std::vector<Turned> turned_;
};

}  // namespace lyr
