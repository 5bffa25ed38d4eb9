// First what is local to a loop; then, for shells whose faces do not fit together, edges, directions and bodies.

#include "kernel/brep/healing.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/text.h"
#include "kernel/brep/assembly.h"
#include "kernel/brep/defect.h"
#include "kernel/brep/face_parity.h"
#include "kernel/brep/loop_closing.h"
#include "kernel/brep/loop_orientation.h"
#include "kernel/brep/small_edges.h"
#include "kernel/brep/validity.h"
#include "kernel/brep/volume.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

Point3 point_of(const Model& model, const Face& face) {
    for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
        const Loop& loop = model.loops[l];
        if (loop.coedge_count > 0)
            return model[model.start_of(model.coedges[loop.first_coedge])].point;
    }
    return Point3::Zero();
}

// What has been done to how many things of which a face is the first.
class Count {
public:
    void add(const Model& model, const Face& face, std::size_t number = 1) {
        if (number == 0) return;
        if (number_ == 0) {
            source_ = face.source;
            point_ = point_of(model, face);
        }
        number_ += number;
    }
    void report(const char* noun, const char* what, Diagnostics& diagnostics) const {
        if (number_ == 0) return;
        diagnostics.push_back(
            defect(Severity::note, counted(number_, noun) + what, source_, point_));
    }

private:
    std::size_t number_ = 0;
    SourceId source_ = 0;
    Point3 point_ = Point3::Zero();
};

void drop_edges_without_length(Model& model, Diagnostics& diagnostics) {
    const std::vector<EdgeId> edges = edges_within(model, resolution_mm);
    if (edges.empty()) return;
    const Edge& first = model[edges.front()];
    diagnostics.push_back(defect(Severity::note,
                                 counted(edges.size(), "edge") + " without length left out",
                                 first.source, model[first.start].point));
    drop_edges(model, edges);
}

// By shell.
std::vector<bool> shells_in_doubt(const Model& model) {
    std::vector<bool> in_doubt(model.shells.size(), false);
    for (const ShellId shell : open_shells(model)) in_doubt[shell.value] = true;
    for (std::size_t s = 0; s < model.shells.size(); ++s) {
        if (model.shells[s].is_surface) in_doubt[s] = true;
    }
    return in_doubt;
}

void turn_loops(Model& model, const std::vector<bool>& in_doubt, Diagnostics& diagnostics) {
    Count turned;
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
        const Face& face = model.faces[f];
        if (in_doubt[face.shell.value]) turned.add(model, face, make_loops_agree(model, FaceId{f}));
    }
    turned.report("loop", " that ran against the others of the face turned round", diagnostics);
}

// In each group of faces that hang together, those in the minority.
void turn_faces(Model& model, const std::vector<bool>& in_doubt, const FaceParity& parity,
                Diagnostics& diagnostics) {
    std::vector<std::size_t> like(model.faces.size(), 0), unlike(model.faces.size(), 0);
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
        const std::uint32_t root = parity.root(FaceId{f}).value;
        ++(parity.unlike_root(FaceId{f}) ? unlike : like)[root];
    }
    Count turned;
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
        const FaceId id{f};
        const std::uint32_t root = parity.root(id).value;
        const bool is_minority = parity.unlike_root(id) == (unlike[root] <= like[root]);
        if (unlike[root] == 0 || !is_minority || !in_doubt[model[id].shell.value]) continue;
        turned.add(model, model[id]);
        reverse_face(model, id);
    }
    turned.report("face", " that looked the other way than the neighbours turned over",
                  diagnostics);
}

struct Regrouping {
    std::vector<SolidPlan> solids;
    std::vector<bool> in_doubt;  // by the shells to be
};

// Solids keep their shells; the faces of surfaces come in groups that hang together.
Regrouping regrouping(const Model& model, const std::vector<bool>& in_doubt,
                      const FaceParity& parity) {
    Regrouping result;
    std::vector<std::size_t> solid_of_root(model.faces.size(), 0);  // one more than its index
    for (std::size_t s = 0; s < model.solids.size(); ++s) {
        SolidPlan plan = plan_of(model, SolidId{s});
        std::vector<ShellPlan> surfaces;
        for (const ShellPlan& shell : plan.shells) {
            if (shell.is_surface) surfaces.push_back(shell);
        }
        std::erase_if(plan.shells, [](const ShellPlan& shell) { return shell.is_surface; });
        if (!plan.shells.empty()) {
            for (const ShellPlan& shell : plan.shells) {
                const bool empty = shell.faces.empty();
                result.in_doubt.push_back(!empty && in_doubt[model[shell.faces[0]].shell.value]);
            }
            result.solids.push_back(plan);
        }
        for (const ShellPlan& shell : surfaces) {
            for (const FaceId face : shell.faces) {
                std::size_t& solid = solid_of_root[parity.root(face).value];
                if (solid == 0) {
                    result.solids.push_back({plan.name, plan.source, {{{}, shell.source, true}}});
                    result.in_doubt.push_back(true);
                    solid = result.solids.size();
                }
                result.solids[solid - 1].shells[0].faces.push_back(face);
            }
        }
    }
    return result;
}

void orient_closed_shells(Model& model, std::vector<bool> in_doubt, double limit_mm,
                          Diagnostics& diagnostics) {
    for (const ShellId open : open_shells(model)) in_doubt[open.value] = false;
    Count senses, shells;
    for (std::size_t s = 0; s < model.shells.size(); ++s) {
        Shell& shell = model.shells[s];
        if (!in_doubt[s] || shell.face_count == 0) continue;
        const bool is_void = model[shell.solid].first_shell != s;
        const ShellOrientation found = orient_closed_shell(model, ShellId{s}, is_void);
        const Face& first = model.faces[shell.first_face];
        senses.add(model, first, found.faces_turned);
        if (found.is_reversed && !shell.is_surface) shells.add(model, first);
        // A sheet and its double close as well, but thinner than a gap is no solid.
        if (std::abs(found.volume_mm3) > limit_mm * found.area_mm2 / 2) shell.is_surface = false;
    }
    senses.report("face", " with a same_sense that contradicts the loops; the loops are taken",
                  diagnostics);
    shells.report("shell", " stated inside out turned around", diagnostics);
}

}  // namespace

void heal(Model& model, const SewingReach& reach, Diagnostics& diagnostics) {
    close_loops(model, reach, diagnostics);
    drop_edges_without_length(model, diagnostics);
    const std::vector<bool> in_doubt = shells_in_doubt(model);
    if (std::find(in_doubt.begin(), in_doubt.end(), true) != in_doubt.end()) {
        turn_loops(model, in_doubt, diagnostics);
        sew(model, reach, diagnostics);
        const FaceParity parity(model);
        turn_faces(model, in_doubt, parity, diagnostics);
        const Regrouping regrouped = regrouping(model, in_doubt, parity);
        model = assembled(model, regrouped.solids);
        orient_closed_shells(model, regrouped.in_doubt, reach.limit_mm, diagnostics);
    }
}

}  // namespace lyr
