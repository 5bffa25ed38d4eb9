// The keys of endstops, homing, probe, mesh and the simulated machine. Private to this room.
//
// Contract
//  1. homing_problems() is as machine_problems().

#pragma once

#include "target/config/machine_keys.h"

namespace lyr::config {

void append_homing_keys(std::vector<Key>& keys);

Problems homing_problems(const Printer& printer, const Given& given);

}  // namespace lyr::config
