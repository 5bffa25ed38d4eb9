#include "format/export/gcode_macro.h"

#include <algorithm>

#include "base/nearest_name.h"
#include "base/text.h"
#include "format/export/fixed_point.h"

namespace lyr::format {
namespace {

constexpr int length_decimals = 3;

std::string in_mm(double value) {
    std::string text;
    append_rounded(text, value, length_decimals);
    return text;
}

Diagnostic unknown(const std::string& placeholder, const Placeholders& known,
                   const std::string& name, std::size_t line) {
    std::vector<std::string> names;
    for (const auto& [key, value] : known) names.push_back(key);
    std::string text = name + ", line " + std::to_string(line) + ": " +
                       in_quotes("{" + placeholder + "}") + " is no placeholder";
    const std::string nearest = nearest_name(placeholder, names);
    if (!nearest.empty()) text += "; did you mean {" + nearest + "}?";
    return {Severity::error, ExitStatus::usage, text, {}};
}

}  // namespace

double stated_target_c(const LayerState& state, HeaterKind kind, std::uint32_t tool) {
    for (const HeaterTarget& target : state.temperatures)
        if (target.heater == Heater{kind, tool}) return target.target_c;
    return 0;
}

Placeholders placeholders_of(const FileHeader& header, const Layer& first,
                             double nozzle_diameter_mm) {
    const Quantum quantum = header.quantum;
    const Summary& sum = header.summary;
    const Bounds& box = first.totals.motion;
    return {{"nozzle_temperature",
             in_mm(stated_target_c(first.state, HeaterKind::tool, first.state.tool))},
            {"bed_temperature", in_mm(stated_target_c(first.state, HeaterKind::bed, 0))},
            {"chamber_temperature", in_mm(stated_target_c(first.state, HeaterKind::chamber, 0))},
            {"tool", std::to_string(first.state.tool)},
            {"layers", std::to_string(sum.layers)},
            {"first_layer_height", in_mm(first.state.height_mm)},
            {"nozzle_diameter", in_mm(nozzle_diameter_mm)},
            {"low_x", in_mm(sum.low_x_mm)},
            {"low_y", in_mm(sum.low_y_mm)},
            {"low_z", in_mm(sum.low_z_mm)},
            {"high_x", in_mm(sum.high_x_mm)},
            {"high_y", in_mm(sum.high_y_mm)},
            {"high_z", in_mm(sum.high_z_mm)},
            {"first_low_x", in_mm(quantum.mm(box.low.x))},
            {"first_low_y", in_mm(quantum.mm(box.low.y))},
            {"first_high_x", in_mm(quantum.mm(box.high.x))},
            {"first_high_y", in_mm(quantum.mm(box.high.y))},
            {"filament_mm", in_mm(sum.filament_mm)},
            {"filament_g", in_mm(sum.mass_g)},
            {"time_s", in_mm(sum.estimated_time_s)},
            {"material", escaped(header.metadata.material)},
            {"printer", escaped(header.metadata.printer)},
            {"profile", escaped(header.metadata.profile)},
            {"source", escaped(header.metadata.source_name)}};
}

Result<std::string> expanded(std::span<const std::string> lines, const Placeholders& placeholders,
                             const std::string& name) {
    std::string out;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::string& line = lines[i];
        for (std::size_t at = 0; at < line.size(); ++at) {
            const char c = line[at];
            const bool is_brace = c == '{' || c == '}';
            const std::size_t end = c == '{' ? line.find('}', at) : std::string::npos;
            if (is_brace && at + 1 < line.size() && line[at + 1] == c) {
                out += c;
                ++at;
            } else if (end != std::string::npos) {
                const std::string key = line.substr(at + 1, end - at - 1);
                const auto found =
                    std::find_if(placeholders.begin(), placeholders.end(),
                                 [&](const auto& entry) { return entry.first == key; });
                if (found == placeholders.end()) return unknown(key, placeholders, name, i + 1);
                out += found->second;
                at = end;
            } else {
                out += c;
            }
        }
        out += '\n';
    }
    return out;
}

bool mentions(std::span<const std::string> lines, std::span<const std::string_view> words) {
    return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
        std::string command = line.substr(0, line.find(';'));
        std::replace(command.begin(), command.end(), 'm', 'M');
        return std::any_of(words.begin(), words.end(), [&](std::string_view word) {
            std::string sought(word);
            std::replace(sought.begin(), sought.end(), 'm', 'M');
            return command.find(sought) != std::string::npos;
        });
    });
}

}  // namespace lyr::format
