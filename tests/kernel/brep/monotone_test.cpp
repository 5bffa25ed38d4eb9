#include "kernel/brep/monotone.h"

#include <doctest/doctest.h>

#include <random>

#include "kernel/brep/placement.h"
#include "kernel/solids.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

std::vector<Model> turned_solids() {
    std::vector<Model> result;
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    for (const Model& model : {box(3, 4, 5), frustum(2, 2, 5, Side::halves),
                               frustum(1, 3, 5, Side::seam), torus(5, 2, true), sphere(2, true)}) {
        result.push_back(model);
        for (int i = 0; i < 4; ++i) {
            const Vector3 axis =
                Vector3(normal(random), normal(random), normal(random)).normalized();
            result.push_back(
                transformed(model, Eigen::Affine3d(Eigen::AngleAxisd(normal(random), axis))));
        }
    }
    return result;
}

}  // namespace

TEST_CASE("monotone 2: the height along a piece only rises, between its levels") {
    for (const Model& model : turned_solids()) {
        for (const MonotonePiece& piece : monotone_pieces(model).pieces) {
            CHECK(piece.bottom_mm < piece.top_mm);
            double before = piece.bottom_mm - 1e-7;
            for (int i = 0; i <= 50; ++i) {
                const double t = piece.t_bottom + (piece.t_top - piece.t_bottom) * i / 50;
                const double z = evaluate(model[piece.edge].curve, t).z();
                CHECK(z >= before - 1e-12);
                CHECK(z <= piece.top_mm + 1e-7);
                before = z;
            }
        }
    }
}

TEST_CASE("monotone 3: pieces met by a plane are odd exactly where an edge changes sides") {
    for (const Model& model : turned_solids()) {
        const MonotoneEdges edges = monotone_pieces(model);
        std::vector<double> heights{0};
        for (const double level : edges.vertex_level_mm) heights.push_back(level);
        for (const MonotonePiece& piece : edges.pieces) {
            heights.push_back(piece.top_mm);
            heights.push_back((piece.top_mm + piece.bottom_mm) / 2);
        }
        for (const double h : heights) {
            std::vector<int> met(model.edges.size(), 0);
            for (const MonotonePiece& piece : edges.pieces) {
                met[piece.edge.value] += piece.bottom_mm <= h && h < piece.top_mm;
            }
            for (std::size_t e = 0; e < met.size(); ++e) {
                const bool start_above = edges.vertex_level_mm[model.edges[e].start.value] > h;
                const bool end_above = edges.vertex_level_mm[model.edges[e].end.value] > h;
                CHECK((met[e] % 2 == 1) == (start_above != end_above));
            }
        }
    }
}

TEST_CASE("monotone 1, 4: what lies in a level plane up to round-off shares one level") {
    Model model = transformed(frustum(2, 2, 5, Side::halves),
                              Eigen::Affine3d(Eigen::AngleAxisd(1e-12, Vector3::UnitX())));
    const MonotoneEdges edges = monotone_pieces(model);
    CHECK(edges.vertex_level_mm[0] == edges.vertex_level_mm[2]);
    CHECK(edges.vertex_level_mm[1] == edges.vertex_level_mm[3]);
    // Only the two lines along the side are met by any plane.
    CHECK(edges.pieces.size() == 2);
}
