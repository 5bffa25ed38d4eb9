// Against a polygon library, on finely polygonised input: the difference of both results has no area to speak of.

#include <doctest/doctest.h>

#include <polyclipping/clipper.hpp>

#include "kernel/region/regions.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

constexpr double units_per_mm = 1e7;
constexpr double chord_rad = 6e-3;  // of an arc: its chord is off by radius * chord_rad^2 / 8

ClipperLib::Path polygon(const Contour& contour) {
    ClipperLib::Path points;
    region::for_monotone_curves(contour, [&](const region::Curve& curve, std::size_t) {
        const double turn = std::abs(curve.curvature_per_mm) * 2 * curve.half_mm;
        const int chords = 1 + static_cast<int>(turn / chord_rad);
        for (int i = 0; i < chords; ++i) {
            const Point2 p = region::point_on(curve, (2.0 * i / chords - 1) * curve.half_mm);
            points.emplace_back(std::llround(p.x() * units_per_mm),
                                std::llround(p.y() * units_per_mm));
        }
    });
    return points;
}

ClipperLib::Paths polygons(const Contours& contours) {
    ClipperLib::Paths paths;
    for (const Contour& contour : contours) paths.push_back(polygon(contour));
    return paths;
}

ClipperLib::Paths clipped(const ClipperLib::Paths& a, const ClipperLib::Paths& b,
                          ClipperLib::ClipType type) {
    ClipperLib::Clipper clipper;
    clipper.AddPaths(a, ClipperLib::ptSubject, true);
    clipper.AddPaths(b, ClipperLib::ptClip, true);
    ClipperLib::Paths result;
    REQUIRE(clipper.Execute(type, result, ClipperLib::pftPositive, ClipperLib::pftPositive));
    return result;
}

double area_mm2(const ClipperLib::Paths& paths) {
    double area = 0;
    for (const ClipperLib::Path& path : paths) area += ClipperLib::Area(path);
    return area / (units_per_mm * units_per_mm);
}

void check_same(const Contours& result, const ClipperLib::Paths& expected, double length) {
    const double off_mm =
        100 * chord_rad * chord_rad / 8;  // on both sides, for radii of up to 50 mm
    CHECK(area_mm2(clipped(polygons(result), expected, ClipperLib::ctXor)) < off_mm * length);
}

}  // namespace

TEST_CASE("region: results are those of a polygon library") {
    Random random(21);
    for (int i = 0; i < 40; ++i) {
        const double size = random.within(1, 40);
        const Contours a = random_region(random, {0, 0}, size);
        const Contours b = random_region(
            random, {size * random.within(-1, 1), size * random.within(-1, 1)}, size * 0.7);
        const double length = total_length(a) + total_length(b);
        const ClipperLib::Paths in_a = polygons(a), in_b = polygons(b);
        for (const auto& [operation, type] : {std::pair{Operation::unite, ClipperLib::ctUnion},
                                              {Operation::intersect, ClipperLib::ctIntersection},
                                              {Operation::subtract, ClipperLib::ctDifference}}) {
            CAPTURE(i);
            check_same(combined(a, b, operation, 1e-5).contours, clipped(in_a, in_b, type), length);
        }
    }
}

TEST_CASE("region: a union of many is that of a polygon library") {
    Random random(22);
    for (int i = 0; i < 3; ++i) {
        std::vector<Contours> regions;
        ClipperLib::Paths all;
        double length = 0;
        for (int r = 0; r < 40; ++r) {
            regions.push_back(random_region(random, {random.within(0, 60), random.within(0, 60)},
                                            random.within(3, 12)));
            for (const ClipperLib::Path& path : polygons(regions.back())) all.push_back(path);
            length += total_length(regions.back());
        }
        const auto result = unite_all(regions, 1e-5);
        CHECK(result.unresolved == 0);
        check_same(result.contours, clipped(all, {}, ClipperLib::ctUnion), length);
    }
}
