// What stepc says of a print's time and material.

#include <cmath>
#include <cstdio>

#include "base/text.h"
#include "slicer/slicer.h"

namespace lyr::slicer {
namespace {

constexpr double s_per_min = 60;
constexpr double mm_per_m = 1e3, mm3_per_cm3 = 1e3;

std::string duration(double time_s) {
    const auto whole_s = static_cast<long long>(std::llround(time_s));
    char text[64];
    std::snprintf(text, sizeof text, "%lld h %02lld min %02lld s", whole_s / 3600,
                  whole_s / 60 % 60, whole_s % 60);
    return text;
}

}  // namespace

std::string estimate_text(const Summary& summary, const std::string& printer_name) {
    char line[160];
    std::snprintf(line, sizeof line, ", filament %.3f m", summary.filament_mm / mm_per_m);
    std::string text = "time " + duration(summary.estimate.time_s()) + " on printer " +
                       in_quotes(printer_name) + line;
    if (summary.mass_g > 0) {
        std::snprintf(line, sizeof line, ", %.1f g", summary.mass_g);
        text += line;
    }
    std::snprintf(line, sizeof line, "\n  %-18s%10s%10s%10s\n", "role", "m", "cm3", "min");
    text += line;
    const Estimate& estimate = summary.estimate;
    for (std::size_t i = 0; i < estimate.roles.size(); ++i) {
        const RoleEstimate& role = estimate.roles[i];
        if (!(role.length_mm > 0)) continue;
        const std::string name(name_of(static_cast<format::Role>(i)));
        std::snprintf(line, sizeof line, "  %-18s%10.3f%10.3f%10.1f\n", name.c_str(),
                      role.length_mm / mm_per_m, role.volume_mm3 / mm3_per_cm3,
                      role.time_s / s_per_min);
        text += line;
    }
    std::snprintf(line, sizeof line, "  %-18s%10.3f%20.1f\n", "travel",
                  estimate.travel_mm / mm_per_m, estimate.travel_time_s / s_per_min);
    return text + line;
}

}  // namespace lyr::slicer
