// The same curve run along the other way.

#pragma once

#include "kernel/contour/contour.h"

namespace lyr {

// From its end to its start.
Path turned_round(const Path& open);

// From where it starts: the same boundary with the material on its other side.
Contour turned_round(const Contour& closed);

}  // namespace lyr
