// What must hold of every imported model whose geometry is exact.

#pragma once

#include <doctest/doctest.h>

#include <map>
#include <utility>

#include "kernel/brep/model.h"
#include "kernel/geometry/tolerance.h"
#include "parser/import/import.h"
#include "parser/import/step_text.h"

namespace lyr::test {

struct Imported {
    Model model;
    Diagnostics diagnostics;
};

inline Imported imported(const StepText& step) {
    const auto file = part21::File::parse("test.step", step.text());
    REQUIRE_MESSAGE(file.ok(), (file.ok() ? "" : to_string(file.error())));
    Imported result;
    Result<Model> model = importer::import_model(*file, result.diagnostics);
    REQUIRE_MESSAGE(model.ok(), (model.ok() ? "" : to_string(model.error())));
    result.model = std::move(*model);
    return result;
}

inline Diagnostic refused(const StepText& step) {
    const auto file = part21::File::parse("test.step", step.text());
    REQUIRE_MESSAGE(file.ok(), (file.ok() ? "" : to_string(file.error())));
    Diagnostics diagnostics;
    const Result<Model> model = importer::import_model(*file, diagnostics);
    REQUIRE(!model.ok());
    CHECK(model.error().severity == Severity::error);
    return model.error();
}

inline bool mentions(const Diagnostic& diagnostic, const std::string& text) {
    const bool found = diagnostic.message.find(text) != std::string::npos;
    if (!found) MESSAGE("\"" << text << "\" is not in: " << to_string(diagnostic));
    return found;
}

inline Eigen::AlignedBox3d box_of(const Model& model) {
    Eigen::AlignedBox3d box;
    for (const Vertex& vertex : model.vertices) box.extend(vertex.point);
    return box;
}

inline bool near(const Point3& a, const Point3& b) {
    return (a - b).norm() <= resolution_mm;
}

inline VertexId start_of(const Model& model, const Coedge& use) {
    return use.reversed ? model[use.edge].end : model[use.edge].start;
}
inline VertexId end_of(const Model& model, const Coedge& use) {
    return use.reversed ? model[use.edge].start : model[use.edge].end;
}

// Twice the area that the loops of a plane face enclose, positive where they run counter-clockwise about the
// outward normal; from points along the edges.
inline double twice_area(const Model& model, const Face& face) {
    const Vector3 outward = (face.same_sense ? 1 : -1) * std::get<Plane>(face.surface).frame.z;
    constexpr int steps = 64;
    double sum = 0;
    for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
        const Loop& loop = model.loops[l];
        for (std::uint32_t c = loop.first_coedge; c < loop.first_coedge + loop.coedge_count; ++c) {
            const Coedge& use = model.coedges[c];
            const Edge& edge = model[use.edge];
            const double a = use.reversed ? edge.t_end : edge.t_start,
                         b = use.reversed ? edge.t_start : edge.t_end;
            for (int k = 0; k < steps; ++k) {
                const Point3 p = evaluate(edge.curve, a + (b - a) * k / steps);
                const Point3 q = evaluate(edge.curve, a + (b - a) * (k + 1) / steps);
                sum += outward.dot(p.cross(q));
            }
        }
    }
    return sum;
}

// The volume of the plane-faced shells: of all that look away from their material.
inline double plane_volume(const Model& model) {
    double volume = 0;
    for (const Face& face : model.faces) {
        const Plane& plane = std::get<Plane>(face.surface);
        const double height = plane.frame.origin.dot((face.same_sense ? 1 : -1) * plane.frame.z);
        volume += twice_area(model, face) / 2 * height / 3;
    }
    return volume;
}

inline void check_loops(const Model& model) {
    for (const Loop& loop : model.loops) {
        for (std::uint32_t i = 0; i < loop.coedge_count; ++i) {
            const Coedge& use = model.coedges[loop.first_coedge + i];
            const Coedge& next = model.coedges[loop.first_coedge + (i + 1) % loop.coedge_count];
            CHECK(end_of(model, use) == start_of(model, next));
        }
    }
}

inline void check_shells(const Model& model) {
    for (const Shell& shell : model.shells) {
        std::map<std::uint32_t, std::pair<int, int>> uses;
        for (std::uint32_t f = shell.first_face; f < shell.first_face + shell.face_count; ++f) {
            const Face& face = model.faces[f];
            CHECK(&model[face.shell] == &shell);
            for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
                const Loop& loop = model.loops[l];
                for (std::uint32_t c = loop.first_coedge; c < loop.first_coedge + loop.coedge_count;
                     ++c) {
                    auto& [along, against] = uses[model.coedges[c].edge.value];
                    ++(model.coedges[c].reversed ? against : along);
                    const Edge& edge = model[model.coedges[c].edge];
                    for (const double t :
                         {edge.t_start, 0.5 * (edge.t_start + edge.t_end), edge.t_end}) {
                        const Point3 p = evaluate(edge.curve, t);
                        CHECK(near(evaluate(face.surface, invert(face.surface, p)), p));
                    }
                }
            }
        }
        for (const auto& [edge, count] : uses) CHECK(count == std::pair(1, 1));
    }
}

inline void check_model(const Model& model) {
    for (const Edge& edge : model.edges) {
        CHECK(near(evaluate(edge.curve, edge.t_start), model[edge.start].point));
        CHECK(near(evaluate(edge.curve, edge.t_end), model[edge.end].point));
    }
    check_loops(model);
    check_shells(model);
    for (const Face& face : model.faces) {
        if (std::holds_alternative<Plane>(face.surface)) CHECK(twice_area(model, face) > 0);
    }
    for (const Solid& solid : model.solids) {
        for (std::uint32_t s = solid.first_shell; s < solid.first_shell + solid.shell_count; ++s) {
            CHECK(&model[model.shells[s].solid] == &solid);
        }
    }
}

}  // namespace lyr::test
