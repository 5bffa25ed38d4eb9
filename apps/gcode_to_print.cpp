#include "apps/gcode_to_print.h"

#include <filesystem>

#include "apps/files.h"
#include "base/read_text.h"
#include "base/text.h"
#include "format/import/gcode_import.h"

namespace lyr::command_line {

Result<std::string> gcode_to_print(const std::string& gcode_path, const std::string& lyr_path,
                                   double filament_diameter_mm, Diagnostics& diagnostics) {
    const auto text = read_text(gcode_path, most_readable_bytes(gcode_path));
    if (!text) return text.error();
    const std::string name = input_name(gcode_path);
    const std::string source =
        gcode_path == "-" ? std::string() : std::filesystem::path(gcode_path).filename().string();
    const auto totals = format::import_gcode(
        *text, name, source, lyr_path,
        {.filament_diameter_mm = filament_diameter_mm, .generator = "lyrview " LYR_VERSION},
        diagnostics);
    if (!totals) return totals.error();
    return name + ": " + counted(text->size(), "byte") + '\n' + output_name(lyr_path) + ": " +
           counted(totals->layers, "layer") + ", " + counted(totals->operations, "operation") +
           ", " + counted(totals->bytes, "byte") + '\n';
}

}  // namespace lyr::command_line
