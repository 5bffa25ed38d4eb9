#include "kernel/toolpath/offset.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/region/verify.h"
#include "kernel/toolpath/offset_check.h"
#include "kernel/toolpath/offset_curve.h"
#include "kernel/toolpath/offset_sweeps.h"

namespace lyr {
namespace {

// Of allowed_mm, what the region operations may move; the rest is for what is joined and for round-off. The second
// method moves the region too, before it begins.
constexpr double region_share = 0.5;
constexpr double source_share = 0.25;

std::optional<OffsetFault> fault_of(const RegionResult& result, Region region,
                                    const OffsetRequest& request) {
    if (result.unresolved > 0) return OffsetFault{OffsetFault::Kind::region};
    return fault_of(result.contours, region, request);
}

// The same request of an operation that may move that share.
OffsetRequest within(OffsetRequest request, double share) {
    request.allowed_mm *= share;
    return request;
}

}  // namespace

OffsetResult settled(const RegionResult& first, Region region, const OffsetRequest& request) {
    if (!fault_of(first, region, request)) {
        return {.contours = first.contours, .slivers = first.slivers};
    }
    const RegionResult source = cleaned(region, source_share * request.allowed_mm);
    RegionResult second = offset_by_sweeps(source.contours, within(request, region_share));
    auto fault = source.unresolved > 0 ? std::optional(OffsetFault{OffsetFault::Kind::region})
                                       : fault_of(second, source.contours, request);
    return {.contours = std::move(second.contours),
            .slivers = second.slivers,
            .second_method = true,
            .unresolved = fault};
}

OffsetResult offset(Region region, const OffsetRequest& request) {
    if (!std::isfinite(request.distance_mm) || !(request.allowed_mm > 0) ||
        !std::all_of(region.begin(), region.end(), region::is_finite)) {
        return {.contours = {region.begin(), region.end()},
                .unresolved = OffsetFault{OffsetFault::Kind::input}};
    }
    if (request.distance_mm == 0) return {.contours = {region.begin(), region.end()}};
    const RegionResult first = cleaned(offset_curves(region, request),
                                       region_share * request.allowed_mm, request.allowed_mm);
    return settled(first, region, request);
}

}  // namespace lyr
