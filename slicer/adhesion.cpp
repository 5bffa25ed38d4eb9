#include "slicer/adhesion.h"

#include <cmath>

#include "kernel/toolpath/infill.h"

namespace lyr::slicer {

namespace {

struct Loops {
    double count = 0;
    double first_mm = 0, spacing_mm = 0;  // of their middles, from the outline
};

Loops loops_of(const profile::Profile& profile, double height_mm) {
    const profile::Adhesion& adhesion = profile.adhesion;
    const double width_mm = profile.perimeters.width_mm;
    const double spacing_mm = line_spacing_mm(width_mm, height_mm);
    if (adhesion.kind == profile::AdhesionKind::skirt)
        return {static_cast<double>(adhesion.skirt_loops),
                adhesion.skirt_distance_mm + width_mm / 2, spacing_mm};
    if (adhesion.kind == profile::AdhesionKind::brim)
        return {std::ceil(adhesion.brim_width_mm / spacing_mm), width_mm / 2, spacing_mm};
    return {};
}

}  // namespace

std::vector<Piece> adhesion_of(Region outline, double height_mm, const Options& options,
                               std::size_t& unresolved) {
    const Loops loops = loops_of(options.profile, height_mm);
    const bool is_skirt = options.profile.adhesion.kind == profile::AdhesionKind::skirt;
    const double width_mm = options.profile.perimeters.width_mm;
    std::vector<Piece> pieces;
    for (double loop = loops.count - 1; loop >= 0; --loop) {
        const OffsetResult around =
            offset(outline, {.distance_mm = loops.first_mm + loop * loops.spacing_mm,
                             .allowed_mm = options.tolerance().unite_mm()});
        unresolved += around.unresolved.has_value();
        for (const Contour& contour : around.contours) {
            if (area_mm2(contour) > 0)
                pieces.push_back({is_skirt ? format::Role::skirt : format::Role::brim,
                                  Strand{contour, width_mm}});
        }
    }
    return pieces;
}

double adhesion_reach_mm(const profile::Profile& profile) {
    const Loops loops = loops_of(profile, profile.layer.first_height_mm);
    if (loops.count == 0) return 0;
    return loops.first_mm + (loops.count - 1) * loops.spacing_mm + profile.perimeters.width_mm / 2;
}

}  // namespace lyr::slicer
