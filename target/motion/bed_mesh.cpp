#include "target/motion/bed_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lyr::motion {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// One axis of the grid: between which lines a place lies. Before the first and after the last line there is no other
// one, and both ends are the line at the rim.
struct Between {
    std::size_t low, high;
    double low_mm, high_mm;
};

Between between(double place_mm, double first_mm, double pitch_mm, std::size_t lines) {
    const double line = std::floor((place_mm - first_mm) / pitch_mm);
    if (line < 0) return {0, 0, -infinity, first_mm};
    const auto last = static_cast<double>(lines - 1);
    if (line >= last) return {lines - 1, lines - 1, first_mm + last * pitch_mm, infinity};
    const auto low = static_cast<std::size_t>(line);
    return {low, low + 1, first_mm + line * pitch_mm, first_mm + (line + 1) * pitch_mm};
}

}  // namespace

BedMesh::BedMesh(const Point& first, const Point& last, std::size_t columns,
                 std::vector<double> heights_mm, double fade_mm)
    : first_(first),
      columns_(columns),
      rows_(heights_mm.size() / columns),
      heights_mm_(std::move(heights_mm)),
      fade_mm_(fade_mm) {
    pitch_x_mm_ = (last.x - first.x) / static_cast<double>(columns_ - 1);
    pitch_y_mm_ = (last.y - first.y) / static_cast<double>(rows_ - 1);
    measure();
}

// By weights of the four corners; cell_at() is for those who need derivatives.
double BedMesh::lift_mm(const Point& head) const {
    if (fade_mm_ > 0 && head.z >= fade_mm_) return 0;
    const auto place = [](double at_mm, double first_mm, double pitch_mm, std::size_t lines) {
        const double at =
            std::clamp((at_mm - first_mm) / pitch_mm, 0.0, static_cast<double>(lines - 1));
        const std::size_t low = std::min(static_cast<std::size_t>(at), lines - 2);
        return std::pair(low, at - static_cast<double>(low));
    };
    const auto [column, u] = place(head.x, first_.x, pitch_x_mm_, columns_);
    const auto [row, v] = place(head.y, first_.y, pitch_y_mm_, rows_);
    const double height_mm = (1 - v) * ((1 - u) * at(column, row) + u * at(column + 1, row)) +
                             v * ((1 - u) * at(column, row + 1) + u * at(column + 1, row + 1));
    return fade_mm_ > 0 ? height_mm * std::clamp(1 - head.z / fade_mm_, 0.0, 1.0) : height_mm;
}

MeshCell BedMesh::cell_at(const Point& head) const {
    const Between x = between(head.x, first_.x, pitch_x_mm_, columns_);
    const Between y = between(head.y, first_.y, pitch_y_mm_, rows_);
    MeshCell cell{{x.low_mm, y.low_mm, -infinity}, {x.high_mm, y.high_mm, infinity}};
    cell.x_mm = first_.x + static_cast<double>(x.low) * pitch_x_mm_;
    cell.y_mm = first_.y + static_cast<double>(y.low) * pitch_y_mm_;
    cell.height_mm = at(x.low, y.low);
    cell.slope_x = (at(x.high, y.low) - cell.height_mm) / pitch_x_mm_;
    cell.slope_y = (at(x.low, y.high) - cell.height_mm) / pitch_y_mm_;
    cell.twist_per_mm =
        (at(x.high, y.high) - at(x.high, y.low) - at(x.low, y.high) + cell.height_mm) /
        (pitch_x_mm_ * pitch_y_mm_);
    if (!(fade_mm_ > 0)) return cell;
    const bool below = head.z < 0, above = head.z >= fade_mm_;
    cell.low_mm[2] = below ? -infinity : above ? fade_mm_ : 0;
    cell.high_mm[2] = below ? 0 : above ? infinity : fade_mm_;
    cell.share = above ? 0 : 1;
    cell.share_slope_per_mm = below || above ? 0 : -1 / fade_mm_;
    return cell;
}

void BedMesh::measure() {
    double highest_mm = 0;
    for (const double height_mm : heights_mm_)
        highest_mm = std::max(highest_mm, std::abs(height_mm));
    if (fade_mm_ > 0) shape_.fade_slope = highest_mm / fade_mm_;
    if (fade_mm_ > 0) shape_.fade_per_mm = 1 / fade_mm_;
    // A slope is linear between two edges that face each other; all of them, and how they differ beside each other.
    double slope_x = 0, slope_y = 0, kink_x = 0, kink_y = 0;
    for (std::size_t row = 0; row < rows_; ++row)
        for (std::size_t column = 0; column < columns_; ++column) {
            const auto rise_x = [&](std::size_t i) {
                return (at(i + 1, row) - at(i, row)) / pitch_x_mm_;
            };
            const auto rise_y = [&](std::size_t i) {
                return (at(column, i + 1) - at(column, i)) / pitch_y_mm_;
            };
            const double left = column > 0 ? rise_x(column - 1) : 0;
            const double right = column + 1 < columns_ ? rise_x(column) : 0;
            const double before = row > 0 ? rise_y(row - 1) : 0;
            const double after = row + 1 < rows_ ? rise_y(row) : 0;
            slope_x = std::max(slope_x, std::abs(right));
            slope_y = std::max(slope_y, std::abs(after));
            kink_x = std::max(kink_x, std::abs(right - left));
            kink_y = std::max(kink_y, std::abs(after - before));
            if (column + 1 == columns_ || row + 1 == rows_) continue;
            const double twist =
                (at(column + 1, row + 1) - at(column + 1, row)) / pitch_y_mm_ - after;
            shape_.twist_per_mm = std::max(shape_.twist_per_mm, std::abs(twist) / pitch_x_mm_);
        }
    shape_.slope = std::hypot(slope_x, slope_y);
    shape_.kink = std::hypot(kink_x, kink_y);
}

}  // namespace lyr::motion
