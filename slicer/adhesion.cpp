#include "slicer/adhesion.h"

#include <cmath>

#include "kernel/toolpath/infill.h"

namespace lyr::slicer {

std::vector<Piece> adhesion_of(Region outline, double height_mm, const Options& options,
                               std::size_t& unresolved) {
    const profile::Adhesion& adhesion = options.profile.adhesion;
    const double width_mm = options.profile.perimeters.width_mm;
    const double spacing_mm = line_spacing_mm(width_mm, height_mm);
    const bool is_skirt = adhesion.kind == profile::AdhesionKind::skirt;
    const bool is_brim = adhesion.kind == profile::AdhesionKind::brim;
    const auto loops = is_skirt  ? static_cast<double>(adhesion.skirt_loops)
                       : is_brim ? std::ceil(adhesion.brim_width_mm / spacing_mm)
                                 : 0;
    const double first_mm = (is_skirt ? adhesion.skirt_distance_mm : 0) + width_mm / 2;
    std::vector<Piece> pieces;
    for (double loop = loops - 1; loop >= 0; --loop) {
        const OffsetResult around = offset(outline, {.distance_mm = first_mm + loop * spacing_mm,
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

}  // namespace lyr::slicer
