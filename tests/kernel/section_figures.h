// Area and boundary length of a section, all solids together.

#pragma once

#include "kernel/section/cutter.h"

namespace lyr::testing {

inline double area_of(const Section& section) {
    double area = 0;
    for (const SolidSection& solid : section.solids) {
        for (const Contour& contour : solid.contours) area += area_mm2(contour);
    }
    return area;
}

inline double length_of(const Section& section) {
    double length = 0;
    for (const SolidSection& solid : section.solids) {
        for (const Contour& contour : solid.contours) length += length_mm(contour);
    }
    return length;
}

}  // namespace lyr::testing
