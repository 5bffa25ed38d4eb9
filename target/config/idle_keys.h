// Keys that nothing would look at, because another key is missing or says otherwise: whoever wrote one meant something by
// it. Private to this room.
//
// Contract
//  1. idle_problems() is as machine_problems(). Keys that switch something off may always stand.

#pragma once

#include "target/config/machine_keys.h"

namespace lyr::config {

Problems idle_problems(const Printer& printer, const Given& given);

}  // namespace lyr::config
