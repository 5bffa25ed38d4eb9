// A simulated machine that heats, with faults by a script.

#pragma once

#include <doctest/doctest.h>

#include <string>

#include "target/thermal/simulated_heat.h"

namespace lyr::tests {

inline config::Printer heated_printer() {
    config::Printer printer = config::generic_printer();
    printer.heaters[config::heater_chamber] = config::default_heater(config::heater_chamber);
    return printer;
}

inline std::vector<thermal::Fault> faults_of(const std::string& script,
                                             const config::Printer& printer = heated_printer()) {
    const auto faults = thermal::parse_faults(script, "faults.txt", printer);
    REQUIRE_MESSAGE(faults.ok(), (faults.ok() ? "" : to_string(faults.error())));
    return *faults;
}

struct Targets {
    double tool_c = 210, bed_c = 60, chamber_c = 0;
};

inline void set_targets(thermal::SimulatedHeat& heat, const Targets& targets) {
    heat.control().set_target(config::heater_tool, targets.tool_c);
    heat.control().set_target(config::heater_bed, targets.bed_c);
    heat.control().set_target(config::heater_chamber, targets.chamber_c);
}

}  // namespace lyr::tests
