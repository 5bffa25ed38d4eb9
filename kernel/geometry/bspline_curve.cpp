// B-spline curves by de Boor's algorithm and blossoms.
//
// Values and derivatives come from de Boor's triangle, in homogeneous coordinates when rational. Questions about a
// whole stretch (where does the height turn, which point is nearest) are asked of the Bezier pieces, whose
// coefficients bound them: no sampling density decides whether an answer is found.

#include "kernel/geometry/bspline_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kernel/geometry/bernstein.h"
#include "kernel/geometry/height_turns.h"
#include "kernel/geometry/root.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {

namespace {

using bernstein::Coefficients;
using Homogeneous = Eigen::Vector4d;

// Splines of a higher degree than any modeller writes still work, from the heap.
constexpr std::size_t usual_order = 12;

// de Boor's triangle for the span that holds an argument.
template <class Value>
class Triangle {
public:
    template <class Control>
    Triangle(const BSplineCurve& curve, std::size_t span, const Control& control)
        : knots_(curve.knots.data() + span), degree_(static_cast<std::size_t>(curve.degree)) {
        if (degree_ + 1 > usual_order) heap_.resize(degree_ + 1);
        Value* const d = row();
        for (std::size_t i = 0; i <= degree_; ++i) d[i] = control(span - degree_ + i);
    }

    // One level of the blossom: its argument number `level` (from 1) is t.
    void apply(std::size_t level, double t) {
        Value* const d = row();
        for (std::size_t i = degree_; i >= level; --i) {
            const double low = *(knots_ + i - degree_);
            const double high = *(knots_ + i + 1 - level);
            const double alpha = (t - low) / (high - low);
            d[i] = (1 - alpha) * d[i - 1] + alpha * d[i];
        }
    }

    // The value and, from the level before the last, the derivative at t.
    std::pair<Value, Value> value_and_derivative(double t) {
        for (std::size_t level = 1; level < degree_; ++level) apply(level, t);
        const Value* const d = row();
        const Value slope = (static_cast<double>(degree_) / (knots_[1] - knots_[0])) *
                            (d[degree_] - d[degree_ - 1]);
        apply(degree_, t);
        return {row()[degree_], slope};
    }

    const Value& top() { return row()[degree_]; }

private:
    Value* row() { return heap_.empty() ? stack_.data() : heap_.data(); }

    const double* knots_;  // of the span's start
    std::size_t degree_;
    std::array<Value, usual_order> stack_;
    std::vector<Value> heap_;
};

// The span [knots[k], knots[k + 1]) that holds t, never an empty one.
std::size_t span_of(const BSplineCurve& curve, double t) {
    const auto first = curve.knots.begin() + curve.degree;
    const auto last =
        curve.knots.begin() + static_cast<std::ptrdiff_t>(curve.control_points.size());
    auto above = std::upper_bound(first, last, t);
    // At the domain's end: the last span that is not empty.
    if (above == last) above = std::lower_bound(first, last, *last);
    return static_cast<std::size_t>(std::max(above - 1, first) - curve.knots.begin());
}

double into_domain(const BSplineCurve& curve, double t) {
    const double start = curve.domain_start(), end = curve.domain_end();
    if (t >= start && t <= end) return t;
    if (!curve.closed) return std::clamp(t, start, end);
    const double length = end - start;
    const double turns = std::floor((t - start) / length);
    return std::clamp(t - turns * length, start, end);
}

Homogeneous homogeneous(const BSplineCurve& curve, std::size_t i) {
    const Point3& p = curve.control_points[i];
    if (curve.weights.empty()) return {p.x(), p.y(), p.z(), 1.0};
    const double w = curve.weights[i];
    return {w * p.x(), w * p.y(), w * p.z(), w};
}

// {height over `base`, its derivative}; heights are taken relative to lose no digits to the quotient.
std::pair<double, double> height_and_slope(const BSplineCurve& curve, double parameter,
                                           double base_mm) {
    const double t = into_domain(curve, parameter);
    const std::size_t span = span_of(curve, t);
    if (curve.weights.empty()) {
        Triangle<double> triangle(
            curve, span, [&](std::size_t i) { return curve.control_points[i].z() - base_mm; });
        return triangle.value_and_derivative(t);
    }
    Triangle<Vector2> triangle(curve, span, [&](std::size_t i) -> Vector2 {
        return {curve.weights[i] * (curve.control_points[i].z() - base_mm), curve.weights[i]};
    });
    const auto [value, slope] = triangle.value_and_derivative(t);
    const double height = value.x() / value.y();
    return {height, (slope.x() - slope.y() * height) / value.y()};
}

void append_pieces(const BSplineCurve& curve, double from, double to,
                   std::vector<BezierPiece>& pieces) {
    const auto degree = static_cast<std::size_t>(curve.degree);
    for (std::size_t span = degree; span < curve.control_points.size(); ++span) {
        const double a = std::max(from, curve.knots[span]);
        const double b = std::min(to, curve.knots[span + 1]);
        if (!(a < b)) continue;
        BezierPiece piece{a, b, std::vector<Homogeneous>(degree + 1)};
        Triangle<Homogeneous> to_b(curve, span,
                                   [&](std::size_t i) { return homogeneous(curve, i); });
        for (std::size_t i = 0; i <= degree; ++i) {
            if (i > 0) to_b.apply(i, b);
            Triangle<Homogeneous> blossom = to_b;
            for (std::size_t level = i + 1; level <= degree; ++level) blossom.apply(level, a);
            piece.control_points[i] = blossom.top();
        }
        pieces.push_back(std::move(piece));
    }
}

Coefficients component(const BezierPiece& piece, Eigen::Index row, double base) {
    Coefficients c(piece.control_points.size());
    for (std::size_t i = 0; i < c.size(); ++i) {
        c[i] = piece.control_points[i][row] - base * piece.control_points[i].w();
    }
    return c;
}

// Whether the control points only rise or only fall: so does the curve then, which meets no plane more often than they do.
bool is_plainly_monotone(const BezierPiece& piece) {
    bool rises = true, falls = true;
    double before = piece.control_points.front().z() / piece.control_points.front().w();
    for (const Homogeneous& control : piece.control_points) {
        const double height = control.z() / control.w();
        rises = rises && height >= before;
        falls = falls && height <= before;
        before = height;
    }
    return rises || falls;
}

// Parameters inside the piece between which the height is monotone. With z = Z/w, z' has the sign of Z'w - Zw'.
std::vector<double> turning_candidates(const BezierPiece& piece) {
    if (is_plainly_monotone(piece)) return {};
    const double base = piece.control_points.front().z() / piece.control_points.front().w();
    const Coefficients z = component(piece, 2, base), w = component(piece, 3, 0);
    const Coefficients slope =
        bernstein::difference(bernstein::product(bernstein::derivative(z), w),
                              bernstein::product(z, bernstein::derivative(w)));
    // Inside a group of roots across which the height changes by less than this, which of them is reported does
    // not matter: height_turns() ignores turns a thousand times larger.
    constexpr double negligible_mm = resolution_mm / 1000;
    const double smallest_w = *std::min_element(w.begin(), w.end());
    const auto negligible = [&](const Coefficients& c, double width) {
        const auto [low, high] = std::minmax_element(c.begin(), c.end());
        return std::max(-*low, *high) * width <= negligible_mm * smallest_w * smallest_w;
    };
    std::vector<double> parameters = bernstein::isolate(slope, negligible);
    for (double& t : parameters) t = piece.from + (piece.to - piece.from) * t;
    return parameters;
}

// The squared distance to a point along (part of) a Bezier piece: numerator over w^2, and the numerator of its
// derivative, all in Bernstein form so that halving keeps them.
struct DistanceField {
    double from, to;
    Coefficients numerator, denominator, slope;
};

DistanceField distance_field(const BezierPiece& piece, const Point3& point) {
    const Coefficients w = component(piece, 3, 0);
    Coefficients numerator(2 * w.size() - 1, 0.0);
    for (Eigen::Index row = 0; row < 3; ++row) {
        const Coefficients offset = component(piece, row, point[row]);
        const Coefficients square = bernstein::product(offset, offset);
        for (std::size_t i = 0; i < square.size(); ++i) numerator[i] += square[i];
    }
    // d/dt (N / w^2) has the sign of N'w - 2Nw'.
    Coefficients twice_w_slope = bernstein::derivative(w);
    for (double& c : twice_w_slope) c *= 2;
    Coefficients slope =
        bernstein::difference(bernstein::product(bernstein::derivative(numerator), w),
                              bernstein::product(numerator, twice_w_slope));
    return {piece.from, piece.to, std::move(numerator), bernstein::product(w, w), std::move(slope)};
}

double lower_bound_mm(const DistanceField& field) {
    double bound = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < field.numerator.size(); ++i) {
        bound = std::min(bound, field.numerator[i] / field.denominator[i]);
    }
    return std::sqrt(std::max(bound, 0.0));
}

// Distance to the box of the piece's control points.
double box_distance_mm(const BezierPiece& piece, const Point3& point) {
    Eigen::AlignedBox3d box;
    for (const Homogeneous& c : piece.control_points) box.extend(Point3(c.head<3>() / c.w()));
    return box.exteriorDistance(point);
}

class NearestPoint {
public:
    NearestPoint(const BSplineCurve& curve, const Point3& point) : curve_(curve), point_(point) {}

    void try_parameter(double t) {
        const double distance = (evaluate(curve_, t) - point_).norm();
        if (distance < distance_mm_) {
            distance_mm_ = distance;
            parameter_ = t;
        }
    }

    // Newton on (C - P) . C' with C'' left out (Gauss-Newton): what the Bernstein root lacks in digits.
    void polish() {
        constexpr int max_steps = 8;
        for (int i = 0; i < max_steps; ++i) {
            const auto [position, tangent] = point_and_tangent(curve_, parameter_);
            const double square = tangent.squaredNorm();
            if (square == 0) return;
            const double before = distance_mm_;
            const double step = (point_ - position).dot(tangent) / square;
            try_parameter(
                std::clamp(parameter_ + step, curve_.domain_start(), curve_.domain_end()));
            if (!(distance_mm_ < before)) return;
        }
    }

    // Branch and bound over one piece. The distance has a single minimum where its slope changes sign once.
    void search(const DistanceField& field) {
        if (lower_bound_mm(field) >= distance_mm_ - gain_mm) return;
        const int variations = bernstein::sign_variations(field.slope);
        const double width = field.to - field.from;
        if (variations == 0) return;  // nearest at an end, which has been tried
        if (variations == 1) {
            try_parameter(field.from + width * bernstein::single_root(field.slope));
            return;
        }
        const double middle = 0.5 * (field.from + field.to);
        try_parameter(middle);
        if (width <= smallest_width_ * (curve_.domain_end() - curve_.domain_start())) return;
        auto numerator = bernstein::split(field.numerator, 0.5);
        auto denominator = bernstein::split(field.denominator, 0.5);
        auto slope = bernstein::split(field.slope, 0.5);
        search({field.from, middle, std::move(numerator.first), std::move(denominator.first),
                std::move(slope.first)});
        search({middle, field.to, std::move(numerator.second), std::move(denominator.second),
                std::move(slope.second)});
    }

    double distance_mm() const { return distance_mm_; }
    double parameter() const { return parameter_; }

    // A part of the curve that is nearer by less than this is not looked for.
    static constexpr double gain_mm = resolution_mm / 1000;

private:
    // Of the domain: halving beyond this meets the spacing of doubles.
    static constexpr double smallest_width_ = 1e-15;

    const BSplineCurve& curve_;
    Point3 point_;
    double distance_mm_ = std::numeric_limits<double>::infinity();
    double parameter_ = 0;
};

}  // namespace

PointAndTangent point_and_tangent(const BSplineCurve& curve, double parameter) {
    const double t = into_domain(curve, parameter);
    const std::size_t span = span_of(curve, t);
    if (curve.weights.empty()) {
        Triangle<Vector3> triangle(
            curve, span, [&](std::size_t i) -> const Point3& { return curve.control_points[i]; });
        const auto [point, tangent] = triangle.value_and_derivative(t);
        return {point, tangent};
    }
    Triangle<Homogeneous> triangle(curve, span,
                                   [&](std::size_t i) { return homogeneous(curve, i); });
    const auto [value, slope] = triangle.value_and_derivative(t);
    const Point3 point = value.head<3>() / value.w();
    return {point, (slope.head<3>() - slope.w() * point) / value.w()};
}

Point3 evaluate(const BSplineCurve& curve, double t) {
    return point_and_tangent(curve, t).point;
}

Vector3 derivative(const BSplineCurve& curve, double t) {
    return point_and_tangent(curve, t).tangent;
}

std::vector<BezierPiece> bezier_pieces(const BSplineCurve& curve, double from, double to) {
    std::vector<BezierPiece> pieces;
    append_pieces(curve, from, to, pieces);
    return pieces;
}

double invert(const BSplineCurve& curve, const Point3& point) {
    const std::vector<BezierPiece> pieces =
        bezier_pieces(curve, curve.domain_start(), curve.domain_end());
    NearestPoint nearest(curve, point);
    nearest.try_parameter(curve.domain_start());
    std::vector<std::pair<double, const BezierPiece*>> order;
    for (const BezierPiece& piece : pieces) {
        nearest.try_parameter(piece.to);
        order.emplace_back(box_distance_mm(piece, point), &piece);
    }
    nearest.polish();
    std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
        return a.first != b.first ? a.first < b.first : a.second->from < b.second->from;
    });
    for (const auto& [bound, piece] : order) {
        if (bound >= nearest.distance_mm() - NearestPoint::gain_mm) break;
        nearest.search(distance_field(*piece, point));
    }
    nearest.polish();
    return nearest.parameter();
}

std::vector<double> height_extrema(const BSplineCurve& curve, double from, double to) {
    const double low = std::min(from, to), high = std::max(from, to);
    const double start = curve.domain_start(), length = curve.domain_end() - start;
    std::vector<HeightSample> samples;
    const auto sample = [&](double t) {
        samples.push_back({t, height_and_slope(curve, t, 0).first});
    };
    sample(low);
    const double first_turn = curve.closed ? std::floor((low - start) / length) : 0;
    const double last_turn = curve.closed ? std::floor((high - start) / length) : 0;
    for (double turn = first_turn; turn <= last_turn; ++turn) {
        const double shift = turn * length;
        const double a = std::max(start, low - shift), b = std::min(start + length, high - shift);
        for (const BezierPiece& piece : bezier_pieces(curve, a, b)) {
            for (const double t : turning_candidates(piece)) sample(t + shift);
            sample(piece.to + shift);  // a kink, where pieces meet, may be a turn as well
        }
    }
    sample(high);
    std::vector<double> turns = height_turns(samples);
    std::erase_if(turns, [&](double t) { return !(t > low && t < high); });
    if (from > to) std::reverse(turns.begin(), turns.end());
    return turns;
}

double parameter_at_height(const BSplineCurve& curve, double from, double to, double z_mm) {
    const double at_from = height_and_slope(curve, from, z_mm).first;
    const double at_to = height_and_slope(curve, to, z_mm).first;
    if (at_from == 0) return from;
    if (at_to == 0) return to;
    if ((at_from > 0) == (at_to > 0)) return std::abs(at_from) <= std::abs(at_to) ? from : to;
    // Tighter than the contract: the last step of Newton's method gains it for nothing.
    constexpr double height_tolerance_mm = resolution_mm / 10000;
    const double guess = from + (to - from) * (at_from / (at_from - at_to));
    const auto f = [&](double t) { return height_and_slope(curve, t, z_mm); };
    return bracketed_root(f, from, to, at_from > 0, guess, height_tolerance_mm);
}

}  // namespace lyr
