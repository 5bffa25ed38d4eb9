// Where control sockets are: lyrrun puts its own there, lyrctl looks for them there.

#pragma once

#include <string>
#include <vector>

namespace lyr::control {

inline constexpr const char* machine_socket_folder = "/run/lyr";
// That, and the one of the user who is logged in.
std::vector<std::string> socket_folders();

// All that are there, in the order of their names.
std::vector<std::string> sockets();

}  // namespace lyr::control
