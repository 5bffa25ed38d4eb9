// What a print is written as: by the ending of the file's name, or as --to says.
//
// Contract
//  1. --to wins over the ending. Standard output and names without a known ending are as `otherwise` says; none: an error
//     (status usage) that lists the formats.
//  2. What a format cannot say is in the diagnostics.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/replace_file.h"
#include "format/reader.h"

namespace lyr::command_line {

enum class ExportFormat : std::uint8_t { lyr, page, gcode, svg, dxf, cli, slices_3mf };

// Whether it can be of one layer; the others are of the whole print.
constexpr bool is_drawing(ExportFormat format) {
    return format == ExportFormat::svg || format == ExportFormat::dxf;
}

// "lyr, gcode, ...": what --to takes.
std::string export_format_names();
std::optional<ExportFormat> export_format_named(const std::string& name);
Result<ExportFormat> export_format(const std::string& path, const std::string& to,
                                   std::optional<ExportFormat> otherwise);

// Of G-code, where the command line says it; the rest is the print's own configuration.
struct GcodeRequest {
    std::string flavor{}, extrusion{};     // empty: not given
    std::string start_path{}, end_path{};  // files of lines; empty: not given
    bool any() const {
        return !flavor.empty() || !extrusion.empty() || !start_path.empty() || !end_path.empty();
    }
};

struct ExportRequest {
    ExportFormat format = ExportFormat::svg;
    std::optional<std::uint32_t> layer{};  // from 0; none: all
    bool travels = true;
    GcodeRequest gcode{};
};

// Writes the print that the reader is at the beginning of, but for pages, which hold the file itself. The bytes written.
Result<std::uint64_t> export_print(format::Reader& reader, const ExportRequest& request,
                                   ReplaceFile file, Diagnostics& diagnostics);

}  // namespace lyr::command_line
