// With `distance` positive to the right, a segment of curvature k (positive: turns left) has a parallel that is
// 1 + k distance times as long and as curved; where this is not positive, the parallel is past the centre. A corner that
// turns to the left by `turn` is gone round if turn and distance have the same sign.

#include "kernel/toolpath/offset_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "kernel/geometry/tolerance.h"
#include "kernel/region/curve.h"

namespace lyr {
namespace {

constexpr double full_turn_rad = 2 * std::numbers::pi;

Vector2 right_of(const Vector2& direction) {
    return {direction.y(), -direction.x()};
}

// A segment and its parallel.
struct Side {
    bool is_line() const { return sagitta_mm == 0 && !centre; }

    Point2 end;  // of the segment: the corner that follows
    Vector2 start_tangent, end_tangent;
    Point2 parallel_start, parallel_end;  // at the distance beside the segment's ends
    double sagitta_mm;                    // of the parallel
    std::optional<Point2> centre{};       // if there is no parallel
};

Side side_of(const Point2& start, const Segment& segment, double distance_mm) {
    Side side{segment.end, start_tangent(start, segment), end_tangent(start, segment), {}, {}, 0};
    side.parallel_start = start + distance_mm * right_of(side.start_tangent);
    side.parallel_end = segment.end + distance_mm * right_of(side.end_tangent);
    const double chord2 = (segment.end - start).squaredNorm(), sagitta = segment.sagitta_mm;
    const double radius_mm = std::abs(chord2 / 4 / sagitta + sagitta) / 2;
    const double scale = 1 + distance_mm * 8 * sagitta / (chord2 + 4 * sagitta * sagitta);
    side.sagitta_mm = scale * sagitta;
    if (sagitta != 0 && scale * radius_mm <= resolution_mm) {
        side.centre = circle_of(start, segment)->centre;
    }
    return side;
}

// Without what has no length: its direction would be random.
std::vector<Side> sides_of(const Path& path, double distance_mm) {
    std::vector<Side> sides;
    Path kept{path.start, {}};
    Point2 from = path.start;
    for (const Segment& segment : path.segments) {
        if ((segment.end - from).norm() <= resolution_mm &&
            std::abs(segment.sagitta_mm) <= resolution_mm) {
            continue;
        }
        kept.segments.push_back(segment);
        from = segment.end;
    }
    if (kept.segments.size() < 2) return sides;
    kept.segments.back().end = from = path.start;
    for (const Segment& segment : kept.segments) {
        sides.push_back(side_of(from, segment, distance_mm));
        from = segment.end;
    }
    return sides;
}

class CurveBuilder {
public:
    CurveBuilder(std::vector<Side> sides, const OffsetRequest& request)
        : sides_(std::move(sides)), request_(request), distance_mm_(request.distance_mm) {}

    std::optional<Contour> result();

private:
    enum class Joint { smooth, round, mitre, crossing };

    const Side& after(std::size_t i) const { return sides_[(i + 1) % sides_.size()]; }
    std::size_t before(std::size_t i) const { return (i == 0 ? sides_.size() : i) - 1; }
    double turn_rad(std::size_t i) const;
    Joint joint_at(std::size_t i) const;
    bool is_mitred(std::size_t i) const {
        return request_.corner == Corner::mitre && joint_at(i) == Joint::mitre;
    }
    Point2 mitre_at(std::size_t i) const;
    void line_to(const Point2& point);
    void segment_to(const Segment& segment);
    Point2 start() const;
    void add_side(std::size_t i);
    void add_joint(std::size_t i);

    std::vector<Side> sides_;
    const OffsetRequest& request_;
    double distance_mm_;
    Path path_;
    Point2 at_;
};

// At the corner that follows a side, to the left.
double CurveBuilder::turn_rad(std::size_t i) const {
    const Vector2 &from = sides_[i].end_tangent, &to = after(i).start_tangent;
    const double turn = std::atan2(cross(from, to), from.dot(to));
    const bool is_cusp = std::abs(turn) > std::numbers::pi - cusp_rad;
    return is_cusp && turn * distance_mm_ < 0 ? turn + std::copysign(full_turn_rad, distance_mm_)
                                              : turn;
}

CurveBuilder::Joint CurveBuilder::joint_at(std::size_t i) const {
    if ((after(i).parallel_start - sides_[i].parallel_end).norm() <= resolution_mm) {
        return Joint::smooth;
    }
    const double turn = turn_rad(i);
    if (turn * distance_mm_ < 0) return Joint::crossing;
    const bool mitred = request_.corner == Corner::mitre && std::abs(turn) < std::numbers::pi &&
                        request_.mitre_limit * std::cos(turn / 2) >= 1;
    return mitred ? Joint::mitre : Joint::round;
}

Point2 CurveBuilder::mitre_at(std::size_t i) const {
    const Point2& corner = sides_[i].end;
    const Vector2 middle = (sides_[i].parallel_end + after(i).parallel_start) / 2 -
                           corner;  // |distance| cos(turn / 2)
    return corner + distance_mm_ * distance_mm_ / middle.squaredNorm() * middle;
}

void CurveBuilder::line_to(const Point2& point) {
    if ((point - at_).norm() > resolution_mm) segment_to({point, 0});
}

void CurveBuilder::segment_to(const Segment& segment) {
    path_.segments.push_back(segment);
    at_ = segment.end;
}

// A line that comes from a mitre is one line from there, as it is one to the next mitre.
void CurveBuilder::add_side(std::size_t i) {
    const Side& side = sides_[i];
    if (side.centre) return line_to(*side.centre);
    if (!side.is_line() || !is_mitred(before(i))) line_to(side.parallel_start);
    const bool to_mitre = side.is_line() && is_mitred(i);
    segment_to({to_mitre ? mitre_at(i) : side.parallel_end, side.sagitta_mm});
}

void CurveBuilder::add_joint(std::size_t i) {
    switch (joint_at(i)) {
        case Joint::smooth:
            return;
        case Joint::crossing:
            return line_to(sides_[i].end);
        case Joint::mitre:
            if (!sides_[i].is_line()) line_to(sides_[i].parallel_end);
            line_to(mitre_at(i));
            if (!after(i).is_line()) line_to(after(i).parallel_start);
            return;
        case Joint::round:
            line_to(sides_[i].parallel_end);
            return segment_to(arc_with_sweep(at_, after(i).parallel_start, turn_rad(i)));
    }
}

Point2 CurveBuilder::start() const {
    const std::size_t last = before(0);
    if (sides_[0].centre) return *sides_[0].centre;
    return sides_[0].is_line() && is_mitred(last) ? mitre_at(last) : sides_[0].parallel_start;
}

std::optional<Contour> CurveBuilder::result() {
    if (sides_.empty()) return std::nullopt;
    at_ = path_.start = start();
    for (std::size_t i = 0; i < sides_.size(); ++i) {
        add_side(i);
        add_joint(i);
    }
    line_to(path_.start);
    if (path_.segments.size() < 2) return std::nullopt;
    path_.segments.back().end = path_.start;
    return path_;
}

std::optional<Contour> circle_beside(const FullCircle& circle, double distance_mm) {
    const double radius =
        circle.radius_mm + (circle.counter_clockwise ? distance_mm : -distance_mm);
    if (radius <= resolution_mm) return std::nullopt;
    return FullCircle{circle.centre, radius, circle.counter_clockwise};
}

}  // namespace

std::vector<Contour> offset_curves(Region region, const OffsetRequest& request) {
    std::vector<Contour> curves;
    for (const Contour& contour : region) {
        const auto* circle = std::get_if<FullCircle>(&contour);
        auto curve =
            circle ? circle_beside(*circle, request.distance_mm)
                   : CurveBuilder(sides_of(std::get<Path>(contour), request.distance_mm), request)
                         .result();
        if (curve) curves.push_back(std::move(*curve));
    }
    return curves;
}

}  // namespace lyr
