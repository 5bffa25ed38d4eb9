// The torus. In the basis whose `across` falls along the lean, a point at (u about the axis, v about the tube)
// has the height  rise * minor * sin v - lean * (major + minor cos v) * cos u  over the centre. Solved for the
// plane's height h:
//     cos u = q(v) = (rise * minor * sin v - h) / (lean * (major + minor cos v)),
// so the section is two mirrored branches u = +-acos q(v) over the intervals of v where |q| <= 1. An interval's
// ends, q = +-1, solve  minor * sin(v -+ phi) = h +- lean * major  with tan phi = lean / rise: closed form. At an
// end the branches meet; with v = middle - half * cos(theta) both are smooth in theta, and one key goes round.
// Along z x n, v rises where u < 0 and falls where u > 0; so too on an inner sheet, where the reach
// major + minor cos v is negative and the point lies opposite to u, since both turn.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/section/surface_section.h"

namespace lyr {
namespace {

using std::numbers::pi;

double cosine_about_axis(const TorusSection& torus, double v) {
    const double reach = torus.major_mm + torus.minor_mm * std::cos(v);
    return (torus.basis.rise * torus.minor_mm * std::sin(v) - torus.height_mm) /
           (torus.basis.lean * reach);
}

// Appends the solutions of sin(v - shift) = value in (-pi, pi].
void append_roots(double value, double shift, std::vector<double>& roots) {
    if (std::abs(value) > 1) return;
    const double root = std::asin(value);
    roots.push_back(std::remainder(root + shift, 2 * pi));
    roots.push_back(std::remainder(pi - root + shift, 2 * pi));
}

void find_components(TorusSection& torus) {
    const double phi = std::atan2(torus.basis.lean, torus.basis.rise);
    const double over = torus.basis.lean * torus.major_mm;
    std::vector<double> ends;
    append_roots((torus.height_mm + over) / torus.minor_mm, phi, ends);
    append_roots((torus.height_mm - over) / torus.minor_mm, -phi, ends);
    std::sort(ends.begin(), ends.end());
    const auto inside = [&](double v) {
        const bool beyond_axis = torus.major_mm + torus.minor_mm * std::cos(v) < 0;
        return beyond_axis == torus.inner_sheet && std::abs(cosine_about_axis(torus, v)) < 1;
    };
    if (ends.empty()) {
        torus.both_ways = inside(0);
        torus.count = torus.both_ways ? 2 : 0;
        return;
    }
    for (std::size_t i = 0; i < ends.size() && torus.count < 2; ++i) {
        const double from = ends[i], to = i + 1 < ends.size() ? ends[i + 1] : ends[0] + 2 * pi;
        if (to <= from || !inside((from + to) / 2)) continue;
        const auto c = static_cast<std::size_t>(torus.count++);
        torus.from_rad[c] = from;
        torus.to_rad[c] = to;
    }
}

SurfaceSection level_circles(const Torus& torus, bool same_sense, double height_mm) {
    const Point2 centre = torus.frame.origin.head<2>();
    const double half2 = (torus.minor_mm - height_mm) * (torus.minor_mm + height_mm);
    // The two circles are one: the plane touches the tube's top or bottom.
    if (half2 <= resolution_mm * resolution_mm) return TouchSection{};
    const double half = std::sqrt(half2);
    if (torus.inner_sheet) {
        if (half <= torus.major_mm) return TouchSection{};
        return CircleSection{centre, 1, {half - torus.major_mm, 0}, {same_sense, false}, 0};
    }
    // Beyond the axis the inner circle would be on the tube's other sheet.
    const int count = half > torus.major_mm ? 1 : 2;
    return CircleSection{centre,
                         count,
                         {torus.major_mm + half, torus.major_mm - half},
                         {same_sense, !same_sense},
                         torus.major_mm};
}

// How far, in the tube's angle, a point is from a component's interval.
double outside(const TorusSection& torus, std::size_t component, double v) {
    const double middle = (torus.from_rad[component] + torus.to_rad[component]) / 2;
    const double half = (torus.to_rad[component] - torus.from_rad[component]) / 2;
    return std::abs(std::remainder(v - middle, 2 * pi)) - half;
}

}  // namespace

SurfaceSection torus_section(const Torus& torus, bool same_sense, double z_mm, double extent_mm) {
    const double height = z_mm - torus.frame.origin.z();
    const Vector3 axis = torus.frame.z.z() < 0 ? Vector3(-torus.frame.z) : torus.frame.z;
    if (std::hypot(axis.x(), axis.y()) * extent_mm <= resolution_mm) {
        return level_circles(torus, same_sense, height);
    }
    TorusSection section{torus.frame.origin,
                         leaning_basis(axis),
                         torus.major_mm,
                         torus.minor_mm,
                         torus.inner_sheet,
                         height,
                         same_sense ? 1.0 : -1.0,
                         0,
                         false,
                         {},
                         {}};
    find_components(section);
    if (section.count == 0) return TouchSection{};
    return section;
}

Place locate(const TorusSection& torus, const CrossingPoint& crossing) {
    const Vector3 offset = crossing.point - torus.centre;
    // Beyond the axis the tube's centre is on the other side.
    const double side = torus.inner_sheet ? -1 : 1;
    const double x = offset.dot(torus.basis.across), y = side * offset.dot(torus.basis.side);
    const double v =
        std::atan2(offset.dot(torus.basis.axis), side * std::hypot(x, y) - torus.major_mm);
    const bool positive = y > 0;
    if (torus.both_ways) return {positive ? 0 : 1, torus.sense * (positive ? -v : v)};
    const std::size_t c = torus.count == 2 && outside(torus, 1, v) < outside(torus, 0, v) ? 1 : 0;
    const double middle = (torus.from_rad[c] + torus.to_rad[c]) / 2;
    const double half = (torus.to_rad[c] - torus.from_rad[c]) / 2;
    const double share = std::clamp(-std::remainder(v - middle, 2 * pi) / half, -1.0, 1.0);
    const double theta = std::acos(share);
    return {static_cast<int>(c), torus.sense * (positive ? -theta : theta)};
}

CurvePoint at(const TorusSection& torus, const Place& place) {
    const double key = std::remainder(torus.sense * place.key, 2 * pi);
    double v = 0;
    bool positive = false;
    if (torus.both_ways) {
        positive = place.component == 0;
        v = positive ? -key : key;
    } else {
        const auto c = static_cast<std::size_t>(place.component);
        const double half = (torus.to_rad[c] - torus.from_rad[c]) / 2;
        v = (torus.from_rad[c] + torus.to_rad[c]) / 2 - half * std::cos(key);
        positive = key < 0;
    }
    const double cosine = std::clamp(cosine_about_axis(torus, v), -1.0, 1.0);
    const double sine = (positive ? 1 : -1) * std::sqrt((1 - cosine) * (1 + cosine));
    const Vector3 radial = cosine * torus.basis.across + sine * torus.basis.side;
    const Vector3 outward = std::cos(v) * radial + std::sin(v) * torus.basis.axis;
    const Point3 point = torus.centre + torus.major_mm * radial + torus.minor_mm * outward;
    const Vector2 tangent = torus.sense * Vector2(-outward.y(), outward.x());
    return {point.head<2>(), tangent.normalized()};
}

}  // namespace lyr
