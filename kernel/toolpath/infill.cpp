#include "kernel/toolpath/infill.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/region/verify.h"
#include "kernel/toolpath/infill_concentric.h"
#include "kernel/toolpath/infill_lines.h"
#include "kernel/toolpath/infill_waves.h"

namespace lyr {
namespace {

// Lines farther apart than this many times their spacing are strands: straight links would cut too much off a curved
// boundary.
constexpr double widest_run_spacing = 1.5;

bool is_valid(const InfillRequest& request) {
    return request.density > 0 && request.density <= 1 && std::isfinite(request.angle_rad) &&
           std::isfinite(request.z_mm) && request.height_mm > 0 && request.allowed_mm > 0 &&
           std::isfinite(request.width_mm) && request.width_mm >= request.height_mm;
}

bool crosses_itself(InfillPattern pattern) {
    return pattern != InfillPattern::rectilinear && pattern != InfillPattern::aligned &&
           pattern != InfillPattern::concentric;
}

}  // namespace

double line_spacing_mm(double width_mm, double height_mm) {
    return width_mm - height_mm * (1 - std::numbers::pi / 4);
}

Fill infill(Region inside, const InfillRequest& asked) {
    Fill fill;
    if (!is_valid(asked) || !std::all_of(inside.begin(), inside.end(), region::is_finite)) {
        fill.unresolved = 1;
        return fill;
    }
    InfillRequest request = asked;
    if (request.density == 1 && crosses_itself(request.pattern))
        request.pattern = InfillPattern::rectilinear;
    if (request.pattern == InfillPattern::concentric) {
        fill_with_offsets(inside, request, fill);
        return fill;
    }
    if (request.pattern == InfillPattern::honeycomb || request.pattern == InfillPattern::gyroid) {
        const bool gyroid = request.pattern == InfillPattern::gyroid;
        fill_with_waves(inside, gyroid ? gyroid_waves(request) : honeycomb_waves(request), request,
                        fill);
        return fill;
    }
    const std::vector<BoundaryPiece> boundary = boundary_pieces(inside);
    const std::vector<RowGrid> grids = row_grids(request);
    const double spacing_mm = line_spacing_mm(request.width_mm, request.height_mm);
    if (grids.size() == 1 && grids.front().pitch_mm <= widest_run_spacing * spacing_mm) {
        fill_with_runs(boundary, grids.front(), request, fill);
    } else {
        fill_with_strands(boundary, grids, request, fill);
    }
    return fill;
}

}  // namespace lyr
