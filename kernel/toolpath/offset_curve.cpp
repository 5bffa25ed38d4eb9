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

    bool follows_gap = false;  // the side before it has been left out

    Segment parallel() const { return {parallel_end, sagitta_mm}; }
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
    kept.segments.reserve(path.segments.size());
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
    sides.reserve(kept.segments.size());
    kept.segments.back().end = from = path.start;
    for (const Segment& segment : kept.segments) {
        sides.push_back(side_of(from, segment, distance_mm));
        from = segment.end;
    }
    return sides;
}

// Where two parallels cross, along each from its middle; none where they do not between their ends.
struct Crossing {
    Point2 point;
    double before_mm, after_mm;
};

std::optional<Crossing> crossing_of(const region::Curve& before, const region::Curve& after) {
    const region::Meetings found = region::meetings(before, after);
    std::optional<Crossing> last;
    for (int i = 0; i < found.count; ++i) {
        const Point2& point = found.points[static_cast<std::size_t>(i)];
        const Crossing here{point, region::along_mm(before, point), region::along_mm(after, point)};
        const bool is_between = std::abs(here.before_mm) <= before.half_mm &&
                                std::abs(here.after_mm) <= after.half_mm &&
                                std::abs(region::across_mm(before, point)) <= resolution_mm &&
                                std::abs(region::across_mm(after, point)) <= resolution_mm;
        // The one that is nearer to the corner.
        if (is_between && (!last || here.before_mm > last->before_mm)) last = here;
    }
    return last;
}

// What is left of a parallel, along it from its middle.
struct Rest {
    region::Curve parallel;
    double from_mm, to_mm;
    std::optional<Point2> start{}, end{};  // where it is cut
};

class CurveBuilder {
public:
    CurveBuilder(std::vector<Side> sides, const OffsetRequest& request)
        : sides_(std::move(sides)), request_(request), distance_mm_(request.distance_mm) {}

    // False: too little of the contour is left, or too much left out in a row.
    bool trim();
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
    static bool has_parallel(const Side& side) {
        return !side.centre && (side.parallel_end - side.parallel_start).norm() > resolution_mm;
    }
    void leave_out(std::size_t i);
    std::optional<std::size_t> cut(std::vector<Rest>& rests) const;
    Vector2 middle(std::size_t i) const;
    bool may_be_mitred(std::size_t i) const;
    Point2 mitre_at(std::size_t i) const;
    void line_to(const Point2& point);
    void segment_to(const Segment& segment);
    Point2 start() const;
    void add_side(std::size_t i);
    void add_joint(std::size_t i);

    std::vector<Side> sides_;
    const OffsetRequest& request_;
    double distance_mm_;
    double left_out_mm_ = 0;  // at most, between sides that are neighbours now
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
                        request_.mitre_limit * std::cos(turn / 2) >= 1 && may_be_mitred(i);
    return mitred ? Joint::mitre : Joint::round;
}

// From a corner to the middle between its parallels: |distance| cos(turn / 2).
Vector2 CurveBuilder::middle(std::size_t i) const {
    return (sides_[i].parallel_end + after(i).parallel_start) / 2 - sides_[i].end;
}

bool CurveBuilder::may_be_mitred(std::size_t i) const {
    return !request_.mitred ||
           request_.mitred->contains(sides_[i].end, middle(i) / std::abs(distance_mm_));
}

Point2 CurveBuilder::mitre_at(std::size_t i) const {
    return sides_[i].end + distance_mm_ * distance_mm_ / middle(i).squaredNorm() * middle(i);
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

void CurveBuilder::leave_out(std::size_t i) {
    left_out_mm_ = std::max(left_out_mm_, (sides_[i].end - sides_[before(i)].end).norm());
    sides_[(i + 1) % sides_.size()].follows_gap = true;
    sides_.erase(sides_.begin() + static_cast<std::ptrdiff_t>(i));
}

bool CurveBuilder::trim() {
    // Sides whose parallels are used up are left out; between them and the next ones left out no more than this.
    const double longest_gap_mm = 2 * std::abs(distance_mm_);
    for (std::size_t i = sides_.size(); i-- > 0;)
        if (!has_parallel(sides_[i])) leave_out(i);
    std::vector<Rest> rests;
    for (;;) {
        if (sides_.size() < 2 || left_out_mm_ > longest_gap_mm) return false;
        const std::optional<std::size_t> used_up = cut(rests);
        if (!used_up) break;
        leave_out(*used_up);
    }
    for (std::size_t i = 0; i < sides_.size(); ++i) {
        Side& side = sides_[i];
        const Rest& rest = rests[i];
        if (rest.start) side.parallel_start = *rest.start;
        if (rest.end) side.parallel_end = *rest.end;
        const double sweep = rest.parallel.curvature_per_mm * (rest.to_mm - rest.from_mm);
        if ((rest.start || rest.end) && sweep != 0)
            side.sagitta_mm =
                arc_with_sweep(side.parallel_start, side.parallel_end, sweep).sagitta_mm;
    }
    return true;
}

// Cuts parallels where they cross the next. The first side of which nothing is left, or the shorter one of two that do not
// cross.
std::optional<std::size_t> CurveBuilder::cut(std::vector<Rest>& rests) const {
    rests.clear();
    rests.reserve(sides_.size());
    for (const Side& side : sides_) {
        const region::Curve parallel = region::curve_of(side.parallel_start, side.parallel());
        rests.push_back({parallel, -parallel.half_mm, parallel.half_mm});
    }
    for (std::size_t i = 0; i < sides_.size(); ++i) {
        if (!after(i).follows_gap && joint_at(i) != Joint::crossing) continue;
        Rest &one = rests[i], &other = rests[(i + 1) % rests.size()];
        const auto crossing = crossing_of(one.parallel, other.parallel);
        if (!crossing)
            return one.parallel.half_mm < other.parallel.half_mm ? i : (i + 1) % rests.size();
        one.end = other.start = crossing->point;
        one.to_mm = crossing->before_mm;
        other.from_mm = crossing->after_mm;
    }
    for (std::size_t i = 0; i < rests.size(); ++i)
        if (!(rests[i].to_mm - rests[i].from_mm > resolution_mm)) return i;
    return std::nullopt;
}

std::optional<Contour> CurveBuilder::result() {
    if (sides_.empty()) return std::nullopt;
    at_ = path_.start = start();
    path_.segments.reserve(sides_.size() + 1);
    for (std::size_t i = 0; i < sides_.size(); ++i) {
        add_side(i);
        add_joint(i);
    }
    line_to(path_.start);
    if (path_.segments.size() < 2) return std::nullopt;
    path_.segments.back().end = path_.start;
    return std::move(path_);
}

std::optional<Contour> circle_beside(const FullCircle& circle, double distance_mm) {
    const double radius =
        circle.radius_mm + (circle.counter_clockwise ? distance_mm : -distance_mm);
    if (radius <= resolution_mm) return std::nullopt;
    return FullCircle{circle.centre, radius, circle.counter_clockwise};
}

}  // namespace

std::optional<std::vector<Contour>> trimmed_curves(Region region, const OffsetRequest& request) {
    std::vector<Contour> curves;
    for (const Contour& contour : region) {
        std::optional<Contour> curve;
        if (const auto* circle = std::get_if<FullCircle>(&contour)) {
            curve = circle_beside(*circle, request.distance_mm);
        } else {
            CurveBuilder builder(sides_of(std::get<Path>(contour), request.distance_mm), request);
            if (!builder.trim()) return std::nullopt;
            curve = builder.result();
        }
        if (curve) curves.push_back(std::move(*curve));
    }
    return curves;
}

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
