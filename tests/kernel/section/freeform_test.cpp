// Sections of free-form solids: areas that add up to the volume, points on the surface, whatever the position.

#include <doctest/doctest.h>

#include "kernel/brep/placement.h"
#include "kernel/freeform_solids.h"
#include "kernel/geometry/bspline_offset.h"
#include "kernel/geometry/random_curves.h"
#include "kernel/section/cutter.h"
#include "kernel/section_figures.h"

using namespace lyr;
using namespace lyr::testing;

TEST_CASE("free-form: the areas of a bent cube's sections add up to its volume") {
    const Tolerance tolerance{0.001};
    test::Random random(5);
    for (unsigned seed = 0; seed < 24; ++seed) {
        CAPTURE(seed);
        const BezierVolume volume(1 + static_cast<int>(seed % 4), 20, 0.35, seed % 3 == 2, seed);
        Eigen::Affine3d position =
            seed < 4 ? Eigen::Affine3d::Identity() : random.similarity(false);
        const Model model = transformed(bent_cube(volume), position);
        const SectionSum sum = sum_of_sections(model, tolerance, 300);
        const double exact = volume.volume_mm3();
        CHECK(std::abs(sum.volume_mm3 - exact) < 2e-4 * exact + sum.allowed_mm3);
    }
}

TEST_CASE("free-form: contours lie on the surface within the tolerance") {
    const Tolerance tolerance{0.005};
    test::Random random(6);
    double worst = 0;
    for (unsigned seed = 0; seed < 8; ++seed) {
        CAPTURE(seed);
        const BezierVolume volume(2 + static_cast<int>(seed % 3), 20, 0.35, seed % 2 == 1, seed);
        const Model model = transformed(bent_cube(volume), random.similarity(false));
        const Cutter cutter(model, tolerance);
        const HeightRange range = cutter.height_range();
        for (int i = 0; i < 10; ++i) {
            const double z = range.bottom_mm + (i + 0.5) / 10 * (range.top_mm - range.bottom_mm);
            for (const SolidSection& solid : cutter.cut(z).solids) {
                for (const Contour& contour : solid.contours) {
                    const Path& path = std::get<Path>(contour);
                    Point2 from = path.start;
                    for (const Segment& segment : path.segments) {
                        for (const double share : {0.0, 0.13, 0.37, 0.5, 0.71, 0.9}) {
                            const Point2 p = point_at(from, segment, share);
                            double least = 1e9;
                            for (const Face& face : model.faces) {
                                const Point3 q(p.x(), p.y(), z);
                                const Point2 uv = invert(face.surface, q);
                                least = std::min(least, (evaluate(face.surface, uv) - q).norm());
                            }
                            worst = std::max(worst, least);
                        }
                        from = segment.end;
                    }
                }
            }
        }
    }
    MESSAGE("farthest: " << worst);
    CHECK(worst <= tolerance.fit_mm() + tolerance.trace_mm());
}

namespace {

// A solid of one face without edges.
Model whole(const BSplineSurface& surface) {
    Builder b;
    b.face(std::make_shared<const BSplineSurface>(surface), true, {});
    return b.finish();
}

BSplineSurface spun(const Curve& profile, double from, double to) {
    return revolved(rational(profile, from, to), Frame{});
}

// A tube whose cross-section is one Bezier piece that comes back to its start.
BSplineSurface one_piece_tube(double height) {
    BSplineCurve ring{6, std::vector<double>(7, 0.0), {}, {}, true};
    ring.knots.resize(14, 1.0);
    for (const Point2& p : {Point2(6, 0), Point2(6, 9), Point2(-12, 12), Point2(-18, 0),
                            Point2(-12, -12), Point2(6, -9), Point2(6, 0)}) {
        ring.control_points.push_back({p.x(), p.y(), 0});
    }
    return extruded(ring, {0, 0, height});
}

// In the x-z plane, from the lowest point to the highest: outward is d/du x d/dv.
Frame upright(const Point3& centre) {
    return {centre, Vector3::UnitX(), Vector3::UnitZ(), -Vector3::UnitY()};
}

}  // namespace

TEST_CASE("free-form: balls and rings that are one closed face, in every position") {
    struct Solid {
        const char* name;
        Model model;
        double volume_mm3;
    };
    const Frame at_axis = upright(Point3::Zero());
    const std::vector<Solid> solids{
        {"ball", whole(spun(Circle{at_axis, 5}, -pi / 2, pi / 2)), 4 * pi / 3 * 125},
        {"ellipsoid", whole(spun(Ellipse{at_axis, 7, 4}, -pi / 2, pi / 2)), 4 * pi / 3 * 49 * 4},
        {"ring", whole(spun(Circle{upright({6, 0, 0}), 2}, -pi, pi)), 2 * pi * pi * 6 * 4}};
    const Tolerance tolerance{0.001};
    test::Random random(8);
    for (const Solid& solid : solids) {
        CAPTURE(solid.name);
        for (int number = 0; number < 12; ++number) {
            CAPTURE(number);
            Eigen::Affine3d position = Eigen::Affine3d::Identity();
            if (number == 1) position = Eigen::AngleAxisd(pi / 2, Vector3::UnitX());
            if (number == 2) position = Eigen::AngleAxisd(1e-6, Vector3::UnitX());
            if (number > 2) position = random.similarity(false);
            const Model model = transformed(solid.model, position);
            const Cutter cutter(model, tolerance);
            const HeightRange range = cutter.height_range();
            constexpr int planes = 300;
            const double step = (range.top_mm - range.bottom_mm) / planes;
            double sum = 0, allowed = 0;
            for (int i = 0; i < planes; ++i) {
                CAPTURE(i);
                const Section section = cutter.cut(range.bottom_mm + (i + 0.5) * step);
                CHECK(section.open == 0);
                CHECK(section.diagnostics.empty());
                CHECK(area_of(section) > 0);
                sum += step * area_of(section);
                allowed += step * length_of(section) * tolerance.total_mm;
            }
            CHECK(std::abs(sum - solid.volume_mm3) < 2e-4 * solid.volume_mm3 + allowed);
        }
    }
}

TEST_CASE("free-form: an offset of a ball or a ring cuts like the ball or ring of that size") {
    const auto grown = [](const BSplineSurface& surface, double distance_mm) {
        return whole(std::get<BSplineSurface>(offset(surface, distance_mm)));
    };
    const Tolerance tolerance{0.001};
    const Point3 centre(1, -2, 3);
    const Vector3 axis = Vector3(1, 2, -0.5).normalized();
    const Eigen::Affine3d position =
        Eigen::Translation3d(centre) * Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), axis);
    for (const double distance_mm : {-2.5, 0.75}) {
        CAPTURE(distance_mm);
        const double radius_mm = 5 + distance_mm;
        const BSplineSurface ball = spun(Circle{upright(Point3::Zero()), 5}, -pi / 2, pi / 2);
        const Model model = transformed(grown(ball, distance_mm), position);
        const Cutter cutter(model, tolerance);
        CHECK(std::abs(cutter.height_range().top_mm - centre.z() - radius_mm) < resolution_mm);
        for (int i = 0; i < 40; ++i) {
            const double z = radius_mm * ((i + 0.5) / 20 - 1);
            const Section section = cutter.cut(centre.z() + z);
            CHECK(section.open == 0);
            CHECK(std::abs(area_of(section) - pi * (radius_mm * radius_mm - z * z)) <
                  tolerance.total_mm * length_of(section));
        }
    }
    for (const double distance_mm : {-0.5, 1.5}) {
        CAPTURE(distance_mm);
        const double tube_mm = 2 + distance_mm;
        const BSplineSurface ring = spun(Circle{upright({6, 0, 0}), 2}, -pi, pi);
        const Model model = grown(ring, distance_mm);
        const Cutter cutter(model, tolerance);
        for (int i = 0; i < 40; ++i) {
            const double z = tube_mm * ((i + 0.5) / 20 - 1);
            const Section section = cutter.cut(z);
            CHECK(section.open == 0);
            // Between two circles, whose radii add up to 12.
            const double width_mm = 2 * std::sqrt(tube_mm * tube_mm - z * z);
            CHECK(std::abs(area_of(section) - pi * 12 * width_mm) <
                  tolerance.total_mm * length_of(section));
        }
    }
}

TEST_CASE("free-form: a ring that lies in one cell of its surface is found (C_Radial_D6.3mm)") {
    BSplineSurface tube = one_piece_tube(10);
    tube.closed_u = true;
    for (const double lean : {0.0, 0.01, 0.1}) {
        CAPTURE(lean);
        const Eigen::Affine3d turn(Eigen::AngleAxisd(lean, Vector3::UnitX()));
        const HeightMesh mesh =
            height_mesh(std::make_shared<const BSplineSurface>(transformed(tube, turn)));
        const std::vector<LevelCurve> curves = level_curves(mesh, 5, true, 1e-4);
        REQUIRE(curves.size() == 1);
        CHECK(curves[0].closed);
        CHECK(curves[0].length_mm() > 40);
    }
}

TEST_CASE("free-form: a bend between ends that lie along their chord is not lost") {
    const std::vector<std::vector<double>> sides{
        {0, 0, 10, 0, 0}, {0, 0, 0, 30, 0, 0, 0}, {0, .01, 0, 8, -8, 0, -.01, 0}};
    for (const std::vector<double>& offsets : sides) {
        CAPTURE(offsets.size());
        const std::size_t n = offsets.size();
        BSplineCurve curve{static_cast<int>(n) - 1, std::vector<double>(n, 0.0), {}, {}};
        curve.knots.resize(2 * n, 1.0);
        for (std::size_t i = 0; i < n; ++i) {
            curve.control_points.push_back(
                {40.0 * static_cast<double>(i) / static_cast<double>(n - 1), offsets[i], 0});
        }
        double exact = 0;
        for (int i = 0; i < 20000; ++i) {
            exact += (evaluate(curve, (i + 1) / 20000.0) - evaluate(curve, i / 20000.0)).norm();
        }
        const HeightMesh mesh =
            height_mesh(std::make_shared<const BSplineSurface>(extruded(curve, {0, 0, 10})));
        const std::vector<LevelCurve> found = level_curves(mesh, 5, true, 1e-4);
        REQUIRE(found.size() == 1);
        CHECK(found[0].length_mm() == doctest::Approx(exact).epsilon(1e-3));
    }
}
