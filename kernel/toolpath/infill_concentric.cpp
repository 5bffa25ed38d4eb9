#include "kernel/toolpath/infill_concentric.h"

#include <utility>

#include "kernel/region/curve.h"
#include "kernel/toolpath/offset.h"

namespace lyr {
namespace {

// No point is deeper in a region than that, whatever an offset that failed says.
double depth_limit_mm(Region region) {
    region::Box2 box;
    for (const Contour& contour : region) box.extend(region::box_of(contour));
    return box.isEmpty() ? 0 : box.sizes().minCoeff() / 2;
}

}  // namespace

void fill_with_offsets(Region inside, const InfillRequest& request, Fill& fill) {
    const double spacing = line_spacing_mm(request.width_mm, request.height_mm);
    const double pitch = spacing / request.density;
    const double limit = depth_limit_mm(inside);
    for (double k = 0;; ++k) {
        const double depth = (pitch - spacing) / 2 + k * pitch;
        if (depth > limit) return;
        std::vector<Contour> contours(inside.begin(), inside.end());
        if (depth > 0) {
            OffsetResult result =
                offset(inside, {.distance_mm = -depth, .allowed_mm = request.allowed_mm});
            if (result.unresolved) ++fill.unresolved;
            fill.left_out += result.slivers;
            contours = std::move(result.contours);
        }
        if (contours.empty()) return;
        for (Contour& contour : contours) {
            fill.strands.push_back({.path = std::move(contour), .width_mm = request.width_mm});
        }
    }
}

}  // namespace lyr
