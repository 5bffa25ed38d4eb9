#include "slicer/plate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/text.h"
#include "slicer/adhesion.h"

namespace lyr::slicer {
namespace {

// No printer of this kind is larger.
constexpr double largest_plate_mm = 10'000;
// Pitches are multiples of this, which is a whole number of any quantum.
constexpr double pitch_step_mm = 0.001;
// The nozzle passes over finished copies so high above them: over what curls up or hangs from it.
constexpr double lift_mm = 2;

using Sizes = Eigen::Array2d;

struct Grid {
    std::size_t columns = 0, rows = 0;
};

double rounded_up_mm(double length_mm) {
    return std::ceil(length_mm / pitch_step_mm - plate_slack_mm / pitch_step_mm) * pitch_step_mm;
}

class Layout {
public:
    Layout(const Eigen::AlignedBox3d& box, const profile::Profile& profile)
        : plate_(profile.plate),
          corner_(box.min().x(), box.min().y()),
          size_(box.sizes().x(), box.sizes().y()),
          in_sequence_(plate_.sequential && plate_.copies > 1),
          one_behind_other_(in_sequence_ && box.max().z() > plate_.clearance_height_mm) {
        const bool has_brim = profile.adhesion.kind == profile::AdhesionKind::brim;
        const double brim_mm = has_brim ? adhesion_reach_mm(profile) : 0;
        gap_mm_ = plate_.spacing_mm + 2 * brim_mm;
        if (in_sequence_) gap_mm_ = std::max(gap_mm_, plate_.clearance_radius_mm + brim_mm);
        for (const Eigen::Index axis : {0, 1}) pitch_[axis] = rounded_up_mm(size_[axis] + gap_mm_);
    }

    Result<PlateLayout> make() const {
        const Grid room = most();
        const std::optional<Grid> grid = best_within(room);
        if (!grid) return does_not_fit(room);
        PlateLayout made{.columns = grid->columns, .rows = grid->rows, .gap_mm = gap_mm_};
        for (std::size_t i = 0; i < plate_.copies; ++i)
            made.shifts.emplace_back(static_cast<double>(i % grid->columns) * pitch_[0],
                                     static_cast<double>(i / grid->columns) * pitch_[1]);
        made.order = to_and_fro(*grid);
        made.outline = {around(*grid)};
        made.lift_mm = in_sequence_ ? lift_mm : 0;
        return made;
    }

private:
    bool is_stated() const { return plate_.size_mm[0] > 0 || plate_.size_mm[1] > 0; }
    double end_mm(Eigen::Index axis) const {
        return is_stated() ? plate_.size_mm[static_cast<std::size_t>(axis)] : largest_plate_mm;
    }

    // How many fit beside and behind each other.
    Grid most() const {
        const auto along = [&](Eigen::Index axis) -> std::size_t {
            const double room_mm = end_mm(axis) - corner_[axis] - size_[axis] + plate_slack_mm;
            if (!(room_mm >= 0)) return 0;
            const double more = std::min<double>(plate_.copies, std::floor(room_mm / pitch_[axis]));
            return 1 + static_cast<std::size_t>(more);
        };
        Grid room{along(0), along(1)};
        if (one_behind_other_) room.columns = std::min<std::size_t>(room.columns, 1);
        return room;
    }

    double longer_side_mm(const Grid& grid) const {
        const Sizes cells(static_cast<double>(grid.columns), static_cast<double>(grid.rows));
        return (cells * pitch_ - gap_mm_).maxCoeff();
    }

    std::optional<Grid> best_within(const Grid& room) const {
        std::optional<Grid> best;
        for (std::size_t columns = 1; columns <= std::min<std::size_t>(room.columns, plate_.copies);
             ++columns) {
            const Grid grid{columns, (plate_.copies + columns - 1) / columns};
            if (grid.rows > room.rows) continue;
            if (!best || longer_side_mm(grid) < longer_side_mm(*best) - plate_slack_mm) best = grid;
        }
        return best;
    }

    Diagnostic does_not_fit(const Grid& room) const {
        char text[400];
        std::snprintf(
            text, sizeof text,
            "%u copies of %.6g x %.6g mm, %.6g mm apart%s, do not fit on %s of %.6g x %.6g "
            "mm from %.6g, %.6g on: at most %zu would (plate.copies, plate.size, plate.at, "
            "plate.spacing%s)",
            plate_.copies, size_[0], size_[1], gap_mm_,
            one_behind_other_ ? " and one behind the other, as they are higher than "
                                "plate.clearance_height"
                              : "",
            is_stated() ? "the plate" : "any plate", end_mm(0), end_mm(1), corner_[0], corner_[1],
            room.columns * room.rows, in_sequence_ ? ", plate.clearance_radius" : "");
        return {Severity::error, ExitStatus::geometry, text, {}};
    }

    // Along the shorter pitch, each line of copies in the opposite direction of the one before, and so that a last row
    // that is shorter begins where the one before ends.
    std::vector<std::uint32_t> to_and_fro(const Grid& grid) const {
        const bool by_rows = pitch_[0] <= pitch_[1];
        const std::size_t lines = by_rows ? grid.rows : grid.columns;
        const std::size_t length = by_rows ? grid.columns : grid.rows;
        std::vector<std::uint32_t> order;
        for (std::size_t line = 0; line < lines; ++line)
            for (std::size_t k = 0; k < length; ++k) {
                const bool forward = (lines - 1 - line) % 2 == 0;
                const std::size_t along = forward ? k : length - 1 - k;
                const std::size_t copy =
                    by_rows ? line * grid.columns + along : along * grid.columns + line;
                if (copy < plate_.copies) order.push_back(static_cast<std::uint32_t>(copy));
            }
        return order;
    }

    // The last row may be shorter than the others.
    Contour around(const Grid& grid) const {
        const std::size_t in_last = plate_.copies - (grid.rows - 1) * grid.columns;
        const auto end = [&](Eigen::Index axis, std::size_t cells) {
            return corner_[axis] + static_cast<double>(cells) * pitch_[axis] - gap_mm_;
        };
        const double left = corner_[0], right = end(0, grid.columns), inner = end(0, in_last);
        const double front = corner_[1], rear = end(1, grid.rows);
        const double step = in_last < grid.columns ? end(1, grid.rows - 1) : rear;
        Path path{{left, front}, {{{right, front}}, {{right, step}}}};
        if (in_last < grid.columns) {
            path.segments.push_back({{inner, step}});
            path.segments.push_back({{inner, rear}});
        }
        path.segments.push_back({{left, rear}});
        path.segments.push_back({{left, front}});
        return path;
    }

    const profile::Plate& plate_;
    Sizes corner_, size_, pitch_;
    double gap_mm_ = 0;
    bool in_sequence_, one_behind_other_;
};

}  // namespace

Result<PlateLayout> lay_out(const Eigen::AlignedBox3d& box, const profile::Profile& profile) {
    return Layout(box, profile).make();
}

std::string layout_text(const PlateLayout& layout) {
    if (layout.shifts.size() <= 1) return {};
    char text[120];
    std::snprintf(text, sizeof text, "%zu copies in %s, %.6g mm apart, %s\n", layout.shifts.size(),
                  counted(layout.rows, "row").c_str(), layout.gap_mm,
                  layout.is_sequential() ? "one after the other" : "layer by layer");
    return text;
}

}  // namespace lyr::slicer
