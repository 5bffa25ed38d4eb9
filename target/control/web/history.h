// Temperatures over time: a ring that a page draws.
//
// Contract
//  1. One sample in sample_s of the print's own time at the most; the last most_samples are kept.
//  2. since(n) gives, as one JSON object, those from number n on, and the number to ask with next. Numbers count from
//     0 and never come back, so that a page that was away gets what it has missed, if it is still kept.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "target/run/print_control.h"

namespace lyr::control {

class History {
public:
    static constexpr double sample_s = 1;
    // An hour.
    static constexpr std::size_t most_samples = 3600;

    void take(const run::PrintStatus& status);
    std::string since(std::uint64_t number) const;

private:
    struct Sample {
        float time_s = 0;
        std::array<float, 2 * config::heater_count> values_c{};  // measured, target; of each heater
    };

    std::vector<Sample> ring_;
    std::uint64_t count_ = 0;
    std::optional<double> last_s_;
};

}  // namespace lyr::control
