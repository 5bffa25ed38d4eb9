// What a fill prints, as single lines and arcs, and how much of a region that covers.

#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kernel/region/regions.h"
#include "kernel/toolpath/hatch.h"
#include "kernel/toolpath/infill.h"

namespace lyr::testing {

inline Point2 row_end(const HatchRun& run, std::size_t row, bool last) {
    const Vector2 left(-run.direction.y(), run.direction.x());
    const bool along = row % 2 == 0;
    const double at = along == last ? run.rows[row].end_mm : run.rows[row].start_mm;
    return at * run.direction + (run.offset_mm + static_cast<double>(row) * run.pitch_mm) * left;
}

struct PrintedLine {
    Point2 start;
    Segment segment;
    bool is_link = false;  // of a run
};

// A full circle as two halves.
inline std::vector<PrintedLine> lines_of(const Fill& fill) {
    std::vector<PrintedLine> lines;
    for (const HatchRun& run : fill.runs) {
        for (std::size_t i = 0; i < run.rows.size(); ++i) {
            const Point2 start = row_end(run, i, false);
            if (run.rows[i].linked) lines.push_back({row_end(run, i - 1, true), {start}, true});
            lines.push_back({start, {row_end(run, i, true)}});
        }
    }
    for (const Strand& strand : fill.strands) {
        if (const auto* circle = std::get_if<FullCircle>(&strand.path)) {
            const Vector2 radius(circle->radius_mm, 0);
            const double turn = circle->counter_clockwise ? pi : -pi;
            const Point2 right = circle->centre + radius, left = circle->centre - radius;
            lines.push_back({right, arc_with_sweep(right, left, turn)});
            lines.push_back({left, arc_with_sweep(left, right, turn)});
            continue;
        }
        const Path& path = std::get<Path>(strand.path);
        Point2 from = path.start;
        for (const Segment& segment : path.segments) {
            lines.push_back({from, segment});
            from = segment.end;
        }
    }
    return lines;
}

inline double length_mm(const Fill& fill) {
    double length = 0;
    for (const PrintedLine& line : lines_of(fill)) {
        length += lyr::length_mm(line.start, line.segment);
    }
    return length;
}

using Intervals = std::vector<std::pair<double, double>>;

// What a strand with round ends covers of the horizontal line at y: it is convex, so one interval.
inline void add_covered(const Point2& a, const Point2& b, double radius_mm, double y,
                        Intervals& intervals) {
    double low = 1e300, high = -1e300;
    const auto extend = [&](double x) {
        low = std::min(low, x);
        high = std::max(high, x);
    };
    for (const Point2& end : {a, b}) {
        const double half2 = radius_mm * radius_mm - (y - end.y()) * (y - end.y());
        if (half2 < 0) continue;
        extend(end.x() - std::sqrt(half2));
        extend(end.x() + std::sqrt(half2));
    }
    const Vector2 along = (b - a).normalized(), side(-radius_mm * along.y(), radius_mm * along.x());
    const Point2 corners[] = {a + side, b + side, b - side, a - side};
    for (int i = 0; i < 4; ++i) {
        const Point2 &from = corners[i], &to = corners[(i + 1) % 4];
        if ((from.y() > y) == (to.y() > y)) continue;
        extend(from.x() + (y - from.y()) / (to.y() - from.y()) * (to.x() - from.x()));
    }
    if (low < high) intervals.push_back({low, high});
}

// The share of a region that strands cover, on lines 10 um apart.
inline double covered_share(const Contours& region, const Fill& fill, double width_mm) {
    constexpr double line_mm = 0.01;
    constexpr double chord_mm = 0.05;
    const Hatch scan = hatch(region, 0, line_mm);
    std::vector<Intervals> covered(scan.row_count());
    for (const PrintedLine& line : lines_of(fill)) {
        const int chords =
            line.segment.sagitta_mm == 0
                ? 1
                : 1 + static_cast<int>(lyr::length_mm(line.start, line.segment) / chord_mm);
        for (int i = 0; i < chords; ++i) {
            const Point2 a = point_at(line.start, line.segment, static_cast<double>(i) / chords);
            const Point2 b =
                point_at(line.start, line.segment, static_cast<double>(i + 1) / chords);
            const double low = std::min(a.y(), b.y()) - width_mm / 2 - scan.first_offset_mm;
            const double high = std::max(a.y(), b.y()) + width_mm / 2 - scan.first_offset_mm;
            const auto rows = static_cast<int>(scan.row_count());
            for (int row = std::max(0, static_cast<int>(low / line_mm));
                 row < std::min(rows, static_cast<int>(high / line_mm) + 1); ++row) {
                add_covered(a, b, width_mm / 2, scan.first_offset_mm + row * line_mm,
                            covered[static_cast<std::size_t>(row)]);
            }
        }
    }
    double all_mm = 0, covered_mm = 0;
    for (std::size_t row = 0; row < scan.row_count(); ++row) {
        std::sort(covered[row].begin(), covered[row].end());
        for (std::uint32_t s = scan.row_start[row]; s < scan.row_start[row + 1]; ++s) {
            const HatchSpan& span = scan.spans[s];
            all_mm += span.end_mm - span.start_mm;
            double at = span.start_mm;
            for (const auto& [low, high] : covered[row]) {
                const double from = std::max(at, low), to = std::min(span.end_mm, high);
                if (to > from) covered_mm += to - from;
                at = std::max(at, high);
            }
        }
    }
    return covered_mm / all_mm;
}

}  // namespace lyr::testing
