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

namespace lyr::format {

class RowPredictor {
public:
    static constexpr std::uint64_t most_intervals = 32;

    // At the start of every hatch operation.
    void begin_run() { counts_ = {}, last_ = 0; }

    void begin_row(std::uint64_t intervals) {
        const std::uint8_t oldest = two_before_;
        two_before_ = before_;
        before_ = now_;
        now_ = oldest;
        counts_ = {intervals, counts_[0], counts_[1]};
        const bool known = intervals <= most_intervals && counts_[1] == intervals;
        order_ = !known ? 0 : counts_[2] == intervals ? 2 : 1;
    }

    // The j-th end of the row, counted along the direction.
    std::int64_t predict(std::uint64_t j) const {
        if (order_ == 0) return last_;
        const auto at = static_cast<std::size_t>(j);
        return order_ == 1 ? rows_[before_][at] : 2 * rows_[before_][at] - rows_[two_before_][at];
    }

    void note(std::uint64_t j, std::int64_t value) {
        if (j < 2 * most_intervals) rows_[now_][static_cast<std::size_t>(j)] = value;
        last_ = value;
    }

private:
    std::array<std::array<std::int64_t, 2 * most_intervals>, 3> rows_{};
    std::uint8_t now_ = 0, before_ = 1, two_before_ = 2;  // which of them is this row, and so on
    std::array<std::uint64_t, 3> counts_{};               // intervals of this row and those before
    std::int64_t last_ = 0;
    int order_ = 0;
};

}  // namespace lyr::format
