#include "kernel/brep/extent.h"

#include <doctest/doctest.h>

#include <cmath>

#include "kernel/solids.h"

using namespace lyr;
using namespace lyr::testing;

TEST_CASE("extent: a part of a kilometre is cut, one point beyond is named") {
    CHECK(check_extent(box(1.9e6, 4, 5)));
    for (const double x : {1.1e6, -1e10, 1e300, double{INFINITY}, double{NAN}}) {
        Model model = box(3, 4, 5);
        model.vertices[3].point.x() = x;
        model.vertices[3].source = 77;
        const Status checked = check_extent(model);
        REQUIRE(!checked);
        CHECK(checked.error().status == ExitStatus::geometry);
        CHECK(checked.error().where.entity == 77);
    }
}

TEST_CASE("extent: control points count") {
    Model model = box(3, 4, 5);
    const Edge& edge = model.edges[5];
    BSplineCurve spline = rational(edge.curve, edge.t_start, edge.t_end);
    CHECK(check_extent(model));
    spline.control_points.back().y() = -1e10;
    model.edges[5].curve = spline;
    model.edges[5].source = 78;
    const Status checked = check_extent(model);
    REQUIRE(!checked);
    CHECK(checked.error().where.entity == 78);
}
