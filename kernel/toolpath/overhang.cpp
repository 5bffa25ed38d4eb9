// A stroke along an open path is the offset of the path there and back, a region without area.

#include "kernel/toolpath/overhang.h"

#include <algorithm>
#include <utility>

#include "kernel/contour/turned_round.h"
#include "kernel/toolpath/boundary.h"
#include "kernel/toolpath/bridges.h"
#include "kernel/toolpath/islands.h"
#include "kernel/toolpath/offset.h"

namespace lyr {
namespace {

using Contours = std::vector<Contour>;

// Of a bridge's rows, by their length: the rest is in corners.
constexpr double least_held = 0.98;

Contour there_and_back(Path path) {
    const Path back = turned_round(path);
    path.segments.insert(path.segments.end(), back.segments.begin(), back.segments.end());
    return path;
}

class Finder {
public:
    Finder(Region layer, Region below, const OverhangEdges& edges,
           std::span<const Path> leaning_below, const OverhangRequest& request)
        : layer_(layer),
          below_(below),
          edges_(edges),
          leaning_below_(leaning_below),
          request_(request) {}

    Overhang overhang(bool may_be_flat) {
        if (!may_be_flat && edges_.leaning.empty()) return {};
        const Contours blocked = blocked_region();
        Contours along =
            strokes(edges_.leaning, request_.margin_mm, request_.allowed_mm, result_.unresolved);
        Contours flat = may_be_flat ? flat_parts() : Contours{};
        if (!blocked.empty()) flat = changed(flat, blocked, Operation::subtract);
        flat = grown(flat, request_.margin_mm);
        result_.contours = changed(along, flat, Operation::unite);
        if (!blocked.empty())
            result_.contours = changed(result_.contours, blocked, Operation::subtract);
        return std::move(result_);
    }

private:
    Contours changed(const Contours& a, const Contours& b, Operation operation) {
        if (b.empty()) return a;
        if (a.empty()) return operation == Operation::unite ? b : Contours{};
        RegionResult result = combined(a, b, operation, request_.allowed_mm);
        result_.unresolved += result.unresolved;
        return std::move(result.contours);
    }

    Contours grown(const Contours& region, double distance_mm) {
        if (region.empty()) return {};
        OffsetResult result =
            offset(region, {.distance_mm = distance_mm, .allowed_mm = request_.allowed_mm});
        result_.unresolved += result.unresolved.has_value();
        return std::move(result.contours);
    }

    Contours blocked_region() {
        Contours region = edges_.blocked_area;
        for (const BlockedEdge& edge : edges_.blocked) {
            const Contours stroke =
                strokes({&edge.path, 1}, edge.reach_mm, request_.allowed_mm, result_.unresolved);
            region = changed(region, stroke, Operation::unite);
        }
        return region;
    }

    // Without what is narrower than a ledge.
    Contours flat_parts() {
        RegionResult over_air = combined(layer_, below_, Operation::subtract, request_.allowed_mm);
        result_.unresolved += over_air.unresolved;
        const double radius_mm = request_.ledge_mm / 2;
        const Contours opened = grown(grown(over_air.contours, -radius_mm), radius_mm);
        Contours flat;
        for (Contours& part : parts_of(opened))
            if (is_slope(part) || !is_bridge(part))
                flat.insert(flat.end(), part.begin(), part.end());
        return flat;
    }

    bool is_slope(const Contours& part) const {
        const Boundary boundary(part);
        const auto beside = [&](const Path& path) {
            Point2 from = path.start;
            for (const Segment& segment : path.segments) {
                for (const double share : {0.0, 0.5, 1.0}) {
                    const Point2 at = point_at(from, segment, share);
                    if (boundary.winding(at) > 0 || boundary.is_near(at, request_.ledge_mm))
                        return true;
                }
                from = segment.end;
            }
            return false;
        };
        return std::any_of(edges_.leaning.begin(), edges_.leaning.end(), beside) ||
               std::any_of(leaning_below_.begin(), leaning_below_.end(), beside);
    }

    bool is_bridge(const Contours& part) const {
        const auto span = bridge_span(part, below_, request_.width_mm);
        return span && span->held >= least_held && span->longest_mm <= request_.longest_bridge_mm;
    }

    Region layer_, below_;
    const OverhangEdges& edges_;
    std::span<const Path> leaning_below_;
    const OverhangRequest& request_;
    Overhang result_{};
};

}  // namespace

std::vector<Contour> strokes(std::span<const Path> paths, double distance_mm, double allowed_mm,
                             std::size_t& unresolved) {
    Contours lines;
    for (const Path& path : paths)
        if (!path.segments.empty()) lines.push_back(there_and_back(path));
    if (lines.empty()) return {};
    OffsetResult result = offset(lines, {.distance_mm = distance_mm, .allowed_mm = allowed_mm});
    unresolved += result.unresolved.has_value();
    return std::move(result.contours);
}

Overhang overhang_of(Region layer, Region below, const OverhangEdges& edges,
                     std::span<const Path> leaning_below, bool may_be_flat,
                     const OverhangRequest& request) {
    return Finder(layer, below, edges, leaning_below, request).overhang(may_be_flat);
}

}  // namespace lyr
