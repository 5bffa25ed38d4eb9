#include "kernel/region/sliver.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/region/winding_count.h"

namespace lyr::region {
namespace {

// Of a curve's half length, where a contour's width is looked at.
constexpr std::array<double, 5> places{-0.9, -0.5, 0, 0.5, 0.9};

// A disc touches the contour where it comes this near to it, of its radius; nearer, it is cut.
constexpr double touching_share = 0.999;

}  // namespace

bool is_sliver(const Contour& contour, double width_mm) {
    const double area = area_mm2(contour);
    // Cheaper, and so for most: on average it is wider.
    if (2 * std::abs(area) > width_mm * length_mm(contour)) return false;
    const Input input{&contour};
    const std::vector<Source> sources = sources_of({&input, 1});
    const WindingCount count({&input, 1}, sources);
    const double radius = width_mm / 2, inwards = area > 0 ? radius : -radius;
    const auto fits = [&](const Curve& at, double share) {
        const Vector2 tangent = tangent_at(at, share * at.half_mm);
        const Point2 centre = point_on(at, share * at.half_mm) + inwards * left_of(tangent);
        return !count.is_near(centre, touching_share * radius) && !(count.at(centre) == Winding{});
    };
    return std::none_of(sources.begin(), sources.end(), [&](const Source& source) {
        return std::any_of(places.begin(), places.end(),
                           [&](double share) { return fits(source.curve, share); });
    });
}

}  // namespace lyr::region
