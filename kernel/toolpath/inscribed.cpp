// A disc that touches the boundary at p, where the normal is n, has its centre at p + r n. With curvature k and left
// normal l of another segment at its start, and v from there to p, it touches that segment's line or circle for
// r = (2 v.l - k v^2) / (2 (1 - n.l + k n.v)): in closed form, and with no difference between a line and a flat arc.

#include "kernel/toolpath/inscribed.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lyr {
namespace {

// Where the boundary turns by less, it goes straight on.
constexpr double smooth_rad = 1e-6;

// As far as the centres of discs that touch either side of such a turn may miss both.
constexpr double slop_mm = 2e-6;

// Below that, points are the same.
constexpr double same_mm = 1e-9;

// A disc that would be so much larger is taken for the one that an arc allows by itself: along a segment that goes on
// almost straight from the arc, discs that touch both are that one but for round-off.
constexpr double nearly_mm = 1e-7;

// What is less than this is round-off in products of unit vectors.
constexpr double least_product = 1e-14;

constexpr double none_mm = -1;

double signed_angle(const Vector2& from, const Vector2& to) {
    return std::atan2(cross(from, to), from.dot(to));
}

}  // namespace

InscribedDiscs::InscribedDiscs(Region region, double usual_mm)
    : boundary_(region), usual_mm_(usual_mm) {
    const std::vector<BoundaryPiece>& pieces = boundary_.pieces();
    joints_.resize(pieces.size());
    previous_.resize(pieces.size());
    next_.resize(pieces.size());
    for_neighbours(pieces, [&](const BoundaryPiece& before, const BoundaryPiece& piece) {
        const auto b = static_cast<std::uint32_t>(&before - pieces.data());
        const auto p = static_cast<std::uint32_t>(&piece - pieces.data());
        const double turn = signed_angle(before.end_tangent, piece.start_tangent);
        joints_[b] = {2 * b, 2 * p, std::abs(turn) < smooth_rad ? 0 : turn};
        next_[b] = p;
        previous_[p] = b;
    });
}

bool InscribedDiscs::is_site(SiteId site) const {
    return site % 2 == 0 || joints_[site / 2].turn_rad < 0;
}

double InscribedDiscs::curvature_per_mm(SiteId site) const {
    return site % 2 == 0 ? piece(site).curvature_per_mm : 0;
}

double InscribedDiscs::turn_rad(SiteId site) const {
    if (site % 2 == 1) return std::abs(joints_[site / 2].turn_rad);
    return std::abs(piece(site).curvature_per_mm) * piece(site).length_mm;
}

SiteFoot InscribedDiscs::foot(SiteId site, double at) const {
    const BoundaryPiece& p = piece(site);
    if (site % 2 == 1) {
        const Eigen::Rotation2Dd turn(at * joints_[site / 2].turn_rad);
        return {p.end, turn * left_of(p.end_tangent)};
    }
    if (at == 0) return {p.start, left_of(p.start_tangent)};
    if (at == 1) return {p.end, left_of(p.end_tangent)};
    const BoundaryPoint here = p.at(at);
    return {here.point, left_of(here.tangent)};
}

SiteFoot InscribedDiscs::foot_of(SiteId site, const Point2& centre) const {
    const BoundaryPiece& p = piece(site);
    if (site % 2 == 1) return {p.end, (centre - p.end).normalized()};
    const double k = p.curvature_per_mm;
    const Vector2 left = left_of(p.start_tangent);
    if (k == 0) return {p.start + (centre - p.start).dot(p.start_tangent) * p.start_tangent, left};
    const Point2 middle = p.start + left / k;
    const Vector2 normal = (k > 0 ? middle - centre : centre - middle).normalized();
    return {middle - normal / k, normal};
}

double InscribedDiscs::radius_mm(const SiteFoot& foot, SiteId other) const {
    if (other % 2 == 1) {
        const Vector2 way = piece(other).end - foot.point;
        const double depth = foot.normal.dot(way);
        return depth > least_product * way.norm() && way.norm() > same_mm
                   ? way.squaredNorm() / (2 * depth)
                   : none_mm;
    }
    const BoundaryPiece& p = piece(other);
    const Vector2 v = foot.point - p.start, l = left_of(p.start_tangent);
    const double k = p.curvature_per_mm;
    const double divisor = 2 * (1 - foot.normal.dot(l) + k * foot.normal.dot(v));
    return divisor > least_product ? (2 * v.dot(l) - k * v.squaredNorm()) / divisor : none_mm;
}

double InscribedDiscs::radius_mm(SiteId site, double at, SiteId other) const {
    if (site == other) {
        const double k = curvature_per_mm(site);
        return k > 0 ? 1 / k : none_mm;
    }
    return radius_mm(foot(site, at), other);
}

bool InscribedDiscs::is_beside(SiteId site, const Point2& centre) const {
    if (site % 2 == 1) return true;
    const BoundaryPiece& p = piece(site);
    if (p.is_circle) return true;
    const bool before = (centre - p.start).dot(p.start_tangent) < -slop_mm;
    const bool after = (centre - p.end).dot(p.end_tangent) > slop_mm;
    return p.is_wide ? !(before && after) : !(before || after);
}

// A disc cannot touch what the boundary goes on with, straight on or, from a corner's point, to either side, in another
// point; round-off would say that it does.
bool InscribedDiscs::is_passed_over(SiteId site, double at, SiteId other) const {
    if (site == other) return true;
    const std::uint32_t mine = site / 2, its = other / 2;
    if (site % 2 == 1) return other % 2 == 0 ? its == mine || its == next_[mine] : false;
    if (other % 2 == 1) return its == mine || its == previous_[mine];
    const auto is_joined = [](const Joint& joint, bool at_end) {
        return joint.turn_rad == 0 || (joint.turn_rad < 0 && at_end);
    };
    return (its == next_[mine] && is_joined(joints_[mine], at == 1)) ||
           (its == previous_[mine] && is_joined(joints_[its], at == 0));
}

double InscribedDiscs::place(SiteId site, const Point2& centre) const {
    const BoundaryPiece& p = piece(site);
    const double k = p.curvature_per_mm;
    double at = 0;
    if (site % 2 == 1) {
        at = signed_angle(left_of(p.end_tangent), centre - p.end) / joints_[site / 2].turn_rad;
    } else if (k == 0) {
        at = (centre - p.start).dot(p.start_tangent) / p.length_mm;
    } else {
        const Vector2 to_middle = -left_of(p.middle_tangent) / k;
        const Vector2 to_foot = centre - (p.middle - to_middle);
        at = 0.5 + signed_angle(to_middle, to_foot) / (k * p.length_mm);
    }
    return std::clamp(at, 0.0, 1.0);
}

// A disc that is an arc's own touches it along its length: coming along the segment before or after, where that ends.
double InscribedDiscs::other_place(SiteId site, double at, SiteId other, const Point2& centre,
                                   double radius_mm) const {
    if (site == other) return at;
    const double k = curvature_per_mm(other);
    if (k > 0 && radius_mm > 1 / k - nearly_mm && site % 2 == 0) {
        if (other / 2 == next_[site / 2]) return 0;
        if (other / 2 == previous_[site / 2]) return 1;
    }
    return place(other, centre);
}

Touch InscribedDiscs::touch_with(SiteId site, double at, SiteId other) const {
    const SiteFoot from = foot(site, at);
    const double radius = std::max(0.0, radius_mm(site, at, other));
    const Point2 centre = from.point + radius * from.normal;
    return {at, other, other_place(site, at, other, centre, radius), centre, radius};
}

Touch InscribedDiscs::touch(SiteId site, double at) const {
    const SiteFoot from = foot(site, at);
    if (site % 2 == 0 && at == 1 && joints_[site / 2].turn_rad > 0)
        return {at, 2 * next_[site / 2], 0, from.point, 0};
    if (site % 2 == 0 && at == 0 && joints_[previous_[site / 2]].turn_rad > 0)
        return {at, 2 * previous_[site / 2], 1, from.point, 0};
    const double k = curvature_per_mm(site);
    const double own_mm = k > 0 ? 1 / k : std::numeric_limits<double>::infinity();
    double least = own_mm;
    SiteId found = site;
    const auto consider = [&](SiteId other) {
        if (!is_site(other) || is_passed_over(site, at, other)) return;
        const double radius = radius_mm(from, other);
        if (radius < 0 || radius > least || (radius == least && other >= found)) return;
        if (radius > own_mm - nearly_mm) return;
        if (!is_beside(other, from.point + radius * from.normal)) return;
        least = radius;
        found = other;
    };
    const Point2 middle = from.point + usual_mm_ * from.normal;
    const Vector2 reach(usual_mm_, usual_mm_);
    boundary_.meeting({middle - reach, middle + reach}, [&](std::uint32_t i) {
        consider(2 * i);
        consider(2 * i + 1);
    });
    if (least > usual_mm_ && own_mm > usual_mm_)
        for (SiteId other = 0; other < site_count(); ++other) consider(other);
    if (std::isinf(least)) return {at, site, at, from.point, 0};
    const Point2 centre = from.point + least * from.normal;
    return {at, found, other_place(site, at, found, centre, least), centre, least};
}

bool InscribedDiscs::are_neighbours(SiteId site, SiteId other) const {
    const std::uint32_t mine = site / 2, its = other / 2;
    if (site % 2 == 1 && other % 2 == 1) return false;
    if (site % 2 == 1) return its == mine || its == next_[mine];
    if (other % 2 == 1) return mine == its || mine == next_[its];
    return (its == next_[mine] && joints_[mine].turn_rad == 0) ||
           (mine == next_[its] && joints_[its].turn_rad == 0);
}

double InscribedDiscs::end_towards(SiteId site, SiteId other) const {
    const std::uint32_t mine = site / 2, its = other / 2;
    if (site % 2 == 1) return its == mine ? 0 : 1;
    if (other % 2 == 1) return its == mine ? 1 : 0;
    return its == next_[mine] ? 1 : 0;
}

}  // namespace lyr
