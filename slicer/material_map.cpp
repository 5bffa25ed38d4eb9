#include "slicer/material_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/toolpath/hatch.h"

namespace lyr::slicer {
namespace {

// A quarter of the lines that nozzles lay: what is bare of the narrowest web that is printed has two squares across. So
// many of them are made larger, which is four megabytes.
constexpr double fine_mm = 0.1, most_fine = 4e6;

// A few lines wide.
constexpr double coarse_mm = 2, most_coarse = 1e6;

// Of strands, in squares: none is passed over.
constexpr double sample_share = 0.8;

// Strands that turn by less leave nothing bare beside them.
constexpr double smooth_cosine = 0.95;

// A circle as two halves.
Path as_path(const Contour& contour) {
    if (const auto* path = std::get_if<Path>(&contour)) return *path;
    const auto& [centre, radius_mm, ccw] = std::get<FullCircle>(contour);
    const Vector2 to_side(radius_mm, 0);
    return {centre + to_side, {{centre - to_side, radius_mm}, {centre + to_side, radius_mm}}};
}

}  // namespace

MaterialMap::Grid::Grid(const region::Box2& box, double least_edge_mm, double most_squares)
    : edge_mm(std::max(least_edge_mm, std::sqrt(box.volume() / most_squares))),
      // So that rows of hatch() are the middles of rows of squares.
      corner((box.min() / edge_mm).array().floor() * edge_mm),
      columns(static_cast<std::size_t>((box.max().x() - corner.x()) / edge_mm) + 1),
      rows(static_cast<std::size_t>((box.max().y() - corner.y()) / edge_mm) + 1) {}

std::size_t MaterialMap::Grid::at(const Point2& point) const {
    const auto number = [&](double distance_mm, std::size_t count) {
        return static_cast<std::size_t>(
            std::clamp(distance_mm / edge_mm, 0.0, static_cast<double>(count - 1)));
    };
    return number(point.y() - corner.y(), rows) * columns + number(point.x() - corner.x(), columns);
}

Point2 MaterialMap::Grid::middle(std::size_t square) const {
    return corner + edge_mm * Vector2(static_cast<double>(square % columns) + 0.5,
                                      static_cast<double>(square / columns) + 0.5);
}

MaterialMap::MaterialMap(const region::Box2& box, double run_width_mm)
    : run_width_mm_(run_width_mm),
      fine_(box, fine_mm, most_fine),
      coarse_(box, coarse_mm, most_coarse),
      marks_(fine_.columns * fine_.rows),
      missing_mm2_(coarse_.columns * coarse_.rows) {}

void MaterialMap::ask_for(Region region, double share) {
    const double edge_mm = fine_.edge_mm;
    const Hatch lines = hatch(region, 0, edge_mm);
    for (std::size_t row = 0; row < lines.row_count(); ++row) {
        const double y_mm = lines.first_offset_mm + static_cast<double>(row) * edge_mm;
        for (std::uint32_t i = lines.row_start[row]; i < lines.row_start[row + 1]; ++i) {
            const HatchSpan& span = lines.spans[i];
            for (double from = span.start_mm; from < span.end_mm;) {
                const double to = std::min(span.end_mm, from + edge_mm);
                const Point2 middle((from + to) / 2, y_mm);
                missing_mm2_[coarse_.at(middle)] += share * edge_mm * (to - from);
                from = to;
            }
            // Squares that are not wholly in are not asked for.
            const double start = (span.start_mm - fine_.corner.x()) / edge_mm;
            const double end = (span.end_mm - fine_.corner.x()) / edge_mm;
            const double first = share > 0 ? std::ceil(start) : std::floor(start);
            const double last = share > 0 ? std::floor(end) : std::ceil(end);
            for (double column = first; column < last; ++column) {
                std::uint8_t& mark =
                    marks_[fine_.at({fine_.corner.x() + (column + 0.5) * edge_mm, y_mm})];
                mark = share > 0 ? asked : 0;
            }
        }
    }
}

void MaterialMap::lay_line(const Point2& from, const Segment& segment, double width_mm,
                           double laid_mm) {
    const double length = length_mm(from, segment), sample_mm = sample_share * fine_.edge_mm;
    const int steps = 1 + static_cast<int>(length / sample_mm);
    const int threads = 1 + static_cast<int>(width_mm / sample_mm);
    const double area_mm2 = laid_mm * length / (steps * threads);
    Point2 before = from;
    for (int i = 1; i <= steps; ++i) {
        const Point2 after = point_at(from, segment, static_cast<double>(i) / steps);
        const Vector2 along = (after - before).normalized(), across(-along.y(), along.x());
        for (int k = 0; k < threads; ++k) {
            const Point2 at =
                (before + after) / 2 + ((k + 0.5) / threads - 0.5) * width_mm * across;
            missing_mm2_[coarse_.at(at)] -= area_mm2;
            marks_[fine_.at(at)] |= laid;
        }
        before = after;
    }
}

void MaterialMap::lay_disc(const Point2& middle, double width_mm) {
    const double sample_mm = sample_share * fine_.edge_mm;
    for (double y = -width_mm / 2; y <= width_mm / 2; y += sample_mm)
        for (double x = -width_mm / 2; x <= width_mm / 2; x += sample_mm)
            if (std::hypot(x, y) <= width_mm / 2) marks_[fine_.at(middle + Vector2(x, y))] |= laid;
}

void MaterialMap::lay(const Strand& strand, double lapped_mm, double flow) {
    const Path path = as_path(strand.path);
    Point2 from = path.start;
    Vector2 before = Vector2::Zero();
    for (std::size_t i = 0; i < path.segments.size(); ++i) {
        const Segment& segment = path.segments[i];
        const double own_mm = strand.widths_mm.empty() ? strand.width_mm : strand.widths_mm[i];
        // What is more than the strand holds spreads beside it.
        const double width_mm = std::max(1.0, flow) * own_mm;
        if (before.dot(start_tangent(from, segment)) < smooth_cosine) lay_disc(from, width_mm);
        lay_line(from, segment, width_mm, flow * (own_mm - lapped_mm));
        before = end_tangent(from, segment);
        from = segment.end;
        if (i + 1 == path.segments.size()) lay_disc(from, width_mm);
    }
}

void MaterialMap::lay(const HatchRun& run, double lapped_mm, double flow) {
    const Vector2 across(-run.direction.y(), run.direction.x());
    const double laid_mm = flow * (run_width_mm_ - lapped_mm);
    Point2 before = start_of(run);
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
        const HatchRow& row = run.rows[i];
        const Point2 foot = (run.offset_mm + static_cast<double>(i) * run.pitch_mm) * across;
        Point2 start = foot + row.start_mm * run.direction, end = foot + row.end_mm * run.direction;
        if (i % 2 == 1) std::swap(start, end);
        if (row.linked) lay_line(before, {start, 0}, run_width_mm_, laid_mm);
        lay_line(start, {end, 0}, run_width_mm_, laid_mm);
        lay_disc(start, run_width_mm_);
        lay_disc(end, run_width_mm_);
        before = end;
    }
}

MaterialMap::Spot MaterialMap::largest_bare() const {
    std::vector<std::uint8_t> marks = marks_;
    std::vector<std::size_t> spot;
    Spot largest;
    const auto take = [&](std::size_t square) {
        if (marks[square] != asked) return;
        marks[square] = 0;
        spot.push_back(square);
    };
    for (std::size_t first = 0; first < marks.size(); ++first) {
        spot.clear();
        take(first);
        for (std::size_t i = 0; i < spot.size(); ++i) {
            const std::size_t at = spot[i], column = at % fine_.columns;
            if (column > 0) take(at - 1);
            if (column + 1 < fine_.columns) take(at + 1);
            if (at >= fine_.columns) take(at - fine_.columns);
            if (at + fine_.columns < marks.size()) take(at + fine_.columns);
        }
        const double area_mm2 = static_cast<double>(spot.size()) * fine_.edge_mm * fine_.edge_mm;
        if (area_mm2 > largest.area_mm2) largest = {area_mm2, fine_.middle(spot[spot.size() / 2])};
    }
    return largest;
}

Point2 MaterialMap::most(double sign) const {
    Point2 place = coarse_.corner;
    double most_mm2 = 0;
    for (std::size_t square = 0; square < missing_mm2_.size(); ++square) {
        const std::size_t row = square / coarse_.columns, column = square % coarse_.columns;
        double sum = 0;
        for (std::size_t y = row - (row > 0); y < std::min(row + 2, coarse_.rows); ++y)
            for (std::size_t x = column - (column > 0); x < std::min(column + 2, coarse_.columns);
                 ++x)
                sum += sign * missing_mm2_[y * coarse_.columns + x];
        if (sum <= most_mm2) continue;
        most_mm2 = sum;
        place = coarse_.middle(square);
    }
    return place;
}

}  // namespace lyr::slicer
