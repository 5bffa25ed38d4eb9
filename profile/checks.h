// What no key says by itself: values that contradict each other. Private to this room.

#pragma once

#include "profile/resolve.h"

namespace lyr::profile {

// Contract 4 of resolve.h.
Status check(const Resolved& resolved);

// "abs.toml:7", "--set", "default, as layer.height".
std::string origin_text(const Resolved& resolved, std::size_t key, Folders folders);

}  // namespace lyr::profile
