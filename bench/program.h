// Whole programs and what they take.

#pragma once

#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace lyr::bench {

struct Usage {
    double processor_s = 0;  // user and system time of all its threads
    double peak_bytes = 0;   // resident memory
};

// Runs a program, found along PATH, on the processors that this process may use. Errors (status internal): it cannot
// be run, or fails.
Result<Usage> run_program(const std::vector<std::string>& command);

// The medians of several runs, each by itself.
Result<Usage> median_usage(int runs, const std::vector<std::string>& command);

}  // namespace lyr::bench
