// The keys of heaters and fans. Private to this room.
//
// Contract
//  1. heat_problems() is as machine_problems().

#pragma once

#include "target/config/machine_keys.h"

namespace lyr::config {

void append_heat_keys(std::vector<Key>& keys);

Problems heat_problems(const Printer& printer, const Given& given);

}  // namespace lyr::config
