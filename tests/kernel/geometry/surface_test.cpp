// The numbers are those of the contract in kernel/geometry/surface.h.

#include "kernel/geometry/surface.h"

#include <doctest/doctest.h>

#include <numbers>

#include "kernel/geometry/random_curves.h"
#include "kernel/geometry/tolerance.h"

using namespace lyr;
using lyr::test::inversion_bound_mm;
using lyr::test::Random;
using std::numbers::pi;

namespace {

Surface random_elementary_surface(Random& random) {
    const Frame frame = random.frame();
    switch (random.integer(0, 4)) {
        case 0:
            return Plane{frame};
        case 1:
            return Cylinder{frame, random.between(0.1, 50)};
        case 2:
            return Cone{frame, random.between(0, 30), random.between(0.05, 1.5)};
        case 3:
            return Sphere{frame, random.between(0.1, 50)};
        default:
            return Torus{frame, random.between(0.1, 50), random.between(0.1, 50)};
    }
}

// Parameters of a random point, on the nappe with positive radius for a cone.
Point2 random_parameters(Random& random, const Surface& surface) {
    Point2 uv(random.between(-3.1, 3.1), random.between(-1.5, 1.5));
    if (const auto* cone = std::get_if<Cone>(&surface)) {
        uv.y() = -cone->radius_mm / std::tan(cone->half_angle_rad) + random.between(0, 20);
    }
    if (std::holds_alternative<Torus>(surface)) uv.y() = random.between(-3.1, 3.1);
    return uv;
}

}  // namespace

TEST_CASE("3: the point of a surface's parameters is found again") {
    Random random(21);
    for (int i = 0; i < 3000; ++i) {
        const Surface s = random_elementary_surface(random);
        const Point3 p = evaluate(s, random_parameters(random, s));
        CHECK((evaluate(s, invert(s, p)) - p).norm() <= inversion_bound_mm);
    }
}

TEST_CASE("3: no point of the surface is nearer, and the offset is along the normal") {
    Random random(22);
    for (int i = 0; i < 1000; ++i) {
        const Surface s = random_elementary_surface(random);
        const Point3 p = random.vector(100);
        const Point2 uv = invert(s, p);
        const Vector3 offset = p - evaluate(s, uv);
        for (int k = 0; k < 50; ++k) {
            CHECK((p - evaluate(s, random_parameters(random, s))).norm() >=
                  offset.norm() - inversion_bound_mm);
        }
        const auto* cone = std::get_if<Cone>(&s);
        const bool at_apex =
            cone != nullptr &&
            cone->radius_mm + uv.y() * std::tan(cone->half_angle_rad) < resolution_mm;
        if (!at_apex) CHECK(offset.cross(normal(s, uv)).norm() <= 1e-9 * (1 + offset.norm()));
    }
}

TEST_CASE("3: angles are in (-pi, pi]") {
    const Cylinder cylinder{Frame{}, 2};
    CHECK(invert(cylinder, {-2, -0.0, 1}).x() == pi);
    CHECK(invert(cylinder, {-2, -1e-300, 1}).x() == pi);
    CHECK(invert(Torus{Frame{}, 5, 1}, {3, 0, -1e-300}).y() == pi);
}

TEST_CASE("2: the normal points away from the axis, centre and tube centre, mirrored or not") {
    Random random(23);
    for (int i = 0; i < 2000; ++i) {
        const Surface s = random_elementary_surface(random);
        const Point2 uv = random_parameters(random, s);
        const Vector3 n = normal(s, uv);
        CHECK(n.norm() == doctest::Approx(1));
        const double h = 1e-5;
        const Vector3 du = evaluate(s, uv + Vector2(h, 0)) - evaluate(s, uv);
        const Vector3 dv = evaluate(s, uv + Vector2(0, h)) - evaluate(s, uv);
        CHECK(std::abs(n.dot(du)) <= 1e-3 * du.norm() + 1e-12);
        CHECK(std::abs(n.dot(dv)) <= 1e-3 * dv.norm() + 1e-12);

        const Eigen::Affine3d move = random.similarity(true);
        const Surface moved = transformed(s, move);
        CHECK((evaluate(moved, invert(moved, move * evaluate(s, uv))) - move * evaluate(s, uv))
                  .norm() <= inversion_bound_mm);
        const Vector3 expected = (move.linear() * n).normalized();
        CHECK((normal(moved, invert(moved, move * evaluate(s, uv))) - expected).norm() <= 1e-6);
    }
    CHECK(normal(Cylinder{Frame{}, 2}, {0, 0}) == Vector3::UnitX());
    CHECK(normal(Plane{Frame{}}, {0, 0}) == Vector3::UnitZ());
    CHECK(normal(Cone{Frame{}, 1, pi / 4}, {0, 0}).x() > 0);
    CHECK(normal(Cone{Frame{}, 1, pi / 4}, {0, 0}).z() < 0);
}
