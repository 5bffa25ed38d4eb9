// A contour winds around a point as often as its chords do, and once more or less for each arc between which and its
// chord the point lies. So no arc needs to be cut where it turns. Nor does it where a line crosses it: the sides of its
// ends, and that of its circle's farthest point, say how often that is.

#include "kernel/toolpath/boundary.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/constants.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

BoundaryPiece piece_of(const FullCircle& circle, std::uint32_t contour) {
    const double turn = circle.counter_clockwise ? 1 : -1;
    const Vector2 radius(circle.radius_mm, 0), tangent(0, turn);
    return {.start = circle.centre + radius,
            .end = circle.centre + radius,
            .start_tangent = tangent,
            .end_tangent = tangent,
            .middle = circle.centre - radius,
            .middle_tangent = -tangent,
            .curvature_per_mm = turn / circle.radius_mm,
            .length_mm = full_turn_rad * circle.radius_mm,
            .contour = contour,
            .is_circle = true,
            .is_wide = true};
}

BoundaryPiece piece_of(const Point2& start, const Segment& segment, std::uint32_t contour) {
    const Vector2 chord = segment.end - start;
    const double half2 = chord.squaredNorm() / 4, s = segment.sagitta_mm;
    const Vector2 along = chord.normalized();
    return {.start = start,
            .end = segment.end,
            .start_tangent = start_tangent(start, segment),
            .end_tangent = end_tangent(start, segment),
            .middle = (start + segment.end) / 2 - s * left_of(along),
            .middle_tangent = along,
            .curvature_per_mm = 2 * s / (half2 + s * s),
            .length_mm = length_mm(start, segment),
            .contour = contour,
            .is_wide = s * s > half2};
}

// With the ends: a circle that has one of them as its lowest point must not begin above it, by round-off.
region::Box2 circle_box(const BoundaryPiece& piece) {
    const double radius = 1 / piece.curvature_per_mm;
    const Point2 centre = piece.start + radius * left_of(piece.start_tangent);
    const Vector2 margin(std::abs(radius), std::abs(radius));
    // With the ends, which round-off may leave outside: their heights say which rays meet the chord.
    return region::Box2(Point2(centre - margin), Point2(centre + margin))
        .extend(piece.start)
        .extend(piece.end);
}

std::vector<region::Box2> boxes_of(const std::vector<BoundaryPiece>& pieces) {
    std::vector<region::Box2> boxes;
    boxes.reserve(pieces.size());
    for (const BoundaryPiece& piece : pieces) boxes.push_back(piece.box());
    return boxes;
}

// Whether a point is right of a chord. Where the chord passes above or below it all the way, no product decides: its
// round-off could contradict the comparison of heights by which chords are counted.
bool is_right_of_chord(const Point2& point, const BoundaryPiece& piece) {
    const Vector2 chord = piece.end - piece.start;
    const bool start_above = piece.start.y() > point.y(), end_above = piece.end.y() > point.y();
    const bool start_beyond = piece.start.x() > point.x(), end_beyond = piece.end.x() > point.x();
    if (start_above == end_above && start_beyond != end_beyond) return start_above == end_beyond;
    return cross(point - piece.start, chord) > 0;
}

// What it adds to the winding around a point, by a ray to the right.
int winding_of(const BoundaryPiece& piece, const Point2& point) {
    const bool right = is_right_of_chord(point, piece);
    const bool rises = piece.end.y() > point.y();
    int winding = 0;
    if (rises != (piece.start.y() > point.y()) && right != rises) winding = rises ? 1 : -1;
    if (piece.curvature_per_mm == 0) return winding;
    const bool turns_left = piece.curvature_per_mm > 0;
    if (!piece.is_circle && right != turns_left) return winding;
    const bool is_inside = (offset_mm(piece.carrier(), point) < 0) == turns_left;
    return is_inside ? winding + (turns_left ? 1 : -1) : winding;
}

// A way as a line with a direction.
struct Way {
    Point2 from;
    Vector2 along;  // unit
    double length_mm;

    double left_mm(const Point2& point) const { return cross(along, point - from); }
    double along_mm(const Point2& point) const { return along.dot(point - from); }

    // Whether it may meet what is in the box; the resolution covers round-off.
    bool meets(const region::Box2& box) const {
        const Vector2 half = box.sizes() / 2, middle = box.min() + half - from;
        const double reach = half.x() * std::abs(along.y()) + half.y() * std::abs(along.x());
        if (std::abs(cross(along, middle)) > reach + resolution_mm) return false;
        const double depth = half.x() * std::abs(along.x()) + half.y() * std::abs(along.y());
        const double at = along.dot(middle);
        return at + depth >= -resolution_mm && at - depth <= length_mm + resolution_mm;
    }
};

// Calls take(along_mm, leaves) where the piece crosses the whole line.
template <class Take>
void cross_way(const BoundaryPiece& piece, const Way& way, Take take) {
    const double start_left = way.left_mm(piece.start), end_left = way.left_mm(piece.end);
    const bool changes = (start_left > 0) != (end_left > 0), rises = end_left > 0;
    if (piece.curvature_per_mm == 0) {
        if (!changes) return;
        const double start = way.along_mm(piece.start), end = way.along_mm(piece.end);
        return take(start + (end - start) * start_left / (start_left - end_left), rises);
    }
    const bool turns_left = piece.curvature_per_mm > 0;
    const double radius = 1 / std::abs(piece.curvature_per_mm);
    const Point2 centre = piece.start + left_of(piece.start_tangent) / piece.curvature_per_mm;
    const double aside = way.left_mm(centre), middle = way.along_mm(centre);
    const double half = std::sqrt(std::max(0.0, (radius - aside) * (radius + aside)));
    // A circle that turns left rises where the line leaves it.
    if (changes) return take(rises == turns_left ? middle + half : middle - half, rises);
    if (half == 0) return;
    const Point2 farthest = centre + (rises ? -radius : radius) * left_of(way.along);
    const bool is_right = cross(farthest - piece.start, piece.end - piece.start) > 0;
    if (!piece.is_circle && is_right != turns_left) return;
    take(middle - half, !turns_left);
    take(middle + half, turns_left);
}

}  // namespace

// From the middle, as far as which numbers are most exact.
BoundaryPoint BoundaryPiece::at(double fraction) const {
    const double along_mm = (fraction - 0.5) * length_mm, turn = curvature_per_mm * along_mm;
    if (turn == 0) return {middle + along_mm * middle_tangent, middle_tangent};
    const double sine = std::sin(turn), cosine = std::cos(turn), half_sine = std::sin(turn / 2);
    const Vector2 left = left_of(middle_tangent);
    return {middle + (sine * middle_tangent + 2 * half_sine * half_sine * left) / curvature_per_mm,
            cosine * middle_tangent + sine * left};
}

// That of the tangents' triangle, for what is at most a quarter of a circle.
region::Box2 BoundaryPiece::box() const {
    if (start_tangent.dot(end_tangent) < 0 || is_wide) return circle_box(*this);
    region::Box2 box(start);
    box.extend(end);
    if (curvature_per_mm == 0) return box;
    const Vector2 chord = end - start;
    return box.extend(start + chord.squaredNorm() / chord.dot(start_tangent) / 2 * start_tangent);
}

std::vector<BoundaryPiece> boundary_pieces(Region region) {
    std::size_t segments = 0;
    for (const Contour& contour : region) {
        const auto* path = std::get_if<Path>(&contour);
        segments += path ? path->segments.size() : 1;
    }
    std::vector<BoundaryPiece> pieces;
    pieces.reserve(segments);
    for (std::uint32_t c = 0; c < region.size(); ++c) {
        if (const auto* circle = std::get_if<FullCircle>(&region[c])) {
            pieces.push_back(piece_of(*circle, c));
            continue;
        }
        const Path& path = std::get<Path>(region[c]);
        Point2 from = path.start;
        for (const Segment& segment : path.segments) {
            if (segment.end == from) continue;
            pieces.push_back(piece_of(from, segment, c));
            from = segment.end;
        }
    }
    return pieces;
}

double BoundaryPiece::distance_mm(const Point2& point) const {
    const bool before = (point - start).dot(start_tangent) < 0;
    const bool after = (point - end).dot(end_tangent) > 0;
    // As distance_mm() of kernel/contour.
    const bool beside = is_circle || (is_wide ? !(before && after) : !(before || after));
    if (beside) return std::abs(offset_mm(carrier(), point));
    return std::sqrt(std::min((point - start).squaredNorm(), (point - end).squaredNorm()));
}

Boundary::Boundary(Region region)
    : pieces_(boundary_pieces(region)),
      tree_(boxes_of(pieces_), region::BoxOrder::along_contours) {}

double Boundary::distance_mm(const Point2& point, double within_mm) const {
    const Vector2 margin(within_mm, within_mm);
    double least = within_mm;
    tree_.meeting({point - margin, point + margin},
                  [&](std::uint32_t i) { least = std::min(least, pieces_[i].distance_mm(point)); });
    return least;
}

std::pair<double, double> Boundary::distances_mm(const Point2& a, const Point2& b,
                                                 double within_mm) const {
    const Vector2 margin(within_mm, within_mm);
    std::pair least(within_mm, within_mm);
    tree_.meeting({a.cwiseMin(b) - margin, a.cwiseMax(b) + margin}, [&](std::uint32_t i) {
        least.first = std::min(least.first, pieces_[i].distance_mm(a));
        least.second = std::min(least.second, pieces_[i].distance_mm(b));
    });
    return least;
}

bool Boundary::is_near(const Point2& point, double within_mm, std::size_t except) const {
    const Vector2 margin(within_mm, within_mm);
    return tree_.any({point - margin, point + margin}, [&](std::uint32_t i) {
        return i != except && pieces_[i].distance_mm(point) <= within_mm;
    });
}

bool Boundary::is_near(const Point2& point, double within_mm, Guess& guess) const {
    for (std::size_t i = guess.piece; i < std::min(pieces_.size(), guess.piece + 2); ++i) {
        if (pieces_[i].distance_mm(point) > within_mm) continue;
        guess.piece = i;
        return true;
    }
    const Vector2 margin(within_mm, within_mm);
    return tree_.any({point - margin, point + margin}, [&](std::uint32_t i) {
        if (pieces_[i].distance_mm(point) > within_mm) return false;
        guess.piece = i;
        return true;
    });
}

std::optional<std::uint32_t> Boundary::nearest(const Point2& point, double within_mm) const {
    const Vector2 margin(within_mm, within_mm);
    double least = within_mm;
    std::optional<std::uint32_t> found;
    tree_.meeting({point - margin, point + margin}, [&](std::uint32_t i) {
        const double distance = pieces_[i].distance_mm(point);
        if (distance > least || (distance == least && found && i > *found)) return;
        least = distance;
        found = i;
    });
    return found;
}

void Boundary::crossings(const Point2& from, const Point2& to,
                         std::vector<BoundaryCrossing>& found) const {
    found.clear();
    const double length = (to - from).norm();
    if (length == 0) return;
    const Way way{from, (to - from) / length, length};
    tree_.where([&](const region::Box2& box) { return way.meets(box); },
                [&](std::uint32_t i) {
                    cross_way(pieces_[i], way, [&](double along, bool leaves) {
                        if (along > 0 && along < length) found.push_back({along, i, leaves});
                    });
                });
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
        return a.along_mm < b.along_mm || (a.along_mm == b.along_mm && a.piece < b.piece);
    });
}

int Boundary::winding(const Point2& point) const {
    const Point2 far(std::max(point.x(), tree_.bounds().max().x()), point.y());
    int sum = 0;
    tree_.meeting({point, far}, [&](std::uint32_t i) { sum += winding_of(pieces_[i], point); });
    return sum;
}

}  // namespace lyr
