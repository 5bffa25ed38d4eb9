#include "slicer/mend.h"

#include <algorithm>
#include <string>

#include "base/text.h"
#include "kernel/brep/assembly.h"
#include "kernel/brep/defect.h"
#include "kernel/brep/edge_deviation.h"
#include "kernel/brep/gaps.h"
#include "kernel/brep/healing.h"
#include "kernel/brep/validity.h"

namespace lyr::slicer {
namespace {

// Gaps are closed, with warnings, up to so many times the file's own uncertainty, and up to the tolerance in any case:
// for the print, what is nearer is the same.
constexpr double limit_ratio = 10;

SewingReach reach_for(const Model& model, const Tolerance& tolerance) {
    const double accepted_mm = std::max(model.uncertainty_mm, resolution_mm);
    return {accepted_mm, std::max(limit_ratio * accepted_mm, tolerance.total_mm)};
}

bool is_surface(const Model& model, SolidId id) {
    const Solid& solid = model[id];
    return std::any_of(model.shells.begin() + solid.first_shell,
                       model.shells.begin() + solid.first_shell + solid.shell_count,
                       [](const Shell& shell) { return shell.is_surface; });
}

// One for each surface, with its first hole; that of most faces first.
Diagnostics open_surfaces(const Model& model) {
    std::vector<const Gap*> first_gap(model.shells.size(), nullptr);
    const std::vector<Gap> all = gaps(model);
    for (auto gap = all.rbegin(); gap != all.rend(); ++gap) first_gap[gap->shell.value] = &*gap;
    std::vector<std::size_t> surfaces;
    for (std::size_t s = 0; s < model.shells.size(); ++s) {
        if (model.shells[s].is_surface) surfaces.push_back(s);
    }
    std::stable_sort(surfaces.begin(), surfaces.end(), [&](std::size_t a, std::size_t b) {
        return model.shells[a].face_count > model.shells[b].face_count;
    });
    Diagnostics found;
    for (const std::size_t s : surfaces) {
        const Shell& shell = model.shells[s];
        const std::string name = "surface #" + std::to_string(shell.source) + " of " +
                                 std::to_string(shell.face_count) + " faces ";
        Diagnostic surface{Severity::warning, ExitStatus::geometry, name + "bounds no volume", {}};
        surface.where.entity = shell.source;
        if (first_gap[s] != nullptr) {
            const Edge& first = model[first_gap[s]->edges.front()];
            surface = defect(Severity::warning,
                             name + "does not close: " + description(model, *first_gap[s]),
                             first.source, model[first.start].point);
        }
        found.push_back(std::move(surface));
    }
    return found;
}

Status settle_surfaces(Model& model, const Options& options, Diagnostics& found) {
    std::vector<SolidPlan> solids;
    for (std::size_t s = 0; s < model.solids.size(); ++s) {
        if (!is_surface(model, SolidId{s})) solids.push_back(plan_of(model, SolidId{s}));
    }
    if (solids.size() == model.solids.size()) return Done{};
    Diagnostics open = open_surfaces(model);
    if (solids.empty()) {
        if (options.allow_open) return Done{};
        Diagnostic error = open.front();
        error.severity = Severity::error;
        error.message += "; there is no solid besides (--allow-open cuts it all the same)";
        found.insert(found.end(), open.begin() + 1, open.end());
        return error;
    }
    for (Diagnostic& surface : open) {
        surface.message += "; it is left out";
        found.push_back(std::move(surface));
    }
    model = assembled(model, solids);
    return Done{};
}

Status refuse_defects(const Diagnostics& found) {
    const auto is_defect = [](const Diagnostic& d) { return d.status == ExitStatus::geometry; };
    const auto count = std::count_if(found.begin(), found.end(), is_defect);
    if (count == 0) return Done{};
    Diagnostic error = *std::find_if(found.begin(), found.end(), is_defect);
    error.severity = Severity::error;
    error.message +=
        " (" + counted(static_cast<std::uint64_t>(count), "finding") + "; --strict heals none)";
    return error;
}

}  // namespace

Status mend(Model& model, const Options& options, Diagnostics& found) {
    heal(model, reach_for(model, options.tolerance()), found);
    if (Status settled = settle_surfaces(model, options, found); !settled) return settled;
    report_deviations(
        model, std::max({model.uncertainty_mm, resolution_mm, options.tolerance().trace_mm()}),
        found);
    const Diagnostics remaining = validate(model);
    found.insert(found.end(), remaining.begin(), remaining.end());
    return options.strict ? refuse_defects(found) : Done{};
}

}  // namespace lyr::slicer
