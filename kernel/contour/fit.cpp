// Greedy: the longest biarc that stays within the bound, then on from its end. The step that was right last is
// the first guess for the next, so a curve of n biarcs costs a few n trials.
//
// Sampling. Along a biarc the signed deviation is a smooth function of the parameter, zero with its slope at both
// ends. Its extrema are taken from parabolas through neighbouring samples; what a parabola misses is of fourth
// order in the step, below one part in fifty of the extremum for these many samples (the test measures it).

#include "kernel/contour/fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

constexpr int fit_samples = 15;  // over both arcs of a biarc
constexpr double sampled_share = 0.98;

// A biarc may turn by less than a right angle: beyond that, equal tangent lengths make poor arcs.
constexpr double least_cosine_of_turn = 0.2;

// Bisection of the step ends when it is known to this share; finer gains no arcs.
constexpr double step_share = 1.0 / 64;

// A curve that asks for more bisections than this has a corner; it is then cut there by a chord.
constexpr int most_halvings = 40;

struct Biarc {
    Segment first, second;
};

// The sagitta of the arc over `chord` that leaves along `tangent`.
double sagitta_from_tangent(const Vector2& chord, const Vector2& tangent) {
    const double length = chord.norm();
    return length / 2 * cross(tangent, chord) / (length + tangent.dot(chord));
}

std::optional<Biarc> biarc_between(const CurvePoint& from, const CurvePoint& to) {
    const Vector2 chord = to.point - from.point, sum = from.tangent + to.tangent;
    const double turn = from.tangent.dot(to.tangent);
    if (!(turn > least_cosine_of_turn) || !(chord.dot(from.tangent) > 0) ||
        !(chord.dot(to.tangent) > 0)) {
        return std::nullopt;
    }
    // |chord - d (from + to)| = 2 d: the positive root, in the form that does not cancel.
    const double b = chord.dot(sum), c = chord.squaredNorm();
    const double d = c / (b + std::sqrt(b * b + 2 * (1 - turn) * c));
    const Point2 middle = 0.5 * (from.point + to.point + d * (from.tangent - to.tangent));
    return Biarc{{middle, sagitta_from_tangent(middle - from.point, from.tangent)},
                 {to.point, -sagitta_from_tangent(middle - to.point, -to.tangent)}};
}

// Measures points against a biarc: each against the arc on whose side of the joint it lies.
class BiarcGauge {
public:
    BiarcGauge(const Point2& start, const Biarc& biarc)
        : first_(carrier_of(start, biarc.first)),
          second_(carrier_of(biarc.first.end, biarc.second)),
          along_joint_(end_tangent(start, biarc.first)) {}

    double offset_mm(const Point2& point) const {
        const bool first = (point - second_.start).dot(along_joint_) < 0;
        return lyr::offset_mm(first ? first_ : second_, point);
    }

private:
    Carrier first_, second_;
    Vector2 along_joint_;
};

// The greatest deviation of the curve from the biarc between two parameters.
double deviation_mm(const PlaneCurve& curve, double from, double to, const Point2& start,
                    const Biarc& biarc) {
    const BiarcGauge gauge(start, biarc);
    std::array<double, fit_samples + 2> off{};  // zero at both ends
    for (int i = 1; i <= fit_samples; ++i) {
        const Point2 point = curve(from + (to - from) * i / (fit_samples + 1)).point;
        off[static_cast<std::size_t>(i)] = gauge.offset_mm(point);
    }
    double worst = 0;
    for (std::size_t i = 1; i + 1 < off.size(); ++i) {
        const double slope = (off[i + 1] - off[i - 1]) / 2;
        const double bend = off[i - 1] - 2 * off[i] + off[i + 1];
        // The vertex of the parabola through three neighbours, where it lies between them.
        const bool peak = std::abs(slope) < std::abs(bend);
        worst = std::max(worst, std::abs(peak ? off[i] - slope * slope / (2 * bend) : off[i]));
    }
    return worst;
}

// A biarc and the parameter that it reaches.
struct Reach {
    Biarc biarc;
    double to;
};

// The longest biarc from `from` towards `to`, first tried at `guess`; none where even the shortest does not fit.
std::optional<Reach> longest_biarc(const PlaneCurve& curve, double from, const CurvePoint& start,
                                   double guess, double to, const Point2& end, double bound_mm) {
    std::optional<Reach> best;
    double good = from, bad = std::numeric_limits<double>::infinity();
    double target = std::min(to, guess);
    for (int halvings = 0; halvings < most_halvings;) {
        CurvePoint goal = curve(target);
        if (target == to) goal.point = end;
        const auto biarc = biarc_between(start, goal);
        if (biarc && deviation_mm(curve, from, target, start.point, *biarc) <= bound_mm) {
            best = Reach{*biarc, target};
            good = target;
            if (good == to) break;
        } else {
            bad = target;
            ++halvings;
        }
        if (bad - good <= step_share * (good - from)) break;
        const double doubled = std::min(to, from + 2 * (good - from));
        target = good > from && doubled < bad ? doubled : (good + bad) / 2;
        // No parameter is left between the two.
        if (!(good < target && target < bad)) break;
    }
    return best;
}

}  // namespace

void fit_arcs(const PlaneCurve& curve, double from, double to, const Point2& start,
              const Point2& end, double allowed_mm, std::vector<Segment>& out) {
    const double bound_mm = allowed_mm * sampled_share;
    const double shortest = (to - from) * std::ldexp(1.0, -most_halvings);
    double at = from, step = to - from, chord = shortest;
    CurvePoint here{start, curve(from).tangent};
    while (at < to) {
        const auto reach = longest_biarc(curve, at, here, at + step, to, end, bound_mm);
        const double before = at;
        if (reach && reach->to > at) {
            out.push_back(reach->biarc.first);
            out.push_back(reach->biarc.second);
            at = reach->to;
            chord = shortest;
        } else {
            // A corner of the curve, or the last bits of its parameter: no tangent to keep, only the
            // point. Chords double until it is passed.
            for (; at == before; chord *= 2) at = std::min(to, at + chord);
            out.push_back({at == to ? end : curve(at).point, 0});
        }
        step = std::max(at - before, shortest);
        here = {out.back().end, curve(at).tangent};
    }
}

namespace {

// Whether the points strictly between two of them are as near to a biarc between these as is allowed. Between neighbours
// there is nothing to measure, but the curve does not bulge there.
bool holds(const Biarc& biarc, std::span<const CurvePoint> points, double allowed_mm) {
    if (points.size() == 2) {
        return std::abs(biarc.first.sagitta_mm) <= allowed_mm &&
               std::abs(biarc.second.sagitta_mm) <= allowed_mm;
    }
    const BiarcGauge gauge(points.front().point, biarc);
    return std::all_of(points.begin() + 1, points.end() - 1, [&](const CurvePoint& p) {
        return std::abs(gauge.offset_mm(p.point)) <= allowed_mm;
    });
}

struct PointReach {
    Biarc biarc;
    std::size_t last;
};

// The longest biarc from the first point, looked for from `guess` points ahead.
std::optional<PointReach> longest_biarc(std::span<const CurvePoint> points, std::size_t guess,
                                        double allowed_mm) {
    std::optional<PointReach> best;
    std::size_t good = 0, bad = points.size();
    for (std::size_t target = std::clamp<std::size_t>(guess, 1, points.size() - 1);
         good + 1 < bad;) {
        const auto biarc = biarc_between(points.front(), points[target]);
        if (biarc && holds(*biarc, points.first(target + 1), allowed_mm)) {
            best = PointReach{*biarc, target};
            good = target;
        } else {
            bad = target;
        }
        const std::size_t doubled = std::min(2 * good, points.size() - 1);
        target = doubled > good && doubled < bad ? doubled : good + (bad - good) / 2;
    }
    return best;
}

// What is straight to the model's own resolution is a line.
Segment straightened(Segment segment) {
    if (std::abs(segment.sagitta_mm) <= resolution_mm) segment.sagitta_mm = 0;
    return segment;
}

void fit_smooth(std::span<const CurvePoint> points, double allowed_mm, std::vector<Segment>& out) {
    std::size_t guess = points.size();
    while (points.size() > 1) {
        const auto reach = longest_biarc(points, guess, allowed_mm);
        if (reach) {
            out.push_back(straightened(reach->biarc.first));
            out.push_back(straightened(reach->biarc.second));
            guess = reach->last;
        } else {
            out.push_back({points[1].point, 0});
            guess = 1;
        }
        points = points.subspan(guess);
    }
}

}  // namespace

void fit_arcs(std::span<const CurvePoint> points, double allowed_mm, std::vector<Segment>& out) {
    for (std::size_t first = 0; first + 1 < points.size();) {
        std::size_t last = first + 1;
        while (last + 1 < points.size() && points[last + 1].point != points[last].point) ++last;
        fit_smooth(points.subspan(first, last - first + 1), allowed_mm, out);
        first = last + 1;
    }
}

}  // namespace lyr
