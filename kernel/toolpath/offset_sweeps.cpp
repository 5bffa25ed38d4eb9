#include "kernel/toolpath/offset_sweeps.h"

#include <cmath>

#include "kernel/contour/turned_round.h"
#include "kernel/geometry/tolerance.h"
#include "kernel/toolpath/boundary.h"
#include "kernel/toolpath/offset_curve.h"

namespace lyr {
namespace {

Vector2 right_of(const Vector2& direction) {
    return {direction.y(), -direction.x()};
}

// Around a path that winds clockwise, the other way.
Path counter_clockwise(Path path) {
    if (area_mm2(Contour(path)) > 0) return path;
    return std::get<Path>(turned_round(Contour(std::move(path))));
}

class Sweeps {
public:
    explicit Sweeps(const OffsetRequest& request)
        : request_(request), distance_mm_(std::abs(request.distance_mm)) {}

    std::vector<Contour> covered(Region region) {
        const Boundary boundary(region);
        for (const BoundaryPiece& piece : boundary.pieces()) add(piece);
        if (request_.corner == Corner::mitre) add_mitres(boundary.pieces());
        return std::move(covered_);
    }

private:
    void add(const BoundaryPiece& piece);
    void add_circle(const BoundaryPiece& piece);
    void add_beside(const BoundaryPiece& piece, double side_mm);
    void add_mitres(const std::vector<BoundaryPiece>& pieces);
    void add_mitre(const BoundaryPiece& before, const BoundaryPiece& after);

    const OffsetRequest& request_;
    double distance_mm_;
    std::vector<Contour> covered_;
};

void Sweeps::add(const BoundaryPiece& piece) {
    if (piece.is_circle) return add_circle(piece);
    covered_.push_back(FullCircle{piece.start, distance_mm_, true});
    for (const double side_mm : {distance_mm_, -distance_mm_}) add_beside(piece, side_mm);
}

void Sweeps::add_circle(const BoundaryPiece& piece) {
    const Point2 centre = (piece.start + piece.middle) / 2;
    const double radius = std::abs(1 / piece.curvature_per_mm);
    covered_.push_back(FullCircle{centre, radius + distance_mm_, true});
    if (radius - distance_mm_ > resolution_mm) {
        covered_.push_back(FullCircle{centre, radius - distance_mm_, false});
    }
}

// Between the segment and its parallel, which is no farther than its centre.
void Sweeps::add_beside(const BoundaryPiece& piece, double side_mm) {
    const double k = piece.curvature_per_mm;
    const double sweep = k * piece.length_mm;
    const auto arc = [](const Point2& from, const Point2& to, double angle) {
        return angle == 0 ? Segment{to} : arc_with_sweep(from, to, angle);
    };
    const bool to_centre = 1 + k * side_mm <= std::abs(k) * resolution_mm;
    const double depth_mm = to_centre ? -1 / k : side_mm;
    const Point2 far_end = piece.end + depth_mm * right_of(piece.end_tangent);
    Path path{piece.start, {arc(piece.start, piece.end, sweep), {far_end}}};
    if (!to_centre) {
        const Point2 far_start = piece.start + depth_mm * right_of(piece.start_tangent);
        path.segments.push_back(arc(far_end, far_start, -sweep));
    }
    path.segments.push_back({piece.start});
    covered_.push_back(counter_clockwise(std::move(path)));
}

void Sweeps::add_mitres(const std::vector<BoundaryPiece>& pieces) {
    for_neighbours(pieces, [&](const BoundaryPiece& before, const BoundaryPiece& after) {
        if (!after.is_circle) add_mitre(before, after);
    });
}

// The kite between the corner, the feet of both parallels and the mitre.
void Sweeps::add_mitre(const BoundaryPiece& before, const BoundaryPiece& after) {
    const Point2& corner = after.start;
    const Vector2 one = request_.distance_mm * right_of(before.end_tangent);
    const Vector2 other = request_.distance_mm * right_of(after.start_tangent);
    const bool goes_round = cross(one, other) * request_.distance_mm > 0;
    const Vector2 middle = (one + other) / 2;
    const double cosine = middle.norm() / distance_mm_;
    if (!goes_round || (one - other).norm() <= resolution_mm || request_.mitre_limit * cosine < 1) {
        return;
    }
    if (request_.mitred && !request_.mitred->contains(corner, middle / distance_mm_)) return;
    const Point2 tip = corner + middle / (cosine * cosine);
    covered_.push_back(
        counter_clockwise({corner, {{corner + one}, {tip}, {corner + other}, {corner}}}));
}

}  // namespace

RegionResult offset_by_sweeps(Region region, const OffsetRequest& request) {
    const std::vector<Contour> covered = Sweeps(request).covered(region);
    return combined(region, covered,
                    request.distance_mm > 0 ? Operation::unite : Operation::subtract,
                    request.allowed_mm, request.allowed_mm);
}

}  // namespace lyr
