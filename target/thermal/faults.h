// Faults for the simulator, by a script: what breaks when.
//
//     # time in s   fault      heater   value
//     120           open       tool
//     300.5         draught    bed      2
//     400           silent
//
// Contract
//  1. A line is a time, a fault, and for all but `silent` a heater or a contact (the endstop of x, y or z, or the probe)
//     that the printer has; weak, draught, jump, bounce and lose take a value. What stands after # is a comment. Anything
//     else is an error (status input) with its line.
//  2. Faults come out in the order of time.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "target/config/printer.h"
#include "target/thermal/model.h"

namespace lyr::thermal {

enum class FaultKind : std::uint8_t {
    open,        // the sensor's wire breaks
    shorted,     // its wires touch
    detached,    // it falls out of the block
    frozen,      // the converter repeats its last figure
    unreadable,  // the kernel's file gives an error
    jump,        // the sensor reads `value` °C more
    stuck_on,    // the heater's switch burns through
    no_power,    // the heater burns out
    weak,        // it gives only the share `value` of its power
    draught,     // `value` W/K are lost in addition
    silent,      // the control of the heaters hangs
    mend,        // all of the heater's faults end
    // Of contacts and motors; target/home has the machine that they break.
    stuck,   // the contact stays closed
    dead,    // it does not close any more
    bounce,  // it opens and closes for `value` ms
    lose,    // the motor of the axis does not turn for `value` steps
};

struct Fault {
    double time_s = 0;
    FaultKind kind = FaultKind::open;
    std::size_t heater = 0;
    double value = 0;
    std::size_t contact = 0;  // of config
};

bool is_of_contact(FaultKind kind);

Result<std::vector<Fault>> parse_faults(std::string_view text, const std::string& file,
                                        const config::Printer& printer);

void apply(const Fault& fault, ModelFaults& faults);

}  // namespace lyr::thermal
