// A request is looked at whole before anything of it is done, so that "set" with one bad value of three sets nothing.

#include "target/control/dispatcher.h"

#include <algorithm>
#include <filesystem>

#include "base/text.h"
#include "target/run/life.h"

namespace lyr::control {
namespace {

using run::PrintState;

template <class... Calls>
struct Overloaded : Calls... {
    using Calls::operator()...;
};

bool is_ending(PrintState state) {
    return state == PrintState::stopping || run::is_over(state);
}

bool is_at_rest(PrintState state) {
    return state == PrintState::pausing || state == PrintState::paused;
}

Refusal wrong_state(const char* what, PrintState state) {
    return {"null", ErrorCode::wrong_state,
            std::string(what) + ": the print is " +
                std::string(run::print_state_names[static_cast<std::size_t>(state)])};
}

}  // namespace

std::string Dispatcher::greeting() const {
    std::error_code error;
    const auto path = std::filesystem::absolute(print_.status().file, error);
    return "{\"greeting\":\"lyrrun\",\"protocol\":" + std::to_string(protocol_version) +
           ",\"printer\":" + in_json(escaped(printer_.name)) +
           ",\"file\":" + in_json(escaped(path.string())) + '}';
}

std::string Dispatcher::status_event() const {
    return "{\"event\":\"status\",\"status\":" + json_of(print_.status(), printer_) + '}';
}

std::string Dispatcher::answer(std::string_view line, Subscription* subscription) {
    const auto read = read_request(line);
    if (const auto* refusal = std::get_if<Refusal>(&read)) return refusal_line(*refusal);
    const Request& request = std::get<Request>(read);
    const Overloaded act{
        [&](const GetStatus&) {
            return "{\"id\":" + request.id +
                   ",\"ok\":true,\"status\":" + json_of(print_.status(), printer_) + '}';
        },
        [&](const Subscribe& subscribe) {
            if (!subscription)
                return refusal_line({request.id, ErrorCode::unknown_command,
                                     "subscribe is for the socket; here, ask for the status"});
            subscription->interval.reset();
            subscription->next_due = Subscription::Clock::now();
            if (subscribe.interval_s > 0)
                subscription->interval = std::chrono::duration_cast<Subscription::Clock::duration>(
                    std::chrono::duration<double>(subscribe.interval_s));
            return done_line(request.id);
        },
        [&](const Commands& commands) { return carry_out(request.id, commands); }};
    return std::visit(act, request.wish);
}

std::string Dispatcher::carry_out(const std::string& id, const Commands& commands) {
    std::optional<Refusal> refusal = objection(commands);
    if (!refusal && !print_.post(commands))
        refusal = {"null", ErrorCode::busy, "too many commands wait already"};
    if (!refusal) return done_line(id);
    refusal->id = id;
    return refusal_line(*refusal);
}

std::optional<Refusal> Dispatcher::objection(const Commands& commands) const {
    const run::PrintStatus status = print_.status();
    for (const run::Command& command : commands) {
        if (auto refusal = objection(command, status)) return refusal;
        if (const auto why = run::objection(command, printer_))
            return Refusal{"null", ErrorCode::bad_value, *why};
    }
    return std::nullopt;
}

std::optional<Refusal> Dispatcher::objection(const run::Command& command,
                                             const run::PrintStatus& status) const {
    using Objection = std::optional<Refusal>;
    const PrintState state = status.state;
    const Overloaded check{
        // Of two people who see fire, the second must not be told off.
        [](const run::EmergencyStop&) { return Objection(); },
        [&](const run::Pause&) {
            return is_ending(state) || is_at_rest(state) ? wrong_state("cannot pause", state)
                                                         : Objection();
        },
        [&](const run::Resume&) -> Objection {
            if (!is_at_rest(state)) return wrong_state("cannot resume", state);
            if (status.draws_out)
                return Refusal{"null", ErrorCode::wrong_state,
                               "cannot resume: the filament is still being drawn out"};
            return std::nullopt;
        },
        [&](const run::ChangeFilament&) {
            return is_ending(state) ? wrong_state("cannot change filament", state) : Objection();
        },
        [&](const run::Cancel&) {
            return is_ending(state) ? wrong_state("cannot cancel", state) : Objection();
        },
        [&](const run::SetTemperature& set) -> Objection {
            if (is_ending(state)) return wrong_state("cannot set temperatures", state);
            const auto& heater = printer_.heaters[set.heater];
            if (!heater || !status.heaters[set.heater].is_present)
                return Refusal{
                    "null", ErrorCode::no_such_heater,
                    "this print has no heater " + std::string(config::heater_names[set.heater])};
            const bool pushes = set.heater == config::heater_tool && state != PrintState::paused;
            if (pushes && set.target_c < heater->min_extrude_c)
                return Refusal{"null", ErrorCode::wrong_state,
                               "filament is pushed from " + shortest(heater->min_extrude_c) +
                                   " °C on; pause first"};
            return std::nullopt;
        },
        [&](const run::SetFan&) -> Objection {
            if (is_ending(state)) return wrong_state("cannot set the fan", state);
            // Whoever tends the heaters switches the fan.
            if (std::ranges::none_of(status.heaters, &run::HeaterNow::is_present))
                return Refusal{"null", ErrorCode::bad_value,
                               "this print switches no fan: it runs without heat"};
            return std::nullopt;
        },
        [&](const auto&) {
            return is_ending(state) ? wrong_state("cannot set this", state) : Objection();
        }};
    return std::visit(check, command);
}

std::string json_of(const run::PrintStatus& status, const config::Printer& printer) {
    std::string text = "{\"state\":\"";
    text += run::print_state_names[static_cast<std::size_t>(status.state)];
    text += "\",\"message\":" + in_json(escaped(status.message));
    text += ",\"file\":" + in_json(escaped(status.file));
    text += ",\"printer\":" + in_json(escaped(printer.name));
    text += ",\"layer\":" + std::to_string(status.layer);
    text += ",\"layers\":" + std::to_string(status.layers);
    const auto& at = status.position_mm;
    text += ",\"position_mm\":";
    text += status.is_position_known
                ? '[' + in_json(at[0], 3) + ',' + in_json(at[1], 3) + ',' + in_json(at[2], 3) + ']'
                : "null";
    text += ",\"time_s\":" + in_json(status.time_s, 2);
    text += ",\"elapsed_s\":" + in_json(status.elapsed_s, 2);
    text += ",\"estimated_s\":";
    text += status.estimated_s > 0 ? in_json(status.estimated_s, 2) : "null";
    text += ",\"heaters\":{";
    bool first = true;
    for (std::size_t i = 0; i < status.heaters.size(); ++i) {
        const run::HeaterNow& heater = status.heaters[i];
        if (!heater.is_present) continue;
        text += first ? "\"" : ",\"";
        first = false;
        text += config::heater_names[i];
        text += "\":{\"temperature_c\":" + in_json(heater.temperature_c, 1);
        text += ",\"target_c\":" + in_json(heater.target_c, 1) + '}';
    }
    text += "},\"fan\":" + in_json(status.fan, 3);
    text += ",\"speed\":" + in_json(status.speed_factor, 3);
    text += ",\"filament_mm\":" + in_json(status.filament_mm, 1) + '}';
    return text;
}

}  // namespace lyr::control
