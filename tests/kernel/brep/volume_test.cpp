// The numbers are those of the contract in kernel/brep/volume.h.

#include "kernel/brep/volume.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "kernel/brep/orientation.h"
#include "kernel/brep/placement.h"
#include "kernel/geometry/random_curves.h"

using namespace lyr;
using lyr::test::Random;
using std::numbers::pi;

namespace {

const Vector3 x_axis = Vector3::UnitX(), y_axis = Vector3::UnitY(), z_axis = Vector3::UnitZ();

// One shell, face by face.
class Shape {
public:
    Shape() {
        model.solids.push_back({"", 0, 1, 0});
        model.shells.push_back({0, 0, SolidId(0), 0});
    }

    std::uint32_t edge(const Curve& curve, double from, double to) {
        const VertexId start = vertex(evaluate(curve, from)), end = vertex(evaluate(curve, to));
        model.edges.push_back({curve, from, to, start, end, 0});
        return static_cast<std::uint32_t>(model.edges.size() - 1);
    }
    std::uint32_t ring(const Frame& frame, double radius) {
        return edge(Circle{frame, radius}, 0, 2 * pi);
    }

    struct Use {
        std::uint32_t edge;
        bool reversed;
    };
    Shape& face(const Surface& surface, bool same_sense,
                const std::vector<std::vector<Use>>& loops) {
        model.faces.push_back({surface, same_sense, static_cast<std::uint32_t>(model.loops.size()),
                               static_cast<std::uint32_t>(loops.size()), ShellId(0), 0});
        for (const auto& loop : loops) {
            model.loops.push_back({static_cast<std::uint32_t>(model.coedges.size()),
                                   static_cast<std::uint32_t>(loop.size()), 0});
            for (const Use& use : loop)
                model.coedges.push_back({EdgeId(std::size_t{use.edge}), use.reversed});
        }
        ++model.shells[0].face_count;
        return *this;
    }

    Model model;

private:
    VertexId vertex(const Point3& p) {
        for (std::size_t i = 0; i < model.vertices.size(); ++i) {
            if ((model.vertices[i].point - p).norm() < 1e-9) return VertexId(i);
        }
        model.vertices.push_back({p, 0});
        return VertexId(model.vertices.size() - 1);
    }
};

Frame at_height(double z) {
    return {{0, 0, z}, x_axis, y_axis, z_axis};
}

// As it is, turned inside out, moved and mirrored.
void check_volume(const Shape& shape, double expected) {
    const double bound = volume_accuracy * std::abs(expected) * 10;
    CHECK(std::abs(signed_volume_mm3(shape.model, ShellId(0)) - expected) <= bound);
    Model reversed = shape.model;
    reverse_shell(reversed, ShellId(0));
    CHECK(std::abs(signed_volume_mm3(reversed, ShellId(0)) + expected) <= bound);
    Random random(31);
    for (int i = 0; i < 20; ++i) {
        const Eigen::Affine3d move = random.similarity(false);
        CHECK(std::abs(signed_volume_mm3(transformed(shape.model, move), ShellId(0)) - expected) <=
              bound);
        CHECK(std::abs(signed_volume_mm3(transformed(reversed, move), ShellId(0)) + expected) <=
              bound);
        if (expected > 0)
            testing::check_orientation(transformed(shape.model, move), expected, random);
    }
}

// A body of revolution between two heights: the lateral face and two discs.
Shape turned(const Surface& lateral, double low, double low_radius, double high,
             double high_radius) {
    Shape shape;
    const auto bottom = shape.ring(at_height(low), low_radius),
               top = shape.ring(at_height(high), high_radius);
    shape.face(lateral, true, {{{bottom, false}}, {{top, true}}});
    shape.face(Plane{at_height(low)}, false, {{{bottom, true}}});
    shape.face(Plane{at_height(high)}, true, {{{top, false}}});
    return shape;
}

}  // namespace

TEST_CASE("1, 2, 5: cylinders and cones") {
    check_volume(turned(Cylinder{at_height(3), 2}, 1, 2, 8, 2), pi * 4 * 7);
    check_volume(turned(Cone{at_height(0), 1, std::atan(0.5)}, 1, 1.5, 3, 2.5),
                 pi * 2 / 3 * (1.5 * 1.5 + 1.5 * 2.5 + 2.5 * 2.5));
    // To the apex: a vertex loop, or a seam that goes there and back.
    const Cone cone{at_height(0), 0, std::atan(0.5)};
    Shape with_loop;
    const auto rim = with_loop.ring(at_height(4), 2);
    with_loop.face(cone, true, {{{rim, true}}, {}})
        .face(Plane{at_height(4)}, true, {{{rim, false}}});
    check_volume(with_loop, pi * 4 * 4 / 3);
    Shape with_seam;
    const auto top = with_seam.ring(at_height(4), 2);
    const auto seam =
        with_seam.edge(Line{{0, 0, 0}, Vector3(2, 0, 4).normalized()}, 0, std::sqrt(20.0));
    with_seam.face(cone, true, {{{seam, false}, {top, true}, {seam, true}}});
    with_seam.face(Plane{at_height(4)}, true, {{{top, false}}});
    check_volume(with_seam, pi * 4 * 4 / 3);
}

TEST_CASE("1: a cone that is all but a cylinder, its apex far away (trj6_k1)") {
    for (const double half_angle : {2.6e-7, 1e-5, 1e-3}) {
        CAPTURE(half_angle);
        const double top = 2 + 7 * std::tan(half_angle);
        check_volume(turned(Cone{at_height(1), 2, half_angle}, 1, 2, 8, top),
                     pi * 7 / 3 * (4 + 2 * top + top * top));
    }
}

TEST_CASE("1: half a cone, its loop through the apex") {
    const double r = 3, h = 5;
    Shape half;
    const auto rim = half.edge(Circle{at_height(0), r}, 0, pi);
    const Vector3 up = Vector3(-r, 0, h).normalized(), up_left = Vector3(r, 0, h).normalized();
    const double slant = std::hypot(r, h);
    const auto right = half.edge(Line{{r, 0, 0}, up}, 0, slant),
               left = half.edge(Line{{-r, 0, 0}, up_left}, 0, slant),
               base = half.edge(Line{{-r, 0, 0}, x_axis}, 0, 2 * r);
    const Frame down{{0, 0, 0}, x_axis, -y_axis, -z_axis};
    half.face(Cone{down, r, std::atan(r / h)}, true,
              {{{rim, false}, {left, false}, {right, true}}});
    half.face(Plane{down}, true, {{{rim, true}, {base, true}}});
    half.face(Plane{{{0, 0, 0}, x_axis, z_axis, -y_axis}}, true,
              {{{base, false}, {right, false}, {left, true}}});
    check_volume(half, pi * r * r * h / 6);
}

TEST_CASE("1, 2, 5: spheres, whole and in parts") {
    const double r = 3, whole = 4.0 / 3 * pi * r * r * r;
    const Sphere sphere{{{1, 2, 3}, x_axis, y_axis, z_axis}, r};
    Shape bare;
    bare.face(sphere, true, {});
    check_volume(bare, whole);
    Shape with_seam;
    const Frame meridian{sphere.frame.origin, x_axis, z_axis, -y_axis};
    const auto seam = with_seam.edge(Circle{meridian, r}, -pi / 2, pi / 2);
    with_seam.face(sphere, true, {{{seam, false}, {seam, true}}});
    check_volume(with_seam, whole);
    // Two halves that meet in a circle through the poles: a meridian and the one across.
    Shape halves;
    const auto one = halves.edge(Circle{meridian, r}, -pi / 2, pi / 2);
    const auto other = halves.edge(Circle{meridian, r}, pi / 2, 3 * pi / 2);
    halves.face(sphere, true, {{{one, false}, {other, false}}})
        .face(sphere, true, {{{other, true}, {one, true}}});
    check_volume(halves, whole);
    // Caps of any size, and the rest of the sphere.
    for (const double h : {0.01, 0.5, 3.0, 5.5, 5.99}) {
        const double plane = 3 + r - h, rim = std::sqrt(r * r - (plane - 3) * (plane - 3));
        const Frame at{{1, 2, plane}, x_axis, y_axis, z_axis};
        Shape cap;
        const auto edge = cap.ring(at, rim);
        cap.face(sphere, true, {{{edge, false}}}).face(Plane{at}, false, {{{edge, true}}});
        check_volume(cap, pi * h * h * (3 * r - h) / 3);
    }
    // A spherical bubble in a box's place: its shell looks inward.
    Shape bubble;
    bubble.face(sphere, false, {});
    check_volume(bubble, -whole);
}

TEST_CASE("1, 2, 5: tori, whole and in parts") {
    const double major = 5, minor = 2, tube = pi * minor * minor;
    const Torus torus{at_height(0), major, minor};
    Shape bare;
    bare.face(torus, true, {});
    check_volume(bare, 2 * pi * major * tube);
    // Seams around both ways.
    Shape with_seams;
    const auto outer = with_seams.ring(at_height(0), major + minor);
    const Frame section{{major, 0, 0}, x_axis, z_axis, -y_axis};
    const auto across = with_seams.ring(section, minor);
    with_seams.face(torus, true,
                    {{{outer, false}, {across, false}, {outer, true}, {across, true}}});
    check_volume(with_seams, 2 * pi * major * tube);
    // Elbows of less and of more than half a turn.
    for (const double angle : {0.1, 1.0, 3.0, 3.3, 5.0, 6.2}) {
        const Vector3 out(std::cos(angle), std::sin(angle), 0), along(-out.y(), out.x(), 0);
        const Frame last{major * out, out, z_axis, -along};
        Shape elbow;
        const auto start = elbow.ring(section, minor), end = elbow.ring(last, minor);
        elbow.face(torus, true, {{{start, true}}, {{end, false}}});
        elbow.face(Plane{section}, true, {{{start, false}}})
            .face(Plane{last}, false, {{{end, true}}});
        check_volume(elbow, angle * major * tube);
    }
    // Above a plane through the tube.
    for (const double v : {0.3, 0.0, -0.7}) {
        const double z = minor * std::sin(v), reach = minor * std::cos(v);
        Shape upper;
        const auto outside = upper.ring(at_height(z), major + reach);
        const auto inside = upper.ring(at_height(z), major - reach);
        upper.face(torus, true, {{{outside, false}}, {{inside, true}}});
        upper.face(Plane{at_height(z)}, false, {{{outside, true}}, {{inside, false}}});
        const double segment = minor * minor * (pi / 2 - v - std::sin(v) * std::cos(v));
        check_volume(upper, 2 * pi * major * segment);
    }
}

TEST_CASE("1, 2, 5: where the tube crosses the axis, the lemon inside") {
    const Torus torus{at_height(0), 2, 5, true};
    const double tip = std::sqrt(25.0 - 4);
    for (const double z : {-4.0, -1.0, 0.0, 3.0}) {
        // The part above z, its radius sqrt(25 - h^2) - 2 at height h.
        const auto primitive = [](double h) {
            return 29 * h - h * h * h / 3 - 2 * (h * std::sqrt(25 - h * h) + 25 * std::asin(h / 5));
        };
        Shape shape;
        const auto rim = shape.ring(at_height(z), std::sqrt(25 - z * z) - 2);
        shape.face(torus, true, {{{rim, false}}}).face(Plane{at_height(z)}, false, {{{rim, true}}});
        check_volume(shape, pi * (primitive(tip) - primitive(z)));
    }
    // A wedge of it between two meridians, which meet in both poles.
    const double half = std::acos(2.0 / 5);
    for (const double angle : {0.5, 2.0, 4.0}) {
        const auto meridian = [&](double u) {
            const Vector3 out(std::cos(u), std::sin(u), 0);
            return Circle{{-2 * out, out, z_axis, out.cross(z_axis)}, 5};
        };
        const auto primitive = [](double h) {
            return 29 * h - h * h * h / 3 - 2 * (h * std::sqrt(25 - h * h) + 25 * std::asin(h / 5));
        };
        Shape wedge;
        const auto first = wedge.edge(meridian(0), -half, half),
                   second = wedge.edge(meridian(angle), -half, half);
        const auto axis = wedge.edge(Line{{0, 0, -tip}, z_axis}, 0, 2 * tip);
        wedge.face(torus, true, {{{second, false}, {first, true}}});
        wedge.face(Plane{{{0, 0, 0}, x_axis, z_axis, -y_axis}}, true,
                   {{{first, false}, {axis, true}}});
        const Vector3 out(std::cos(angle), std::sin(angle), 0);
        wedge.face(Plane{{{0, 0, 0}, out, z_axis, out.cross(z_axis)}}, false,
                   {{{axis, false}, {second, true}}});
        check_volume(wedge, angle / 2 * (primitive(tip) - primitive(-tip)));
    }
}

TEST_CASE("4: areas, negative where sense and loops contradict each other") {
    const double slant = std::sqrt(1 + 0.25);
    const Shape shapes[] = {turned(Cylinder{at_height(3), 2}, 1, 2, 8, 2),
                            turned(Cone{at_height(0), 1, std::atan(0.5)}, 1, 1.5, 3, 2.5)};
    const double areas[][3] = {{2 * pi * 2 * 7, pi * 4, pi * 4},
                               {pi * (1.5 + 2.5) * 2 * slant, pi * 2.25, pi * 6.25}};
    Random random(32);
    for (std::size_t i = 0; i < 2; ++i) {
        for (int k = 0; k < 10; ++k) {
            Model model = transformed(shapes[i].model, random.similarity(false));
            for (std::size_t f = 0; f < 3; ++f) {
                CHECK(signed_area_mm2(model, FaceId(f)) ==
                      doctest::Approx(areas[i][f]).epsilon(1e-9));
                model.faces[f].same_sense = !model.faces[f].same_sense;
                CHECK(signed_area_mm2(model, FaceId(f)) ==
                      doctest::Approx(-areas[i][f]).epsilon(1e-9));
            }
        }
    }
    const Frame section{{5, 0, 0}, x_axis, z_axis, -y_axis};
    Shape elbow;
    const Vector3 out(0, 1, 0);
    const auto start = elbow.ring(section, 2), end = elbow.ring({5 * out, out, z_axis, x_axis}, 2);
    elbow.face(Torus{at_height(0), 5, 2}, true, {{{start, true}}, {{end, false}}});
    CHECK(signed_area_mm2(elbow.model, FaceId(0)) ==
          doctest::Approx(pi / 2 * 5 * 2 * pi * 2).epsilon(1e-9));
    Shape ball;
    ball.face(Sphere{at_height(0), 3}, true, {});
    CHECK(signed_area_mm2(ball.model, FaceId(0)) == doctest::Approx(4 * pi * 9));
}
