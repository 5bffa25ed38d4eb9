// Surfaces in all forms that files state them in, by the numbers of the contract in parser/import/surfaces.h.

#include <doctest/doctest.h>

#include <cmath>

#include "surface_writers.h"

using namespace lyr;
using namespace lyr::test;

namespace {

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
