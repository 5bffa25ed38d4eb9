#include "kernel/toolpath/offset.h"

#include "kernel/toolpath/offset_curve.h"

namespace lyr {
namespace {

// Of allowed_mm, what the region operations may move; the rest is for what is joined and for round-off.
constexpr double region_share = 0.5;

}  // namespace

OffsetResult offset(Region region, const OffsetRequest& request) {
    if (request.distance_mm == 0) return {.contours = {region.begin(), region.end()}};
    RegionResult cleaned_curves = cleaned(offset_curves(region, request),
                                          region_share * request.allowed_mm, request.allowed_mm);
    OffsetResult result{.contours = std::move(cleaned_curves.contours),
                        .slivers = cleaned_curves.slivers};
    if (cleaned_curves.unresolved > 0) result.unresolved = {OffsetFault::Kind::region};
    return result;
}

}  // namespace lyr
