#include "apps/export_format.h"

#include <algorithm>
#include <array>

#include "apps/command_line.h"
#include "apps/gcode_settings.h"
#include "base/text.h"
#include "format/export/cli.h"
#include "format/export/dxf.h"
#include "format/export/gcode.h"
#include "format/export/slice_3mf.h"
#include "format/export/svg.h"

namespace lyr::command_line {
namespace {

struct Name {
    ExportFormat format;
    std::string_view name;  // for --to
    std::array<std::string_view, 3> endings;
};

constexpr Name names[] = {{ExportFormat::lyr, "lyr", {".lyr"}},
                          {ExportFormat::page, "html", {".html", ".htm"}},
                          {ExportFormat::gcode, "gcode", {".gcode", ".gco", ".g"}},
                          {ExportFormat::svg, "svg", {".svg"}},
                          {ExportFormat::dxf, "dxf", {".dxf"}},
                          {ExportFormat::cli, "cli", {".cli"}},
                          {ExportFormat::slices_3mf, "3mf", {".3mf"}}};

bool ends_with(std::string text, std::string_view ending) {
    std::transform(text.begin(), text.end(), text.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return !ending.empty() && text.size() > ending.size() && text.ends_with(ending);
}

Status write_svg(format::Reader& reader, const ExportRequest& request, const format::Sink& sink) {
    if (!request.layer) return format::print_svg(reader, {.travels = request.travels}, sink);
    const auto svg = format::layer_svg(reader, *request.layer, {.travels = request.travels});
    if (!svg) return svg.error();
    sink(*svg);
    return Done{};
}

Status write_gcode(format::Reader& reader, const ExportRequest& request, const format::Sink& sink,
                   Diagnostics& diagnostics) {
    const auto options = gcode_settings(reader.header().metadata.configuration, request.gcode);
    if (!options) return options.error();
    return format::write_gcode(reader, *options, sink, diagnostics);
}

Status write(format::Reader& reader, const ExportRequest& request, const format::Sink& sink,
             Diagnostics& diagnostics) {
    switch (request.format) {
        case ExportFormat::gcode:
            return write_gcode(reader, request, sink, diagnostics);
        case ExportFormat::svg:
            return write_svg(reader, request, sink);
        case ExportFormat::dxf:
            return format::write_dxf(reader, {.layer = request.layer, .travels = request.travels},
                                     sink);
        case ExportFormat::cli:
            return format::write_cli(reader, sink, diagnostics);
        case ExportFormat::slices_3mf:
            return format::write_slice_3mf(reader, sink, diagnostics);
        case ExportFormat::page:
            return usage("a page is made of a print: lyrview part.lyr -o part.html");
        case ExportFormat::lyr:
            break;
    }
    return usage("a .lyr file is what stepc writes");
}

}  // namespace

std::string export_format_names() {
    std::string text;
    for (const Name& name : names) text += (text.empty() ? "" : ", ") + std::string(name.name);
    return text;
}

std::optional<ExportFormat> export_format_named(const std::string& text) {
    for (const Name& name : names)
        if (name.name == text) return name.format;
    return std::nullopt;
}

Result<ExportFormat> export_format(const std::string& path, const std::string& to,
                                   std::optional<ExportFormat> otherwise) {
    if (!to.empty()) {
        if (const auto format = export_format_named(to)) return *format;
        return usage("--to: expected one of " + export_format_names() + ", found " + in_quotes(to));
    }
    for (const Name& name : names)
        for (const std::string_view ending : name.endings)
            if (ends_with(path, ending)) return name.format;
    if (otherwise) return *otherwise;
    return usage(in_quotes(path) + " does not say by its ending what to write: say --to FORMAT (" +
                 export_format_names() + ')');
}

Result<std::uint64_t> export_print(format::Reader& reader, const ExportRequest& request,
                                   ReplaceFile file, Diagnostics& diagnostics) {
    std::uint64_t bytes = 0;
    const format::Sink sink = [&](std::string_view text) {
        bytes += text.size();
        file.write(text);
    };
    if (Status written = write(reader, request, sink, diagnostics); !written)
        return written.error();
    if (Status committed = file.commit(); !committed) return committed.error();
    return bytes;
}

}  // namespace lyr::command_line
