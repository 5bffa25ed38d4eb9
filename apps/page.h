// lyrctl's page, in builds that have libmicrohttpd.

#pragma once

#include <cstdint>
#include <string>

#include "apps/command_line.h"

namespace lyr::command_line {

struct PageOptions {
    std::uint16_t port = 0;  // 0: one that is free
    std::string socket;      // empty: that of the first print that is found
    std::string token_path;  // empty: a new token, which is told
};

// Until a signal ends the program. Errors: input (the token), machine (the port), unsupported (a build without).
Status serve_page(const Program& program, const PageOptions& options);

}  // namespace lyr::command_line
