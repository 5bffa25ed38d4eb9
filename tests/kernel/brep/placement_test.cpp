#include "kernel/brep/placement.h"

#include <doctest/doctest.h>

#include "kernel/brep/validity.h"
#include "kernel/solids.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

// Distances of vertices to their edges' ends and to their faces' surfaces.
double worst_gap(const Model& model) {
    double worst = 0;
    for (const Edge& edge : model.edges) {
        worst =
            std::max(worst, (evaluate(edge.curve, edge.t_start) - model[edge.start].point).norm());
        worst = std::max(worst, (evaluate(edge.curve, edge.t_end) - model[edge.end].point).norm());
    }
    for (const Face& face : model.faces) {
        for (std::uint32_t l = 0; l < face.loop_count; ++l) {
            const Loop& loop = model.loops[face.first_loop + l];
            for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
                const Coedge& coedge = model.coedges[loop.first_coedge + c];
                const Point3 p = model[model.start_of(coedge)].point;
                const Point3 foot = evaluate(face.surface, invert(face.surface, p));
                worst = std::max(worst, (foot - p).norm());
            }
        }
    }
    return worst;
}

}  // namespace

TEST_CASE("placement 1: rotating, moving, scaling and mirroring keeps everything together") {
    Eigen::Affine3d turn(Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()));
    turn.pretranslate(Vector3(10, 20, 30));
    Eigen::Affine3d scaled = turn, mirrored = turn;
    scaled.scale(2.5);
    mirrored.prescale(Vector3(1, 1, -1));
    for (const Model& model : {box(3, 4, 5), frustum(1, 3, 5, Side::seam), torus(5, 2, true),
                               sphere(2, true), frustum(2, 2, 5, Side::halves)}) {
        for (const Eigen::Affine3d& move : {turn, scaled, mirrored}) {
            const Model moved = transformed(model, move);
            CHECK(worst_gap(moved) < 1e-12 * 100);
            CHECK(validate(moved).empty());
        }
    }
}

TEST_CASE("placement 2: up becomes z, also for straight down") {
    for (const Vector3& up :
         {Vector3(0, 0, 1), Vector3(0, 0, -2), Vector3(1, 0, 0), Vector3(1, -2, 3)}) {
        const Vector3 turned = turned_up(up).linear() * up.normalized();
        CHECK((turned - Vector3::UnitZ()).norm() < 1e-12);
        CHECK(turned_up(up).linear().determinant() == doctest::Approx(1));
    }
}
