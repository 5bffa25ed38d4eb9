// The text of lyrview --info.

#include <cmath>
#include <cstdio>

#include "base/text.h"
#include "format/export/statistics.h"

namespace lyr::format {
namespace {

// A file's text must not steer the terminal.
std::string printable(std::string value) {
    for (char& c : value)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    return value;
}

void append_known(std::string& text, const char* label, const std::string& value) {
    if (!value.empty()) text += label + printable(value) + '\n';
}

// 1234567 as "1 234 567".
std::string grouped(std::uint64_t number) {
    std::string digits = std::to_string(number);
    for (std::size_t at = digits.size(); at > 3;) {
        at -= 3;
        digits.insert(at, 1, ' ');
    }
    return digits;
}

std::string duration(double time_s) {
    const auto whole_s = static_cast<std::uint64_t>(std::llround(time_s));
    char text[64];
    std::snprintf(text, sizeof text, "%llu h %02llu min %02llu s",
                  static_cast<unsigned long long>(whole_s / 3600),
                  static_cast<unsigned long long>(whole_s / 60 % 60),
                  static_cast<unsigned long long>(whole_s % 60));
    return text;
}

void append_head(std::string& text, const Statistics& s, const std::string& name) {
    const FileHeader& header = s.header;
    const Metadata& metadata = header.metadata;
    text += name;
    text += formatted(": .lyr %u.%u, %s bytes, whole\n", header.major, header.minor,
                      grouped(s.bytes).c_str());
    append_known(text, "source        ", metadata.source_name);
    append_known(text, "  sha-256     ", metadata.source_sha256);
    append_known(text, "made by       ", metadata.generator);
    append_known(text, "printer       ", metadata.printer);
    append_known(text, "material      ", metadata.material);
    append_known(text, "profile       ", metadata.profile);
    for (const std::string& object : metadata.objects) append_known(text, "object        ", object);
    for (const auto& [key, value] : metadata.extra)
        append_known(text, "              ", key + " = " + value);
    text += formatted("resolution    %g um", header.quantum.nm / 1e3);
    if (metadata.tolerance_mm > 0) text += formatted(", tolerance %g mm", metadata.tolerance_mm);
    text += '\n';
}

void append_size(std::string& text, const Statistics& s) {
    const Summary& summary = s.header.summary;
    text += formatted("layers        %u", s.layers);
    if (s.layers > 0) {
        text += formatted(", z %.3f to %.3f mm, ", s.lowest_layer_mm, s.highest_layer_mm);
        if (s.least_height_mm == s.most_height_mm)
            text += formatted("%g mm thick", s.most_height_mm);
        else
            text += formatted("%g to %g mm thick", s.least_height_mm, s.most_height_mm);
    }
    text += formatted(
        "\nbox           x %.3f to %.3f, y %.3f to %.3f, z %.3f to %.3f mm (%.2f x %.2f mm)\n",
        summary.low_x_mm, summary.high_x_mm, summary.low_y_mm, summary.high_y_mm, summary.low_z_mm,
        summary.high_z_mm, summary.high_x_mm - summary.low_x_mm,
        summary.high_y_mm - summary.low_y_mm);
    if (s.hottest_tool_c > 0 || s.hottest_bed_c > 0)
        text +=
            formatted("temperatures  nozzle %g, bed %g deg C\n", s.hottest_tool_c, s.hottest_bed_c);
}

void append_roles(std::string& text, const Statistics& s) {
    text += formatted("\n%-18s%10s%10s%10s%9s%12s%13s%13s\n", "role", "paths", "lines", "arcs",
                      "circles", "hatch lines", "length m", "volume cm3");
    RoleStatistics sum;
    const auto row = [&](std::string_view name, const RoleStatistics& role) {
        text += formatted("%-18.*s%10s%10s%10s%9s%12s%13.3f%13.3f\n", static_cast<int>(name.size()),
                          name.data(), grouped(role.paths).c_str(), grouped(role.lines).c_str(),
                          grouped(role.arcs).c_str(), grouped(role.circles).c_str(),
                          grouped(role.hatch_lines).c_str(), role.length_mm / 1e3,
                          role.volume_mm3 / 1e3);
    };
    for (std::size_t i = 0; i < s.roles.size(); ++i) {
        const RoleStatistics& role = s.roles[i];
        if (role.paths == 0 && role.motions() == 0) continue;
        row(name_of(static_cast<Role>(i)), role);
        sum.paths += role.paths;
        sum.lines += role.lines;
        sum.arcs += role.arcs;
        sum.circles += role.circles;
        sum.hatch_lines += role.hatch_lines;
        sum.length_mm += role.length_mm;
        sum.volume_mm3 += role.volume_mm3;
    }
    row("all", sum);
    text += formatted("%-18s%64.3f\n", "travel", s.travel_mm / 1e3);
}

void append_bytes(std::string& text, const Statistics& s) {
    text += formatted("\n%-18s%12s%14s%12s%10s\n", "operation", "count", "bytes", "each", "share");
    const auto row = [&](const char* name, const KindStatistics& kind) {
        if (kind.count == 0) return;
        text += formatted("%-18s%12s%14s%12.2f%8.1f %%\n", name, grouped(kind.count).c_str(),
                          grouped(kind.bytes).c_str(),
                          static_cast<double>(kind.bytes) / static_cast<double>(kind.count),
                          100 * static_cast<double>(kind.bytes) / static_cast<double>(s.bytes));
    };
    row("line", s.lines);
    row("arc", s.arcs);
    row("circle", s.circles);
    row("hatch line", s.hatch_lines);
    row("travel", s.travels);
    row("wipe", s.wipes);
    row("path", s.paths);
    row("setting", s.settings);
    row("layer", s.layer_heads);
    row("everything else", s.rest);
    text += formatted("%s operations in %s chunks; %s hatch runs with %s travels; %s retractions\n",
                      grouped(s.operations).c_str(), grouped(s.chunks).c_str(),
                      grouped(s.hatch_runs).c_str(), grouped(s.hatch_travels).c_str(),
                      grouped(s.retractions).c_str());
    const std::uint64_t intervals = (s.hatch_lines.count + s.hatch_travels) / 2;
    if (intervals > 0)
        text +=
            formatted("%s hatch intervals of %.2f bytes each: a line and the way to it\n",
                      grouped(intervals).c_str(),
                      static_cast<double>(s.hatch_lines.bytes) / static_cast<double>(intervals));
}

void append_estimates(std::string& text, const Statistics& s) {
    const Summary& summary = s.header.summary;
    text += formatted("\nfilament      %.3f m of %g mm", summary.filament_mm / 1e3,
                      s.header.metadata.filament_diameter_mm);
    if (summary.mass_g > 0) text += formatted(", %.1f g", summary.mass_g);
    text += formatted("\ntime          ");
    if (summary.estimated_time_s > 0)
        text +=
            formatted("%s, estimated by the slicer\n", duration(summary.estimated_time_s).c_str());
    else
        text += formatted("more than %s (way over speed, without accelerations)\n",
                          duration(s.moving_time_s + s.dwell_time_s).c_str());
}

}  // namespace

std::string to_text(const Statistics& statistics, const std::string& name) {
    std::string text;
    append_head(text, statistics, name);
    append_size(text, statistics);
    append_estimates(text, statistics);
    append_roles(text, statistics);
    append_bytes(text, statistics);
    return text;
}

}  // namespace lyr::format
