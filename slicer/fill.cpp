#include "slicer/fill.h"

#include <algorithm>
#include <numbers>

#include "kernel/toolpath/bridges.h"
#include "kernel/toolpath/centre_lines.h"
#include "kernel/toolpath/infill.h"

namespace lyr::slicer {
namespace {

InfillPattern kernel_pattern(profile::InfillPattern pattern) {
    switch (pattern) {
        case profile::InfillPattern::rectilinear:
            return InfillPattern::rectilinear;
        case profile::InfillPattern::aligned:
            return InfillPattern::aligned;
        case profile::InfillPattern::grid:
            return InfillPattern::grid;
        case profile::InfillPattern::triangles:
            return InfillPattern::triangles;
        case profile::InfillPattern::concentric:
            return InfillPattern::concentric;
        case profile::InfillPattern::honeycomb:
            return InfillPattern::honeycomb;
        case profile::InfillPattern::gyroid:
            return InfillPattern::gyroid;
        case profile::InfillPattern::cubic:
            return InfillPattern::cubic;
    }
    return InfillPattern::rectilinear;
}

InfillPattern kernel_pattern(profile::SkinPattern pattern) {
    switch (pattern) {
        case profile::SkinPattern::rectilinear:
            return InfillPattern::rectilinear;
        case profile::SkinPattern::aligned:
            return InfillPattern::aligned;
        case profile::SkinPattern::concentric:
            return InfillPattern::concentric;
    }
    return InfillPattern::rectilinear;
}

// How far the flow of solid fill may be off one.
constexpr double least_flow = 0.8, most_flow = 1.1;

double radians(double degrees) {
    return degrees * std::numbers::pi / 180;
}

class Filler {
public:
    Filler(std::size_t index, const LayerSpan& span, const Options& options)
        : index_(index),
          span_(span),
          profile_(options.profile),
          allowed_mm_(options.tolerance().unite_mm()) {}

    void solid(Region region, format::Role role) {
        append(region, role, kernel_pattern(profile_.skin.pattern),
               radians(profile_.skin.angle_deg));
    }

    void bridges(Region region, Region below) {
        for (const Bridge& bridge : bridges_over(region, below, profile_.skin.width_mm)) {
            if (bridge.angle_rad) {
                append(bridge.contours, format::Role::bridge, InfillPattern::aligned,
                       *bridge.angle_rad);
            } else {
                solid(bridge.contours, format::Role::bottom_skin);
            }
        }
    }

    // From flank to flank: of thin walls, these are the outline.
    void narrow(Region region, std::span<const Joint> joints, format::Role role, double least_mm,
                double flank_mm) {
        if (region.empty()) return;
        CentreLines lines = centre_lines(region,
                                         {.min_width_mm = least_mm,
                                          .max_width_mm = profile_.perimeters.max_width_mm,
                                          .allowed_mm = allowed_mm_},
                                         joints);
        fill.unresolved += lines.unresolved;
        for (Strand& strand : lines.strands) {
            strand.width_mm += 2 * flank_mm;
            for (double& width : strand.widths_mm) width += 2 * flank_mm;
            fill.pieces.push_back({role, std::move(strand)});
        }
    }

    // By how much the flanks of walls reach over the boundary between them and what is beside them.
    double flank_mm() const {
        return profile_.perimeters.overlap * span_.height_mm() * (1 - std::numbers::pi / 4) / 2;
    }

    void sparse(Region region) {
        if (profile_.infill.density == 0) return;
        append(region, format::Role::sparse_infill,
               {.pattern = kernel_pattern(profile_.infill.pattern),
                .density = profile_.infill.density,
                .width_mm = profile_.infill.width_mm,
                .angle_rad = radians(profile_.infill.angle_deg)});
    }

    LayerFill fill{};

private:
    void append(Region region, format::Role role, InfillPattern pattern, double angle_rad) {
        append(region, role,
               {.pattern = pattern,
                .density = 1,
                .width_mm = profile_.skin.width_mm,
                .angle_rad = angle_rad});
    }

    // The region begins half a spacing from the walls' middles; lines end so that their flanks overlap with those of the
    // walls by what the profile says.
    void append(Region region, format::Role role, InfillRequest request) {
        if (region.empty()) return;
        request.height_mm = span_.height_mm();
        request.z_mm = span_.middle_mm();
        request.layer = index_;
        request.allowed_mm = allowed_mm_;
        const double inset_mm = flank_mm() + (0.5 - profile_.infill.overlap) * request.width_mm;
        const OffsetResult middles =
            offset(region, {.distance_mm = -inset_mm, .allowed_mm = allowed_mm_});
        fill.unresolved += middles.unresolved.has_value();
        Fill lines = infill(middles.contours, request);
        fill.unresolved += lines.unresolved;
        const std::size_t first = fill.pieces.size();
        for (HatchRun& run : lines.runs) fill.pieces.push_back({role, std::move(run)});
        for (Strand& strand : lines.strands) fill.pieces.push_back({role, std::move(strand)});
        if (request.density == 1) balance(first, region, request.width_mm);
    }

    // What lines reach over into walls and links add makes up for what is left beside them, by the flow.
    void balance(std::size_t first, Region region, double width_mm) {
        double lines_mm = 0;
        for (std::size_t i = first; i < fill.pieces.size(); ++i)
            lines_mm += length_mm(fill.pieces[i]);
        const double filled_mm2 = lines_mm * line_spacing_mm(width_mm, span_.height_mm());
        if (!(filled_mm2 > 0)) return;
        const double flow = std::clamp(area_mm2(region) / filled_mm2, least_flow, most_flow);
        for (std::size_t i = first; i < fill.pieces.size(); ++i) fill.pieces[i].flow = flow;
    }

    std::size_t index_;
    LayerSpan span_;
    const profile::Profile& profile_;
    double allowed_mm_;
};

}  // namespace

double length_mm(const Piece& piece) {
    const auto* run = std::get_if<HatchRun>(&piece.way);
    return run ? lyr::length_mm(*run) : lyr::length_mm(std::get<Strand>(piece.way).path);
}

LayerFill fill_layer(std::size_t index, const LayerSpan& span, const Walls& walls,
                     std::span<const SkinOutline> outlines, const Options& options) {
    const profile::Profile& profile = options.profile;
    Filler filler(index, span, options);
    const bool is_solid = profile.infill.density == 1;
    // Of a solid part only what is bare has a role of its own.
    const auto layers = [&](std::uint32_t count) { return is_solid ? std::min(count, 1u) : count; };
    LayerSkins skins = skins_of(outlines, index, walls.inside,
                                {.top_layers = layers(profile.skin.top_layers),
                                 .bottom_layers = layers(profile.skin.bottom_layers),
                                 .width_mm = profile.skin.width_mm,
                                 .min_sparse_mm2 = profile.skin.min_area_mm2,
                                 .allowed_mm = options.tolerance().unite_mm()});
    filler.fill.unresolved += skins.unresolved;
    const profile::Perimeters& perimeters = profile.perimeters;
    filler.narrow(walls.thin, walls.thin_joints, format::Role::thin_wall, perimeters.min_width_mm,
                  0);
    filler.narrow(walls.gaps, walls.gap_joints, format::Role::gap_fill, perimeters.min_gap_mm,
                  filler.flank_mm());
    filler.solid(skins.bottom, format::Role::bottom_skin);
    filler.solid(skins.top, format::Role::top_skin);
    if (index > 0) filler.bridges(skins.bridge, outlines[index - 1].region());
    if (is_solid) {
        const RegionResult rest =
            combined(skins.solid, skins.sparse, Operation::unite, options.tolerance().unite_mm());
        filler.fill.unresolved += rest.unresolved;
        filler.solid(rest.contours, format::Role::solid_infill);
    } else {
        filler.solid(skins.solid, format::Role::solid_infill);
        filler.sparse(skins.sparse);
    }
    return std::move(filler.fill);
}

}  // namespace lyr::slicer
