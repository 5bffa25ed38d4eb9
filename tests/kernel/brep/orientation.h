// What orient_closed_shell() has to do with any solid, however it is stated.

#pragma once

#include <doctest/doctest.h>

#include <cmath>

#include "kernel/brep/volume.h"
#include "kernel/geometry/random_curves.h"

namespace lyr::testing {

// Whether a face's boundary tells its area's sign.
inline bool is_told(const Model& model, FaceId face) {
    Model turned = model;
    turned.faces[face.value].same_sense = !turned.faces[face.value].same_sense;
    return signed_area_mm2(turned, face) < 0;
}

// Of a solid of one shell whose faces look away from its material: whichever senses are turned, and inside out, it comes
// out as it was, and its volume is about right.
inline void check_orientation(const Model& model, double volume_mm3, test::Random& random) {
    constexpr double accuracy = 5e-3;  // of kernel/brep/volume.h
    for (const bool inside_out : {false, true}) {
        Model stated = model;
        if (inside_out) reverse_shell(stated, ShellId{0});
        std::size_t turned = 0;
        for (std::size_t f = 0; f < stated.faces.size(); ++f) {
            if (random.coin() || !is_told(stated, FaceId{f})) continue;
            stated.faces[f].same_sense = !stated.faces[f].same_sense;
            ++turned;
        }
        const ShellOrientation found = orient_closed_shell(stated, ShellId{0}, false);
        CHECK(found.faces_turned == turned);
        CHECK(found.is_reversed == inside_out);
        const double bound = accuracy * std::pow(found.area_mm2, 1.5);
        CHECK(std::abs(found.volume_mm3 - (inside_out ? -1 : 1) * volume_mm3) <= bound);
        for (std::size_t f = 0; f < stated.faces.size(); ++f)
            CHECK(stated.faces[f].same_sense == model.faces[f].same_sense);
    }
}

}  // namespace lyr::testing
