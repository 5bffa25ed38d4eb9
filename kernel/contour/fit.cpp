// Greedy: the longest biarc that stays within the bound, then on from its end. The step that was right last is
// the first guess for the next, so a curve of n biarcs costs a few n trials.
//
// Sampling. On each arc the deviation d(t) is smooth, zero at both ends. With n interior samples the true
// extremum lies at most half a sample step from a sample; a parabola through its neighbourhood falls off by
// (1 / (n + 1))^2 of the extremum there. The bound is lowered by that share.

#include "kernel/contour/fit.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lyr {
namespace {

constexpr int fit_samples = 12;  // over both arcs of a biarc
constexpr double sampled_share = 1 - 4.0 / ((fit_samples + 1) * (fit_samples + 1));

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

bool within(const PlaneCurve& curve, double from, double to, const Point2& start,
            const Biarc& biarc, double allowed_mm) {
    for (int i = 1; i <= fit_samples; ++i) {
        const Point2 point = curve(from + (to - from) * i / (fit_samples + 1)).point;
        const double off_first = distance_mm(start, biarc.first, point);
        if (off_first <= allowed_mm) continue;
        if (!(distance_mm(biarc.first.end, biarc.second, point) <= allowed_mm)) return false;
    }
    return true;
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
    double good = from, bad = to + (to - from) * step_share, target = std::min(to, guess);
    for (int halvings = 0; halvings < most_halvings;) {
        CurvePoint goal = curve(target);
        if (target == to) goal.point = end;
        const auto biarc = biarc_between(start, goal);
        if (biarc && within(curve, from, target, start.point, *biarc, bound_mm)) {
            best = Reach{*biarc, target};
            good = target;
            if (good == to) break;
        } else {
            bad = target;
            ++halvings;
        }
        if (good > from && bad - good <= step_share * (good - from)) break;
        const double doubled = from + 2 * (good - from);
        target = good > from && doubled < bad ? std::min(doubled, to) : (good + bad) / 2;
        if (target >= to && bad <= to) target = (good + bad) / 2;
    }
    return best;
}

}  // namespace

void fit_arcs(const PlaneCurve& curve, double from, double to, const Point2& start,
              const Point2& end, double allowed_mm, std::vector<Segment>& out) {
    const double bound_mm = allowed_mm * sampled_share;
    const double shortest = (to - from) * std::ldexp(1.0, -most_halvings);
    double at = from, step = to - from;
    CurvePoint here{start, curve(from).tangent};
    while (at < to) {
        const auto reach = longest_biarc(curve, at, here, at + step, to, end, bound_mm);
        const double before = at;
        if (reach) {
            out.push_back(reach->biarc.first);
            out.push_back(reach->biarc.second);
            at = reach->to;
        } else {
            // A corner of the curve: no tangent to keep, only the point.
            at = std::min(to, at + shortest);
            out.push_back({at == to ? end : curve(at).point, 0});
        }
        step = std::max(at - before, shortest);
        here = {out.back().end, curve(at).tangent};
    }
}

}  // namespace lyr
