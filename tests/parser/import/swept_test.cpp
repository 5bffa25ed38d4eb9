// Extruded and turned curves, by the numbers of the contract in parser/import/swept.h.

#include <doctest/doctest.h>

#include <cmath>

#include "surface_writers.h"

using namespace lyr;
using namespace lyr::test;

TEST_CASE("swept 1: an extruded line is a plane, a circle along its axis a cylinder") {
    for (const double side : {1.0, -1.0}) {
        const Face plane = face_on(extrusion(line({1, 2, 3}, {5, 2, 3}), {0, 0, side}),
                                   {{1, 2, 3}, {5, 2, 3}, {5, 2, 4}});
        REQUIRE(std::holds_alternative<Plane>(plane.surface));
        CHECK(near(stated_normal(plane, {1, 2, 3}), {0, -side, 0}));
        const Face cylinder = face_on(
            extrusion(circle({1, 2, 3}, Vector3::UnitZ(), Vector3::UnitX(), 2), {0, 0, side}),
            {{3, 2, 3}, {1, 4, 3}, {1, 4, 5}});
        REQUIRE(std::holds_alternative<Cylinder>(cylinder.surface));
        CHECK(std::get<Cylinder>(cylinder.surface).radius_mm == 2);
        CHECK(near(stated_normal(cylinder, {3, 2, 0}), {side, 0, 0}));
    }
}

TEST_CASE("swept 2: other extrusions reach beyond the face") {
    // A circle moved askew.
    const Vector3 askew(1, 0, 1);
    const Face oblique =
        face_on(extrusion(circle({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitX(), 2), askew),
                {{2, 0, 0}, {0, 2, 0}, {10, 2, 10}, {12, 0, 10}});
    const auto& s = std::get<SharedBSplineSurface>(oblique.surface);
    CHECK(s->closed_u);
    for (const double h : {0.0, 4.0, 10.0}) CHECK(is_on(oblique, Point3(0, -2, 0) + h * askew));
    CHECK(near(stated_normal(oblique, {0, 2, 0}), {0, 1, 0}));
    // A parabola, as far as the face goes.
    const auto parabola = [](StepText& step) {
        return step.add("PARABOLA(''," + StepText::ref(origin_placement(step)) + ",1.)");
    };
    const auto on = [](double t, double h) { return Point3(t * t, 2 * t, h); };
    const Face gutter =
        face_on(extrusion(parabola, {0, 0, -1}), {on(-3, 0), on(5, 0), on(5, -7), on(-3, -7)});
    for (const double t : {-3.0, 0.0, 5.0}) {
        CHECK(is_on(gutter, on(t, 0)));
        CHECK(is_on(gutter, on(t, -7)));
    }
    CHECK(stated_normal(gutter, on(0, -1)).x() < -0.9);
    // A polyline has its kinks.
    const auto polyline = [](StepText& step) {
        return step.add(
            "POLYLINE(''," +
            StepText::refs({step.point({0, 0, 0}), step.point({2, 0, 0}), step.point({2, 5, 0})}) +
            ")");
    };
    const Face folded =
        face_on(extrusion(polyline, {0, 0, 1}), {{0, 0, 0}, {2, 0, 0}, {2, 5, 0}, {2, 5, 3}});
    CHECK(is_on(folded, {2, 4, 1}));
    CHECK(is_on(folded, {1, 0, 3}));
}

TEST_CASE("swept 1: a turned line is a cylinder, a cone or a plane") {
    for (const double side : {1.0, -1.0}) {
        const Vector3 up = side * Vector3::UnitZ();
        const Face cylinder =
            face_on(revolution(line({2, 0, 0}, Point3(2, 0, 0) + up), {0, 0, 5}, Vector3::UnitZ()),
                    {{2, 0, 0}, {0, 2, 0}, {0, 2, 1}});
        REQUIRE(std::holds_alternative<Cylinder>(cylinder.surface));
        CHECK(near(stated_normal(cylinder, {0, 2, 0}), {0, side, 0}));
        const Face cone =
            face_on(revolution(line({2, 0, 0}, Point3(2, 0, 0) + side * Vector3(1, 0, 2)),
                               {0, 0, 5}, Vector3::UnitZ()),
                    {{2, 0, 0}, {0, 2, 0}, {0, 3, 2}});
        REQUIRE(std::holds_alternative<Cone>(cone.surface));
        CHECK(is_on(cone, {0, -3, 2}));
        CHECK(stated_normal(cone, {2, 0, 0}).x() * side > 0.5);
        // From its other nappe it looks outward and down.
        const Face below =
            face_on(revolution(line({2, 0, 0}, Point3(2, 0, 0) + side * Vector3(1, 0, 2)),
                               {0, 0, 5}, Vector3::UnitZ()),
                    {{-1, 0, -6}, {0, -1, -6}, {0, -2, -8}});
        REQUIRE(std::holds_alternative<Cone>(below.surface));
        CHECK(is_on(below, {-1, 0, -6}));
        CHECK(stated_normal(below, {-1, 0, -6}).x() * side < -0.5);
        const Face disc =
            face_on(revolution(line({2, 0, 3}, Point3(2, 0, 3) + side * Vector3::UnitX()),
                               {0, 0, 5}, Vector3::UnitZ()),
                    {{2, 0, 3}, {0, 2, 3}, {0, -4, 3}});
        REQUIRE(std::holds_alternative<Plane>(disc.surface));
        CHECK(near(stated_normal(disc, {0, 3, 3}), {0, 0, -side}));
    }
    // A skew line: the waist of a hyperboloid is where it comes nearest to the axis.
    const Face waist = face_on(revolution(line({2, 0, 0}, {2, 1, 1}), {0, 0, 0}, Vector3::UnitZ()),
                               {{2, -3, -3}, {2, 4, 4}, {-2, 0, 0}});
    for (const double h : {-3.0, 0.0, 4.0}) CHECK(is_on(waist, {0, std::hypot(2, h), h}));
}

TEST_CASE("swept 1: a circle turned about an axis in its plane is a torus or a sphere") {
    for (const double side : {1.0, -1.0}) {
        // Counter-clockwise as seen from -y, for side = 1: upwards on its outer half.
        const Write profile = circle({6, 0, 1}, {0, -side, 0}, Vector3::UnitX(), 2);
        const Face torus = face_on(revolution(profile, {0, 0, 0}, Vector3::UnitZ()),
                                   {{8, 0, 1}, {6, 0, 3}, {0, 8, 1}});
        REQUIRE(std::holds_alternative<Torus>(torus.surface));
        CHECK(std::get<Torus>(torus.surface).major_mm == doctest::Approx(6));
        CHECK(near(stated_normal(torus, {0, 8, 1}), {0, side, 0}));
        CHECK(near(stated_normal(torus, {4, 0, 1}), {-side, 0, 0}));
        // Half a circle, from pole to pole.
        const Write half = trimmed(circle({0, 0, 1}, {0, -1, 0}, Vector3::UnitX(), 2),
                                   {0, 0, 1 - side * 2}, {0, 0, 1 + side * 2}, side > 0);
        const Face sphere = face_on(revolution(half, {0, 0, 0}, Vector3::UnitZ()),
                                    {{2, 0, 1}, {0, 2, 1}, {-2, 0, 1}});
        REQUIRE(std::holds_alternative<Sphere>(sphere.surface));
        CHECK(near(stated_normal(sphere, {0, 2, 1}), {0, side, 0}));
        // The half on the other side of the axis, upwards: the normal looks inward there.
        const Write other = trimmed(circle({0, 0, 1}, {0, -1, 0}, Vector3::UnitX(), 2), {0, 0, 3},
                                    {0, 0, -1}, true);
        const Face inward = face_on(revolution(other, {0, 0, 0}, Vector3::UnitZ()),
                                    {{2, 0, 1}, {0, 2, 1}, {-2, 0, 1}});
        CHECK(near(stated_normal(inward, {0, 2, 1}), {0, -1, 0}));
    }
}

TEST_CASE("swept 3: only one side of a curve that crosses the axis is turned") {
    const auto ellipse = [](StepText& step) {
        const int at = step.placement({0, 0, 1}, {0, -1, 0}, Vector3::UnitX());
        return step.add("ELLIPSE(''," + StepText::ref(at) + ",4.,2.)");
    };
    const Face egg = face_on(revolution(ellipse, {0, 0, 0}, Vector3::UnitZ()),
                             {{4, 0, 1}, {0, 4, 1}, {-4, 0, 1}});
    const auto& s = std::get<SharedBSplineSurface>(egg.surface);
    CHECK(!s->closed_v);
    // From pole to pole.
    for (const double v : {s->start_v(), s->end_v()}) {
        for (const double u : {0.0, 1.0, 4.0}) {
            CHECK(evaluate(*s, {u, v}).head<2>().norm() <= resolution_mm);
        }
    }
    CHECK(is_on(egg, {0, -4, 1}));
    CHECK(is_on(egg, {0, 0, 3}));
    // An ellipse off the axis that crosses it: of its two parts, the one that the face lies on.
    const auto off_axis = [](StepText& step) {
        const int at = step.placement({1, 0, 0}, {0, -1, 0}, Vector3::UnitX());
        return step.add("ELLIPSE(''," + StepText::ref(at) + ",3.,2.)");
    };
    const Face apple = face_on(revolution(off_axis, {0, 0, 0}, Vector3::UnitZ()),
                               {{4, 0, 0}, {0, 4, 0}, {-4, 0, 0}});
    CHECK(is_on(apple, {0, -4, 0}));
    CHECK(!is_on(apple, {2, 0, 0}));
    const Face lemon = face_on(revolution(off_axis, {0, 0, 0}, Vector3::UnitZ()),
                               {{2, 0, 0}, {0, 2, 0}, {-2, 0, 0}});
    CHECK(is_on(lemon, {0, -2, 0}));
    CHECK(!is_on(lemon, {4, 0, 0}));
    // A parabola about its own axis.
    const auto parabola = [](StepText& step) {
        const int at = step.placement({0, 0, 0}, {0, 1, 0}, Vector3::UnitZ());
        return step.add("PARABOLA(''," + StepText::ref(at) + ",1.)");
    };
    const Face dish = face_on(revolution(parabola, {0, 0, 0}, Vector3::UnitZ()),
                              {{6, 0, 9}, {0, 6, 9}, {-6, 0, 9}});
    CHECK(is_on(dish, {0, 0, 0}));
    CHECK(is_on(dish, {0, -6, 9}));
    CHECK(is_on(dish, {2, 0, 1}));
}

TEST_CASE("swept 2: a turned B-spline") {
    const auto profile = [](StepText& step) {
        std::vector<int> ids;
        for (const Point3& p : {Point3(3, 0, 0), Point3(5, 0, 2), Point3(3, 0, 4), Point3(4, 0, 6)})
            ids.push_back(step.point(p));
        return step.add("BEZIER_CURVE('',3," + StepText::refs(ids) + ",.UNSPECIFIED.,.F.,.U.)");
    };
    const Face vase = face_on(revolution(profile, {0, 0, 0}, Vector3::UnitZ()),
                              {{3, 0, 0}, {0, 3, 0}, {-3, 0, 0}});
    const auto& s = std::get<SharedBSplineSurface>(vase.surface);
    CHECK(s->closed_u);
    const double x = (3 + 3 * 5 + 3 * 3 + 4) / 8.0, z = (3 * 2 + 3 * 4 + 6) / 8.0;
    CHECK(is_on(vase, {0, -x, z}));
    CHECK(stated_normal(vase, {-x, 0, z}).x() < -0.5);
}
