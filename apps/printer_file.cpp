#include "apps/printer_file.h"

#include "base/read_text.h"

namespace lyr::command_line {
namespace {

// What the reader of printer files takes, too.
constexpr std::size_t largest_printer_bytes = std::size_t{1} << 20;

}  // namespace

Result<config::Printer> read_printer(const std::string& path) {
    if (path.empty()) return config::generic_printer();
    if (path != "-") return config::read_printer(path);
    const auto text = read_text(path, largest_printer_bytes);
    if (!text) return text.error();
    return config::parse_printer(*text, standard_input_name);
}

}  // namespace lyr::command_line
