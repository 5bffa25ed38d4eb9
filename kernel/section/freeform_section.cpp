// Places on tracked curves. A crossing belongs where the curves come nearest to it: on the plane there is nothing else
// to go by, and an edge is nearer to its face's section than another sheet of the same face.

#include <algorithm>
#include <limits>

#include "kernel/section/surface_section.h"

namespace lyr {
namespace {

struct Foot {
    double distance2, share;
};

Foot foot_on_chord(const Point2& from, const Point2& to, const Point2& point) {
    const Vector2 chord = to - from;
    const double length2 = chord.squaredNorm();
    const double share =
        length2 > 0 ? std::clamp((point - from).dot(chord) / length2, 0.0, 1.0) : 0.0;
    return {(from + share * chord - point).squaredNorm(), share};
}

// The chord that a key lies on: from points[i - 1] to points[i].
std::size_t chord_at(const LevelCurve& curve, double key) {
    const auto next = std::upper_bound(curve.key.begin() + 1, curve.key.end() - 1, key);
    return static_cast<std::size_t>(next - curve.key.begin());
}

CurvePoint point_at(const LevelCurve& curve, double key) {
    if (curve.closed) key -= curve.length_mm() * std::floor(key / curve.length_mm());
    const std::size_t i = chord_at(curve, key);
    const double chord = curve.key[i] - curve.key[i - 1];
    const double share = chord > 0 ? std::clamp((key - curve.key[i - 1]) / chord, 0.0, 1.0) : 0;
    return between(curve.points[i - 1], curve.points[i], share);
}

// Appends the curve's points from one key to another, which may lie a turn ahead. A closed curve's last point is its first
// again: it comes once, unless there is a corner or the end.
void append_between(const LevelCurve& curve, double from, double to,
                    std::vector<CurvePoint>& points, std::vector<double>& keys) {
    const double turn = curve.closed ? curve.length_mm() : 0;
    const double first = turn > 0 ? turn * std::floor(from / turn) : 0;
    for (double base = first; base < to || base == first; base += turn) {
        const auto begin = std::lower_bound(curve.key.begin(), curve.key.end(), from - base);
        for (auto key = begin; key != curve.key.end() && base + *key <= to; ++key) {
            const bool again = curve.closed && key + 1 == curve.key.end();
            if (again && !curve.closes_in_corner && base + *key < to) break;
            points.push_back(curve.points[static_cast<std::size_t>(key - curve.key.begin())]);
            keys.push_back(base + *key);
        }
        if (turn == 0) break;
    }
}

// Appends a point, before it as many of the cubic that leads to it as keep chords near the curve.
void append_dense(const CurvePoint& point, double allowed_mm, std::vector<CurvePoint>& points) {
    // Arcs that hold to the points within their share of the tolerance cannot use more than this between them.
    constexpr double share_of_allowed = 1.0 / 8;
    const CurvePoint before = points.back();
    const double sagitta = sagitta_mm(before, point);
    const int count =
        static_cast<int>(std::ceil(std::sqrt(sagitta / (share_of_allowed * allowed_mm))));
    for (int i = 1; i < count; ++i) {
        points.push_back(between(before, point, static_cast<double>(i) / count));
    }
    points.push_back(point);
}

}  // namespace

Place locate(const FreeformSection& section, const CrossingPoint& crossing) {
    const Point2 point = crossing.point.head<2>();
    Place nearest;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < section.curves.size(); ++c) {
        const LevelCurve& curve = section.curves[c];
        for (std::size_t i = 1; i < curve.points.size(); ++i) {
            const Foot foot =
                foot_on_chord(curve.points[i - 1].point, curve.points[i].point, point);
            if (foot.distance2 >= least) continue;
            least = foot.distance2;
            nearest = {static_cast<int>(c),
                       curve.key[i - 1] + foot.share * (curve.key[i] - curve.key[i - 1])};
        }
    }
    return nearest;
}

CurvePoint at(const FreeformSection& section, const Place& place) {
    return point_at(section.curves[static_cast<std::size_t>(place.component)], place.key);
}

void trace(const FreeformSection& section, int component, double from, double to,
           const Point2& start, const Point2& end, double allowed_mm, std::vector<Segment>& out) {
    const LevelCurve& curve = section.curves[static_cast<std::size_t>(component)];
    const CurvePoint first = point_at(curve, from), last = point_at(curve, to);
    const Vector2 off_start = start - first.point, off_end = end - last.point;
    std::vector<CurvePoint> points;
    std::vector<double> keys;
    append_between(curve, from, to, points, keys);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double share = (keys[i] - from) / (to - from);
        points[i].point += (1 - share) * off_start + share * off_end;
    }
    // Points so near an end that the chord's direction would be round-off, or the crossing's own inaccuracy. Where an end
    // lies in a corner, it is they that know the tangent on this side of it.
    const auto near = [](const Point2& a, const Vector2& off) {
        const double least = std::max(level_clearance_mm, 2 * off.norm());
        return [&a, least](const CurvePoint& p) { return (p.point - a).norm() <= least; };
    };
    const auto begin = std::find_if_not(points.begin(), points.end(), near(start, off_start));
    const auto kept_end = std::find_if_not(std::make_reverse_iterator(points.end()),
                                           std::make_reverse_iterator(begin), near(end, off_end))
                              .base();
    const CurvePoint& leaving = begin == points.begin() ? first : *std::prev(begin);
    const CurvePoint& arriving = kept_end == points.end() ? last : *kept_end;
    std::vector<CurvePoint> dense{{start, leaving.tangent}};
    for (auto point = begin; point != kept_end; ++point) append_dense(*point, allowed_mm, dense);
    append_dense({end, arriving.tangent}, allowed_mm, dense);
    fit_arcs(dense, allowed_mm, out);
}

}  // namespace lyr
