// Keys whose value is not known are left out, so that a reader cannot take 0 for a measure.

#include <charconv>

#include "format/metadata_text.h"

namespace lyr::format {
namespace {

void put_text(std::string& out, std::string_view key, std::string_view value) {
    out += key;
    out += '=';
    for (const char c : value) {
        if (c == '\\') out += '\\';
        if (c == '\n')
            out += "\\n";
        else
            out += c;
    }
    out += '\n';
}

void put_known(std::string& out, std::string_view key, std::string_view value) {
    if (!value.empty()) put_text(out, key, value);
}

void put_number(std::string& out, std::string_view key, double value) {
    char text[40];
    const auto result = std::to_chars(text, text + sizeof text, value);
    put_text(out, key, std::string_view(text, static_cast<std::size_t>(result.ptr - text)));
}

void put_known(std::string& out, std::string_view key, double value) {
    if (value != 0) put_number(out, key, value);
}

}  // namespace

std::string print_metadata(const Metadata& metadata, const Summary& summary) {
    std::string out;
    put_known(out, "generator", metadata.generator);
    put_known(out, "source", metadata.source_name);
    put_known(out, "source_sha256", metadata.source_sha256);
    put_known(out, "printer", metadata.printer);
    put_known(out, "material", metadata.material);
    put_known(out, "profile", metadata.profile);
    put_known(out, "tolerance_mm", metadata.tolerance_mm);
    put_number(out, "filament_diameter_mm", metadata.filament_diameter_mm);
    put_known(out, "filament_density_g_cm3", metadata.filament_density_g_cm3);
    for (const std::string& object : metadata.objects) put_text(out, "object", object);
    put_text(out, "layers", std::to_string(summary.layers));
    put_number(out, "low_x_mm", summary.low_x_mm);
    put_number(out, "low_y_mm", summary.low_y_mm);
    put_number(out, "low_z_mm", summary.low_z_mm);
    put_number(out, "high_x_mm", summary.high_x_mm);
    put_number(out, "high_y_mm", summary.high_y_mm);
    put_number(out, "high_z_mm", summary.high_z_mm);
    put_number(out, "volume_mm3", summary.volume_mm3);
    put_number(out, "filament_mm", summary.filament_mm);
    put_known(out, "mass_g", summary.mass_g);
    put_known(out, "time_s", summary.estimated_time_s);
    for (const auto& [key, value] : metadata.extra) put_text(out, key, value);
    return out;
}

}  // namespace lyr::format
