#include "kernel/contour/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/contour/arc_chain.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

// What arcs may do between the points that they are held to is left to the rest.
constexpr double bound_share = 0.98;

// Chords of the points that stand for a curve are nearer to it than this share of what is allowed, ...
constexpr double chord_share = 1.0 / 50;

// ... and the cubics through them nearer than this.
constexpr double cubic_share = 1.0 / 200;

// A curve that is not known better than this is taken as it is.
constexpr double noise_share = 1.0 / 8;

// From one point to the next the tangent turns by less than half a radian.
constexpr double least_cosine_of_turn = 0.88;

// Points are halved between no more often than this: a curve that asks for more has a corner there.
constexpr int most_halvings = 40;

// And no more points are taken in all: a curve that asks for more is none.
constexpr std::size_t most_points = 4'000'000;

// However straight the curve: where its curvature changes, points tell. A prime, so that no even number of turns hides.
constexpr int least_spans = 17;

class Sampler {
public:
    Sampler(const PlaneCurve& curve, double allowed_mm) : curve_(curve), allowed_mm_(allowed_mm) {}

    // Appends what lies between two parameters, and the end. `coarser_off_mm` is how far the cubic was off before the
    // span was halved.
    void append(double from, const CurvePoint& start, double to, const CurvePoint& end,
                int halvings, double coarser_off_mm, std::vector<CurvePoint>& points) const {
        const double middle = (from + to) / 2;
        if (halvings < most_halvings && points.size() < most_points && from < middle &&
            middle < to) {
            const CurvePoint half = curve_(middle);
            double off_mm = 0;
            if (!is_dense(start, half, end, coarser_off_mm, off_mm)) {
                append(from, start, middle, half, halvings + 1, off_mm, points);
                append(middle, half, to, end, halvings + 1, off_mm, points);
                return;
            }
        }
        if (end.point != points.back().point) points.push_back(end);
    }

private:
    bool is_dense(const CurvePoint& start, const CurvePoint& half, const CurvePoint& end,
                  double coarser_off_mm, double& off_mm) const {
        const Vector2 chord = end.point - start.point;
        const double length = chord.norm();
        // Closer there is only noise.
        if (!half.point.allFinite() || !half.tangent.allFinite() ||
            (length <= resolution_mm && (half.point - start.point).norm() <= resolution_mm))
            return true;
        if (!(start.tangent.dot(end.tangent) > least_cosine_of_turn) ||
            !(chord.dot(start.tangent) > 0))
            return false;
        const Point2 middle = 0.5 * (start.point + end.point);
        const Vector2 cubic = length / 8 * (start.tangent - end.tangent);
        // As the ends' tangents have it, too: a curve that bends both ways is on its chord in the middle.
        const double bent =
            (std::abs(cross(chord, start.tangent)) + std::abs(cross(chord, end.tangent))) / 8;
        const double sagitta = std::max(bent, std::abs(cross(chord, half.point - middle)) / length);
        off_mm = std::abs(cross(chord, half.point - middle - cubic)) / length;
        if (!(sagitta <= chord_share * allowed_mm_)) return false;
        // Of a smooth curve, a half is off by a sixteenth; what does not get less is how exactly the curve is known.
        const bool is_noise = off_mm <= noise_share * allowed_mm_ && off_mm > coarser_off_mm / 2;
        return off_mm <= cubic_share * allowed_mm_ || is_noise;
    }

    const PlaneCurve& curve_;
    double allowed_mm_;
};

}  // namespace

void fit_arcs(const PlaneCurve& curve, double from, double to, const Point2& start,
              const Point2& end, double allowed_mm, std::vector<Segment>& out) {
    const Sampler sampler(curve, allowed_mm);
    std::vector<CurvePoint> points{{start, curve(from).tangent}};
    CurvePoint here = points.front();
    for (int i = 1; i <= least_spans; ++i) {
        const double before = from + (to - from) * (i - 1) / least_spans;
        const double at = i < least_spans ? from + (to - from) * i / least_spans : to;
        CurvePoint next = curve(at);
        if (i == least_spans) next.point = end;
        sampler.append(before, here, at, next, 0, std::numeric_limits<double>::infinity(), points);
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
