#include "target/control/answer.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/text.h"

namespace lyr::control {
namespace {

using nlohmann::json;

// What stands under a name, or what it would be if it stood there and were of that kind.
template <class Value>
Value value_in(const json& object, std::string_view name, Value otherwise) {
    const auto found = object.find(name);
    if (found == object.end()) return otherwise;
    if constexpr (std::is_same_v<Value, std::string>) {
        return found->is_string() ? found->template get<std::string>() : otherwise;
    } else if constexpr (std::is_same_v<Value, bool>) {
        return found->is_boolean() ? found->template get<bool>() : otherwise;
    } else {
        return found->is_number() ? found->template get<Value>() : otherwise;
    }
}

run::HeaterNow heater_in(const json& heaters, std::string_view name) {
    const auto found = heaters.find(name);
    if (found == heaters.end() || !found->is_object()) return {};
    return {true, value_in(*found, "temperature_c", 0.0), value_in(*found, "target_c", 0.0)};
}

Told told_in(const json& object) {
    Told told{{}, value_in(object, "printer", std::string()), object.dump()};
    run::PrintStatus& status = told.status;
    const auto& names = run::print_state_names;
    const auto state = std::ranges::find(names, value_in(object, "state", std::string()));
    if (state != names.end()) status.state = static_cast<run::PrintState>(state - names.begin());
    status.message = value_in(object, "message", std::string());
    status.file = value_in(object, "file", std::string());
    status.layer = value_in(object, "layer", std::uint32_t{0});
    status.layers = value_in(object, "layers", std::uint32_t{0});
    status.time_s = value_in(object, "time_s", 0.0);
    status.elapsed_s = value_in(object, "elapsed_s", 0.0);
    status.estimated_s = value_in(object, "estimated_s", 0.0);
    status.fan = value_in(object, "fan", 0.0);
    status.speed_factor = value_in(object, "speed", 1.0);
    status.filament_mm = value_in(object, "filament_mm", 0.0);
    const auto at = object.find("position_mm");
    status.is_position_known =
        at != object.end() && at->is_array() && at->size() == 3 &&
        std::ranges::all_of(*at, [](const json& v) { return v.is_number(); });
    for (std::size_t i = 0; status.is_position_known && i < 3; ++i)
        status.position_mm[i] = (*at)[i].get<double>();
    const auto heaters = object.find("heaters");
    if (heaters == object.end() || !heaters->is_object()) return told;
    for (std::size_t i = 0; i < config::heater_count; ++i)
        status.heaters[i] = heater_in(*heaters, config::heater_names[i]);
    return told;
}

}  // namespace

std::optional<Answer> read_answer(std::string_view line) {
    const json object = json::parse(line, nullptr, false);
    if (!object.is_object()) return std::nullopt;
    if (object.contains("greeting"))
        return Greeting{value_in(object, "protocol", 0), value_in(object, "printer", std::string()),
                        value_in(object, "file", std::string())};
    if (const auto status = object.find("status"); status != object.end() && status->is_object()) {
        Told told = told_in(*status);
        told.is_event = object.contains("event");
        return told;
    }
    if (!object.contains("ok")) return std::nullopt;
    if (value_in(object, "ok", false)) return Accepted{};
    const auto error = object.find("error");
    if (error == object.end() || !error->is_object()) return std::nullopt;
    return Refused{value_in(*error, "code", std::string()),
                   value_in(*error, "message", std::string())};
}

std::string text_of(const Told& told) {
    const run::PrintStatus& status = told.status;
    std::string text = escaped(status.file) + " on " + in_quotes(told.printer) + ": " +
                       std::string(run::print_state_names[static_cast<std::size_t>(status.state)]);
    if (!status.message.empty()) text += ", " + escaped(status.message);
    text += formatted("\n  layer      %u of %u\n  time       ", status.layer, status.layers) +
            clock_text(status.time_s);
    if (status.estimated_s > 0)
        text += " of about " + clock_text(status.estimated_s) +
                formatted(" (%.0f %%)", std::min(100.0, 100 * status.time_s / status.estimated_s));
    text += '\n';
    for (std::size_t i = 0; i < config::heater_count; ++i) {
        const run::HeaterNow& heater = status.heaters[i];
        if (!heater.is_present) continue;
        text += formatted("  %-10s %.1f °C, ", std::string(config::heater_names[i]).c_str(),
                          heater.temperature_c);
        text += heater.target_c > 0 ? formatted("set to %g °C\n", heater.target_c) : "off\n";
    }
    text += formatted("  fan        %.0f %%\n  speed      %.0f %%\n", 100 * status.fan,
                      100 * status.speed_factor);
    const auto& at = status.position_mm;
    text += status.is_position_known
                ? formatted("  head       x %.2f y %.2f z %.2f mm\n", at[0], at[1], at[2])
                : "  head       lost: where it is, nobody knows\n";
    return text;
}

}  // namespace lyr::control
