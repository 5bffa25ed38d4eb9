#include "format/import/gcode_strand.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lyr::format {
namespace {

// As the file has them (layout of a path): 0.1 um and 0.00001.
double rounded(double value, double per_unit) {
    return std::round(value * per_unit) / per_unit;
}
constexpr double widths_per_mm = 1e4, flows_per_unit = 1e5;

// The width of a strand of so much cross-section; the inverse of cross_section_mm2.
double width_for(double area_mm2, double height_mm) {
    constexpr double quarter_pi = std::numbers::pi / 4;
    const double round_mm2 = quarter_pi * height_mm * height_mm;
    if (area_mm2 < round_mm2) return area_mm2 / (quarter_pi * height_mm);
    return (area_mm2 - round_mm2) / height_mm + height_mm;
}

}  // namespace

double length_mm(const GcodeGo& go) {
    const double flat =
        go.sweep_rad == 0
            ? std::hypot(go.to.x - go.from.x, go.to.y - go.from.y)
            : std::abs(go.sweep_rad) * std::hypot(go.from.x - go.center_x, go.from.y - go.center_y);
    return std::hypot(flat, go.to.z - go.from.z);
}

PathStyle style_of(const GcodeGo& go, double length_mm, double layer_height_mm,
                   double filament_area_mm2, const PathStyle& last) {
    PathStyle style{
        .role = go.role,
        .width_mm = rounded(go.width_mm, widths_per_mm),
        .height_mm = rounded(go.height_mm > 0 ? go.height_mm : layer_height_mm, widths_per_mm),
        .flow = 1,
        .speed_mm_s = go.speed_mm_s,
        .acceleration_mm_s2 = std::round(go.acceleration_mm_s2)};
    const auto fits = [&](const PathStyle& candidate) {
        const double filament_mm = length_mm * cross_section_mm2(candidate) / filament_area_mm2;
        return std::abs(filament_mm - go.filament_mm) <=
               std::max(kept * go.filament_mm, filament_rounding_mm);
    };
    if (go.width_mm > 0 && fits(style)) return style;
    PathStyle same = style;
    same.flow = last.flow;
    if (go.width_mm == 0) same.width_mm = last.width_mm;
    if (same.width_mm > 0 && same.height_mm == last.height_mm && fits(same)) return same;
    const double area_mm2 = go.filament_mm * filament_area_mm2 / length_mm;
    if (go.width_mm > 0) style.flow = rounded(area_mm2 / cross_section_mm2(style), flows_per_unit);
    if (go.width_mm == 0 || style.flow == 0) {
        style.flow = 1;
        style.width_mm = rounded(width_for(area_mm2, style.height_mm), widths_per_mm);
    }
    return style;
}

}  // namespace lyr::format
