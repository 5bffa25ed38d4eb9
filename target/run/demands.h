// Whether a machine can do what a file asks of it beside motion.
//
// Contract
//  1. Without `no_heat`, an error (status machine) names the first of: a heater that the printer does not have, a
//     temperature within headroom_c of the end of its range_c or beyond, filament that is pushed while the tool has
//     not surely reached min_extrude_c.
//  2. Pauses are an error of status unsupported, unless somebody can tell the print to go on.
//  3. What is passed over is noted: heat, if `no_heat`, and fans that the printer does not have; and axes that are
//     planned slower than they could be, since the board is late.

#pragma once

#include "target/config/printer.h"
#include "target/run/inspect.h"

namespace lyr::run {

using config::headroom_c;

Status check_demands(const Inspection& inspection, const config::Printer& printer, bool no_heat,
                     Diagnostics& notes, bool can_resume = false);

}  // namespace lyr::run
