#include "slicer/fill.h"

#include <numbers>

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
        append(region, role,
               {.pattern = kernel_pattern(profile_.skin.pattern),
                .density = 1,
                .width_mm = profile_.skin.width_mm,
                .angle_rad = radians(profile_.skin.angle_deg)});
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
    // The region begins half a spacing from the walls' middles; lines end so that their flanks overlap with those of the
    // walls by what the profile says.
    void append(Region region, format::Role role, InfillRequest request) {
        if (region.empty()) return;
        request.height_mm = span_.height_mm();
        request.z_mm = span_.middle_mm();
        request.layer = index_;
        request.allowed_mm = allowed_mm_;
        const double flank_mm =
            profile_.perimeters.overlap * span_.height_mm() * (1 - std::numbers::pi / 4) / 2;
        const double inset_mm = flank_mm + (0.5 - profile_.infill.overlap) * request.width_mm;
        const OffsetResult middles =
            offset(region, {.distance_mm = -inset_mm, .allowed_mm = allowed_mm_});
        fill.unresolved += middles.unresolved.has_value();
        Fill lines = infill(middles.contours, request);
        fill.unresolved += lines.unresolved;
        for (HatchRun& run : lines.runs) fill.pieces.push_back({role, std::move(run)});
        for (Strand& strand : lines.strands) fill.pieces.push_back({role, std::move(strand)});
    }

    std::size_t index_;
    LayerSpan span_;
    const profile::Profile& profile_;
    double allowed_mm_;
};

}  // namespace

LayerFill fill_layer(std::size_t index, const LayerSpan& span, const OutlinedLayer& layer,
                     const Options& options) {
    Filler filler(index, span, options);
    if (options.profile.infill.density == 1) {
        filler.solid(layer.walls.inside, format::Role::solid_infill);
    } else {
        filler.sparse(layer.walls.inside);
    }
    return std::move(filler.fill);
}

}  // namespace lyr::slicer
