#include "kernel/toolpath/clip.h"

#include <algorithm>
#include <cmath>

#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

region::Curve curve_of(const BoundaryPiece& piece) {
    return {
        piece.start,        piece.end, piece.middle, piece.middle_tangent, piece.curvature_per_mm,
        piece.length_mm / 2};
}

// Where the path meets the boundary, or where it begins or ends.
struct Knot {
    double at_mm;  // along the path
    bool on_boundary = false;
    BoundaryPlace place{};
};

class Clipper {
public:
    Clipper(const Path& path, const Boundary& region) : path_(path), region_(region) {
        Point2 from = path.start;
        for (const Segment& segment : path.segments) {
            starts_.push_back(from);
            positions_mm_.push_back(total_mm_);
            if (segment.end != from) total_mm_ += length_mm(from, segment);
            from = segment.end;
        }
    }

    std::vector<PathPart> parts() {
        find_knots();
        std::vector<PathPart> parts;
        std::size_t first = 0;  // knot of the part that is being made
        bool inside = false;
        for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
            const double from = knots_[i].at_mm, to = knots_[i + 1].at_mm;
            if (to - from <= resolution_mm) continue;
            const bool in = region_.winding(point_at_mm((from + to) / 2)) > 0;
            if (in && !inside) first = i;
            if (!in && inside) parts.push_back(part(knots_[first], knots_[i]));
            inside = in;
        }
        if (inside) parts.push_back(part(knots_[first], knots_.back()));
        return parts;
    }

private:
    void find_knots() {
        knots_.push_back({0});
        const Vector2 margin(resolution_mm, resolution_mm);
        for (std::size_t i = 0; i < starts_.size(); ++i) {
            if (path_.segments[i].end == starts_[i]) continue;
            const region::Curve curve = region::curve_of(starts_[i], path_.segments[i]);
            const region::Box2 box = region::box_of(curve);
            region_.meeting({box.min() - margin, box.max() + margin},
                            [&](std::uint32_t piece) { add_crossings(i, curve, piece); });
        }
        knots_.push_back({total_mm_});
        std::sort(knots_.begin() + 1, knots_.end() - 1, [](const Knot& a, const Knot& b) {
            return a.at_mm != b.at_mm ? a.at_mm < b.at_mm : a.place.piece < b.place.piece;
        });
    }

    void add_crossings(std::size_t segment, const region::Curve& curve, std::uint32_t index) {
        const BoundaryPiece& piece = region_.pieces()[index];
        const region::Curve boundary = curve_of(piece);
        const auto along = [](const region::Curve& of,
                              const Point2& point) -> std::optional<double> {
            const double at = region::along_mm(of, point);
            if (std::abs(at) > of.half_mm + resolution_mm) return std::nullopt;
            if (std::abs(region::across_mm(of, point)) > resolution_mm) return std::nullopt;
            return std::clamp(at, -of.half_mm, of.half_mm) + of.half_mm;
        };
        const region::Meetings found = region::meetings(curve, boundary);
        for (int i = 0; i < found.count; ++i) {
            const Point2& point = found.points[static_cast<std::size_t>(i)];
            const auto on_path = along(curve, point), on_boundary = along(boundary, point);
            if (on_path && on_boundary)
                knots_.push_back(
                    {positions_mm_[segment] + *on_path, true, {index, *on_boundary, point}});
        }
    }

    // The segment of a place along the path.
    std::size_t segment_at(double at_mm) const {
        const auto after = std::upper_bound(positions_mm_.begin(), positions_mm_.end(), at_mm);
        return static_cast<std::size_t>(after - positions_mm_.begin()) - 1;
    }

    double segment_length_mm(std::size_t segment) const {
        const bool last = segment + 1 == positions_mm_.size();
        return (last ? total_mm_ : positions_mm_[segment + 1]) - positions_mm_[segment];
    }

    Point2 point_at_mm(double at_mm) const {
        const std::size_t i = segment_at(at_mm);
        return point_at(starts_[i], path_.segments[i],
                        (at_mm - positions_mm_[i]) / segment_length_mm(i));
    }

    PathPart part(const Knot& from, const Knot& to) const {
        PathPart part{{from.on_boundary ? from.place.point : path_.start, {}}, {}, {}};
        if (from.on_boundary) part.start = from.place;
        if (to.on_boundary) part.end = to.place;
        const Point2 end = to.on_boundary ? to.place.point : path_.segments.back().end;
        Point2 at = part.path.start;
        double at_mm = from.at_mm;
        for (std::size_t i = segment_at(from.at_mm); at_mm < to.at_mm; ++i) {
            const Segment& segment = path_.segments[i];
            const double length = segment_length_mm(i), end_mm = positions_mm_[i] + length;
            const bool last = end_mm >= to.at_mm - resolution_mm;
            const Point2& next = last ? end : segment.end;
            const double share = length > 0 ? (std::min(end_mm, to.at_mm) - at_mm) / length : 0;
            if (share * length > resolution_mm) {
                const bool whole = share == 1 && next == segment.end && at == starts_[i];
                part.path.segments.push_back(
                    whole ? segment
                          : arc_with_sweep(at, next, share * sweep_rad(starts_[i], segment)));
                at = next;
            } else if (last && !part.path.segments.empty()) {
                part.path.segments.back().end = end;
            }
            if (last) break;
            at_mm = end_mm;
        }
        return part;
    }

    const Path& path_;
    const Boundary& region_;
    std::vector<Point2> starts_;
    std::vector<double> positions_mm_;  // of the segments' starts, along the path
    double total_mm_ = 0;
    std::vector<Knot> knots_;
};

}  // namespace

std::vector<PathPart> clipped(const Path& path, const Boundary& region) {
    if (path.segments.empty()) return {};
    return Clipper(path, region).parts();
}

}  // namespace lyr
