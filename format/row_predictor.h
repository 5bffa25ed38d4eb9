// What a hatch row's ends will probably be, so that only the difference is stored. Along straight
// edges the ends of consecutive rows advance by equal steps, along curves by almost equal ones.
//
// Contract
//  1. The rule is part of the file format (docs/lyr-format.md): reader and writer must agree.
//  2. Memory is fixed: rows of more than `most_intervals` are predicted from the value before.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace lyr::format {

class RowPredictor {
public:
    static constexpr std::uint64_t most_intervals = 32;

    // At the start of every hatch operation.
    void begin_run() { counts_ = {}, last_ = 0; }

    void begin_row(std::uint64_t intervals) {
        std::swap(rows_[1], rows_[2]);
        std::swap(rows_[0], rows_[1]);
        counts_ = {intervals, counts_[0], counts_[1]};
        const bool known = intervals <= most_intervals && counts_[1] == intervals;
        order_ = !known ? 0 : counts_[2] == intervals ? 2 : 1;
    }

    // The j-th end of the row, counted along the direction.
    std::int64_t predict(std::uint64_t j) const {
        if (order_ == 0) return last_;
        const auto at = static_cast<std::size_t>(j);
        return order_ == 1 ? rows_[1][at] : 2 * rows_[1][at] - rows_[2][at];
    }

    void note(std::uint64_t j, std::int64_t value) {
        if (j < 2 * most_intervals) rows_[0][static_cast<std::size_t>(j)] = value;
        last_ = value;
    }

private:
    // This row, the one before and the one before that; and their numbers of intervals.
    std::array<std::array<std::int64_t, 2 * most_intervals>, 3> rows_{};
    std::array<std::uint64_t, 3> counts_{};
    std::int64_t last_ = 0;
    int order_ = 0;
};

}  // namespace lyr::format
