// The holes in a shell: where its faces end and no other goes on.

#pragma once

#include <string>
#include <vector>

#include "kernel/brep/free_edges.h"

namespace lyr {

// Free edges of one shell that hang together.
struct Gap {
    ShellId shell;
    std::vector<EdgeId> edges;
    double around_mm;  // the edges' length together
    double area_mm2;   // of the hole, seen from where it looks largest
};

// In the order of shells.
std::vector<Gap> gaps(const Model& model);

// "a hole of 12.3 mm2, 14 mm around, edges #4, #5"
std::string description(const Model& model, const Gap& gap);

}  // namespace lyr
