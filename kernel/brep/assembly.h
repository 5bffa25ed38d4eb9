// A model put together anew from faces of another.
//
// Contract
//  1. Solids, shells and faces come in the order asked for; faces that no plan names are left out, and so are edges
//     and vertices that then nothing uses.
//  2. Edges and vertices keep their order; nothing but indices changes in what is kept.

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

}  // namespace lyr
