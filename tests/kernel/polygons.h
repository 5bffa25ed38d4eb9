// Regions as polygons, and what a polygon library makes of them: a second opinion on lines and arcs.

#pragma once

#include <cmath>
#include <polyclipping/clipper.hpp>
#include <span>

#include "kernel/region/curve.h"
#include "kernel/region/region.h"

namespace lyr::testing {

inline constexpr double polygon_units_per_mm = 1e6;

// Corners lie on the contour, chords are off it by no more than chord_mm.
inline ClipperLib::Path polygon(const Contour& contour, double chord_mm) {
    ClipperLib::Path points;
    region::for_monotone_curves(contour, [&](const region::Curve& curve, std::size_t) {
        // sagitta = (turn / chords)^2 / (8 k)
        const double k = std::abs(curve.curvature_per_mm), turn = k * 2 * curve.half_mm;
        const int chords = 1 + static_cast<int>(turn / std::sqrt(8 * k * chord_mm + 1e-300));
        for (int i = 0; i < chords; ++i) {
            const Point2 p = region::point_on(curve, (2.0 * i / chords - 1) * curve.half_mm);
            points.emplace_back(std::llround(p.x() * polygon_units_per_mm),
                                std::llround(p.y() * polygon_units_per_mm));
        }
    });
    return points;
}

inline ClipperLib::Paths polygons(Region region, double chord_mm) {
    ClipperLib::Paths paths;
    for (const Contour& contour : region) paths.push_back(polygon(contour, chord_mm));
    return paths;
}

inline ClipperLib::Paths offset_polygons(const ClipperLib::Paths& paths, double distance_mm,
                                         double chord_mm) {
    ClipperLib::ClipperOffset offset(2, chord_mm * polygon_units_per_mm);
    offset.AddPaths(paths, ClipperLib::jtRound, ClipperLib::etClosedPolygon);
    ClipperLib::Paths result;
    offset.Execute(result, distance_mm * polygon_units_per_mm);
    return result;
}

inline double area_mm2(const ClipperLib::Path& path) {
    return ClipperLib::Area(path) / (polygon_units_per_mm * polygon_units_per_mm);
}

inline double area_mm2(const ClipperLib::Paths& paths) {
    double area = 0;
    for (const ClipperLib::Path& path : paths) area += area_mm2(path);
    return area;
}

inline double length_mm(const ClipperLib::Path& path) {
    double length = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const ClipperLib::IntPoint &a = path[i], &b = path[(i + 1) % path.size()];
        length += std::hypot(static_cast<double>(b.X - a.X), static_cast<double>(b.Y - a.Y));
    }
    return length / polygon_units_per_mm;
}

inline double length_mm(const ClipperLib::Paths& paths) {
    double length = 0;
    for (const ClipperLib::Path& path : paths) length += length_mm(path);
    return length;
}

// What is in one of them only.
inline ClipperLib::Paths difference_of(const ClipperLib::Paths& a, const ClipperLib::Paths& b) {
    ClipperLib::Clipper clipper;
    clipper.AddPaths(a, ClipperLib::ptSubject, true);
    clipper.AddPaths(b, ClipperLib::ptClip, true);
    ClipperLib::Paths result;
    clipper.Execute(ClipperLib::ctXor, result, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
    return result;
}

}  // namespace lyr::testing
