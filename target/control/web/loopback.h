// Listening sockets that this machine alone can reach.

#pragma once

#include <cstdint>
#include <utility>

#include "base/diagnostic.h"

namespace lyr::control {

// Of 127.0.0.1 and ::1, on the same port; the second is below 0 where the machine has no IPv6. Port 0: one that is free.
Result<std::pair<int, int>> listen_on_loopback(std::uint16_t& port);

}  // namespace lyr::control
