// The numbers are those of the contract in kernel/brep/sewing.h.

#include "kernel/brep/sewing.h"

#include <doctest/doctest.h>

#include <set>

#include "kernel/brep/assembly.h"
#include "kernel/brep/free_edges.h"
#include "kernel/brep/gaps.h"
#include "kernel/brep/healing.h"
#include "kernel/brep/placement.h"
#include "kernel/brep/point_index.h"
#include "kernel/brep/validity.h"
#include "kernel/brep/volume.h"
#include "kernel/exploded.h"
#include "kernel/geometry/random_curves.h"
#include "kernel/solids.h"

using namespace lyr;
using namespace lyr::testing;
using lyr::test::Random;

namespace {

constexpr SewingReach sewing_reach{0.001, 0.01};

Model moved(const Model& model, const Vector3& by) {
    return transformed(model, Eigen::Affine3d(Eigen::Translation3d(by)));
}

// Without the face of that source.
Model without_face(Model model, SourceId source) {
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
        if (model.faces[f].source != source) continue;
        Shell& shell = model.shells[model.faces[f].shell.value];
        model.faces.erase(model.faces.begin() + static_cast<std::ptrdiff_t>(f));
        --shell.face_count;
    }
    return model;
}

std::set<SourceId> edges_of(const Model& model, const Face& face) {
    std::set<SourceId> sources;
    for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
        const Loop& loop = model.loops[l];
        for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
            sources.insert(model[model.coedges[loop.first_coedge + c].edge].source);
        }
    }
    return sources;
}

std::vector<double> volumes_of(const Model& model) {
    std::vector<double> volumes;
    for (std::size_t s = 0; s < model.shells.size(); ++s) {
        volumes.push_back(signed_volume_mm3(model, ShellId{s}));
    }
    std::sort(volumes.begin(), volumes.end());
    return volumes;
}

}  // namespace

TEST_CASE("points by place: those in a box, each once") {
    Random random(1);
    for (const int count : {0, 1, 2, 3, 100, 1000}) {
        std::vector<Point3> points;
        for (int i = 0; i < count; ++i) {
            // Some of them in one place, or on a line.
            const int kind = random.integer(0, 2);
            points.push_back(kind == 0   ? Point3(1, 2, 3)
                             : kind == 1 ? Point3(0, 0, random.between(-10, 10))
                                         : random.vector(10));
        }
        const PointIndex index(points);
        for (int k = 0; k < 50; ++k) {
            const Eigen::AlignedBox3d box = box_around(
                k == 0 ? Point3(1, 2, 3) : Point3(random.vector(10)), random.between(0, 5));
            std::multiset<std::uint32_t> found, expected;
            index.within(box, [&](std::uint32_t i) { found.insert(i); });
            for (std::uint32_t i = 0; i < points.size(); ++i) {
                if (box.contains(points[i])) expected.insert(i);
            }
            CHECK(found == expected);
        }
    }
}

TEST_CASE("sewing 1: a missing face leaves a hole with just its edges") {
    for (const Model& original : {box(3, 4, 5), drilled_box(10, 8, 6, 2), half_round(4, 10),
                                  hexagon_under_cone(5, 3, 8), frustum(1, 3, 5, Side::halves)}) {
        for (const Face& face : original.faces) {
            CAPTURE(face.source);
            for (const bool as_surfaces : {false, true}) {
                Explosion how;
                how.jitter_mm = sewing_reach.accepted_mm;
                how.as_surfaces = as_surfaces;
                how.turns_faces = true;
                Model model = exploded(original, how);
                const ShellId open = [&] {
                    for (const Face& f : model.faces) {
                        if (f.source == face.source) return f.shell;
                    }
                    return ShellId();
                }();
                if (as_surfaces) {
                    // The face with its shell and solid.
                    std::vector<SolidPlan> plans;
                    for (std::size_t s = 0; s < model.solids.size(); ++s) {
                        if (model[open].solid != SolidId{s}) {
                            plans.push_back(plan_of(model, SolidId{s}));
                        }
                    }
                    model = assembled(model, plans);
                } else {
                    model = without_face(model, face.source);
                }
                Diagnostics found;
                heal(model, sewing_reach, found);
                CHECK(model.faces.size() == original.faces.size() - 1);
                std::set<SourceId> named;
                for (const Gap& gap : gaps(model)) {
                    for (const EdgeId edge : gap.edges) named.insert(model[edge].source);
                }
                std::set<SourceId> expected = edges_of(original, face);
                // A drilled face leaves its rims, a wall of a bore does not bound itself.
                CHECK(named == expected);
                CHECK(!validate(model).empty());
                for (const Shell& shell : model.shells) CHECK(shell.is_surface == as_surfaces);
            }
        }
    }
}

TEST_CASE("sewing 1: closed edges that begin in different places are one") {
    for (int seed = 0; seed < 20; ++seed) {
        Random random(static_cast<unsigned>(seed));
        Explosion how;
        how.as_surfaces = seed % 2 == 0;
        Model model = exploded(frustum(2, 2, 5, Side::two_loops), how);
        for (Edge& edge : model.edges) {
            const double turn = random.between(-3, 3);
            edge.t_start += turn;
            edge.t_end += turn;
            model.vertices[edge.start.value].point = evaluate(edge.curve, edge.t_start);
        }
        Diagnostics found;
        heal(model, sewing_reach, found);
        CHECK(validate(model).empty());
        CHECK(volumes_of(model).size() == 1);
        CHECK(volumes_of(model)[0] == doctest::Approx(pi * 4 * 5));
    }
}

TEST_CASE("sewing 1: gaps beyond the limit stay open") {
    Model model = exploded(box(3, 4, 5), {});
    for (Face& face : model.faces) {
        if (face.source != 2000) continue;
        // The face as a whole, a little away.
        const Vector3 away(-2 * sewing_reach.limit_mm, 0, 0);
        const Loop& loop = model.loops[face.first_loop];
        for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
            Edge& edge = model.edges[model.coedges[loop.first_coedge + c].edge.value];
            edge.curve = transformed(edge.curve, Eigen::Affine3d(Eigen::Translation3d(away)));
            model.vertices[edge.start.value].point = evaluate(edge.curve, edge.t_start);
            model.vertices[edge.end.value].point = evaluate(edge.curve, edge.t_end);
        }
    }
    Diagnostics found;
    heal(model, sewing_reach, found);
    CHECK(free_edges(model).size() == 8);
    CHECK(gaps(model).size() == 2);
}

TEST_CASE("sewing 2: solids keep to themselves, surfaces do not") {
    // Two halves of a box, cut through the middle: each lacks the face between them.
    const Model left = without_face(box(2, 4, 5), 2003);
    const Model right = moved(without_face(box(2, 4, 5), 2000), {2, 0, 0});
    for (const bool as_surfaces : {false, true}) {
        Model model = joined(left, right);
        for (Shell& shell : model.shells) shell.is_surface = as_surfaces;
        Diagnostics found;
        heal(model, sewing_reach, found);
        CHECK(model.solids.size() == (as_surfaces ? 1 : 2));
        CHECK(validate(model).empty() == as_surfaces);
        if (as_surfaces) CHECK(volumes_of(model)[0] == doctest::Approx(4 * 4 * 5));
    }
}

TEST_CASE("sewing 2: bodies that touch in whole faces stay apart, whatever way faces look") {
    for (unsigned seed = 0; seed < 16; ++seed) {
        CAPTURE(seed);
        Explosion how;
        how.as_surfaces = true;
        how.turns_faces = seed % 2 == 1;
        how.seed = seed;
        const Model one = exploded(box(2, 3, 4), how);
        how.seed = 50 + seed;
        // Beside it a higher one: they share three edges of a face and the part of two others.
        const Model other = moved(exploded(box(2, 3, 6), how), {2, 0, 1});
        Model model = joined(one, other);
        Diagnostics found;
        heal(model, sewing_reach, found);
        const std::vector<double> volumes = volumes_of(model);
        REQUIRE(volumes.size() == 2);
        CHECK(volumes[0] == doctest::Approx(24));
        CHECK(volumes[1] == doctest::Approx(36));
    }
}

TEST_CASE("sewing 3: what is not free stays as it is, and the rest in its place") {
    Explosion how;
    how.jitter_mm = sewing_reach.accepted_mm;
    Model model = joined(drilled_box(10, 8, 6, 2), moved(exploded(box(3, 4, 5), how), {30, 0, 0}));
    const Model before = model;
    Diagnostics found;
    sew(model, sewing_reach, found);
    for (std::size_t e = 0; e < drilled_box(10, 8, 6, 2).edges.size(); ++e) {
        CHECK(model.edges[e].start == before.edges[e].start);
        CHECK(model.edges[e].end == before.edges[e].end);
        CHECK(model.edges[e].t_start == before.edges[e].t_start);
    }
    for (const Coedge& coedge : model.coedges) {
        const Edge& edge = model[coedge.edge];
        CHECK((point_on(edge, 0) - model[edge.start].point).norm() <= 2 * sewing_reach.accepted_mm);
        CHECK((point_on(edge, 1) - model[edge.end].point).norm() <= 2 * sewing_reach.accepted_mm);
    }
}

TEST_CASE("a sheet and its double close, but bound no volume") {
    Builder b;
    const VertexId v[4] = {b.vertex(0, 0, 0), b.vertex(1, 0, 0), b.vertex(1, 1, 0),
                           b.vertex(0, 1, 0)};
    const EdgeId e[4] = {b.line(v[0], v[1]), b.line(v[1], v[2]), b.line(v[2], v[3]),
                         b.line(v[3], v[0])};
    const Plane plane{Builder::frame_at({0, 0, 0})};
    b.face(plane, true, {{{e[0]}, {e[1]}, {e[2]}, {e[3]}}});
    b.face(plane, true, {{{e[0]}, {e[1]}, {e[2]}, {e[3]}}});
    Model model = b.finish();
    model.shells[0].is_surface = true;
    Diagnostics found;
    heal(model, sewing_reach, found);
    CHECK(model.shells[0].is_surface);
}
