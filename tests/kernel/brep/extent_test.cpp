#include "kernel/brep/extent.h"

#include <doctest/doctest.h>

#include <cmath>

#include "kernel/freeform_solids.h"
#include "kernel/solids.h"

using namespace lyr;
using namespace lyr::testing;

TEST_CASE("extent: a part of a kilometre is cut, one point beyond is named") {
    CHECK(check_places(box(1.9e6, 4, 5)));
    for (const double x : {1.1e6, -1e10, 1e300, double{INFINITY}, double{NAN}}) {
        Model model = box(3, 4, 5);
        model.vertices[3].point.x() = x;
        model.vertices[3].source = 77;
        const Status checked = check_places(model);
        REQUIRE(!checked);
        CHECK(checked.error().status == ExitStatus::geometry);
        CHECK(checked.error().where.entity == 77);
    }
}

TEST_CASE("extent: control points and the ends of edges count") {
    Edge edge = box(3, 4, 5).edges[5];
    CHECK(check_extent(edge));
    edge.source = 78;
    BSplineCurve spline = rational(edge.curve, edge.t_start, edge.t_end);
    spline.control_points.back().y() = -1e10;
    Edge bent = edge;
    bent.curve = spline;
    const Status checked = check_extent(bent);
    REQUIRE(!checked);
    CHECK(checked.error().where.entity == 78);
    for (const double t : {1e7, double{INFINITY}}) {
        Edge endless = edge;
        endless.t_end = t;
        CHECK_FALSE(check_extent(endless));
    }
    Model cube = bent_cube(BezierVolume(2, 20, 0.3, false, 1));
    CHECK(check_extent(cube.faces[2]));
    BSplineSurface surface = *std::get<SharedBSplineSurface>(cube.faces[2].surface);
    surface.control_points[4].z() = 1e7;
    cube.faces[2].surface = std::make_shared<const BSplineSurface>(surface);
    CHECK_FALSE(check_extent(cube.faces[2]));
}

TEST_CASE(
    "extent: an edge far off its vertices is named, one a little off is the healer's affair") {
    for (const double off_mm : {0.0, 0.5, 5.0, 8.0, 1e3, 1e6}) {
        Model model = box(3, 4, 5);
        Line& line = std::get<Line>(model.edges[2].curve);
        line.origin += off_mm * line.direction.unitOrthogonal();
        model.edges[2].source = 79;
        const Status checked = check_places(model);
        CHECK(checked.ok() == (off_mm < 7.07));
        if (!checked) CHECK(checked.error().where.entity == 79);
    }
}
