// From what a file states to what can be cut: repairs, and surfaces told from solids.

#pragma once

#include "base/diagnostic.h"
#include "kernel/brep/model.h"
#include "slicer/slicer.h"

namespace lyr::slicer {

// Contract
//  1. The model is healed (kernel/brep/healing.h); what is found, and what remains open, is appended to `found`.
//  2. With `strict`, nothing is healed if anything with status geometry is found or has been found before: that is the
//     error.
//  3. Surfaces that do not close are taken out, with a warning each that describes their holes; if there is nothing
//     else, they are the error, unless `allow_open`.
Status mend(Model& model, const Options& options, Diagnostics& found);

}  // namespace lyr::slicer
