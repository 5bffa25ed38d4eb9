#include "kernel/contour/fit.h"

#include <algorithm>
#include <cmath>

#include "kernel/contour/arc_chain.h"

namespace lyr {
namespace {

// What arcs may do between the points that they are held to is left to the rest.
constexpr double bound_share = 0.98;

// Chords of the points that stand for a curve are nearer to it than this share of what is allowed, ...
constexpr double chord_share = 1.0 / 50;

// ... and the cubics through them nearer than this.
constexpr double cubic_share = 1.0 / 200;

// From one point to the next the tangent turns by less than half a radian.
constexpr double least_cosine_of_turn = 0.88;

// Where a curve asks for points closer than two to this power of the whole, it has a corner.
constexpr int closest_log2 = -40;

// However straight the curve: where its curvature changes, points tell.
constexpr int least_spans = 16;

class Sampler {
public:
    Sampler(const PlaneCurve& curve, double from, double to, double allowed_mm)
        : curve_(curve), closest_(std::ldexp(to - from, closest_log2)), allowed_mm_(allowed_mm) {}

    // Appends what lies between two parameters, and the end.
    void append(double from, const CurvePoint& start, double to, const CurvePoint& end,
                std::vector<CurvePoint>& points) const {
        const double middle = (from + to) / 2;
        if (to - from > closest_ && from < middle && middle < to) {
            const CurvePoint half = curve_(middle);
            if (!is_dense(start, half, end)) {
                append(from, start, middle, half, points);
                append(middle, half, to, end, points);
                return;
            }
        }
        if (end.point != points.back().point) points.push_back(end);
    }

private:
    bool is_dense(const CurvePoint& start, const CurvePoint& half, const CurvePoint& end) const {
        const Vector2 chord = end.point - start.point;
        const double length = chord.norm();
        if (!(start.tangent.dot(end.tangent) > least_cosine_of_turn) ||
            !(chord.dot(start.tangent) > 0))
            return false;
        const Point2 middle = 0.5 * (start.point + end.point);
        const Vector2 cubic = length / 8 * (start.tangent - end.tangent);
        const double sagitta = std::abs(cross(chord, half.point - middle)) / length;
        const double off = std::abs(cross(chord, half.point - middle - cubic)) / length;
        return sagitta <= chord_share * allowed_mm_ && off <= cubic_share * allowed_mm_;
    }

    const PlaneCurve& curve_;
    double closest_, allowed_mm_;
};

}  // namespace

void fit_arcs(const PlaneCurve& curve, double from, double to, const Point2& start,
              const Point2& end, double allowed_mm, std::vector<Segment>& out) {
    const Sampler sampler(curve, from, to, allowed_mm);
    std::vector<CurvePoint> points{{start, curve(from).tangent}};
    CurvePoint here = points.front();
    for (int i = 1; i <= least_spans; ++i) {
        const double before = from + (to - from) * (i - 1) / least_spans;
        const double at = i < least_spans ? from + (to - from) * i / least_spans : to;
        CurvePoint next = curve(at);
        if (i == least_spans) next.point = end;
        sampler.append(before, here, at, next, points);
        here = next;
    }
    if (points.size() == 1) {
        out.push_back({end, 0});
    } else {
        chain_arcs(points, bound_share * allowed_mm, out);
    }
}

void fit_arcs(std::span<const CurvePoint> points, double allowed_mm, std::vector<Segment>& out) {
    for (std::size_t first = 0; first + 1 < points.size();) {
        std::size_t last = first + 1;
        while (last + 1 < points.size() && points[last + 1].point != points[last].point) ++last;
        chain_arcs(points.subspan(first, last - first + 1), bound_share * allowed_mm, out);
        first = last + 1;
    }
}

}  // namespace lyr
