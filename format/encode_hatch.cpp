// A hatch run as rows of whole numbers on a grid. A run that does not fit its chunk goes on as
// another hatch operation on the same grid.

#include <cmath>

#include "format/encoder_state.h"
#include "format/layout.h"

namespace lyr::format {
namespace {

// Leaves room for the opcodes in front of and behind the rows.
constexpr std::size_t most_rows_bytes = longest_buffered_payload - 128;
constexpr std::size_t hatch_head_bytes = 3 + 2 * longest_varint;
constexpr std::size_t most_group_head_bytes = 2 * longest_varint;
// The difference of two ends on a grid takes at most so many bytes.
constexpr std::size_t most_end_bytes = 6;
// Rows with more are written in pieces.
constexpr std::size_t most_piece_ends = 8192;
static_assert(most_piece_ends * most_end_bytes + 2 * most_group_head_bytes < most_rows_bytes);
// A caller's unit vector is one by its own rounding.
constexpr double unit_slack = 1e-6;
// Runs whose rows coincide up to this, in quanta, share a grid: nothing against the rounding of a
// row to a whole quantum.
constexpr double grid_slack_quanta = 1.0 / 256;

}  // namespace

std::optional<Grid> LayerEncoder::Implementation::grid_of(const HatchRun& run) {
    const double length = std::hypot(run.direction_x, run.direction_y);
    if (!(std::abs(length - 1) <= unit_slack)) {
        mistake("a hatch's direction is no unit vector");
        return std::nullopt;
    }
    if (!quanta(run.offset_mm) || !quanta(run.pitch_mm)) return std::nullopt;
    const auto fine = [&](double mm) {
        return std::llround(mm * 1e6 / quantum_.nm * scale::offset);
    };
    Grid grid;
    grid.a = std::llround(run.direction_x / length * scale::direction);
    grid.b = std::llround(run.direction_y / length * scale::direction);
    grid.offset = fine(run.offset_mm);
    grid.pitch = fine(run.pitch_mm);
    return grid;
}

// Gives the number of the grid's row on which the run's row 0 lies, after stating the grid if it is
// not the current one.
std::int64_t LayerEncoder::Implementation::select_grid(const Grid& grid) {
    if (grid_ && grid_->a == grid.a && grid_->b == grid.b && grid_->pitch == grid.pitch) {
        const std::int64_t apart = grid.offset - grid_->offset;
        const std::int64_t row =
            grid.pitch == 0
                ? 0
                : std::llround(static_cast<double>(apart) / static_cast<double>(grid.pitch));
        const double off =
            static_cast<double>(apart) - static_cast<double>(row) * static_cast<double>(grid.pitch);
        if (std::abs(off) <= grid_slack_quanta * scale::offset) return row;
    }
    grid_ = grid;
    begin_operation(1 + 4 * longest_varint);
    put_byte(out_.bytes, opcode::grid);
    put_signed(out_.bytes, grid.a);
    put_signed(out_.bytes, grid.b);
    put_signed(out_.bytes, grid.offset);
    put_signed(out_.bytes, grid.pitch);
    return 0;
}

void LayerEncoder::Implementation::hatch(const HatchRun& run) {
    std::size_t intervals = 0;
    for (const HatchRow& row : run.rows) intervals += row.intervals;
    if (intervals != run.intervals.size()) mistake("a hatch's rows do not add up to its intervals");
    if (!has_path()) return;
    const std::optional<Grid> grid = grid_of(run);
    if (!grid || intervals == 0) return;
    const std::int64_t first = select_grid(*grid);
    one_way_ = run.one_way;
    const HatchInterval* next = run.intervals.data();
    Row row;
    for (std::size_t k = 0; k < run.rows.size(); ++k) {
        row.number = first + static_cast<std::int64_t>(k);
        row.forward = run.one_way || k % 2 == 0;
        if (!round_row(run.rows[k], next, row)) break;
        next += run.rows[k].intervals;
        for (std::size_t begin = 0; begin < row.ends.size(); begin += most_piece_ends)
            put_row(row, begin, std::min(begin + most_piece_ends, row.ends.size()));
    }
    close_hatch();
    given_x_mm_ = quantum_.mm(at_.x);
    given_y_mm_ = quantum_.mm(at_.y);
}

bool LayerEncoder::Implementation::round_row(const HatchRow& row, const HatchInterval* intervals,
                                             Row& out) {
    out.linked = row.linked;
    out.ends.clear();
    if (row.intervals == 0) return true;
    const std::optional<std::int64_t> offset = grid_->row(out.number);
    if (!offset) mistake("a hatch's row is out of range");
    if (error_) return false;
    out.offset = *offset;
    const auto in_range = [](std::int64_t value) {
        return value >= -coordinate_limit && value <= coordinate_limit;
    };
    const auto point = [&](std::int64_t along) {
        return Point{grid_->x(along, out.offset), grid_->y(along, out.offset), at_.z};
    };
    for (std::uint32_t i = 0; i < row.intervals; ++i) {
        const HatchInterval& interval = intervals[i];
        if (!(interval.start_mm <= interval.end_mm))
            mistake("a hatch's interval ends before it starts");
        const auto start = quanta(interval.start_mm), end = quanta(interval.end_mm);
        if (!start || !end || error_) return false;
        const Point from = point(*start), to = point(*end);
        if (!in_range(from.x) || !in_range(from.y) || !in_range(to.x) || !in_range(to.y)) {
            mistake("a hatch's line is out of range");
            return false;
        }
        if (from == to) continue;
        out.ends.push_back(*start);
        out.ends.push_back(*end);
    }
    return true;
}

// The ends [begin, end) in the order of the way along the row.
void LayerEncoder::Implementation::put_row(const Row& row, std::size_t begin, std::size_t end) {
    if (hatch_open_) {
        const std::size_t so_far = hatch_groups_.size() + group_.ends.size();
        const std::size_t most = 2 * most_group_head_bytes + (end - begin) * most_end_bytes;
        if (begin > 0 || so_far + most > most_rows_bytes) close_hatch();
    }
    if (!hatch_open_) open_hatch(row);
    for (; hatch_next_row_ < row.number; ++hatch_next_row_) begin_hatch_row(0);
    const std::uint64_t count = end - begin;
    begin_hatch_row(count | (row.linked && begin == 0 ? 1 : 0));
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t j = row.forward ? i : count - 1 - i;
        const std::size_t from_first = begin + static_cast<std::size_t>(i);
        const std::int64_t value =
            row.forward ? row.ends[from_first] : row.ends[row.ends.size() - 1 - from_first];
        put_signed(group_.ends, value - predictor_.predict(j));
        predictor_.note(j, value);
    }
    ++hatch_next_row_;
    count_row(row, begin, end);
}

// Rows with the same head share it.
void LayerEncoder::Implementation::begin_hatch_row(std::uint64_t head) {
    if (group_.rows == 0 || group_.head != head) close_group();
    group_.head = head;
    ++group_.rows;
    predictor_.begin_row(head / 2);
}

void LayerEncoder::Implementation::close_group() {
    if (group_.rows > 0) {
        put_varint(hatch_groups_, group_.head);
        put_varint(hatch_groups_, group_.rows);
        hatch_groups_.insert(hatch_groups_.end(), group_.ends.begin(), group_.ends.end());
    }
    group_.rows = 0;
    group_.ends.clear();
}

void LayerEncoder::Implementation::open_hatch(const Row& row) {
    hatch_open_ = true;
    hatch_groups_.clear();
    hatch_first_row_ = hatch_next_row_ = row.number;
    hatch_backward_ = !row.forward;
    predictor_.begin_run();
}

void LayerEncoder::Implementation::close_hatch() {
    if (!hatch_open_) return;
    hatch_open_ = false;
    close_group();
    begin_operation(hatch_head_bytes + hatch_groups_.size());
    put_byte(out_.bytes, opcode::hatch);
    put_byte(out_.bytes,
             (one_way_ ? hatch_bit::one_way : 0) | (hatch_backward_ ? hatch_bit::backward : 0));
    put_signed(out_.bytes, hatch_first_row_);
    put_varint(out_.bytes, static_cast<std::uint64_t>(hatch_next_row_ - hatch_first_row_));
    out_.bytes.insert(out_.bytes.end(), hatch_groups_.begin(), hatch_groups_.end());
}

void LayerEncoder::Implementation::count_row(const Row& row, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
        const std::int64_t along = row.forward ? row.ends[i] : row.ends[row.ends.size() - 1 - i];
        const Point to{grid_->x(along, row.offset), grid_->y(along, row.offset), at_.z};
        const bool line = i % 2 == 1 || (i == 0 && row.linked);
        if (line)
            count_line(to);
        else
            count_travel(to);
    }
}

}  // namespace lyr::format
