// Does a plane pay for faces that it does not meet? Towers of 10^2 to 10^5 faces, of which every plane meets eight.

#pragma once

#include "base/diagnostic.h"
#include "bench/table.h"

namespace lyr::bench {

// Prints the table. Errors: a tower that is not read or whose sections are not what they must be.
Status compare_scaling(Requirements& requirements);

}  // namespace lyr::bench
