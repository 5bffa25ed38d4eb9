// Where parallel rows run through regions, as intervals: a quick look at what one region has and others have not.
//
// Contract
//  1. Rows are those of rows.h along x, in register for every region with the same pitch.
//  2. Operations are those on sets of points of the rows; a row's intervals are apart and in rising order.
//  3. A disc of a diameter d >= pitch_mm that lies in a region has on a row of it an interval of at least
//     sqrt(d^2 - pitch_mm^2). So what has only shorter ones holds no such disc.
//  4. Neighbouring rows have an interval of at least sqrt(d^2 - 4 pitch_mm^2) in common where a disc of a diameter
//     d >= 2 pitch_mm lies in the region; of a strip narrower than pitch_mm and nearly along the rows they have none.
//
// Cost: linear in the intervals.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/toolpath/hatch.h"

namespace lyr {

class RowCover {
public:
    RowCover() = default;
    RowCover(std::span<const Contour> region, double pitch_mm);

    bool empty() const { return intervals_.empty(); }
    double length_mm() const;        // of all intervals
    double longest_mm() const;       // interval
    double longest_pair_mm() const;  // that a row and the next have in common

    // What of this is not in the other; in any of the two; in both.
    RowCover without(const RowCover& other) const;
    RowCover with(const RowCover& other) const;
    RowCover common(const RowCover& other) const;

private:
    std::int64_t last_row() const {
        return first_row_ + static_cast<std::int64_t>(starts_.size()) - 1;
    }
    // None where there is no such row.
    std::span<const HatchSpan> row(std::int64_t number) const;
    void begin_row() { starts_.push_back(static_cast<std::uint32_t>(intervals_.size())); }

    std::int64_t first_row_ = 0;
    std::vector<std::uint32_t> starts_{};  // intervals of row k: [starts_[k], starts_[k + 1])
    std::vector<HatchSpan> intervals_{};
};

}  // namespace lyr
