// What a simulation found, for people and for programs, and what a print did.

#include <algorithm>
#include <array>
#include <cmath>

#include "base/constants.h"
#include "base/text.h"
#include "target/motion/time_walk.h"
#include "target/run/print.h"
#include "target/run/simulate.h"

namespace lyr::run {
namespace {

using config::axis_count;
using config::axis_names;

constexpr double half_step = 0.5;
// Of positions in double precision, in steps: far above rounding, far below anything a motor does.
constexpr double rounding_steps = 1e-6;

std::string duration_text(double time_s) {
    const auto whole_s = static_cast<long long>(time_s);
    std::string text;
    if (whole_s >= 3600) text += formatted("%lld h ", whole_s / 3600);
    if (whole_s >= 60) text += formatted("%lld min ", whole_s / 60 % 60);
    text += formatted("%.3f s", std::fmod(time_s, 60));
    return text;
}

double rate_hz(const PulseFigures& figures) {
    return figures.shortest_interval_ns
               ? ns_per_s / static_cast<double>(*figures.shortest_interval_ns)
               : 0;
}

std::string microseconds(const std::optional<std::int64_t>& duration_ns) {
    if (!duration_ns) return "-";
    std::string text;
    text += formatted("%.3f", static_cast<double>(*duration_ns) / ns_per_us);
    return text;
}

void append_axes(std::string& text, const SimulationReport& report) {
    text += formatted("  %-4s %12s %12s %10s %13s %13s %11s %11s %11s\n", "axis", "steps", "net",
                      "reversals", "shortest us", "longest us", "steps/s", "off file", "off plan");
    for (std::size_t i = 0; i < axis_count; ++i) {
        const PulseFigures& pulses = report.pulses[i];
        text += formatted("  %-4s %12llu %12lld %10llu %13s %13s %11.0f %11.6f %11.6f\n",
                          std::string(axis_names[i]).c_str(),
                          static_cast<unsigned long long>(pulses.steps),
                          static_cast<long long>(report.positions[i]),
                          static_cast<unsigned long long>(pulses.reversals),
                          microseconds(pulses.shortest_interval_ns).c_str(),
                          microseconds(pulses.longest_interval_ns).c_str(), rate_hz(pulses),
                          report.path.steps[i], report.planned_steps[i]);
    }
}

// Shortest over all axes of one figure.
std::optional<std::int64_t> shortest(const SimulationReport& report,
                                     std::optional<std::int64_t> PulseFigures::*figure) {
    std::optional<std::int64_t> result;
    for (const PulseFigures& pulses : report.pulses)
        if (const auto& value = pulses.*figure; value && (!result || *value < *result))
            result = value;
    return result;
}

void append_heat(std::string& text, const SimulationReport& report) {
    if (report.heat.empty()) return;
    text += "  heated      ";
    for (const HeatFigures& heat : report.heat) {
        const double power_w = report.printer.heaters[heat.heater]->model.power_w;
        constexpr double j_per_wh = 3'600;
        text += formatted("%s %s to %.1f °C at most with %.1f Wh",
                          &heat == &report.heat.front() ? "" : ",",
                          std::string(config::heater_names[heat.heater]).c_str(), heat.highest_c,
                          heat.full_power_s * power_w / j_per_wh);
    }
    text += '\n';
}

struct Spacing {
    const char* name;
    const char* json_key;
    std::optional<std::int64_t> PulseFigures::*figure;
    std::int64_t config::PulseTiming::*needed;
};
constexpr std::array<Spacing, 4> spacings{{
    {"high", "shortest_high_ns", &PulseFigures::shortest_high_ns, &config::PulseTiming::high_ns},
    {"low", "shortest_low_ns", &PulseFigures::shortest_low_ns, &config::PulseTiming::low_ns},
    {"direction_setup", "shortest_direction_setup_ns", &PulseFigures::shortest_setup_ns,
     &config::PulseTiming::direction_setup_ns},
    {"direction_hold", "shortest_direction_hold_ns", &PulseFigures::shortest_hold_ns,
     &config::PulseTiming::direction_hold_ns},
}};

// What comes before, then the value in quotes.
void append_json(std::string& text, const char* before, const std::string& value) {
    text += before + in_json(value);
}

void append_json(std::string& text, const char* key, const std::optional<std::int64_t>& value) {
    if (value)
        text += formatted(",\"%s\":%lld", key, static_cast<long long>(*value));
    else
        text += formatted(",\"%s\":null", key);
}

void append_json_axes(std::string& text, const SimulationReport& report) {
    text += ",\"axes\":{";
    for (std::size_t i = 0; i < axis_count; ++i) {
        const PulseFigures& pulses = report.pulses[i];
        text += formatted("%s\"%s\":{\"steps\":%llu,\"net_steps\":%lld,\"reversals\":%llu",
                          i ? "," : "", std::string(axis_names[i]).c_str(),
                          static_cast<unsigned long long>(pulses.steps),
                          static_cast<long long>(report.positions[i]),
                          static_cast<unsigned long long>(pulses.reversals));
        append_json(text, "shortest_interval_ns", pulses.shortest_interval_ns);
        append_json(text, "longest_interval_ns", pulses.longest_interval_ns);
        text += formatted(",\"max_rate_hz\":%.3f", rate_hz(pulses));
        text += ",\"off_file_steps\":" + in_json(report.path.steps[i], 9);
        text += ",\"off_plan_steps\":" + in_json(report.planned_steps[i], 9) + '}';
    }
    text += '}';
}

// What an axis may lag behind while its motor makes up for its play.
double lag_steps(const config::Printer& printer, std::size_t axis) {
    if (axis >= printer.backlash_mm.size()) return 0;
    return motion::Play::lag(printer.backlash_mm[axis] * printer.axes[axis].steps_per_mm);
}

}  // namespace

double SimulationReport::worst_steps() const {
    return std::max(path.worst_steps,
                    *std::max_element(planned_steps.begin(), planned_steps.end()));
}

bool SimulationReport::within_limits() const {
    for (std::size_t i = 0; i < axis_count; ++i) {
        const double in_a_ns =
            config::fastest_motor_mm_s(printer, i) * printer.axes[i].steps_per_mm / ns_per_s;
        const double limit = half_step + in_a_ns + rounding_steps + lag_steps(printer, i);
        if (!(path.steps[i] <= limit) || !(planned_steps[i] <= limit)) return false;
    }
    return std::all_of(spacings.begin(), spacings.end(), [this](const Spacing& spacing) {
        const auto found = shortest(*this, spacing.figure);
        return !found || *found >= printer.pulse.*spacing.needed;
    });
}

std::string text_of(const SimulationReport& report) {
    const PathTotals& totals = report.totals;
    std::string text;
    text += report.file + " on printer \"" + report.printer.name + "\", simulated\n";
    text += formatted("  layers       %u, %llu motions\n", totals.layers,
                      static_cast<unsigned long long>(totals.motions));
    text += "  print time   " + duration_text(report.print_time_s);
    if (report.delayed_ns)
        text += formatted(", of it %.3f us for the drivers' edges",
                          static_cast<double>(report.delayed_ns) / ns_per_us);
    if (report.waited_s > 0)
        text += ", and " + duration_text(report.waited_s) + " of waiting for temperatures";
    if (report.paused_s > 0) text += ", and " + duration_text(report.paused_s) + " of pauses";
    if (report.slowed_s > 0)
        text += ", and " + duration_text(report.slowed_s) + " more at the lower speed asked for";
    text += formatted("\n  extruded     %.3f mm with %.3f mm of %.2f mm filament\n",
                      totals.extruded_mm, totals.filament_mm, report.filament_diameter_mm);
    text += formatted("  travelled    %.3f mm\n", totals.travelled_mm);
    append_heat(text, report);
    append_axes(text, report);
    text += "  pulses      ";
    for (const Spacing& spacing : spacings)
        text += formatted(" %s >= %s us%s", spacing.name,
                          microseconds(shortest(report, spacing.figure)).c_str(),
                          &spacing == &spacings.back() ? "\n" : ",");
    const Deviation& path = report.path;
    text += formatted("  off file     %.6f microsteps at most, %.6f mm in space", path.worst_steps,
                      path.distance_mm);
    text += formatted(" (axis %s, layer %u, x %.3f y %.3f z %.3f)\n",
                      std::string(axis_names[path.worst_axis]).c_str(), path.worst_layer + 1,
                      path.worst_at_mm[0], path.worst_at_mm[1], path.worst_at_mm[2]);
    text += formatted("  off plan     %.6f microsteps at most, at the same time\n",
                      *std::max_element(report.planned_steps.begin(), report.planned_steps.end()));
    const auto& play_mm = report.printer.backlash_mm;
    const bool has_play =
        std::any_of(play_mm.begin(), play_mm.end(), [](double mm) { return mm > 0; });
    const char* const allowed =
        has_play ? "half a microstep and a fifth of backlash_mm" : "half a microstep";
    text += report.within_limits()
                ? formatted("  within %s everywhere (times are whole nanoseconds)\n", allowed)
                : formatted("  NOT within %s, or pulses too short\n", allowed);
    return text;
}

std::string json_of(const SimulationReport& report) {
    const PathTotals& totals = report.totals;
    std::string text;
    append_json(text, "{\"file\":", report.file);
    append_json(text, ",\"printer\":", report.printer.name);
    text += formatted(",\"layers\":%u,\"motions\":%llu,\"print_time_s\":%.9f,\"delayed_ns\":%lld",
                      totals.layers, static_cast<unsigned long long>(totals.motions),
                      report.print_time_s, static_cast<long long>(report.delayed_ns));
    text += formatted(",\"waited_s\":%.3f,\"paused_s\":%.3f,\"slowed_s\":%.3f,\"heaters\":{",
                      report.waited_s, report.paused_s, report.slowed_s);
    for (const HeatFigures& heat : report.heat)
        text += formatted("%s\"%s\":{\"highest_c\":%.3f,\"full_power_s\":%.3f}",
                          &heat == &report.heat.front() ? "" : ",",
                          std::string(config::heater_names[heat.heater]).c_str(), heat.highest_c,
                          heat.full_power_s);
    text += '}';
    text += formatted(",\"extruded_mm\":%.6f,\"travelled_mm\":%.6f,\"filament_mm\":%.6f",
                      totals.extruded_mm, totals.travelled_mm, totals.filament_mm);
    text += ",\"deviation_steps\":" + in_json(report.worst_steps(), 9);
    text += ",\"deviation_mm\":" + in_json(report.path.distance_mm, 9);
    text += std::string(",\"within_half_step\":") + (report.within_limits() ? "true" : "false");
    text += ",\"pulses\":{\"writes\":" + std::to_string(report.writes);
    for (const Spacing& spacing : spacings)
        append_json(text, spacing.json_key, shortest(report, spacing.figure));
    text += '}';
    append_json_axes(text, report);
    text += ",\"notes\":[";
    for (const Diagnostic& note : report.notes)
        append_json(text, &note == &report.notes.front() ? "" : ",", note.message);
    text += "]}\n";
    return text;
}

std::string text_of(const PrintReport& report) {
    std::string text = formatted(
        "  printed in %.3f s, %.3f s longer than planned\n  %llu writes, the latest %.3f us late\n",
        report.planned_s + report.stretched_s, report.stretched_s,
        static_cast<unsigned long long>(report.writes),
        static_cast<double>(report.worst_late_ns) / ns_per_us);
    if (report.cpu) text += formatted("  all of them on processor %u\n", *report.cpu);
    if (report.waited_s > 0)
        text += formatted("  waited %.1f s for temperatures\n", report.waited_s);
    if (report.paused_s > 0) text += formatted("  paused for %.1f s\n", report.paused_s);
    if (report.slowed_s > 0)
        text += formatted("  %.1f s more at the lower speed asked for\n", report.slowed_s);
    for (std::size_t i = 0; i < report.lateness.size(); ++i)
        if (report.lateness[i])
            text += formatted("  waits less than %9llu us late: %llu\n", 1ULL << i,
                              static_cast<unsigned long long>(report.lateness[i]));
    return text;
}

}  // namespace lyr::run
