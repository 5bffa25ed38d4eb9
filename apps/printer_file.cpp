#include "apps/printer_file.h"

namespace lyr::command_line {

Result<config::Printer> read_printer(const std::string& path) {
    return path.empty() ? config::generic_printer() : config::read_printer(path);
}

}  // namespace lyr::command_line
