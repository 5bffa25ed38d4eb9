#include "slicer/styles.h"

#include <algorithm>

namespace lyr::slicer {
namespace {

using format::Role;

// Walls shorter than this are small (docs/profiles.md, speed.small).
constexpr double small_wall_mm = 40;

bool is_wall(Role role) {
    return role == Role::outer_wall || role == Role::inner_wall;
}

}  // namespace

bool is_bridge(Role role) {
    return role == Role::bridge || role == Role::internal_bridge || role == Role::overhang_wall;
}

double Styles::speed_mm_s(Role role, double length_mm) const {
    const profile::Speed& speed = profile_.speed;
    switch (role) {
        case Role::outer_wall:
        case Role::inner_wall: {
            const double own =
                role == Role::outer_wall ? speed.outer_wall_mm_s : speed.inner_wall_mm_s;
            return length_mm < small_wall_mm ? std::min(own, speed.small_mm_s) : own;
        }
        case Role::thin_wall:
        case Role::gap_fill:
            return speed.gap_fill_mm_s;
        case Role::sparse_infill:
            return speed.sparse_infill_mm_s;
        case Role::top_skin:
            return speed.top_skin_mm_s;
        case Role::bridge:
        case Role::internal_bridge:
        case Role::overhang_wall:
            return speed.bridge_mm_s;
        case Role::support:
        case Role::support_interface:
            return speed.support_mm_s;
        case Role::skirt:
        case Role::brim:
            return speed.first_layer_mm_s;
        default:
            return speed.solid_infill_mm_s;
    }
}

double Styles::acceleration_mm_s2(Role role) const {
    const profile::Acceleration& acceleration = profile_.acceleration;
    if (layer_ == 0 && acceleration.first_layer_mm_s2 > 0) return acceleration.first_layer_mm_s2;
    switch (role) {
        case Role::outer_wall:
        case Role::thin_wall:
            return acceleration.outer_wall_mm_s2;
        case Role::inner_wall:
        case Role::gap_fill:
            return acceleration.inner_wall_mm_s2;
        case Role::sparse_infill:
            return acceleration.sparse_infill_mm_s2;
        case Role::top_skin:
            return acceleration.top_skin_mm_s2;
        case Role::bridge:
        case Role::internal_bridge:
        case Role::overhang_wall:
            return acceleration.bridge_mm_s2;
        case Role::support:
        case Role::support_interface:
            return acceleration.support_mm_s2;
        default:
            return acceleration.solid_infill_mm_s2;
    }
}

format::PathStyle Styles::of(Role role, double width_mm, double length_mm, double flow) const {
    format::PathStyle style{
        .role = role,
        .width_mm = width_mm,
        .height_mm = height_mm_,
        .flow = flow * profile_.filament.flow * (is_bridge(role) ? profile_.bridge.flow : 1),
        .acceleration_mm_s2 = acceleration_mm_s2(role)};
    double speed = speed_mm_s(role, is_wall(role) ? length_mm : 0);
    if (layer_ == 0) speed = std::min(speed, profile_.speed.first_layer_mm_s);
    const double most_mm3_s = profile_.filament.max_volumetric_speed_mm3_s;
    if (most_mm3_s > 0) speed = std::min(speed, most_mm3_s / cross_section_mm2(style));
    style.speed_mm_s = std::max(std::min(speed, profile_.fan.min_speed_mm_s), speed * factor_);
    return style;
}

}  // namespace lyr::slicer
