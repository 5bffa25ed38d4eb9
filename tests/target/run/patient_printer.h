// Printers for tests that print in real time.

#pragma once

#include "target/config/printer.h"

namespace lyr::tests {

// Machines that run tests are busy and not real-time; what is tested is not how late they are.
inline config::Printer patient_printer() {
    config::Printer printer = config::generic_printer();
    printer.pulse.late_limit_ns = 10'000'000'000;
    printer.heaters = {};
    return printer;
}

// Near the small drawings of print_files.h: time is not spent on the way.
inline config::Printer nearby_printer() {
    config::Printer printer = patient_printer();
    printer.start_mm = {35, 25, 0};
    printer.pause.lift_mm = 0.3;
    printer.pause.retract_mm = 0.2;
    return printer;
}

inline config::Printer parking_printer() {
    config::Printer printer = config::generic_printer();
    printer.pause.park_mm = {{5, 120}};
    return printer;
}

}  // namespace lyr::tests
