// Solids taken apart and healed are what they were. The numbers are those of the contracts in kernel/brep/healing.h
// and sewing.h.

#include "kernel/brep/healing.h"

#include <doctest/doctest.h>

#include "kernel/brep/edge_deviation.h"
#include "kernel/brep/free_edges.h"
#include "kernel/brep/placement.h"
#include "kernel/brep/validity.h"
#include "kernel/brep/volume.h"
#include "kernel/exploded.h"
#include "kernel/freeform_solids.h"
#include "kernel/geometry/random_curves.h"
#include "kernel/solids.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

std::vector<Model> solids() {
    return {box(3, 4, 5),
            drilled_box(10, 8, 6, 2),
            frustum(2, 2, 5, Side::seam),
            frustum(1, 3, 5, Side::halves),
            frustum(3, 1, 5, Side::two_loops),
            half_round(4, 10),
            cone_with_apex(2, 3, true),
            cone_with_apex(2, 3, false),
            sphere(2, true),
            sphere(2, false),
            cut_ball(5, 3),
            halved_ball(3),
            halved_torus(5, 2),
            torus(5, 2, true),
            torus(5, 2, false),
            spindle_dome(2, 5, 4, false),
            hexagon_under_cone(5, 3, 8),
            bent_cube(BezierVolume(2, 20, 0.3, false, 3)),
            bent_cube(BezierVolume(3, 20, 0.3, true, 4))};
}

double volume_of(const Model& model) {
    double volume = 0;
    for (std::size_t s = 0; s < model.shells.size(); ++s) {
        volume += signed_volume_mm3(model, ShellId{s});
    }
    return volume;
}

double area_of(const Model& model) {
    double area = 0;
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
        area += std::abs(signed_area_mm2(model, FaceId{f}));
    }
    return area;
}

constexpr double accepted_mm = 0.001;
constexpr SewingReach reach{accepted_mm, 10 * accepted_mm};

bool has_warning(const Diagnostics& diagnostics) {
    return std::any_of(diagnostics.begin(), diagnostics.end(),
                       [](const Diagnostic& d) { return d.severity != Severity::note; });
}

void check_healed(const Model& original, const Explosion& how, double gap_mm) {
    CAPTURE(how.seed);
    Model model = exploded(original, how);
    Diagnostics found;
    heal(model, reach, found);
    CHECK(model.solids.size() == 1);
    CHECK(model.shells.size() == 1);
    CHECK(model.faces.size() == original.faces.size());
    CHECK(free_edges(model).empty());
    CHECK(validate(model).empty());
    CHECK(!model.shells[0].is_surface);
    const double exact = volume_of(original);
    const double allowed = gap_mm * area_of(original) + 1e-4 * exact;
    CHECK(std::abs(volume_of(model) - exact) <= allowed);
}

}  // namespace

TEST_CASE("healing 3: whole solids stay as they are") {
    for (const Model& original : solids()) {
        Model model = original;
        Diagnostics found;
        heal(model, reach, found);
        CHECK(found.empty());
        CHECK(model.edges.size() == original.edges.size());
        CHECK(model.vertices.size() == original.vertices.size());
        CHECK(volume_of(model) == volume_of(original));
    }
}

TEST_CASE("healing 1, sewing 1: solids taken apart are put together again") {
    std::size_t index = 0;
    for (const Model& original : solids()) {
        CAPTURE(index++);
        for (unsigned seed = 0; seed < 32; ++seed) {
            Explosion how;
            how.seed = seed;
            how.jitter_mm = seed % 2 == 0 ? 0 : accepted_mm;
            how.turns_faces = seed % 4 >= 2;
            how.splits_edges = seed % 8 >= 4;
            how.frees_vertices = seed % 16 >= 8;
            how.as_surfaces = seed >= 16;
            if (original.edges.empty() && how.turns_faces) continue;  // nothing to tell it by
            check_healed(original, how, accepted_mm);
        }
    }
}

TEST_CASE(
    "healing 1: loops that run the wrong way round are found by their face or its neighbours") {
    for (const Model& original : solids()) {
        for (unsigned seed = 0; seed < 16; ++seed) {
            Explosion how;
            how.seed = 100 + seed;
            how.turns_loops = true;
            how.turns_faces = seed % 2 == 1 && !original.edges.empty();
            check_healed(original, how, accepted_mm);
        }
    }
}

TEST_CASE("sewing 1: gaps up to ten times as wide are closed, and each is named") {
    for (unsigned seed = 0; seed < 8; ++seed) {
        Explosion how;
        how.seed = seed;
        how.jitter_mm = 9 * accepted_mm;
        Model model = exploded(box(30, 40, 50), how);
        Diagnostics found;
        heal(model, reach, found);
        CHECK(validate(model).empty());
        CHECK(has_warning(found));
        for (const Diagnostic& diagnostic : found) {
            CHECK(diagnostic.status == ExitStatus::geometry);
            CHECK(diagnostic.where.entity != 0);
            CHECK(diagnostic.where.x_mm.has_value());
        }
    }
}

TEST_CASE("healing 1: edges without length are left out") {
    for (const Model& original : {box(3, 4, 5), drilled_box(10, 8, 6, 2), half_round(4, 10)}) {
        // One in front of every coedge of the first face, from a vertex to another at the same place.
        Model model = original;
        std::vector<Coedge> coedges;
        for (std::size_t l = 0; l < model.loops.size(); ++l) {
            Loop& loop = model.loops[l];
            const auto first = static_cast<std::uint32_t>(coedges.size());
            for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
                const Coedge use = model.coedges[loop.first_coedge + c];
                if (l == 0) {
                    const Point3 at = model[model.start_of(use)].point;
                    const VertexId other{model.vertices.size()};
                    model.vertices.push_back({at, 7000});
                    coedges.push_back({EdgeId{model.edges.size()}, false});
                    model.edges.push_back(
                        {Line{at, Vector3::UnitX()}, 0, 0, other, model.start_of(use), 7001});
                }
                coedges.push_back(use);
            }
            loop.first_coedge = first;
            loop.coedge_count = static_cast<std::uint32_t>(coedges.size()) - first;
        }
        model.coedges = coedges;
        REQUIRE(!validate(model).empty());
        Diagnostics found;
        heal(model, reach, found);
        CHECK(found.size() == 2);
        CHECK(validate(model).empty());
        CHECK(model.edges.size() == original.edges.size());
        CHECK(volume_of(model) == doctest::Approx(volume_of(original)));
    }
}

TEST_CASE("healing 1: a face of nothing but short edges goes with them") {
    // A box whose edge is a sliver of a face, all its edges shorter than the resolution but two.
    Model model = box(3, 4, 5);
    const Point3 corner = model.vertices[0].point;
    Builder b;
    const VertexId v[3] = {b.vertex(corner.x(), corner.y(), corner.z()),
                           b.vertex(corner.x() + 1e-8, corner.y(), corner.z()),
                           b.vertex(corner.x(), corner.y() + 1e-8, corner.z())};
    const EdgeId e[3] = {b.line(v[0], v[1]), b.line(v[1], v[2]), b.line(v[2], v[0])};
    b.face(Plane{Builder::frame_at(corner)}, true, {{{e[0]}, {e[1]}, {e[2]}}});
    model = joined(model, b.finish());
    Diagnostics found;
    heal(model, reach, found);
    CHECK(model.faces.size() == 6);
    CHECK(model.edges.size() == 12);
}

TEST_CASE("healing 1: an edge around a closed curve may end in another vertex than it begins in") {
    for (const double end : {2 * pi, 1e-9, -1e-9, -2 * pi}) {
        CAPTURE(end);
        Model model = frustum(2, 2, 5, Side::two_loops);
        for (Edge& edge : model.edges) {
            edge.end = VertexId{model.vertices.size()};
            model.vertices.push_back({evaluate(edge.curve, end), 8000});
            edge.t_end = edge.t_start + end;
        }
        if (end < 0) {
            for (Coedge& coedge : model.coedges) coedge.reversed = !coedge.reversed;
        }
        REQUIRE(!validate(model).empty());
        Diagnostics found;
        heal(model, reach, found);
        CHECK(validate(model).empty());
        CHECK(volume_of(model) == doctest::Approx(pi * 4 * 5));
    }
}

TEST_CASE("edges off their surfaces are named, with the distance") {
    for (const Model& original : {box(3, 4, 5), frustum(1, 3, 5, Side::halves), halved_torus(5, 2),
                                  bent_cube(BezierVolume(2, 20, 0.3, false, 3))}) {
        Diagnostics none;
        report_deviations(original, accepted_mm, none);
        CHECK(none.empty());
        // Straight off the first face's surface.
        Model model = original;
        const Face& face = model.faces[0];
        Edge& edge =
            model.edges[model.coedges[model.loops[face.first_loop].first_coedge].edge.value];
        const Point3 point = point_on(edge, 0.48);
        const Vector3 off = normal(face.surface, invert(face.surface, point));
        for (const double distance_mm : {0.5 * accepted_mm, 3 * accepted_mm}) {
            Model bent = model;
            Edge& moved = bent.edges[static_cast<std::size_t>(&edge - model.edges.data())];
            moved.curve =
                transformed(moved.curve, Eigen::Affine3d(Eigen::Translation3d(distance_mm * off)));
            Diagnostics found;
            report_deviations(bent, accepted_mm, found);
            if (distance_mm <= accepted_mm) {
                CHECK(found.empty());
                continue;
            }
            REQUIRE(!found.empty());
            CHECK(found[0].severity == Severity::warning);
            CHECK(found[0].status == ExitStatus::geometry);
            const std::string name = '#' + std::to_string(edge.source) + ' ';
            const auto names = [&](const Diagnostic& d) {
                return d.where.entity == face.source && d.message.find(name) != std::string::npos &&
                       d.message.find("0.003 mm") != std::string::npos;
            };
            CHECK(std::any_of(found.begin(), found.end(), names));
        }
    }
}
