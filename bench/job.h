// The whole job, from a STEP file to a file that a printer takes, beside PrusaSlicer's with the same settings.

#pragma once

#include <string>

#include "base/diagnostic.h"
#include "bench/table.h"

namespace lyr::bench {

Status compare_job(const std::string& step_path, double layer_height_mm,
                   Requirements& requirements);

}  // namespace lyr::bench
