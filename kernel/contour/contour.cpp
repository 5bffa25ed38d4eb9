// Area by the polygon of the ends plus what each arc adds to its chord, both taken about the first point so that
// nothing is lost far from the origin.

#include "kernel/contour/contour.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/constants.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

// A run of segments that lie on one line or one circle.
struct Run {
    Point2 start;
    Segment segment;
    std::optional<ArcCircle> circle;
    double sweep = 0;
};

Run run_of(const Point2& start, const Segment& segment) {
    return {start, segment, circle_of(start, segment), sweep_rad(start, segment)};
}

bool same_circle(const Run& a, const Run& b, double allowed_mm) {
    return a.circle && b.circle && (a.sweep > 0) == (b.sweep > 0) &&
           (a.circle->centre - b.circle->centre).norm() +
                   std::abs(a.circle->radius_mm - b.circle->radius_mm) <=
               allowed_mm;
}

// The corner between two lines is nowhere: it lies on the chord that would replace them.
bool in_line(const Run& a, const Run& b) {
    if (a.circle || b.circle) return false;
    const Vector2 first = a.segment.end - a.start, chord = b.segment.end - a.start;
    return first.dot(chord) > 0 && first.dot(chord) < chord.squaredNorm() &&
           std::abs(cross(first, chord)) <= resolution_mm * chord.norm();
}

// Appends b to a if they are of one line or circle and the result is still one segment.
bool join(Run& a, const Run& b, double allowed_mm) {
    if (in_line(a, b)) {
        a.segment.end = b.segment.end;
        return true;
    }
    if (!same_circle(a, b, allowed_mm)) return false;
    const double sweep = a.sweep + b.sweep;
    if (std::abs(sweep) >= full_turn_rad) return false;
    const Segment joined = arc_with_sweep(a.start, b.segment.end, sweep);
    const auto circle = circle_of(a.start, joined);
    // A chord much shorter than the arc says little about the circle; then the two stay apart.
    if (!circle || (circle->centre - a.circle->centre).norm() > allowed_mm) return false;
    a.segment = joined;
    a.sweep = sweep;
    return true;
}

// All runs on one circle, once around.
std::optional<FullCircle> as_circle(const std::vector<Run>& runs, double allowed_mm) {
    double sweep = 0;
    for (const Run& run : runs) {
        if (!same_circle(runs.front(), run, allowed_mm)) return std::nullopt;
        sweep += run.sweep;
    }
    const double missing_mm =
        std::abs(std::abs(sweep) - full_turn_rad) * runs.front().circle->radius_mm;
    if (missing_mm > allowed_mm) return std::nullopt;
    // The longest arc knows its circle best.
    const auto best = std::max_element(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
        return std::abs(a.sweep) < std::abs(b.sweep);
    });
    return FullCircle{best->circle->centre, best->circle->radius_mm, sweep > 0};
}

std::vector<Run> runs_of(const Path& path) {
    std::vector<Run> runs;
    runs.reserve(path.segments.size());
    Point2 from = path.start;
    for (const Segment& segment : path.segments) {
        const bool nothing = (segment.end - from).norm() <= resolution_mm &&
                             std::abs(segment.sagitta_mm) <= resolution_mm;
        if (!nothing) {
            runs.push_back(run_of(from, segment));
            from = segment.end;
        }
    }
    // Closed again, in case what was left out stood at the end.
    if (!runs.empty()) runs.back().segment.end = runs.front().start;
    return runs;
}

}  // namespace

Point2 start_of(const Contour& contour) {
    if (const auto* circle = std::get_if<FullCircle>(&contour)) {
        return circle->centre + Vector2(circle->radius_mm, 0);
    }
    return std::get<Path>(contour).start;
}

double area_mm2(const Contour& contour) {
    if (const auto* circle = std::get_if<FullCircle>(&contour)) {
        const double area = std::numbers::pi * circle->radius_mm * circle->radius_mm;
        return circle->counter_clockwise ? area : -area;
    }
    const Path& path = std::get<Path>(contour);
    double area = 0;
    Point2 from = path.start;
    for (const Segment& segment : path.segments) {
        area += cross(from - path.start, segment.end - path.start) / 2;
        area += enclosed_area_mm2(from, segment);
        from = segment.end;
    }
    return area;
}

double length_mm(const Contour& contour) {
    if (const auto* circle = std::get_if<FullCircle>(&contour)) {
        return full_turn_rad * circle->radius_mm;
    }
    const Path& path = std::get<Path>(contour);
    double length = 0;
    Point2 from = path.start;
    for (const Segment& segment : path.segments) {
        length += length_mm(from, segment);
        from = segment.end;
    }
    return length;
}

SegmentCount count(const Contour& contour) {
    if (std::holds_alternative<FullCircle>(contour)) return {.lines = 0, .arcs = 1};
    SegmentCount result;
    for (const Segment& segment : std::get<Path>(contour).segments) {
        ++(segment.sagitta_mm == 0 ? result.lines : result.arcs);
    }
    return result;
}

std::optional<Contour> simplified(Path path, double allowed_mm) {
    const std::vector<Run> runs = runs_of(path);
    if (runs.empty()) return std::nullopt;
    if (const auto circle = as_circle(runs, allowed_mm)) return *circle;

    std::vector<Run> joined;
    for (const Run& run : runs) {
        if (joined.empty() || !join(joined.back(), run, allowed_mm)) joined.push_back(run);
    }
    // The seam between the last and the first is a corner like the others.
    if (joined.size() > 2 && join(joined.back(), joined.front(), allowed_mm)) {
        joined.front() = joined.back();
        joined.pop_back();
    }
    Path result{joined.front().start, {}};
    for (const Run& run : joined) result.segments.push_back(run.segment);
    // One line there and back again encloses nothing.
    const bool encloses = result.segments.size() > 2 ||
                          (result.segments.size() == 2 && (joined[0].circle || joined[1].circle));
    if (!encloses) return std::nullopt;
    return result;
}

}  // namespace lyr
