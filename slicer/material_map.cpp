#include "slicer/material_map.h"

#include <algorithm>
#include <cmath>

#include "kernel/toolpath/hatch.h"

namespace lyr::slicer {
namespace {

// Squares are a few lines wide, and larger where there would be more of them.
constexpr double least_edge_mm = 2, most_squares = 1e6;

// A quarter of the lines that nozzles lay.
constexpr double sample_mm = 0.1;

}  // namespace

MaterialMap::MaterialMap(const region::Box2& box, double run_width_mm)
    : run_width_mm_(run_width_mm),
      edge_mm_(std::max(least_edge_mm, std::sqrt(box.volume() / most_squares))),
      corner_(box.min()),
      columns_(static_cast<std::size_t>(box.sizes().x() / edge_mm_) + 1),
      rows_(static_cast<std::size_t>(box.sizes().y() / edge_mm_) + 1),
      missing_mm2_(columns_ * rows_) {}

double& MaterialMap::missing_at(const Point2& point) {
    const auto number = [&](double distance_mm, std::size_t count) {
        return static_cast<std::size_t>(
            std::clamp(distance_mm / edge_mm_, 0.0, static_cast<double>(count - 1)));
    };
    return missing_mm2_[number(point.y() - corner_.y(), rows_) * columns_ +
                        number(point.x() - corner_.x(), columns_)];
}

void MaterialMap::ask_for(Region region, double share) {
    const Hatch lines = hatch(region, 0, sample_mm);
    for (std::size_t row = 0; row < lines.row_count(); ++row) {
        const double y_mm = lines.first_offset_mm + static_cast<double>(row) * sample_mm;
        for (std::uint32_t i = lines.row_start[row]; i < lines.row_start[row + 1]; ++i)
            for (double from = lines.spans[i].start_mm; from < lines.spans[i].end_mm;) {
                const double to = std::min(lines.spans[i].end_mm, from + sample_mm);
                missing_at({(from + to) / 2, y_mm}) += share * sample_mm * (to - from);
                from = to;
            }
    }
}

void MaterialMap::lay_line(const Point2& from, const Segment& segment, double laid_mm) {
    const double length = length_mm(from, segment);
    const int samples = 1 + static_cast<int>(length / sample_mm);
    for (int i = 0; i < samples; ++i)
        missing_at(point_at(from, segment, (i + 0.5) / samples)) -= laid_mm * length / samples;
}

void MaterialMap::lay(const Strand& strand, double lapped_mm, double flow) {
    if (const auto* circle = std::get_if<FullCircle>(&strand.path)) {
        const Vector2 to_side(circle->radius_mm, 0);
        const Point2 start = circle->centre + to_side, middle = circle->centre - to_side;
        lay_line(start, {middle, circle->radius_mm}, flow * (strand.width_mm - lapped_mm));
        lay_line(middle, {start, circle->radius_mm}, flow * (strand.width_mm - lapped_mm));
        return;
    }
    const Path& path = std::get<Path>(strand.path);
    Point2 from = path.start;
    for (std::size_t i = 0; i < path.segments.size(); ++i) {
        const double width_mm = strand.widths_mm.empty() ? strand.width_mm : strand.widths_mm[i];
        lay_line(from, path.segments[i], flow * (width_mm - lapped_mm));
        from = path.segments[i].end;
    }
}

void MaterialMap::lay(const HatchRun& run, double lapped_mm, double flow) {
    const Vector2 across = left_of(run.direction);
    const double laid_mm = flow * (run_width_mm_ - lapped_mm);
    Point2 before = start_of(run);
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
        const HatchRow& row = run.rows[i];
        const Point2 foot = (run.offset_mm + static_cast<double>(i) * run.pitch_mm) * across;
        Point2 start = foot + row.start_mm * run.direction, end = foot + row.end_mm * run.direction;
        if (i % 2 == 1) std::swap(start, end);
        if (row.linked) lay_line(before, {start, 0}, laid_mm);
        lay_line(start, {end, 0}, laid_mm);
        before = end;
    }
}

Point2 MaterialMap::most(double sign) const {
    Point2 place = corner_;
    double most_mm2 = 0;
    for (std::size_t row = 0; row < rows_; ++row)
        for (std::size_t column = 0; column < columns_; ++column) {
            double sum = 0;
            for (std::size_t y = row - (row > 0); y < std::min(row + 2, rows_); ++y)
                for (std::size_t x = column - (column > 0); x < std::min(column + 2, columns_); ++x)
                    sum += sign * missing_mm2_[y * columns_ + x];
            if (sum <= most_mm2) continue;
            most_mm2 = sum;
            place = corner_ + edge_mm_ * Vector2(static_cast<double>(column) + 0.5,
                                                 static_cast<double>(row) + 0.5);
        }
    return place;
}

}  // namespace lyr::slicer
