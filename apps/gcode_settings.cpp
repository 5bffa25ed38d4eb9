#include "apps/gcode_settings.h"

#include <toml++/toml.h>

#include "apps/command_line.h"
#include "base/read_text.h"

namespace lyr::command_line {
namespace {

constexpr std::size_t most_macro_bytes = std::size_t{1} << 20;

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        std::string line = text.substr(at, end - at);
        if (!line.empty() && line.back() == '\r') line.pop_back();
        lines.push_back(std::move(line));
        at = end + 1;
    }
    return lines;
}

std::vector<std::string> lines_of(const toml::node_view<const toml::node>& node) {
    std::vector<std::string> lines;
    if (const toml::array* list = node.as_array())
        for (const toml::node& entry : *list)
            if (const auto line = entry.value<std::string>()) lines.push_back(*line);
    return lines;
}

void take_configuration(const std::string& configuration, format::GcodeOptions& options) {
    const toml::parse_result parsed = toml::parse(configuration);
    if (!parsed) return;
    const toml::table& table = parsed.table();
    const auto gcode = table["gcode"];
    if (gcode["flavor"].value_or(std::string()) == "klipper")
        options.flavor = format::GcodeFlavor::klipper;
    options.relative_extrusion = gcode["extrusion"].value_or(std::string()) != "absolute";
    options.start = lines_of(gcode["start"]);
    options.end = lines_of(gcode["end"]);
    options.nozzle_diameter_mm = table["nozzle"]["diameter"].value_or(0.0);
}

Status take_lines(const std::string& path, std::vector<std::string>& lines) {
    if (path.empty()) return Done{};
    const auto text = read_text(path, most_macro_bytes);
    if (!text) return text.error();
    lines = lines_of(*text);
    return Done{};
}

}  // namespace

Result<format::GcodeOptions> gcode_settings(const std::string& configuration,
                                            const GcodeRequest& request) {
    format::GcodeOptions options;
    take_configuration(configuration, options);
    if (!request.flavor.empty()) {
        if (request.flavor != "marlin" && request.flavor != "klipper")
            return usage("--gcode-flavor: expected marlin or klipper, found " + request.flavor);
        options.flavor = request.flavor == "klipper" ? format::GcodeFlavor::klipper
                                                     : format::GcodeFlavor::marlin;
    }
    if (!request.extrusion.empty()) {
        if (request.extrusion != "relative" && request.extrusion != "absolute")
            return usage("--gcode-e: expected relative or absolute, found " + request.extrusion);
        options.relative_extrusion = request.extrusion == "relative";
    }
    if (Status taken = take_lines(request.start_path, options.start); !taken) return taken.error();
    if (Status taken = take_lines(request.end_path, options.end); !taken) return taken.error();
    return options;
}

}  // namespace lyr::command_line
