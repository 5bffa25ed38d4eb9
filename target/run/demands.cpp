#include "target/run/demands.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "base/text.h"
#include "target/run/heat_order.h"

namespace lyr::run {
namespace {

constexpr std::uint32_t part_fan = 0;

std::string name_of(const format::Heater& heater) {
    switch (heater.kind) {
        case format::HeaterKind::bed:
            return "the bed";
        case format::HeaterKind::chamber:
            return "the chamber";
        case format::HeaterKind::tool:
            return "tool " + std::to_string(heater.tool);
    }
    return "a heater";
}

std::string degrees(double temperature_c) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%g °C", temperature_c);
    return text.data();
}

std::string heat_text(const Demands& demands) {
    std::string text;
    for (const format::HeaterTarget& target : demands.hottest)
        text +=
            (text.empty() ? "" : ", ") + name_of(target.heater) + " to " + degrees(target.target_c);
    return text;
}

Diagnostic note(std::string message) {
    return {Severity::note, ExitStatus::ok, std::move(message), {}};
}

Diagnostic impossible(std::string message) {
    return machine_error(std::move(message) + "; --no-heat makes the motions cold");
}

Status check_heat(const Demands& demands, const config::Printer& printer) {
    for (const auto& [heater, target_c] : demands.hottest) {
        const std::optional<std::size_t> number = heater_number(heater);
        if (!number || !printer.heaters[*number])
            return impossible("the file heats " + heat_text(demands) + ", and printer \"" +
                              printer.name + "\" has no heater for " + name_of(heater));
        const double high_c = printer.heaters[*number]->guard.high_c;
        if (target_c > high_c - headroom_c)
            return impossible("the file heats " + name_of(heater) + " to " + degrees(target_c) +
                              "; heater." + std::string(config::heater_names[*number]) +
                              ".range_c ends at " + degrees(high_c) + ", and the last " +
                              degrees(headroom_c) + " of it are for overshoot");
    }
    const std::optional<config::Heater>& tool = printer.heaters[config::heater_tool];
    if (!tool || !demands.coldest_extrusion_c) return Done{};
    if (*demands.coldest_extrusion_c >= tool->min_extrude_c) return Done{};
    Diagnostic cold =
        impossible("the file pushes filament while it has not made sure of more than " +
                   degrees(*demands.coldest_extrusion_c) +
                   " at the tool; heater.tool.min_extrude_c is " + degrees(tool->min_extrude_c));
    cold.where.layer = static_cast<int>(demands.coldest_layer);
    return cold;
}

// Axes that the board is too late for at their full speed.
void note_held_axes(const config::Printer& printer, Diagnostics& notes) {
    for (std::size_t axis = 0; axis < config::axis_count; ++axis) {
        const double full_mm_s = printer.axes[axis].max_speed_mm_s;
        const double held_mm_s = config::held_speed_mm_s(printer, axis);
        if (held_mm_s < full_mm_s)
            notes.push_back(note(
                formatted("axis.%s is planned at %.1f mm/s at the most, not %g: by [timing] the "
                          "board holds %.0f steps a second of each motor",
                          std::string(config::axis_names[axis]).c_str(), held_mm_s, full_mm_s,
                          config::held_steps_per_s(printer))));
    }
}

}  // namespace

Status check_demands(const Inspection& inspection, const config::Printer& printer, bool no_heat,
                     Diagnostics& notes, bool can_resume) {
    const Demands& demands = inspection.demands;
    note_held_axes(printer, notes);
    if (no_heat && !demands.hottest.empty())
        notes.push_back(note("not heated: " + heat_text(demands)));
    const bool has_fans = !no_heat && printer.part_fan &&
                          std::all_of(demands.fans.begin(), demands.fans.end(),
                                      [](std::uint32_t fan) { return fan == part_fan; });
    if (!demands.fans.empty() && !has_fans)
        notes.push_back(note(no_heat ? "fans are not switched: without heat they stay off"
                                     : "fans are not switched: the printer has no part fan, or the "
                                       "file uses others"));
    if (!no_heat)
        if (Status possible = check_heat(demands, printer); !possible) return possible;
    if (demands.pauses && !can_resume)
        return Diagnostic{Severity::error,
                          ExitStatus::unsupported,
                          "the file pauses " + std::to_string(demands.pauses) +
                              " times, and nobody could tell it to go on",
                          {}};
    return Done{};
}

}  // namespace lyr::run
