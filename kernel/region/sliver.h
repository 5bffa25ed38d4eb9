// What is too thin to be a contour.

#pragma once

#include "kernel/contour/contour.h"

namespace lyr::region {

// Whether no disc of this diameter fits into the contour: none that touches it in one of some places of every curve.
bool is_sliver(const Contour& contour, double width_mm);

}  // namespace lyr::region
