#include "target/run/reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace lyr::run {
namespace {

// Ends that are exactly on the limit must not fail by the rounding of a centre: far below a step.
constexpr double rounding_mm = 1e-6;

double off_mm(const AxisValues& point_mm) {
    return std::hypot(point_mm[config::axis_x], point_mm[config::axis_y]);
}

}  // namespace

double farthest_mm(const PathCurve& curve) {
    const double ends_mm = std::max(off_mm(curve.from_mm), off_mm(curve.to_mm));
    if (!curve.is_arc) return ends_mm;
    // A circle is farthest away where its radius points away from the middle.
    const double away_rad = std::atan2(curve.center_y_mm, curve.center_x_mm);
    constexpr double turn_rad = 2 * std::numbers::pi;
    const double ahead_rad = (away_rad - curve.start_angle_rad) * (curve.sweep_rad < 0 ? -1 : 1);
    const double first_rad = ahead_rad - turn_rad * std::floor(ahead_rad / turn_rad);
    if (first_rad > std::abs(curve.sweep_rad)) return ends_mm;
    return std::hypot(curve.center_x_mm, curve.center_y_mm) + curve.radius_mm;
}

Status check_reach(const PathCurve& curve, const std::string& path,
                   const config::Printer& printer) {
    if (printer.kinematics != config::Kinematics::delta) return Done{};
    const double reached_mm = farthest_mm(curve);
    if (!(reached_mm > printer.delta.reach_mm + rounding_mm)) return Done{};
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  "the path goes %.3f mm from the middle of the bed; the arms reach %g mm "
                  "(delta.reach_mm of the printer)",
                  reached_mm, printer.delta.reach_mm);
    Diagnostic error = machine_error(text.data());
    error.where.file = path;
    error.where.layer = static_cast<int>(curve.layer) + 1;
    return error;
}

}  // namespace lyr::run
