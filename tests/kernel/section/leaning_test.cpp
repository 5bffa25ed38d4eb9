// Where surfaces lean out further than a limit, on solids whose divisions are known.

#include "kernel/section/leaning.h"

#include <doctest/doctest.h>

#include <string>

#include "kernel/brep/placement.h"
#include "kernel/section/cutter.h"
#include "kernel/section/level_face.h"
#include "kernel/section_figures.h"
#include "kernel/solids.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

constexpr double limit_rad = 50 * pi / 180;

double leaning_mm(const Model& model, double z_mm, double limit = limit_rad) {
    double length = 0;
    for (const LeaningSpan& span : Cutter(model, Tolerance{}).leaning(z_mm, limit)) {
        CHECK(span.most_rad > limit);
        Point2 from = span.path.start;
        for (const Segment& segment : span.path.segments) {
            length += length_mm(from, segment);
            from = segment.end;
        }
    }
    return length;
}

Model turned(Model model, double angle_rad, const Vector3& axis) {
    return transformed(std::move(model), Eigen::Affine3d(Eigen::AngleAxisd(angle_rad, axis)));
}

}  // namespace

TEST_CASE(
    "leaning 2: a cone leans beyond the limit or not, a hundredth of a degree on either side") {
    for (const double degrees : {40.0, 49.99, 50.0, 50.01, 60.0}) {
        for (const Side side : {Side::seam, Side::halves, Side::two_loops}) {
            CAPTURE(degrees);
            const double top = 2 + 6 * std::tan(degrees * pi / 180);
            const Model cone = frustum(2, top, 6, side);
            const double around = 2 * pi * (2 + 4 * std::tan(degrees * pi / 180));
            CHECK(leaning_mm(cone, 1) == doctest::Approx(degrees > 50 ? around : 0).epsilon(1e-6));
            // Upside down, nothing leans out.
            CHECK(leaning_mm(turned(cone, pi, Vector3::UnitX()), 1) == 0);
        }
    }
}

TEST_CASE("leaning: upright walls do not, and a ball does below the circle of the limit") {
    CHECK(leaning_mm(box(7, 5, 3), 0.3) == 0);
    CHECK(leaning_mm(frustum(4, 4, 9, Side::seam), 0.3) == 0);
    for (const bool seam : {true, false}) {
        const double division = -5 * std::sin(limit_rad);
        CHECK(leaning_mm(sphere(5, seam), division + 1e-4) == 0);
        const double below = leaning_mm(sphere(5, seam), division - 1e-4);
        CHECK(below == doctest::Approx(2 * pi * 5 * std::cos(limit_rad)).epsilon(1e-3));
    }
}

TEST_CASE("leaning 1: an oblique cylinder is divided at the generators of the limit") {
    // The axis leans by `tilt`: at an angle u about it from the lowest generator, the lean's sine is cos(u) sin(tilt).
    for (const double tilt : {0.95, 1.2, 1.5}) {
        for (const double spin : {0.0, 0.7, 2.9}) {
            CAPTURE(tilt);
            CAPTURE(spin);
            const Model model =
                turned(turned(frustum(3, 3, 200, Side::seam), tilt, Vector3::UnitY()), spin,
                       Vector3::UnitZ());
            const double u = std::acos(std::sin(limit_rad) / std::sin(tilt));
            std::size_t divisions = 0;
            const Vector3 axis(std::sin(tilt) * std::cos(spin), std::sin(tilt) * std::sin(spin),
                               std::cos(tilt));
            const Vector3 down = (-Vector3::UnitZ() + axis.z() * axis).normalized();
            for (const LeaningSpan& span : Cutter(model, Tolerance{}).leaning(0.1, limit_rad)) {
                const auto* cylinder = std::get_if<Cylinder>(&model[span.face].surface);
                if (!cylinder) continue;
                for (const Point2& end : {span.path.start, span.path.segments.back().end}) {
                    const Vector3 at(end.x(), end.y(), 0.1);
                    const Vector3 out = (at - at.dot(axis) * axis).normalized();
                    if (std::abs(std::acos(out.dot(down)) - u) < 1e-5) ++divisions;
                }
            }
            CHECK(divisions == 2);
        }
    }
}

TEST_CASE("leaning: the same of a surface, whether it is elementary or free-form") {
    // A frustum's side as a surface of revolution, face by face.
    const auto freeform = [](Model model) {
        for (Face& face : model.faces) {
            const auto* cone = std::get_if<Cone>(&face.surface);
            if (!cone) continue;
            const auto point = [&](double along) {
                const double radius = cone->radius_mm + along * std::tan(cone->half_angle_rad);
                return cone->frame.to_global({radius, 0, along});
            };
            const Line line{point(-1), (point(9) - point(-1)).normalized()};
            const BSplineCurve profile = rational(line, 0, (point(9) - point(-1)).norm());
            face.surface = std::make_shared<const BSplineSurface>(revolved(profile, cone->frame));
        }
        return model;
    };
    for (const double angle : {0.0, 0.4, 1.1, 2.0}) {
        CAPTURE(angle);
        const Model cone =
            turned(frustum(2, 9, 6, Side::halves), angle, Vector3(1, 0.3, 0.2).normalized());
        const double exact = leaning_mm(cone, 0.37), tracked = leaning_mm(freeform(cone), 0.37);
        CHECK(tracked == doctest::Approx(exact).epsilon(1e-3));
    }
}

TEST_CASE("leaning 1: what leans by anything at all is the section") {
    for (const double angle : {0.0, 0.3, 0.9, 1.4}) {
        for (const Model& model :
             {half_round(3, 8), torus(6, 2, true), cut_ball(6, 2), cone_with_apex(3, 8, true)}) {
            const Model turned_model = turned(model, angle, Vector3(1, 1, 0).normalized());
            const double whole = leaning_mm(turned_model, 0.11, -pi);
            const Section section = Cutter(turned_model, Tolerance{}).cut(0.11);
            CHECK(whole == doctest::Approx(length_of(section)).epsilon(1e-4));
        }
    }
}

TEST_CASE("level faces: an underside's region is what its edges bound, whichever way it looks") {
    for (const double angle : {0.0, 0.6}) {
        for (const bool upside_down : {false, true}) {
            Model model = turned(drilled_box(8, 6, 4, 2), angle, Vector3::UnitZ());
            if (upside_down) model = turned(std::move(model), pi, Vector3::UnitX());
            int down = 0, up = 0;
            for (std::uint32_t f = 0; f < model.faces.size(); ++f) {
                const auto level = level_face(model, FaceId{f}, Tolerance{});
                if (!level) continue;
                CHECK(level->z_mm == doctest::Approx(level->looks_down ? -2 : 2));
                ++(level->looks_down ? down : up);
                REQUIRE(level->region.size() == 2);
                double area = 0;
                int circles = 0;
                for (const Contour& contour : level->region) {
                    area += area_mm2(contour);
                    circles += std::holds_alternative<FullCircle>(contour);
                }
                CHECK(area == doctest::Approx(48 - 4 * pi));
                CHECK(circles == 1);
            }
            CHECK(down == 1);
            CHECK(up == 1);
        }
    }
}
