// Surfaces in all forms that files state them in, by the numbers of the contracts in parser/import/surfaces.h and
// parser/import/swept.h.

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "checks.h"

using namespace lyr;
using namespace lyr::test;

namespace {

using Write = std::function<int(StepText&)>;

// A face on the surface that `surface` writes, bounded by straight edges from point to point.
StepText face_step(const Write& surface, const std::vector<Point3>& corners,
                   bool same_sense = true) {
    StepText step;
    std::vector<int> vertices, uses;
    for (const Point3& corner : corners) vertices.push_back(step.vertex(corner));
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::size_t next = (i + 1) % corners.size();
        const int line = step.line(corners[i], corners[next]);
        uses.push_back(step.oriented(step.edge(vertices[i], vertices[next], line), true));
    }
    const int face = step.face({step.bound(step.loop(uses))}, surface(step), same_sense);
    const int shell = step.add("CLOSED_SHELL(''," + StepText::refs({face}) + ")");
    step.representation({step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")},
                        step.millimetres());
    return step;
}

Face face_on(const Write& surface, const std::vector<Point3>& corners, bool same_sense = true) {
    return imported(face_step(surface, corners, same_sense)).model.faces.at(0);
}

// What the file says is outward at a point of the surface.
Vector3 stated_normal(const Face& face, const Point3& at) {
    const Vector3 along = normal(face.surface, invert(face.surface, at));
    return face.same_sense ? along : Vector3(-along);
}

bool is_on(const Face& face, const Point3& p) {
    return near(evaluate(face.surface, invert(face.surface, p)), p);
}

int origin_placement(StepText& step) {
    return step.placement({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitX());
}

Write circle(const Point3& centre, const Vector3& z, const Vector3& x, double radius) {
    return [=](StepText& step) {
        const int at = step.placement(centre, z, x);
        return step.add("CIRCLE(''," + StepText::ref(at) + "," + StepText::num(radius) + ")");
    };
}
Write line(const Point3& from, const Point3& to) {
    return [=](StepText& step) { return step.line(from, to); };
}

Write extrusion(const Write& curve, const Vector3& along) {
    return [=](StepText& step) {
        const int swept = curve(step), direction = step.direction(along);
        const int vector = step.add("VECTOR(''," + StepText::ref(direction) + ",2.5)");
        return step.add("SURFACE_OF_LINEAR_EXTRUSION(''," + StepText::ref(swept) + "," +
                        StepText::ref(vector) + ")");
    };
}

Write revolution(const Write& curve, const Point3& origin, const Vector3& along) {
    return [=](StepText& step) {
        const int swept = curve(step), at = step.point(origin), z = step.direction(along);
        const int axis =
            step.add("AXIS1_PLACEMENT(''," + StepText::ref(at) + "," + StepText::ref(z) + ")");
        return step.add("SURFACE_OF_REVOLUTION(''," + StepText::ref(swept) + "," +
                        StepText::ref(axis) + ")");
    };
}

Write trimmed(const Write& basis, const Point3& from, const Point3& to, bool agrees) {
    return [=](StepText& step) {
        const int curve = basis(step), a = step.point(from), b = step.point(to);
        return step.add("TRIMMED_CURVE(''," + StepText::ref(curve) + ",(" + StepText::ref(a) +
                        "),(" + StepText::ref(b) + ")," + StepText::flag(agrees) + ",.CARTESIAN.)");
    };
}

// A hill: the net of a surface of degree 2 by 3.
std::vector<std::vector<Point3>> hill() {
    return {{{0, 0, 0}, {0, 1, 0}, {0, 2, 0}, {0, 3, 0}},
            {{1, 0, 0}, {1, 1, 5}, {1, 2, 5}, {1, 3, 0}},
            {{2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {2, 3, 0}}};
}

std::string net_text(StepText& step, const std::vector<std::vector<Point3>>& net) {
    std::string text = "(";
    for (const auto& row : net) {
        std::vector<int> ids;
        for (const Point3& p : row) ids.push_back(step.point(p));
        if (text.size() > 1) text += ',';
        text += StepText::refs(ids);
    }
    return text + ")";
}

const std::string net_tail = ",.UNSPECIFIED.,.F.,.F.,.U.";
const std::vector<Point3> hill_corners{{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}};

Write simple_hill(const std::string& type, const std::string& form) {
    return [=](StepText& step) {
        return step.add(type + "('',2,3," + net_text(step, hill()) + net_tail + form + ")");
    };
}
Write rational_hill(const std::string& form, const std::string& weights) {
    return [=](StepText& step) {
        return step.add("(BOUNDED_SURFACE()B_SPLINE_SURFACE(2,3," + net_text(step, hill()) +
                        net_tail + ")" + form +
                        "GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(" + weights +
                        ")REPRESENTATION_ITEM('')SURFACE())");
    };
}

}  // namespace

TEST_CASE("1: B-spline surfaces in every form") {
    const std::string stated = ",(3,3),(4,4),(0.,1.),(0.,1.),.UNSPECIFIED.";
    for (const auto& [type, form] :
         {std::pair<std::string, std::string>("B_SPLINE_SURFACE_WITH_KNOTS", stated),
          {"BEZIER_SURFACE", ""},
          {"QUASI_UNIFORM_SURFACE", ""}}) {
        const Face face = face_on(simple_hill(type, form), hill_corners);
        const auto& s = std::get<SharedBSplineSurface>(face.surface);
        CHECK(near(evaluate(*s, {0.5, 0.5}), {1, 1.5, 5 * 0.5 * 0.75}));
        CHECK(stated_normal(face, {0, 0, 0}).z() > 0);
    }
    // Uniform knots leave the middle one of the spans: it ends a sixth of the way between the border's points.
    const Face uniform = face_on(simple_hill("UNIFORM_SURFACE", ""), hill_corners);
    const auto& s = std::get<SharedBSplineSurface>(uniform.surface);
    CHECK(near(evaluate(*s, {s->start_u(), s->start_v()}), {0.5, 1, 0.5 * 5 * (4 + 1) / 6.0}));
    // Twice the weight on the two points of the ridge.
    for (const std::string form : {"B_SPLINE_SURFACE_WITH_KNOTS((3,3),(4,4),(0.,1.),(0.,1.),.U.)",
                                   "BEZIER_SURFACE()", "QUASI_UNIFORM_SURFACE()"}) {
        const Face face = face_on(
            rational_hill(form, "((1.,1.,1.,1.),(1.,2.,2.,1.),(1.,1.,1.,1.))"), hill_corners);
        const auto& r = std::get<SharedBSplineSurface>(face.surface);
        const double ridge = 0.5 * 0.75;
        CHECK(near(evaluate(*r, {0.5, 0.5}), {1, 1.5, 5 * 2 * ridge / (1 + ridge)}));
    }
}

TEST_CASE("1: what does not fit in a B-spline surface is named") {
    const auto error_of = [](const Write& surface) {
        return refused(face_step(surface, hill_corners));
    };
    const std::string type = "B_SPLINE_SURFACE_WITH_KNOTS";
    const Diagnostic sum =
        error_of(simple_hill(type, ",(3,2),(4,4),(0.,1.),(0.,1.),.UNSPECIFIED."));
    CHECK(mentions(sum, "points + degree + 1 = 6"));
    const Diagnostic order =
        error_of(simple_hill(type, ",(3,3),(4,4),(0.,1.),(1.,0.),.UNSPECIFIED."));
    CHECK(mentions(order, "ascending knots"));
    const Diagnostic weights =
        error_of(rational_hill("BEZIER_SURFACE()", "((1.,1.,1.,1.),(1.,2.,2.),(1.,1.,1.,1.))"));
    CHECK(mentions(weights, "a list of 4"));
    const Diagnostic sign =
        error_of(rational_hill("BEZIER_SURFACE()", "((1.,1.,1.,1.),(1.,0.,2.,1.),(1.,1.,1.,1.))"));
    CHECK(mentions(sign, "positive weight"));
    const Diagnostic ragged = error_of([](StepText& step) {
        auto net = hill();
        net[1].pop_back();
        return step.add("BEZIER_SURFACE('',2,3," + net_text(step, net) + net_tail + ")");
    });
    CHECK(mentions(ragged, "a list of 4"));
    const Diagnostic degree = error_of([](StepText& step) {
        return step.add("BEZIER_SURFACE('',3,3," + net_text(step, hill()) + net_tail + ")");
    });
    CHECK(mentions(degree, "a degree from 1 to"));
}

TEST_CASE("1: a B-spline surface is closed if its borders meet, whatever its flags say") {
    // A square tube, open at both ends; then with one border moved.
    const auto tube = [](double gap, const std::string& flags) {
        return [=](StepText& step) {
            const double x[] = {1, 1, -1, -1, 1}, y[] = {-1, 1, 1, -1, -1};
            std::vector<std::vector<Point3>> net;
            for (int i = 0; i < 5; ++i) {
                const double off = i == 4 ? gap : 0;
                net.push_back({{x[i], y[i] + off, 0}, {x[i], y[i] + off, 4}});
            }
            return step.add("QUASI_UNIFORM_SURFACE('',2,1," + net_text(step, net) +
                            ",.UNSPECIFIED.," + flags + ",.U.)");
        };
    };
    const std::vector<Point3> corners{{1, -1, 0}, {1, -1, 4}, {0, 1, 4}};
    const auto closed = [&](double gap, const std::string& flags) {
        const Face face = face_on(tube(gap, flags), corners);
        const auto& s = std::get<SharedBSplineSurface>(face.surface);
        CHECK(!s->closed_v);
        return s->closed_u;
    };
    CHECK(closed(0, ".F.,.F."));
    CHECK(closed(0.5 * resolution_mm, ".F.,.T."));
    CHECK(!closed(1e-3, ".T.,.T."));
}

TEST_CASE("3: a flat B-spline surface is a plane that looks the same way") {
    for (const bool turned : {false, true}) {
        const Face face = face_on(
            [&](StepText& step) {
                std::vector<std::vector<Point3>> net{{{0, 0, 2}, {0, 1, 2}},
                                                     {{3, 0, 2}, {3, 1, 2}}};
                if (turned) std::swap(net[0], net[1]);
                return step.add("BEZIER_SURFACE('',1,1," + net_text(step, net) + net_tail + ")");
            },
            {{0, 0, 2}, {3, 0, 2}, {3, 1, 2}});
        REQUIRE(std::holds_alternative<Plane>(face.surface));
        CHECK(is_on(face, {2, 2, 2}));
        CHECK(near(stated_normal(face, {0, 0, 2}), {0, 0, turned ? -1.0 : 1.0}));
    }
}

TEST_CASE("1: a torus of which one sheet is meant") {
    for (const bool outer : {true, false}) {
        const Face face = face_on(
            [&](StepText& step) {
                return step.add("DEGENERATE_TOROIDAL_SURFACE(''," +
                                StepText::ref(origin_placement(step)) + ",3.,5.," +
                                StepText::flag(outer) + ")");
            },
            {{8, 0, 0}, {0, 8, 0}, {-8, 0, 0}});
        CHECK(std::get<Torus>(face.surface).inner_sheet == !outer);
        // d/du x d/dv: away from the tube's centre, and into the lemon.
        const double x = outer ? 8 : 2;
        CHECK(stated_normal(face, {x, 0, 0}).x() * (outer ? 1 : -1) > 0.9);
    }
}

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

TEST_CASE("1: bounded and moved surfaces count by their basis") {
    const std::vector<Point3> corners{{2, 0, 0}, {0, 2, 0}, {0, 2, 3}};
    const Write cylinder = [](StepText& step) {
        return step.add("CYLINDRICAL_SURFACE(''," + StepText::ref(origin_placement(step)) + ",2.)");
    };
    for (const bool usense : {true, false}) {
        for (const bool vsense : {true, false}) {
            const Face face = face_on(
                [&](StepText& step) {
                    return step.add("RECTANGULAR_TRIMMED_SURFACE(''," +
                                    StepText::ref(cylinder(step)) + ",0.,1.5,0.,3.," +
                                    StepText::flag(usense) + "," + StepText::flag(vsense) + ")");
                },
                corners);
            REQUIRE(std::holds_alternative<Cylinder>(face.surface));
            CHECK(near(stated_normal(face, {2, 0, 0}), {usense == vsense ? 1.0 : -1.0, 0, 0}));
        }
    }
    const Face bounded = face_on(
        [&](StepText& step) {
            return step.add("CURVE_BOUNDED_SURFACE(''," + StepText::ref(cylinder(step)) +
                            ",(),.T.)");
        },
        corners);
    CHECK(std::holds_alternative<Cylinder>(bounded.surface));
    // Mirrored at the y-z plane and moved by 10 along x.
    const Face replica = face_on(
        [&](StepText& step) {
            const int x = step.direction(Vector3::UnitX()), y = step.direction(-Vector3::UnitY());
            const int at = step.point({10, 0, 0});
            const int to = step.add("CARTESIAN_TRANSFORMATION_OPERATOR_3D(''," + StepText::ref(x) +
                                    "," + StepText::ref(y) + "," + StepText::ref(at) + ",2.,$)");
            return step.add("SURFACE_REPLICA(''," + StepText::ref(cylinder(step)) + "," +
                            StepText::ref(to) + ")");
        },
        {{14, 0, 0}, {10, 4, 0}, {10, 4, 3}});
    CHECK(std::get<Cylinder>(replica.surface).radius_mm == doctest::Approx(4));
    // Its parameters are those of its parent, hence d/du x d/dv looks to the axis.
    CHECK(near(stated_normal(replica, {14, 0, 0}), {-1, 0, 0}));
}

TEST_CASE("1: offsets of elementary surfaces") {
    const auto offset = [](const std::string& type, const std::string& sizes, double distance) {
        return [=](StepText& step) {
            const int basis =
                step.add(type + "(''," + StepText::ref(origin_placement(step)) + sizes + ")");
            return step.add("OFFSET_SURFACE(''," + StepText::ref(basis) + "," +
                            StepText::num(distance) + ",.F.)");
        };
    };
    const std::vector<Point3> corners{{5, 0, 1}, {0, 5, 1}, {-5, 0, 1}};
    const Face plane = face_on(offset("PLANE", "", -2), corners);
    CHECK(is_on(plane, {3, 3, -2}));
    const Face cylinder = face_on(offset("CYLINDRICAL_SURFACE", ",3.", 2), corners);
    CHECK(std::get<Cylinder>(cylinder.surface).radius_mm == 5);
    const Face beyond = face_on(offset("CYLINDRICAL_SURFACE", ",3.", -8), corners);
    CHECK(std::get<Cylinder>(beyond.surface).radius_mm == 5);
    CHECK(near(stated_normal(beyond, {5, 0, 0}), {-1, 0, 0}));
    const Face sphere = face_on(offset("SPHERICAL_SURFACE", ",3.", -1), corners);
    CHECK(std::get<Sphere>(sphere.surface).radius_mm == 2);
    const Face torus = face_on(offset("TOROIDAL_SURFACE", ",6.,2.", -1), corners);
    CHECK(std::get<Torus>(torus.surface).minor_mm == 1);
    // Every point of a cone by 2 along its normal.
    const double half = 0.4;
    const Face cone = face_on(offset("CONICAL_SURFACE", ",3.," + StepText::num(half), 2), corners);
    const Point3 base(3 + 4 * std::tan(half), 0, 4);
    CHECK(is_on(cone, base + 2 * Vector3(std::cos(half), 0, -std::sin(half))));

    CHECK(mentions(refused(face_step(offset("SPHERICAL_SURFACE", ",3.", -3), corners)),
                   "nothing is left"));
}

namespace {

Write offset_of(const Write& basis, double distance) {
    return [=](StepText& step) {
        return step.add("OFFSET_SURFACE(''," + StepText::ref(basis(step)) + "," +
                        StepText::num(distance) + ",.F.)");
    };
}

}  // namespace

TEST_CASE("offset 1: of a free-form surface, along the normal that the file gives it") {
    const Write basis = simple_hill("BEZIER_SURFACE", "");
    const Face face = face_on(basis, hill_corners);
    for (const double distance : {-0.03, 0.05}) {
        const Face moved = face_on(offset_of(basis, distance), hill_corners);
        // What is offset back and forth is offset by the sum.
        const Face twice = face_on(offset_of(offset_of(basis, -4), distance + 4), hill_corners);
        for (const Point2& uv : {Point2(0, 0), Point2(0.3, 0.8), Point2(0.5, 0.5), Point2(1, 1)}) {
            const Point3 p = evaluate(face.surface, uv);
            const Point3 q = p + distance * stated_normal(face, p);
            CHECK(is_on(moved, q));
            CHECK(is_on(twice, q));
            CHECK((stated_normal(moved, q) - stated_normal(face, p)).norm() < 1e-5);
        }
    }
}

TEST_CASE("offset 1: of swept surfaces, which reach as far as the offset's own boundary") {
    // A parabola y = x^2 / 4, extruded along z.
    const Write parabola = [](StepText& step) {
        const int at = step.placement({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitY());
        return step.add("PARABOLA(''," + StepText::ref(at) + ",1.)");
    };
    const Vector3 out = Vector3(4, -2, 0).normalized();  // at (4, 4)
    for (const double distance : {-3.0, 3.0}) {
        const Point3 p = Point3(4, 4, 0) + distance * out, q(-p.x(), p.y(), 0);
        const std::vector<Point3> corners{p, q, q + 2 * Vector3::UnitZ(), p + 2 * Vector3::UnitZ()};
        const Write basis = extrusion(parabola, Vector3::UnitZ());
        const Face plain = face_on(basis, {{4, 4, 0}, {-4, 4, 0}, {-4, 4, 2}});
        const double along = stated_normal(plain, {4, 4, 0}).dot(out) * distance;
        if (distance > 0) {
            const Face face = face_on(offset_of(basis, along), corners);
            for (const Point3& corner : corners) CHECK(is_on(face, corner));
        } else {
            // Its radius of curvature is 2 at the apex.
            const Diagnostic error = refused(face_step(offset_of(basis, along), corners));
            CHECK(error.status == ExitStatus::geometry);
            CHECK(mentions(error, "OFFSET_SURFACE #"));
            CHECK(mentions(error, "folds"));
        }
    }
}

TEST_CASE(
    "offset 2: a crease, a fold and a circle of references are errors that name the surface") {
    const Write roof = [](StepText& step) {
        std::string text = "B_SPLINE_SURFACE_WITH_KNOTS('',1,1,";
        text += net_text(step,
                         {{{0, 0, 0}, {0, 5, 0}}, {{4, 0, 3}, {4, 5, 3}}, {{8, 0, 0}, {8, 5, 0}}});
        return step.add(text + net_tail + ",(2,1,2),(2,2),(0.,1.,2.),(0.,1.),.UNSPECIFIED.)");
    };
    const Diagnostic creased = refused(face_step(offset_of(roof, 0.5), hill_corners));
    CHECK(creased.status == ExitStatus::geometry);
    CHECK(mentions(creased, "OFFSET_SURFACE #"));
    CHECK(mentions(creased, "crease"));
    const Diagnostic folded =
        refused(face_step(offset_of(simple_hill("BEZIER_SURFACE", ""), -40), hill_corners));
    const Diagnostic other =
        refused(face_step(offset_of(simple_hill("BEZIER_SURFACE", ""), 40), hill_corners));
    CHECK((mentions(folded, "folds") && mentions(other, "folds")));
    const Diagnostic cycle = refused(face_step(
        [](StepText& step) {
            const int id = step.reserve();
            step.define(id, "OFFSET_SURFACE(''," + StepText::ref(id) + ",1.,.F.)");
            return id;
        },
        hill_corners));
    CHECK(mentions(cycle, "refers to itself"));
}

TEST_CASE("1: a surface that is its own basis is an error") {
    const Diagnostic error = refused(face_step(
        [](StepText& step) {
            const int id = step.reserve();
            step.define(id, "CURVE_BOUNDED_SURFACE(''," + StepText::ref(id) + ",(),.T.)");
            return id;
        },
        hill_corners));
    CHECK(mentions(error, "refers to itself"));
}
