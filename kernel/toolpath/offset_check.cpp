// Areas. Outwards by d the offset is the Minkowski sum of the region with a disc, so its area is at least
// (sqrt(A) + d sqrt(pi))^2; inwards, the region holds the sum of the offset with a disc, so that bounds the offset from
// above. On the other side, what is added or taken away is covered by what lies within d beside each segment and around
// each corner: d L + d^2 sweep / 2 beside an arc that turns away, and d^2 turn / 2 around a corner.

#include "kernel/toolpath/offset_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernel/geometry/tolerance.h"
#include "kernel/toolpath/boundary.h"
#include "kernel/toolpath/offset_curve.h"
#include "kernel/toolpath/strip_area.h"

namespace lyr {
namespace {

using std::numbers::pi;

// In the tolerance. The result's boundary is looked for where a disc of this radius lies in the offset and touches its
// boundary: it may be off by one there, and where the disc fits is no sliver.
constexpr double disc_share = 4;
constexpr double boundary_share = 2;

// The result's boundary is looked for beside a segment's middle if so much of the contour, in distances, has passed since a
// disc fitted, and beside longer ones in places that are twice the second apart, and no more than so many: what lies between
// two of them may be lost unseen.
constexpr double beside_share = 1;
constexpr double apart_share = 2;
constexpr double most_places = 9;

// Segments that meet at a smaller angle have no corner: what is beside it is beside their middles too.
constexpr double smooth_rad = 1e-3;

// In the tolerance. So far beside a segment, windings are counted if no other part of the boundary is near that place:
// where contours touch, each is on the other's wrong side.
constexpr double probe_share = 2;
constexpr double clear_share = 4;

class Check {
public:
    Check(const BoundedRegion& result, const BoundedRegion& region, const OffsetRequest& request)
        : request_(request),
          outwards_(request.distance_mm > 0),
          distance_mm_(std::abs(request.distance_mm)),
          mitred_mm_(request.corner == Corner::mitre ? request.mitre_limit * distance_mm_
                                                     : distance_mm_),
          slack_mm_(request.allowed_mm + resolution_mm),
          source_contours_(region.contours),
          contours_(result.contours),
          source_(region.boundary),
          result_(result.boundary) {}

    std::optional<OffsetFault> fault() const {
        if (auto found = wrong_distance()) return found;
        if (auto found = wrong_side()) return found;
        if (auto found = wrong_area()) return found;
        return missing();
    }

private:
    using Fault = std::optional<OffsetFault>;
    using Kind = OffsetFault::Kind;

    // Towards the offset.
    Vector2 across(const Vector2& tangent) const {
        return outwards_ ? right_of(tangent) : Vector2(-right_of(tangent));
    }

    double far_mm() const { return mitred_mm_ + slack_mm_; }
    Fault wrong_distance_at(const Point2& point, double source_mm) const;
    Fault wrong_distance() const;
    std::optional<bool> has_material_left(std::size_t index, const Point2& point,
                                          const Vector2& tangent) const;
    Fault wrong_side() const;
    Fault wrong_area() const;
    bool may_be_mitred(const Point2& point) const;
    std::optional<Point2> deep_beside(const Point2& place, const Vector2& towards) const;
    Fault missing_beside(const Point2& place, const Vector2& towards, const Point2& deep,
                         std::vector<bool>::reference counted, Boundary::Guess& guess) const;
    double beside_mm(const BoundaryPiece& piece) const;
    double places_beside(const BoundaryPiece& piece) const;
    Fault missing() const;

    const OffsetRequest& request_;
    bool outwards_;
    double distance_mm_, mitred_mm_, slack_mm_;
    Region source_contours_, contours_;
    const Boundary &source_, &result_;
};

Check::Fault Check::wrong_distance_at(const Point2& point, double source_mm) const {
    // Not "less or more": what is no number is wrong.
    if (source_mm >= distance_mm_ - slack_mm_ && source_mm <= far_mm()) return std::nullopt;
    return OffsetFault{Kind::distance, point,
                       source_.distance_mm(point, 2 * far_mm()) - distance_mm_};
}

Check::Fault Check::wrong_distance() const {
    for (const BoundaryPiece& piece : result_.pieces()) {
        const auto [start_mm, middle_mm] =
            source_.distances_mm(piece.start, piece.middle, far_mm() + slack_mm_);
        auto found = wrong_distance_at(piece.middle, middle_mm);
        if (!found && !piece.is_circle) found = wrong_distance_at(piece.start, start_mm);
        if (found) return found;
    }
    return std::nullopt;
}

// None: other parts of the boundary are too near to tell.
std::optional<bool> Check::has_material_left(std::size_t index, const Point2& point,
                                             const Vector2& tangent) const {
    const double probe_mm = probe_share * slack_mm_, clear_mm = clear_share * slack_mm_;
    const BoundaryPiece& piece = result_.pieces()[index];
    // Beyond the centre of a tiny circle is the other side of it.
    if (std::abs(piece.curvature_per_mm) * clear_mm > 1 ||
        result_.is_near(point, clear_mm, index)) {
        return std::nullopt;
    }
    const Vector2 right = probe_mm * right_of(tangent);
    return result_.winding(point - right) == 1 && result_.winding(point + right) == 0;
}

// A contour that is nowhere near the region's boundary is all on one side of it, and one that no other crosses has the
// material on its left everywhere: once a contour is enough.
Check::Fault Check::wrong_side() const {
    std::vector<bool> seen(contours_.size(), false);
    for (std::size_t i = 0; i < result_.pieces().size(); ++i) {
        const BoundaryPiece& piece = result_.pieces()[i];
        if (seen[piece.contour]) continue;
        auto left = has_material_left(i, piece.middle, piece.middle_tangent);
        if (!left && piece.is_circle) left = has_material_left(i, piece.start, piece.start_tangent);
        if (!left) continue;
        seen[piece.contour] = true;
        if (!*left) return OffsetFault{Kind::nesting, piece.middle};
        if ((source_.winding(piece.middle) > 0) == outwards_) {
            return OffsetFault{Kind::side, piece.middle};
        }
    }
    return std::nullopt;
}

Check::Fault Check::wrong_area() const {
    double length = 0;
    for (const BoundaryPiece& piece : source_.pieces()) length += piece.length_mm;
    for (const BoundaryPiece& piece : result_.pieces()) length += piece.length_mm;
    const double slack_mm2 = slack_mm_ * length;
    const double area = area_mm2(contours_), source = std::max(0.0, area_mm2(source_contours_));
    const double disc = std::sqrt(pi) * distance_mm_, root = std::sqrt(source);
    const double covered = strip_mm2(source_, request_.distance_mm, mitred_mm_);
    const double sum = source > 0 ? (root + disc) * (root + disc) : 0;
    const double least = outwards_ ? sum : source - covered;
    const double inner = std::max(0.0, root - disc);
    const double most = outwards_ ? source + covered : inner * inner;
    if (area >= least - slack_mm2 && area <= most + slack_mm2) return std::nullopt;
    return OffsetFault{Kind::area, contours_.empty() ? Point2::Zero() : start_of(contours_[0])};
}

// Whether the mitre at some corner may cover the point, or one as deep in the offset as is asked for. No part of the
// region's boundary is nearer than the distance.
bool Check::may_be_mitred(const Point2& point) const {
    if (request_.corner != Corner::mitre) return false;
    const double margin_mm = (1 + disc_share) * slack_mm_;
    const double within_mm = distance_mm_ + margin_mm, turn = outwards_ ? 1 : -1;
    bool mitred = false;
    for_neighbours(source_.pieces(), [&](const BoundaryPiece& before, const BoundaryPiece& piece) {
        if (mitred || piece.is_circle) return;
        const Vector2 one = across(before.end_tangent), other = across(piece.start_tangent);
        const Vector2 from_corner = point - piece.start;
        mitred = (cross(before.end_tangent, piece.start_tangent) > 0) == outwards_ &&
                 from_corner.dot(one) <= within_mm && from_corner.dot(other) <= within_mm &&
                 turn * cross(one, from_corner) >= -margin_mm &&
                 turn * cross(from_corner, other) >= -margin_mm &&
                 from_corner.norm() <= mitred_mm_ + margin_mm;
    });
    return mitred;
}

// A point deep in the offset beside a place, if the disc around it up to there has no boundary of the region in it.
std::optional<Point2> Check::deep_beside(const Point2& place, const Vector2& towards) const {
    const double reach_mm = distance_mm_ + disc_share * slack_mm_;
    const Point2 deep = place + reach_mm * towards;
    if (source_.is_near(deep, reach_mm - resolution_mm)) return std::nullopt;
    return deep;
}

// On the way to a point deep in the offset from the place that it is beside, the middle of which is surely not in the
// offset, is the offset's boundary: at the distance. Windings are counted once a contour.
Check::Fault Check::missing_beside(const Point2& place, const Vector2& towards, const Point2& deep,
                                   std::vector<bool>::reference counted,
                                   Boundary::Guess& guess) const {
    const Point2 expected = place + distance_mm_ * towards;
    bool found = result_.is_near(expected, boundary_share * slack_mm_, guess);
    if (found && !counted) {
        // Outwards, the offset is what the result leaves.
        const int in = outwards_ ? 0 : 1;
        found = result_.winding(deep) == in &&
                result_.winding(place + distance_mm_ / 2 * towards) == 1 - in;
        counted = true;
    }
    // Where the region's boundary touches itself, the point may be on another side than the place's.
    if (found || (source_.winding(deep) > 0) == outwards_ || may_be_mitred(expected)) {
        return std::nullopt;
    }
    return OffsetFault{Kind::incomplete, expected};
}

// The length of what is parallel to it at the distance.
double Check::beside_mm(const BoundaryPiece& piece) const {
    const double turned = outwards_ ? piece.curvature_per_mm : -piece.curvature_per_mm;
    return piece.length_mm * std::max(0.0, 1 + turned * distance_mm_);
}

// An odd number, so that the middle is one.
double Check::places_beside(const BoundaryPiece& piece) const {
    const double pairs = std::floor(beside_mm(piece) / (2 * apart_share * distance_mm_));
    return std::min(most_places, 1 + 2 * pairs);
}

Check::Fault Check::missing() const {
    Fault found;
    std::vector<bool> counted(source_contours_.size(), false);
    Boundary::Guess guess;
    // Whether a disc fits there.
    const auto look = [&](const BoundaryPiece& piece, const Point2& place, const Vector2& tangent) {
        const Vector2 towards = across(tangent);
        const auto deep = found ? std::nullopt : deep_beside(place, towards);
        if (deep) found = missing_beside(place, towards, *deep, counted[piece.contour], guess);
        return deep.has_value();
    };
    constexpr double far_mm = std::numeric_limits<double>::infinity();
    std::optional<std::uint32_t> contour;
    double unseen_mm = 0;  // beside the contour, since a disc fitted beside a piece of it
    for_neighbours(source_.pieces(), [&](const BoundaryPiece& before, const BoundaryPiece& piece) {
        if (contour != piece.contour) unseen_mm = far_mm;
        contour = piece.contour;
        unseen_mm += beside_mm(piece);
        if (unseen_mm >= beside_share * distance_mm_) {
            const double places = places_beside(piece);
            for (double i = 0.5; i < places; ++i) {
                const BoundaryPoint place = piece.at(i / places);
                if (look(piece, place.point, place.tangent)) unseen_mm = 0;
            }
        }
        const Vector2 middle = before.end_tangent + piece.start_tangent;
        const double turn = std::abs(cross(before.end_tangent, piece.start_tangent));
        if (piece.is_circle || turn < smooth_rad || middle.norm() < cusp_rad) return;
        look(piece, piece.start, middle.normalized());
    });
    return found;
}

}  // namespace

std::optional<OffsetFault> fault_of(const BoundedRegion& result, const BoundedRegion& region,
                                    const OffsetRequest& request) {
    return Check(result, region, request).fault();
}

}  // namespace lyr
