// The first pass over a STEP file, from bytes to a table of instances, on a large generated file.

#pragma once

#include "base/diagnostic.h"
#include "bench/table.h"

namespace lyr::bench {

// Prints the table. Errors: no room for the file in the folder for temporary files.
Status measure_index(Requirements& requirements);

}  // namespace lyr::bench
