// Figures of sections: area and boundary length, all solids together; distance from the surfaces; volume.

#pragma once

#include <doctest/doctest.h>

#include <algorithm>

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

// The distance of a point from the nearest of the model's surfaces.
inline double off_surfaces(const Model& model, const Point3& point) {
    double least = 1e9;
    for (const Face& face : model.faces) {
        const Point3 foot = evaluate(face.surface, invert(face.surface, point));
        least = std::min(least, (foot - point).norm());
    }
    return least;
}

// The farthest that contours come from the model's surfaces.
inline double worst_distance(const Model& model, const Section& section) {
    double worst = 0;
    for (const SolidSection& solid : section.solids) {
        for (const Contour& contour : solid.contours) {
            const auto* path = std::get_if<Path>(&contour);
            if (!path) continue;
            Point2 from = path->start;
            for (const Segment& segment : path->segments) {
                for (const double share : {0.0, 0.2, 0.5, 0.8}) {
                    const Point2 p = point_at(from, segment, share);
                    worst = std::max(worst, off_surfaces(model, {p.x(), p.y(), section.z_mm}));
                }
                from = segment.end;
            }
            CHECK((from - path->start).norm() == 0);
        }
    }
    return worst;
}

// What the sections of so many planes make of the volume.
struct SectionSum {
    double volume_mm3 = 0;
    double allowed_mm3 = 0;  // by the tolerance along the contours
};

// Checks besides that every section closes and has nothing to report.
inline SectionSum sum_of_sections(const Model& model, const Tolerance& tolerance, int planes) {
    const Cutter cutter(model, tolerance);
    const HeightRange range = cutter.height_range();
    const double step = (range.top_mm - range.bottom_mm) / planes;
    SectionSum sum;
    for (int i = 0; i < planes; ++i) {
        CAPTURE(i);
        const Section section = cutter.cut(range.bottom_mm + (i + 0.5) * step);
        CHECK(section.open == 0);
        CHECK(section.diagnostics.empty());
        sum.volume_mm3 += step * area_of(section);
        sum.allowed_mm3 += step * length_of(section) * tolerance.total_mm;
    }
    return sum;
}

}  // namespace lyr::testing
