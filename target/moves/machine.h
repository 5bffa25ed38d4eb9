// The machine of a printer's file as target/motion knows it.
//
// Contract
//  1. bed_of() is the mesh of the printer's file; none without heights.
//  2. is_timed() says whether steps need the timed generator: a delta, a shaper, pressure advance or a
//     limit of jerk, backlash, or a mesh.

#pragma once

#include "target/config/printer.h"
#include "target/motion/timed_generator.h"

namespace lyr::moves {

motion::Kinematics kinematics_of(const config::Printer& printer);
std::shared_ptr<const motion::BedMesh> bed_of(const config::Printer& printer);
motion::Shaping shaping_of(const config::Printer& printer);
bool is_shaped(const config::Printer& printer);
bool is_timed(const config::Printer& printer);

}  // namespace lyr::moves
