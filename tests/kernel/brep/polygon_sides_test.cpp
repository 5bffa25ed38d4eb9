// The numbers are those of the contract in kernel/brep/polygon_sides.h.

#include "kernel/brep/polygon_sides.h"

#include <doctest/doctest.h>

using namespace lyr;

TEST_CASE("1: sides against each other share an edge, in pairs") {
    Model model;
    PolygonSides sides(model);
    const VertexId a = sides.vertex_at({0, 0, 0}, 1), b = sides.vertex_at({3, 4, 0}, 2);
    const Coedge first = sides.of_side(a, b, 7);
    CHECK(!first.reversed);
    CHECK(sides.open_count() == 1);
    const Coedge same_way = sides.of_side(a, b, 7);
    CHECK(same_way.edge != first.edge);
    const Coedge back = sides.of_side(b, a, 7), back_again = sides.of_side(b, a, 7);
    CHECK(back.reversed);
    CHECK(back_again.reversed);
    CHECK(back.edge != back_again.edge);
    CHECK(sides.open_count() == 0);
    CHECK(model.edges.size() == 2);
    const Edge& edge = model[first.edge];
    CHECK(edge.t_end == 5);
    CHECK(evaluate(edge.curve, edge.t_end) == Point3(3, 4, 0));
}

TEST_CASE("2: the same three numbers are one vertex, as long as it is the same solid") {
    Model model;
    PolygonSides sides(model);
    const VertexId a = sides.vertex_at({0.1, 0, 2}, 1);
    CHECK(sides.vertex_at({0.1, -0.0, 2}, 2) == a);
    CHECK(sides.vertex_at({0.1, 1e-300, 2}, 2) != a);
    sides.clear();
    CHECK(sides.vertex_at({0.1, 0, 2}, 1) != a);
    CHECK(model.vertices.size() == 3);
}

TEST_CASE("the plane of a polygon looks to where its corners run counter-clockwise") {
    const std::vector<Point3> corners{{1, 1, 5}, {4, 1, 5}, {4, 2, 5}, {2, 1.5, 5}, {1, 3, 5}};
    const Plane plane = plane_of(corners);
    CHECK((plane.frame.z - Vector3::UnitZ()).norm() < 1e-15);
    const std::vector<Point3> turned(corners.rbegin(), corners.rend());
    CHECK((plane_of(turned).frame.z + Vector3::UnitZ()).norm() < 1e-15);
    const Plane line = plane_of({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}});
    CHECK(std::abs(line.frame.z.dot(Vector3(1, 1, 1))) < 1e-14);
    CHECK(line.frame.z.norm() == doctest::Approx(1));
}
