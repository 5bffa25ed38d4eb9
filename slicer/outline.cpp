#include "slicer/outline.h"

#include <cmath>
#include <cstdio>

#include "base/text.h"

namespace lyr::slicer {
namespace {

// How far the region reaches out of the box, seen from the ends and middles of its segments.
double excess_mm(const Region& region, const Eigen::AlignedBox3d& box) {
    const Eigen::AlignedBox2d base(Point2(box.min().head<2>()), Point2(box.max().head<2>()));
    double excess = 0;
    const auto look = [&](const Point2& at) {
        excess = std::max(excess, base.exteriorDistance(at));
    };
    for (const Contour& contour : region) {
        if (const auto* circle = std::get_if<FullCircle>(&contour)) {
            for (const Vector2& to : {Vector2(1, 0), Vector2(0, 1), Vector2(-1, 0), Vector2(0, -1)})
                look(circle->centre + circle->radius_mm * to);
            continue;
        }
        Point2 from = std::get<Path>(contour).start;
        for (const Segment& segment : std::get<Path>(contour).segments) {
            look(point_at(from, segment, 0.5));
            look(segment.end);
            from = segment.end;
        }
    }
    return excess;
}

// A section that leaves the part's own box follows faces or edges that are not where the rest is; filling it may be endless.
Status check_inside(const Region& region, const Eigen::AlignedBox3d& box, const Location& where) {
    constexpr double most_share = 0.01;
    const double excess = excess_mm(region, box);
    if (excess <= most_share * box.diagonal().norm()) return Done{};
    char text[128];
    std::snprintf(text, sizeof text,
                  "the section reaches %.3g mm out of the part's box: an edge or a face is damaged",
                  excess);
    return Diagnostic{Severity::error, ExitStatus::geometry, text, where};
}

Walls walls_of(Region outline, const LayerSpan& span, const Options& options) {
    const profile::Perimeters& perimeters = options.profile.perimeters;
    return walls(outline, {.count = perimeters.count,
                           .width_mm = perimeters.width_mm,
                           .height_mm = span.height_mm(),
                           .overlap = perimeters.overlap,
                           .min_width_mm = perimeters.min_width_mm,
                           .min_gap_mm = perimeters.min_gap_mm,
                           .thin_walls = perimeters.thin_walls,
                           .gap_fill = perimeters.gap_fill,
                           .solid = options.profile.infill.density == 1,
                           .corner = perimeters.corner == profile::Corner::mitre ? Corner::mitre
                                                                                 : Corner::round,
                           .allowed_mm = options.tolerance().unite_mm()});
}

}  // namespace

std::vector<LayerSpan> layer_spans(double part_height_mm, const profile::Layer& layer) {
    std::vector<LayerSpan> spans;
    for (std::size_t i = 0;; ++i) {
        // Products, not sums: round-off does not add up.
        const double below = static_cast<double>(i) * layer.height_mm - layer.height_mm;
        const LayerSpan span{i == 0 ? 0 : layer.first_height_mm + below,
                             layer.first_height_mm + below + layer.height_mm};
        // A middle that meets the top within resolution is at the top, not below it; what is no number is below nothing.
        if (!(span.middle_mm() < part_height_mm - resolution_mm)) return spans;
        spans.push_back(span);
    }
}

void add_walls(OutlinedLayer& layer, const LayerSpan& span, const Options& options) {
    layer.walls = walls_of(layer.outline, span, options);
    if (layer.walls.second_method + layer.walls.unresolved == 0) return;
    // Where faces of the model overlap a little, its section crosses itself and is no region. To look for that costs as
    // much as a wall, so it is done only where the walls' own checks found something.
    RegionResult region = cleaned(layer.outline, options.tolerance().unite_mm());
    if (!region.changed || region.unresolved > 0) return;
    layer.outline = std::move(region.contours);
    layer.uncrossed = true;
    layer.walls = walls_of(layer.outline, span, options);
}

OutlinedLayer outline_layer(const Cutter& cutter, std::size_t index, const LayerSpan& span,
                            const Eigen::AlignedBox3d& box, const Options& options) {
    const Location where{.layer = static_cast<int>(index + 1), .z_mm = span.middle_mm()};
    Section section = cutter.cut(span.middle_mm());
    for (Diagnostic& found : section.diagnostics) found.where.layer = where.layer;
    RegionResult region = region_of(section, options.tolerance());
    OutlinedLayer made{.outline = std::move(region.contours),
                       .section = figures_of(section),
                       .united = region.changed,
                       .slivers = region.slivers,
                       .diagnostics = section.diagnostics};
    const auto warn = [&](const std::string& message) {
        made.diagnostics.push_back({Severity::warning, ExitStatus::geometry, message, where});
    };
    if (region.unresolved > 0)
        warn("solids that overlap could not be united: their walls are printed over each other");
    if (Status inside = check_inside(made.outline, box, where); !inside) {
        made.error = inside.error();
        return made;
    }
    add_walls(made, span, options);
    made.printed = figures_of(made.outline);
    made.seen = SkinOutline(made.outline, options.profile.skin.width_mm);
    if (made.walls.unresolved > 0)
        warn(counted(made.walls.unresolved, "offset") +
             " of the layer could not be verified: look at its walls with lyrview");
    return made;
}

}  // namespace lyr::slicer
