// The one table of all keys: reading, --set, --print-config, messages and docs/profiles.md all follow from it.

#pragma once

#include <vector>

#include "profile/kinds.h"

namespace lyr::profile {

// In the order in which they are shown. A key's derived value depends on keys before it only.
const std::vector<Key>& keys();

}  // namespace lyr::profile
