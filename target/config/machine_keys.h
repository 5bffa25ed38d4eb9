// The keys that say how the motors carry the head: kinematics, the frame of a delta, shapers, pressure
// advance and the limit of jerk. Private to this room.
//
// Contract
//  1. machine_problems() gives what is wrong with several keys together, or with one that this kind of
//     machine needs, as the key's path and what to say after it.

#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "target/config/keys.h"

namespace lyr::config {

void append_machine_keys(std::vector<Key>& keys);

using Problems = std::vector<std::pair<std::string, std::string>>;
// Whether the file has a key.
using Given = std::function<bool(const std::string&)>;
Problems machine_problems(const Printer& printer, const Given& given);

// "x = 300 is outside of axis.x.range_mm = [0, 220]"; none: it is within.
std::optional<std::string> outside(const Printer& printer, std::size_t axis, double at_mm);

}  // namespace lyr::config
