#include "slicer/left_out.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "kernel/region/curve.h"
#include "kernel/toolpath/islands.h"
#include "kernel/toolpath/offset.h"

namespace lyr::slicer {
namespace {

// Less than a square of this edge in a layer is the tip of a corner.
constexpr double tip_mm = 0.25;

// Discs a little larger than the least width are left out too: they have no room for a line that is longer than wide.
constexpr double dot_share = 1.25;

bool is_empty_within(const Contour& island, const OutlinedLayer& layer, const LayerFill& fill) {
    const Boundary boundary({&island, 1});
    const auto is_in = [&](const Strand& strand) {
        return boundary.winding(start_of(strand.path)) > 0;
    };
    return std::none_of(layer.walls.strands.begin(), layer.walls.strands.end(), is_in) &&
           std::none_of(fill.pieces.begin(), fill.pieces.end(), [&](const Piece& piece) {
               const auto* strand = std::get_if<Strand>(&piece.way);
               return strand && piece.role == format::Role::thin_wall && is_in(*strand);
           });
}

// The middle of the largest part that is narrower than that.
std::optional<Point2> thin_place(Region outline, double width_mm, double allowed_mm) {
    const auto offset_by = [&](Region region, double distance_mm, Corner corner) {
        return offset(region,
                      {.distance_mm = distance_mm, .allowed_mm = allowed_mm, .corner = corner})
            .contours;
    };
    const auto wide =
        offset_by(offset_by(outline, -width_mm / 2, Corner::round), width_mm / 2, Corner::mitre);
    const auto parts = parts_of(combined(outline, wide, Operation::subtract, allowed_mm).contours);
    const auto largest =
        std::max_element(parts.begin(), parts.end(),
                         [](const auto& a, const auto& b) { return area_mm2(a) < area_mm2(b); });
    if (largest == parts.end()) return std::nullopt;
    return region::box_of(largest->front()).center();
}

}  // namespace

LeftOut left_out_of(const OutlinedLayer& layer, const LayerFill& fill) {
    LeftOut result{.thin_mm2 = layer.walls.too_thin_mm2 + fill.thin_left_out_mm2,
                   .place = layer.walls.lost_web ? layer.walls.lost_web : fill.thin_broken,
                   .is_all = layer.walls.strands.empty() && fill.pieces.empty()};
    for (const Contour& contour : layer.outline) {
        const double area = area_mm2(contour);
        if (area <= 0 || area > tip_mm * tip_mm || !is_empty_within(contour, layer, fill)) continue;
        result.thin_mm2 = std::max(result.thin_mm2, area);
        if (!result.place) result.place = region::box_of(contour).center();
    }
    return result;
}

void LeftOutReport::add(const LeftOut& layer, std::size_t index) {
    prints_ |= !layer.is_all;
    if (layer.thin_mm2 <= tip_mm * tip_mm && !layer.place) return;
    if (layers_++ == 0) first_ = index;
    last_ = index;
    if (layers_ > 1 && layer.thin_mm2 <= most_left_.thin_mm2) return;
    most_ = index;
    most_left_ = layer;
}

Status LeftOutReport::finish(std::span<const OutlinedLayer> layers,
                             std::span<const LayerSpan> spans, const Options& options,
                             Diagnostics& diagnostics) const {
    const profile::Perimeters& perimeters = options.profile.perimeters;
    if (!prints_) return nothing_to_print(perimeters);
    if (layers_ == 0) return Done{};
    const double least_mm = perimeters.thin_walls ? perimeters.min_width_mm : perimeters.width_mm;
    const std::string what =
        perimeters.thin_walls
            ? "parts thinner than " + shortest(least_mm) + " mm (perimeters.min_width)"
            : "parts that no wall goes around (perimeters.thin_walls is off)";
    Location where{.layer = static_cast<int>(most_ + 1), .z_mm = spans[most_].middle_mm()};
    const auto place = most_left_.place ? most_left_.place
                                        : thin_place(layers[most_].outline, dot_share * least_mm,
                                                     options.tolerance().unite_mm());
    if (place) {
        where.x_mm = place->x();
        where.y_mm = place->y();
    }
    diagnostics.push_back(
        {Severity::warning, ExitStatus::geometry,
         what + " are left out in " + counted(layers_, "layer") +
             formatted(", from z = %.6g to %.6g mm; most here, %.3g mm2", spans[first_].bottom_mm,
                       spans[last_].top_mm, most_left_.thin_mm2),
         where});
    return Done{};
}

Diagnostic nothing_to_print(const profile::Perimeters& perimeters) {
    return {Severity::error,
            ExitStatus::geometry,
            "nothing to print: no line fits into the part (perimeters.width is " +
                shortest(perimeters.width_mm) + " mm, perimeters.thin_walls " +
                (perimeters.thin_walls ? "on)" : "off)"),
            {}};
}

}  // namespace lyr::slicer
