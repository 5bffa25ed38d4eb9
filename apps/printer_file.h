// The printer's file of a command line.

#pragma once

#include <string>

#include "target/config/printer.h"

namespace lyr::command_line {

// Empty: the generic printer; "-": from standard input.
Result<config::Printer> read_printer(const std::string& path);

}  // namespace lyr::command_line
