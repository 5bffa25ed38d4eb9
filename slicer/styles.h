// How each role is extruded, from the profile.

#pragma once

#include "format/operation.h"
#include "slicer/outline.h"

namespace lyr::slicer {

// Over air or inside the part.
bool is_bridge(format::Role role);

class Styles {
public:
    Styles(const profile::Profile& profile, std::size_t layer, double height_mm)
        : profile_(profile), layer_(layer), height_mm_(height_mm) {}

    // Of a strand of so much length; `width_mm` and `flow` as it has them.
    format::PathStyle of(format::Role role, double width_mm, double length_mm, double flow) const;

    // All speeds are multiplied by this, down to the profile's least.
    void slow_down(double factor) { factor_ = factor; }

private:
    double speed_mm_s(format::Role role, double length_mm) const;
    double acceleration_mm_s2(format::Role role) const;

    const profile::Profile& profile_;
    std::size_t layer_;
    double height_mm_;
    double factor_ = 1;
};

}  // namespace lyr::slicer
