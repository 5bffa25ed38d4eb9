// Models put together: one anew from faces of another, and one behind another.
//
// Contract
//  1. Solids, shells and faces come in the order asked for; faces that no plan names are left out, and so are edges
//     and vertices that then nothing uses.
//  2. Edges and vertices keep their order; nothing but indices changes in what is kept.
//  3. An appended part's solids, shells, faces, edges and vertices are as they were, behind the model's own. The
//     uncertainty is the larger of the two.

#pragma once

#include <string>
#include <vector>

#include "kernel/brep/model.h"

namespace lyr {

struct ShellPlan {
    std::vector<FaceId> faces;
    SourceId source;
    bool is_surface;
};

struct SolidPlan {
    std::string name;
    SourceId source;
    std::vector<ShellPlan> shells;
};

// What the model's own shells and solids would be asked for by.
ShellPlan plan_of(const Model& model, ShellId shell);
SolidPlan plan_of(const Model& model, SolidId solid);

Model assembled(const Model& model, const std::vector<SolidPlan>& solids);

void append(Model& model, Model part);

}  // namespace lyr
