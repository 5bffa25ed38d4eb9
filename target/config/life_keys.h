// The keys of life.h. Private to this room.

#pragma once

#include "target/config/machine_keys.h"

namespace lyr::config {

void append_life_keys(std::vector<Key>& keys);
// As machine_problems().
Problems life_problems(const Printer& printer);

}  // namespace lyr::config
