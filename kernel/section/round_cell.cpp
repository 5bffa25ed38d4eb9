// With c = cos(u - u0), where u0 is the angle around the axis at which the surface looks up most, l the lean of the axis
// and a its rise, normal and height are
//
//   cylinder  n = l c                      z = o + r l c + v a
//   cone      n = cos(t) l c - sin(t) a    z = o' + (v - v') (a + tan(t) l c)    o' and v' of the apex
//   torus     n = cos(v) l c + sin(v) a    z = o + (R + r cos(v)) l c + r sin(v) a
//
// and bounds of them follow from those of c, cos(v) and sin(v).

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/constants.h"
#include "kernel/section/parameter_cell.h"

namespace lyr {
namespace {

constexpr double quarter_turn_rad = full_turn_rad / 4;

using Interval = RoundCell::Interval;

double width(const Interval& a) {
    return a.high - a.low;
}
double magnitude(const Interval& a) {
    return std::max(std::abs(a.low), std::abs(a.high));
}
Interval operator+(const Interval& a, const Interval& b) {
    return {a.low + b.low, a.high + b.high};
}
Interval operator+(double a, const Interval& b) {
    return {a + b.low, a + b.high};
}
Interval operator*(double a, const Interval& b) {
    return a < 0 ? Interval{a * b.high, a * b.low} : Interval{a * b.low, a * b.high};
}
Interval operator*(const Interval& a, const Interval& b) {
    const auto [low, high] =
        std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
    return {low, high};
}

Interval cosine_of(double from, double to) {
    const auto [low, high] = std::minmax({std::cos(from), std::cos(to)});
    const auto passes = [&](double at) {
        return std::floor((to - at) / full_turn_rad) > std::floor((from - at) / full_turn_rad);
    };
    return {passes(std::numbers::pi) ? -1 : low, passes(0) ? 1 : high};
}

}  // namespace

RoundCell::RoundCell(const Surface& surface, const CellRect& rect) : form_{}, rect_(rect) {
    const auto lay = [&](const Frame& frame, Form::Kind kind, double radius_mm) {
        form_.kind = kind;
        form_.origin_mm = frame.origin.z();
        form_.lean = std::hypot(frame.x.z(), frame.y.z());
        form_.rise = frame.z.z();
        form_.around_rad = std::atan2(frame.y.z(), frame.x.z());
        form_.radius_mm = radius_mm;
    };
    if (const auto* cylinder = std::get_if<Cylinder>(&surface)) {
        lay(cylinder->frame, Form::Kind::cylinder, cylinder->radius_mm);
    } else if (const auto* cone = std::get_if<Cone>(&surface)) {
        lay(cone->frame, Form::Kind::cone, cone->radius_mm);
        form_.sine = std::sin(cone->half_angle_rad);
        form_.cosine = std::cos(cone->half_angle_rad);
    } else {
        const Torus& torus = std::get<Torus>(surface);
        lay(torus.frame, Form::Kind::torus, torus.major_mm);
        form_.tube_mm = torus.minor_mm;
    }
}

double RoundCell::normal_z(const Point2& uv) const {
    const Form& f = form_;
    const double up = f.lean * std::cos(uv.x() - f.around_rad), v = uv.y();
    switch (f.kind) {
        case Form::Kind::cylinder:
            return up;
        case Form::Kind::cone:
            return f.cosine * up - f.sine * f.rise;
        case Form::Kind::torus:
            break;
    }
    return std::cos(v) * up + std::sin(v) * f.rise;
}

RoundCell::Terms RoundCell::terms() const {
    const Form& f = form_;
    const double from = rect_.low.x() - f.around_rad, to = rect_.high.x() - f.around_rad;
    const Interval up = f.lean * cosine_of(from, to), v{rect_.low.y(), rect_.high.y()};
    switch (f.kind) {
        case Form::Kind::cylinder:
            return {up,
                    f.radius_mm * up + f.rise * v,
                    {width(up), 0},
                    {f.radius_mm * width(up), std::abs(f.rise) * width(v)}};
        case Form::Kind::cone: {
            const double slope = f.sine / f.cosine, apex = -f.radius_mm / slope;
            const Interval along = f.rise + slope * up, from_apex = -apex + v;
            return {-f.sine * f.rise + f.cosine * up,
                    f.rise * apex + from_apex * along,
                    {width(up), 0},
                    {slope * magnitude(from_apex) * width(up), magnitude(along) * width(v)}};
        }
        case Form::Kind::torus:
            break;
    }
    const Interval cosine = cosine_of(v.low, v.high);
    const Interval sine = cosine_of(v.low - quarter_turn_rad, v.high - quarter_turn_rad);
    const Interval normal = cosine * up + f.rise * sine;
    const Vector2 varies(magnitude(cosine) * width(up),
                         magnitude(up) * width(cosine) + std::abs(f.rise) * width(sine));
    return {normal, f.radius_mm * up + f.tube_mm * normal, varies,
            f.tube_mm * varies + Vector2(f.radius_mm * width(up), 0)};
}

CellBounds RoundCell::bounds() const {
    const auto [normal, height, by_normal, by_height] = terms();
    const double most = std::max(-normal.low, normal.high);
    return {.bottom_mm = form_.origin_mm + height.low,
            .top_mm = form_.origin_mm + height.high,
            .least = std::max({0.0, normal.low, -normal.high}),
            .mean = std::abs(normal_z(rect_.middle())),
            .most = most};
}

std::array<RoundCell, 2> RoundCell::halves(CellMeasure by) const {
    const Terms all = terms();
    const Vector2 varies = by == CellMeasure::height ? all.height_varies : all.normal_varies;
    const Eigen::Index along = varies.y() > varies.x() ? 1 : 0;
    std::array<RoundCell, 2> result{*this, *this};
    result[0].rect_.high[along] = result[1].rect_.low[along] = rect_.middle()[along];
    return result;
}

}  // namespace lyr
