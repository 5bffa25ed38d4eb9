// What single kinds of operations take to write and to read, on prints of that kind alone.

#pragma once

#include "bench/table.h"

namespace lyr::bench {

// Random lines and arcs, walls beside each other, rows of a hatch. Writes a file in the folder for temporary files.
Table time_lyr_kinds();

}  // namespace lyr::bench
