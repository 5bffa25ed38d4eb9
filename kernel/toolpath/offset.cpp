#include "kernel/toolpath/offset.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/region/verify.h"
#include "kernel/toolpath/offset_check.h"
#include "kernel/toolpath/offset_curve.h"
#include "kernel/toolpath/offset_sweeps.h"
#include "kernel/toolpath/uncross.h"

namespace lyr {
namespace {

// Of allowed_mm, what the region operations may move; the rest is for what is joined and for round-off. The second
// method moves the region too, before it begins.
constexpr double region_share = 0.5;
constexpr double source_share = 0.25;

// In allowed_mm: what is nearer to another part of the boundary is for the region operations.
constexpr double clear_share = 0.25;

// Of the distance, how far a mitre may end from the boundary whose corner it comes from: sides that bend, and corners that
// are a little rounded, lead past it.
constexpr double corner_share = 0.2;

// So many times as far from the mitre's point its sides are looked at: a wall that is cut off square beside a straight
// edge has a mitre that ends on the edge, and there no corner is.
constexpr double sides_seen = 4;

std::optional<OffsetFault> fault_of(const RegionResult& result, const BoundedRegion& region,
                                    const OffsetRequest& request) {
    if (result.unresolved > 0) return OffsetFault{OffsetFault::Kind::region};
    return fault_of(BoundedRegion(result.contours), region, request);
}

// The same request of an operation that may move that share.
OffsetRequest within(OffsetRequest request, double share) {
    request.allowed_mm *= share;
    return request;
}

// Where parallels cross but at corners and in single points: nearly all walls.
std::optional<OffsetResult> trimmed(const BoundedRegion& region, const OffsetRequest& request) {
    const auto curves = trimmed_curves(region.contours, request);
    if (!curves) return std::nullopt;
    const auto contours = uncrossed(BoundedRegion(*curves), clear_share * request.allowed_mm);
    if (!contours) return std::nullopt;
    OffsetResult result{.contours = sorted(*contours)};
    if (fault_of(BoundedRegion(result.contours), region, request)) return std::nullopt;
    return result;
}

}  // namespace

bool CornersOf::contains(const Point2& corner, const Vector2& outwards) const {
    const double cosine = outwards.norm(), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const Vector2 middle = outwards / cosine;
    const Point2 point = corner + inside_mm / cosine * middle;
    // From the mitre's point back along the sides, which turn to the left.
    const Vector2 across = left_of(middle);
    const double near_mm = corner_share * inside_mm, back_mm = sides_seen * near_mm;
    const Point2 before = point - back_mm * (cosine * across + sine * middle);
    const Point2 after = point + back_mm * (cosine * across - sine * middle);
    return boundary.is_near(point, near_mm) && boundary.is_near(before, near_mm) &&
           boundary.is_near(after, near_mm);
}

OffsetResult settled(const RegionResult& first, const BoundedRegion& region,
                     const OffsetRequest& request) {
    if (!fault_of(first, region, request)) {
        return {.contours = first.contours, .slivers = first.slivers};
    }
    const RegionResult source = cleaned(region.contours, source_share * request.allowed_mm);
    RegionResult second = offset_by_sweeps(source.contours, within(request, region_share));
    auto fault = source.unresolved > 0 ? std::optional(OffsetFault{OffsetFault::Kind::region})
                                       : fault_of(second, BoundedRegion(source.contours), request);
    return {.contours = std::move(second.contours),
            .slivers = second.slivers,
            .second_method = true,
            .unresolved = fault};
}

OffsetResult offset(const BoundedRegion& region, const OffsetRequest& request) {
    const auto given = [&] {
        return std::vector<Contour>(region.contours.begin(), region.contours.end());
    };
    if (!std::isfinite(request.distance_mm) || !(request.allowed_mm > 0) ||
        !std::all_of(region.contours.begin(), region.contours.end(), region::is_finite)) {
        return {.contours = given(), .unresolved = OffsetFault{OffsetFault::Kind::input}};
    }
    if (request.distance_mm == 0) return {.contours = given()};
    if (auto result = trimmed(region, request)) return std::move(*result);
    const RegionResult first = cleaned(offset_curves(region.contours, request),
                                       region_share * request.allowed_mm, request.allowed_mm);
    return settled(first, region, request);
}

OffsetResult offset(Region region, const OffsetRequest& request) {
    return offset(BoundedRegion(region), request);
}

}  // namespace lyr
