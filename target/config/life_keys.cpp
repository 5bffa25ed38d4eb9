#include "target/config/life_keys.h"

#include <cmath>

#include "target/config/key_rules.h"

namespace lyr::config {
namespace {

constexpr Range lengths_mm{0, 2'000};
constexpr Range speeds_mm_s{0.1, 10'000};
// A day: who has not come by then will not.
constexpr Range rests_s{0, 86'400};
// The kernel counts whole seconds; a control thread that hangs for longer than a few is lost.
constexpr Range watchdog_s{2, 300};

// `part` is the section's place in a Printer.
template <class Part>
Key of(const std::string& path, Range range, Part Printer::*part, double Part::*field) {
    return number(path, range, [part, field](Draft& draft, double value) {
        draft.printer.*part.*field = value;
    });
}

}  // namespace

void append_life_keys(std::vector<Key>& keys) {
    for (std::size_t i = 0; i < input_count; ++i)
        append_input(keys, "input." + std::string(input_names[i]),
                     [i](Draft& draft) -> std::optional<Pin>& { return draft.printer.inputs[i]; });
    const auto pause = [&](const char* name, Range range, double PauseSettings::*field) {
        keys.push_back(of(std::string("pause.") + name, range, &Printer::pause, field));
    };
    keys.push_back(
        {"pause.park_mm", false, false, [](const toml::node& node, Draft& draft) -> Complaint {
             const Range positions_mm{-10'000, 10'000};
             const auto values = numbers_in<2>(node, positions_mm);
             if (!values) return "expected a list [x, y] of " + text_of(positions_mm);
             draft.printer.pause.park_mm = *values;
             return std::nullopt;
         }});
    pause("lift_mm", lengths_mm, &PauseSettings::lift_mm);
    pause("retract_mm", lengths_mm, &PauseSettings::retract_mm);
    pause("speed_mm_s", speeds_mm_s, &PauseSettings::speed_mm_s);
    pause("tool_off_s", rests_s, &PauseSettings::tool_off_s);
    pause("bed_off_s", rests_s, &PauseSettings::bed_off_s);
    const auto filament = [&](const char* name, Range range, double FilamentSettings::*field) {
        keys.push_back(of(std::string("filament.") + name, range, &Printer::filament, field));
    };
    filament("unload_mm", lengths_mm, &FilamentSettings::unload_mm);
    filament("load_mm", lengths_mm, &FilamentSettings::load_mm);
    filament("purge_mm", lengths_mm, &FilamentSettings::purge_mm);
    filament("speed_mm_s", speeds_mm_s, &FilamentSettings::speed_mm_s);
    keys.push_back(text("recovery.folder", [](Draft& draft, const std::string& value) {
        draft.printer.recovery_folder = value;
    }));
    keys.push_back(text("watchdog.device", [](Draft& draft, const std::string& value) {
        draft.printer.watchdog.device = value;
    }));
    keys.push_back(
        of("watchdog.timeout_s", watchdog_s, &Printer::watchdog, &WatchdogSettings::timeout_s));
}

Problems life_problems(const Printer& printer) {
    if (!printer.pause.park_mm) return {};
    const auto& [x_mm, y_mm] = *printer.pause.park_mm;
    for (const auto& [at_mm, number] : {std::pair{x_mm, axis_x}, {y_mm, axis_y}})
        if (const auto where = outside(printer, number, at_mm))
            return {{"pause.park_mm", ": " + *where}};
    // Without a reach, that is what is wrong.
    const double reach_mm = printer.delta.reach_mm;
    if (printer.kinematics == Kinematics::delta && reach_mm > 0 &&
        std::hypot(x_mm, y_mm) > reach_mm)
        return {{"pause.park_mm", ": farther from the middle than delta.reach_mm"}};
    return {};
}

}  // namespace lyr::config
