#include "kernel/toolpath/clip.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

// A place on the path.
struct Spot {
    std::size_t segment = 0;
    double along_mm = 0;  // from the segment's start
};

// Where the path meets the boundary, or where it begins or ends.
struct Knot {
    Spot spot;
    bool on_boundary = false;
    BoundaryPlace place{};
};

// Not the least, but at no cost: what is no more than a semicircle is no farther from its chord than the sagitta.
region::Box2 box_around(const Point2& start, const Segment& segment) {
    const double s = std::abs(segment.sagitta_mm), half2 = (segment.end - start).squaredNorm() / 4;
    const double reach = (s * s <= half2 ? s : s + half2 / s) + resolution_mm;
    const Vector2 margin(reach, reach);
    return {start.cwiseMin(segment.end) - margin, start.cwiseMax(segment.end) + margin};
}

class Clipper {
public:
    Clipper(const Path& path, const Boundary& region) : path_(path), region_(region) {}

    std::vector<PathPart> parts() {
        find_knots();
        std::vector<PathPart> parts;
        std::size_t first = 0;  // knot of the part that is being made
        bool inside = false;
        for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
            const auto between = point_between(knots_[i].spot, knots_[i + 1].spot);
            if (!between) continue;
            const bool in = region_.winding(*between) > 0;
            if (in && !inside) first = i;
            if (!in && inside) parts.push_back(part(knots_[first], knots_[i]));
            inside = in;
        }
        if (inside) parts.push_back(part(knots_[first], knots_.back()));
        return parts;
    }

    CutPath cut() {
        find_knots();
        CutPath result{{path_.start, {}}};
        std::size_t first = 0;
        for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
            const auto between = point_between(knots_[first].spot, knots_[i + 1].spot);
            if (!between && i + 2 < knots_.size()) continue;
            const bool inside = between ? region_.winding(*between) > 0
                                        : result.inside.empty() || result.inside.back();
            append(knots_[first], knots_[i + 1], result.path, &result.origin);
            result.inside.resize(result.path.segments.size(), inside);
            first = i + 1;
        }
        // Shorter than what is seen.
        if (result.path.segments.empty()) {
            const std::size_t count = path_.segments.size();
            result = {path_, std::vector<bool>(count, true), std::vector<std::uint32_t>(count)};
            std::iota(result.origin.begin(), result.origin.end(), 0u);
        }
        return result;
    }

private:
    const Point2& start_of(std::size_t segment) const {
        return segment == 0 ? path_.start : path_.segments[segment - 1].end;
    }

    double length_of(std::size_t segment) const {
        const Point2& start = start_of(segment);
        const Segment& of = path_.segments[segment];
        return of.end == start ? 0 : length_mm(start, of);
    }

    void find_knots() {
        knots_.push_back({});
        for (std::size_t i = 0; i < path_.segments.size(); ++i) {
            const Point2& start = start_of(i);
            const Segment& segment = path_.segments[i];
            if (segment.end == start) continue;
            std::optional<region::Curve> curve;
            region_.meeting(box_around(start, segment), [&](std::uint32_t piece) {
                if (!curve) curve = region::curve_of(start, segment);
                add_crossings(i, *curve, piece);
            });
        }
        const std::size_t last = path_.segments.size() - 1;
        knots_.push_back({{last, length_of(last)}});
        std::sort(knots_.begin() + 1, knots_.end() - 1, [](const Knot& a, const Knot& b) {
            return std::tie(a.spot.segment, a.spot.along_mm, a.place.piece) <
                   std::tie(b.spot.segment, b.spot.along_mm, b.place.piece);
        });
    }

    void add_crossings(std::size_t segment, const region::Curve& curve, std::uint32_t index) {
        const region::Curve boundary = region_.pieces()[index].curve();
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
                knots_.push_back({{segment, *on_path}, true, {index, *on_boundary, point}});
        }
    }

    // A point well between two places: the middle of the longest part of a segment, of the first, the last and one between
    // them. None where the two are the same but for round-off.
    std::optional<Point2> point_between(const Spot& from, const Spot& to) const {
        std::optional<Point2> best;
        double longest = resolution_mm;
        const auto offer = [&](std::size_t segment, double begin, double end) {
            if (end - begin <= longest) return;
            longest = end - begin;
            best = point_at(start_of(segment), path_.segments[segment],
                            (begin + end) / 2 / length_of(segment));
        };
        if (from.segment == to.segment) {
            offer(from.segment, from.along_mm, to.along_mm);
            return best;
        }
        offer(from.segment, from.along_mm, length_of(from.segment));
        offer(to.segment, 0, to.along_mm);
        for (std::size_t i = from.segment + 1; i < to.segment && (!best || i == from.segment + 1);
             ++i) {
            offer(i, 0, length_of(i));
        }
        return best;
    }

    PathPart part(const Knot& from, const Knot& to) const {
        PathPart part{{from.on_boundary ? from.place.point : path_.start, {}}, {}, {}};
        if (from.on_boundary) part.start = from.place;
        if (to.on_boundary) part.end = to.place;
        part.path.segments.reserve(to.spot.segment - from.spot.segment + 1);
        append(from, to, part.path);
        return part;
    }

    // What lies between two knots; `origin` is told of which segments.
    void append(const Knot& from, const Knot& to, Path& path,
                std::vector<std::uint32_t>* origin = nullptr) const {
        const Point2 end = to.on_boundary ? to.place.point : path_.segments.back().end;
        for (std::size_t i = from.spot.segment; i <= to.spot.segment; ++i) {
            const bool first = i == from.spot.segment, last = i == to.spot.segment;
            append(i, first ? from.spot.along_mm : 0,
                   last ? std::optional(to.spot.along_mm) : std::nullopt, end, path);
            if (origin) origin->resize(path.segments.size(), static_cast<std::uint32_t>(i));
        }
    }

    // A segment from a length on, up to another or, without one, to its end.
    void append(std::size_t index, double from_mm, std::optional<double> to_mm, const Point2& end,
                Path& path) const {
        const Segment& segment = path_.segments[index];
        const Point2& at = path.segments.empty() ? path.start : path.segments.back().end;
        if (!to_mm && from_mm == 0) {
            path.segments.push_back(segment);
            return;
        }
        const double length = length_of(index), until = to_mm.value_or(length);
        if (until - from_mm > resolution_mm) {
            const double share = (until - from_mm) / length;
            const Point2& next = to_mm ? end : segment.end;
            const Segment cut =
                arc_with_sweep(at, next, share * sweep_rad(start_of(index), segment));
            path.segments.push_back(share == 1 && next == segment.end ? segment : cut);
        } else if (to_mm && !path.segments.empty()) {
            path.segments.back().end = end;
        }
    }

    const Path& path_;
    const Boundary& region_;
    std::vector<Knot> knots_;
};

}  // namespace

std::vector<PathPart> clipped(const Path& path, const Boundary& region) {
    if (path.segments.empty()) return {};
    return Clipper(path, region).parts();
}

CutPath cut_at(const Path& path, const Boundary& region) {
    if (path.segments.empty()) return {path};
    return Clipper(path, region).cut();
}

}  // namespace lyr
