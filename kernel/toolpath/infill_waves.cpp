#include "kernel/toolpath/infill_waves.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/toolpath/clip.h"
#include "kernel/toolpath/infill_lines.h"
#include "kernel/toolpath/strand_links.h"

namespace lyr {
namespace {

// Strands begin and end outside the region by this share of the pattern's period at least.
constexpr double margin_share = 0.01;

// In the pattern's own coordinates.
region::Box2 box_across(std::span<const BoundaryPiece> boundary, const Vector2& direction) {
    region::Box2 box;
    for (const BoundaryPiece& piece : boundary) {
        const double bulge = piece.is_wide ? 2 / std::abs(piece.curvature_per_mm)
                                           : (piece.middle - (piece.start + piece.end) / 2).norm();
        for (const Point2& p : {piece.start, piece.end}) {
            const Point2 turned(direction.dot(p), cross(direction, p));
            box.extend(turned - Vector2(bulge, bulge));
            box.extend(turned + Vector2(bulge, bulge));
        }
    }
    return box;
}

region::Box2 box_of(const Wave& wave) {
    region::Box2 box(wave.start);
    Point2 from = wave.start;
    for (const Segment& segment : wave.segments) {
        if (segment.end == from) continue;
        box.extend(region::box_of(region::curve_of(from, segment)));
        from = segment.end;
    }
    return box;
}

struct Range {
    double first, last;
};

// The whole numbers n for which a stretch, moved by n steps, meets an interval.
Range steps_to_meet(double low, double high, double from, double to, double step) {
    return {std::ceil((low - to) / step), std::floor((high - from) / step)};
}

bool is_short(const Path& path, double length_mm) {
    return std::all_of(path.segments.begin(), path.segments.end(), [&](const Segment& segment) {
        return (segment.end - path.start).norm() < length_mm;
    });
}

class Tiling {
public:
    Tiling(const WavePattern& pattern, const region::Box2& box)
        : pattern_(pattern),
          box_(box),
          x_(std::cos(pattern.angle_rad), std::sin(pattern.angle_rad)) {}

    // Calls take(path) for every strand that can meet the box.
    template <class Take>
    void strands(Take take) const {
        const double margin = margin_share * pattern_.period_mm;
        for (const Wave& wave : pattern_.waves) {
            const region::Box2 wave_box = box_of(wave);
            const Range rows = steps_to_meet(box_.min().y(), box_.max().y(), wave_box.min().y(),
                                             wave_box.max().y(), pattern_.distance_mm);
            const double period = pattern_.period_mm, start = wave.start.x();
            const Range periods{std::floor((box_.min().x() - margin - start) / period),
                                std::floor((box_.max().x() + margin - start) / period)};
            for (double row = rows.first; row <= rows.last; ++row) {
                take(strand(wave, periods, row * pattern_.distance_mm));
            }
        }
    }

private:
    Path strand(const Wave& wave, const Range& periods, double y_mm) const {
        const auto placed = [&](const Point2& p, double period) {
            const Point2 at = p + Vector2(period * pattern_.period_mm, y_mm);
            return Point2(at.x() * x_ + at.y() * left_of(x_));
        };
        Path path{placed(wave.start, periods.first), {}};
        const auto count = static_cast<std::size_t>(periods.last - periods.first + 1);
        path.segments.reserve(count * wave.segments.size());
        for (double period = periods.first; period <= periods.last; ++period) {
            for (const Segment& segment : wave.segments) {
                path.segments.push_back({placed(segment.end, period), segment.sagitta_mm});
            }
        }
        return path;
    }

    const WavePattern& pattern_;
    region::Box2 box_;
    Vector2 x_;
};

}  // namespace

void fill_with_waves(Region inside, const WavePattern& pattern, const InfillRequest& request,
                     Fill& fill) {
    if (inside.empty()) return;
    const Boundary boundary(inside);
    const Vector2 direction(std::cos(pattern.angle_rad), std::sin(pattern.angle_rad));
    std::vector<OpenStrand> strands;
    Tiling(pattern, box_across(boundary.pieces(), direction)).strands([&](const Path& path) {
        for (PathPart& part : clipped(path, boundary)) {
            if (!part.start || !part.end || is_short(part.path, request.allowed_mm)) continue;
            strands.push_back({*part.start, *part.end, std::move(part.path.segments)});
        }
    });
    for (Path& path : linked(boundary.pieces(), strands, longest_link * pattern.spacing_mm)) {
        fill.strands.push_back({.path = std::move(path), .width_mm = request.width_mm});
    }
}

}  // namespace lyr
