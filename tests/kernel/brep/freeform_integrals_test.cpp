// The numbers are those of the contract in kernel/brep/freeform_integrals.h; volumes by kernel/brep/volume.h.

#include "kernel/brep/freeform_integrals.h"

#include <doctest/doctest.h>

#include "kernel/brep/orientation.h"
#include "kernel/brep/placement.h"
#include "kernel/brep/volume.h"
#include "kernel/freeform_solids.h"
#include "kernel/geometry/random_curves.h"

using namespace lyr;
using namespace lyr::testing;
using lyr::test::Random;

namespace {

// As it is, turned inside out, moved and mirrored.
void check_volume(const Model& model, double expected, double whole) {
    const double bound = freeform_accuracy * whole;
    CHECK(std::abs(signed_volume_mm3(model, ShellId{0}) - expected) <= bound);
    Model reversed = model;
    reverse_shell(reversed, ShellId{0});
    CHECK(std::abs(signed_volume_mm3(reversed, ShellId{0}) + expected) <= bound);
    Random random(7);
    for (int i = 0; i < 8; ++i) {
        const Eigen::Affine3d move = random.similarity(false);
        CHECK(std::abs(signed_volume_mm3(transformed(model, move), ShellId{0}) - expected) <=
              bound);
        CHECK(std::abs(signed_volume_mm3(transformed(reversed, move), ShellId{0}) + expected) <=
              bound);
        check_orientation(transformed(model, move), expected, random);
    }
}

// Rational circles, quadrant by quadrant from +x, around the z axis: u; and v along a quadratic profile in the (x, z)
// plane, given by its control points and weights. `swapped` exchanges u and v, so that the normal turns.
BSplineSurface turned(const std::vector<Point2>& profile, const std::vector<double>& weights,
                      bool profile_closed, bool swapped) {
    const auto quadratic_knots = [](std::size_t pieces) {
        std::vector<double> knots{0};
        for (std::size_t i = 0; i <= pieces; ++i) knots.insert(knots.end(), 2, double(i));
        knots.push_back(double(pieces));
        return knots;
    };
    BSplineSurface s{
        2, 2, 9, profile.size(), quadratic_knots(4), quadratic_knots(profile.size() / 2), {}, {}};
    s.closed_u = true;
    s.closed_v = profile_closed;
    for (int i = 0; i < 9; ++i) {
        const double angle = i * pi / 4, reach = i % 2 == 0 ? 1 : std::sqrt(2.0);
        for (std::size_t j = 0; j < profile.size(); ++j) {
            const double r = profile[j].x() * reach;
            s.control_points.push_back({r * std::cos(angle), r * std::sin(angle), profile[j].y()});
            s.weights.push_back(weights[j] / reach);
        }
    }
    if (!swapped) return s;
    BSplineSurface t{2, 2, s.count_v, s.count_u, s.knots_v, s.knots_u, {}, {}};
    t.closed_u = s.closed_v;
    t.closed_v = s.closed_u;
    for (std::size_t j = 0; j < s.count_v; ++j) {
        for (std::size_t i = 0; i < s.count_u; ++i) {
            t.control_points.push_back(s.control_points[i * s.count_v + j]);
            t.weights.push_back(s.weights[i * s.count_v + j]);
        }
    }
    return t;
}

const double diagonal = std::sqrt(0.5);

Surface ball_surface(double r, bool swapped) {
    return std::make_shared<const BSplineSurface>(turned(
        {{0, -r}, {r, -r}, {r, 0}, {r, r}, {0, r}}, {1, diagonal, 1, diagonal, 1}, false, swapped));
}
Surface ring_surface(double major, double minor, bool swapped) {
    std::vector<Point2> profile;
    std::vector<double> weights;
    for (int i = 0; i < 9; ++i) {
        const double angle = i * pi / 4, reach = i % 2 == 0 ? 1 : std::sqrt(2.0);
        profile.push_back(
            {major + minor * reach * std::cos(angle), minor * reach * std::sin(angle)});
        weights.push_back(1 / reach);
    }
    return std::make_shared<const BSplineSurface>(turned(profile, weights, true, swapped));
}

// d/du x d/dv looks outward on these unless swapped.
void add_face(Builder& b, const Surface& surface, bool swapped,
              std::initializer_list<std::vector<Use>> loops) {
    b.face(surface, !swapped, loops);
}

Frame upright(const Point3& origin, double angle) {
    Frame frame;
    frame.origin = origin;
    frame.x = {std::cos(angle), std::sin(angle), 0};
    frame.y = Vector3::UnitZ();
    frame.z = frame.x.cross(frame.y);
    return frame;
}

}  // namespace

TEST_CASE("freeform integrals 1: bent cubes have their volume") {
    double worst = 0;
    for (unsigned seed = 0; seed < 24; ++seed) {
        CAPTURE(seed);
        const BezierVolume volume(1 + static_cast<int>(seed % 5), 20, 0.35, seed % 3 == 2, seed);
        const Model cube = bent_cube(volume);
        const double exact = volume.volume_mm3();
        worst = std::max(worst, std::abs(signed_volume_mm3(cube, ShellId{0}) / exact - 1));
        check_volume(cube, exact, exact);
        for (std::size_t f = 0; f < 6; ++f) CHECK(signed_area_mm2(cube, FaceId{f}) > 0);
    }
    MESSAGE("worst error, relative: " << worst);
}

TEST_CASE("freeform integrals 2: areas are negative where sense and loops contradict each other") {
    Model cube = bent_cube(BezierVolume(1, 10, 0, false, 1));
    for (std::size_t f = 0; f < 6; ++f) {
        CHECK(signed_area_mm2(cube, FaceId{f}) == doctest::Approx(100));
        cube.faces[f].same_sense = !cube.faces[f].same_sense;
        CHECK(signed_area_mm2(cube, FaceId{f}) == doctest::Approx(-100));
    }
}

TEST_CASE("orientation: a thin corrugated tube is what it is stated to be") {
    constexpr int lobes = 24, points_per_lobe = 24, count = lobes * points_per_lobe + 1;
    // The inner ring starts half a lobe further on.
    const auto ring = [](double radius_mm, double z_mm) {
        BSplineCurve c{3, {}, {}, {}, true};
        for (int i = 0; i < count; ++i) {
            const double first = radius_mm < 29.5 ? pi / lobes : 0;
            const double angle = first + 2 * pi * (i % (count - 1)) / (count - 1);
            const double r = radius_mm + 3 * std::cos(lobes * angle);
            c.control_points.push_back({r * std::cos(angle), r * std::sin(angle), z_mm});
        }
        c.knots.assign(4, 0.0);
        for (int i = 1; i < count - 3; ++i) c.knots.push_back(i);
        c.knots.resize(count + 4, count - 3);
        return c;
    };
    test::Random random(9);
    for (const double height_mm : {0.5, 5.0, 40.0}) {
        CAPTURE(height_mm);
        Builder b;
        EdgeId edges[2][2], seams[2];
        for (const int outer : {0, 1}) {
            const double radius_mm = 29 + outer;
            const auto low = ring(radius_mm, 0), high = ring(radius_mm, height_mm);
            const Point3 &from = low.control_points[0], &to = high.control_points[0];
            const VertexId bottom = b.vertex(from.x(), from.y(), from.z()),
                           top = b.vertex(to.x(), to.y(), to.z());
            edges[outer][0] = b.edge(low, bottom, bottom);
            edges[outer][1] = b.edge(high, top, top);
            seams[outer] = b.line(bottom, top);
        }
        for (const int outer : {0, 1}) {
            const bool inner = outer == 0;
            const auto wall = std::make_shared<const BSplineSurface>(
                extruded(ring(29 + outer, 0), {0, 0, height_mm}));
            std::vector<Use> loop{
                {edges[outer][0]}, {seams[outer]}, {edges[outer][1], true}, {seams[outer], true}};
            if (inner) {
                std::reverse(loop.begin(), loop.end());
                for (Use& use : loop) use.reversed = !use.reversed;
            }
            b.face(wall, !inner, {loop});
            b.face(Plane{Builder::looking({0, 0, outer * height_mm},
                                          (outer ? 1.0 : -1.0) * Vector3::UnitZ())},
                   true, {{{edges[1][outer], outer == 0}}, {{edges[0][outer], outer == 1}}});
        }
        const Model model = b.finish();
        const double volume_mm3 = signed_volume_mm3(model, ShellId{0});
        REQUIRE(volume_mm3 > 0);
        for (int i = 0; i < 4; ++i)
            check_orientation(transformed(model, random.similarity(false)), volume_mm3, random);
        Model as_stated = model;
        CHECK(orient_closed_shell(as_stated, ShellId{0}, false).faces_turned == 0);
    }
}

TEST_CASE("freeform integrals 3: balls, whole and in parts") {
    const double r = 3, whole = 4.0 / 3 * pi * r * r * r;
    for (const bool swapped : {false, true}) {
        const Surface surface = ball_surface(r, swapped);
        Builder bare;
        add_face(bare, surface, swapped, {});
        check_volume(bare.finish(), whole, whole);
        Builder with_seam;
        const EdgeId seam = with_seam.edge(Circle{upright({0, 0, 0}, 0), r},
                                           with_seam.vertex(0, 0, -r), with_seam.vertex(0, 0, r));
        add_face(with_seam, surface, swapped, {{{seam}, {seam, true}}});
        check_volume(with_seam.finish(), whole, whole);
        for (const double z : {-2.9, -1.0, 0.0, 2.5}) {
            // The cap above z; with a seam to the pole or without.
            for (const bool seamed : {false, true}) {
                Builder b;
                const double rim_radius = std::sqrt(r * r - z * z), h = r - z;
                const VertexId v = b.vertex(rim_radius, 0, z);
                const EdgeId rim = b.circle(z, rim_radius, v);
                if (seamed) {
                    const EdgeId line =
                        b.edge(Circle{upright({0, 0, 0}, 0), r}, v, b.vertex(0, 0, r));
                    add_face(b, surface, swapped, {{{rim}, {line}, {line, true}}});
                } else {
                    add_face(b, surface, swapped, {{{rim}}});
                }
                b.face(Plane{Builder::looking({0, 0, z}, -Vector3::UnitZ())}, true,
                       {{{rim, true}}});
                const Model cap = b.finish();
                check_volume(cap, pi * h * h * (3 * r - h) / 3, whole);
                CHECK(signed_area_mm2(cap, FaceId{0}) == doctest::Approx(2 * pi * r * h));
                // The cap below z.
                check_volume(transformed(cap, Eigen::Affine3d(Eigen::Scaling(1.0, 1.0, -1.0))),
                             pi * h * h * (3 * r - h) / 3, whole);
            }
        }
        for (const double angle : {0.3, 2.0, pi, 3.3, 6.0}) {
            // A wedge between two meridians.
            Builder b;
            const VertexId south = b.vertex(0, 0, -r), north = b.vertex(0, 0, r);
            const EdgeId first = b.edge(Circle{upright({0, 0, 0}, 0), r}, south, north);
            const EdgeId second = b.edge(Circle{upright({0, 0, 0}, angle), r}, south, north);
            const EdgeId axis = b.line(south, north);
            add_face(b, surface, swapped, {{{second}, {first, true}}});
            b.face(Plane{upright({0, 0, 0}, 0)}, true, {{{first}, {axis, true}}});
            b.face(Plane{upright({0, 0, 0}, angle)}, false, {{{axis}, {second, true}}});
            CAPTURE(angle);
            check_volume(b.finish(), whole * angle / (2 * pi), whole);
        }
    }
}

TEST_CASE("freeform integrals 3: a loop may pass through both poles, at vertices or within edges") {
    const double r = 3, half = 2.0 / 3 * pi * r * r * r;
    for (const bool swapped : {false, true}) {
        for (const double angle : {0.0, 0.3, pi / 2, 4.0}) {
            for (const double start : {0.0, 0.1, pi / 2}) {
                CAPTURE(angle);
                CAPTURE(start);
                // The half of the ball beside an upright circle that begins at `start` over the equator.
                Builder b;
                const Circle circle{upright({0, 0, 0}, angle), r};
                const Point3 at = evaluate(Curve(circle), start);
                const VertexId v = b.vertex(at.x(), at.y(), at.z());
                const EdgeId rim = b.edge(circle, v, v);
                add_face(b, ball_surface(r, swapped), swapped, {{{rim}}});
                b.face(Plane{circle.frame}, false, {{{rim, true}}});
                const Model model = b.finish();
                check_volume(model, half, 2 * half);
                CHECK(signed_area_mm2(model, FaceId{0}) ==
                      doctest::Approx(2 * pi * r * r).epsilon(freeform_accuracy));
            }
        }
    }
}

TEST_CASE("freeform integrals 3: rings, whole and in parts") {
    const double major = 5, minor = 2, tube = pi * minor * minor, whole = 2 * pi * major * tube;
    for (const bool swapped : {false, true}) {
        const Surface surface = ring_surface(major, minor, swapped);
        Builder bare;
        add_face(bare, surface, swapped, {});
        check_volume(bare.finish(), whole, whole);
        Builder seamed;
        const VertexId v = seamed.vertex(major + minor, 0, 0);
        const EdgeId around = seamed.circle(0, major + minor, v);
        const EdgeId across = seamed.edge(Circle{upright({major, 0, 0}, 0), minor}, v, v);
        add_face(seamed, surface, swapped, {{{around}, {across}, {around, true}, {across, true}}});
        check_volume(seamed.finish(), whole, whole);
        for (const double angle : {0.1, 3.0, 3.3, 6.2}) {
            Builder b;
            const Vector3 out(std::cos(angle), std::sin(angle), 0);
            const Frame first = upright({major, 0, 0}, 0), last = upright(major * out, angle);
            const Point3 end = (major + minor) * out;
            const VertexId a = b.vertex(major + minor, 0, 0), z = b.vertex(end.x(), end.y(), 0);
            const EdgeId start_ring = b.edge(Circle{first, minor}, a, a);
            const EdgeId end_ring = b.edge(Circle{last, minor}, z, z);
            add_face(b, surface, swapped, {{{start_ring, true}}, {{end_ring}}});
            b.face(Plane{first}, true, {{{start_ring}}});
            b.face(Plane{last}, false, {{{end_ring, true}}});
            check_volume(b.finish(), angle * major * tube, whole);
        }
        for (const double z : {0.8, 0.0, -1.5}) {
            Builder b;
            const double reach = std::sqrt(minor * minor - z * z), v0 = std::asin(z / minor);
            const EdgeId outer = b.circle(z, major + reach, b.vertex(major + reach, 0, z));
            const EdgeId inner = b.circle(z, major - reach, b.vertex(major - reach, 0, z));
            add_face(b, surface, swapped, {{{outer}}, {{inner, true}}});
            b.face(Plane{Builder::looking({0, 0, z}, -Vector3::UnitZ())}, true,
                   {{{outer, true}}, {{inner}}});
            const double segment = minor * minor * (pi / 2 - v0 - std::sin(v0) * std::cos(v0));
            check_volume(b.finish(), 2 * pi * major * segment, whole);
        }
    }
}

TEST_CASE("freeform integrals 2: loops that leave no region give negative areas on tubes too") {
    // A cylinder as a B-spline surface, with two loops.
    for (const bool swapped : {false, true}) {
        const Surface side = std::make_shared<const BSplineSurface>(
            turned({{2, -5}, {2, 0}, {2, 5}}, {1, 1, 1}, false, swapped));
        Builder b;
        const EdgeId low = b.circle(-3, 2, b.vertex(2, 0, -3));
        const EdgeId high = b.circle(4, 2, b.vertex(0, 2, 4));
        add_face(b, side, swapped, {{{low}}, {{high, true}}});
        b.face(Plane{Builder::looking({0, 0, -3}, -Vector3::UnitZ())}, true, {{{low, true}}});
        b.face(Plane{Builder::frame_at({0, 0, 4})}, true, {{{high}}});
        Model drum = b.finish();
        check_volume(drum, pi * 4 * 7, pi * 4 * 10);
        CHECK(signed_area_mm2(drum, FaceId{0}) == doctest::Approx(pi * 4 * 7));
        drum.faces[0].same_sense = !drum.faces[0].same_sense;
        CHECK(signed_area_mm2(drum, FaceId{0}) == doctest::Approx(-pi * 4 * 7));
    }
}
