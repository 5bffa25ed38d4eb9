// A heater is there as soon as a key of its section is; until then it has no defaults either.

#include "target/config/heater_keys.h"

#include <algorithm>

#include "base/text.h"
#include "target/config/key_rules.h"
#include "target/config/sensor_checks.h"

namespace lyr::config {
namespace {

constexpr Range temperatures_c{-60, 1'000};
constexpr Range resistances_ohm{0.1, 1e8};
// A slow PWM answers within this; the sampling is a tenth of the shortest.
constexpr Range cycles_s{0.2, 30};
constexpr Range times_s{1, 3'600};

Heater& heater_of(Draft& draft, std::size_t number) {
    std::optional<Heater>& heater = draft.printer.heaters[number];
    if (!heater) heater = default_heater(number);
    return *heater;
}

Fan& fan_of(Draft& draft) {
    std::optional<Fan>& fan = draft.printer.part_fan;
    if (!fan) fan.emplace();
    return *fan;
}

// Keys of one heater.
struct HeaterKeys {
    std::vector<Key>& keys;
    std::size_t number;
    std::string path;

    // `part` leads from the heater to what has the field.
    template <class Part, class Owner>
    void append(const char* name, Range range, Part part, double Owner::*field) const {
        keys.push_back(config::number(path + name, range,
                                      [n = number, part, field](Draft& draft, double value) {
                                          part(heater_of(draft, n)).*field = value;
                                      }));
    }
};

Complaint apply_kind(const toml::node& node, Sensor& sensor) {
    const std::string name = node.value<std::string>().value_or("");
    const auto known = std::find(sensor_kinds.begin(), sensor_kinds.end(), name);
    if (known == sensor_kinds.end()) {
        std::string all;
        for (const std::string_view kind : sensor_kinds)
            all += (all.empty() ? "\"" : ", \"") + std::string(kind) + '"';
        return expected("one of " + all, node);
    }
    sensor.kind = static_cast<SensorKind>(known - sensor_kinds.begin());
    return std::nullopt;
}

// Resistance must run one way with temperature, or a reading would mean two of them.
Complaint apply_points(const toml::node& node, Sensor& sensor) {
    const std::string what =
        "a list of 2 to 64 pairs [temperature in C, resistance in Ohm], in order of temperature, "
        "resistances falling";
    constexpr std::size_t fewest = 2, most = 64;
    const auto* list = node.as_array();
    if (!list || list->size() < fewest || list->size() > most) return expected(what, node);
    std::vector<ResistancePoint> points;
    for (const toml::node& entry : *list) {
        const auto* pair = entry.as_array();
        if (!pair || pair->size() != 2) return expected(what, node);
        const auto temperature_c = number_in(*pair->get(0), temperatures_c);
        const auto ohm = number_in(*pair->get(1), resistances_ohm);
        if (!temperature_c || !ohm) return expected(what, node);
        if (!points.empty() &&
            !(*temperature_c > points.back().temperature_c && *ohm < points.back().resistance_ohm))
            return Complaint("expected " + what);
        points.push_back({*temperature_c, *ohm});
    }
    sensor.points = std::move(points);
    return std::nullopt;
}

Complaint apply_range(const toml::node& node, GuardLimits& guard) {
    const auto values = numbers_in<2>(node, temperatures_c);
    if (!values || !((*values)[0] < (*values)[1]))
        return "expected a list [lowest, highest] of two numbers from -60 to 1000, the first below "
               "the second";
    guard.low_c = (*values)[0];
    guard.high_c = (*values)[1];
    return std::nullopt;
}

void append_sensor(const HeaterKeys& heater) {
    const std::size_t n = heater.number;
    const std::string path = heater.path + "sensor.";
    const auto part = [](Heater& h) -> Sensor& { return h.sensor; };
    heater.keys.push_back({path + "kind", false, false, [n](const toml::node& node, Draft& draft) {
                               return apply_kind(node, heater_of(draft, n).sensor);
                           }});
    heater.keys.push_back(text(path + "file", [n](Draft& draft, const std::string& value) {
        heater_of(draft, n).sensor.file = value;
    }));
    heater.keys.push_back(
        {path + "points", false, false, [n](const toml::node& node, Draft& draft) {
             return apply_points(node, heater_of(draft, n).sensor);
         }});
    heater.append("sensor.pullup_ohm", resistances_ohm, part, &Sensor::pullup_ohm);
    heater.append("sensor.full_scale", {1, 1e9}, part, &Sensor::full_scale);
    heater.append("sensor.r25_ohm", resistances_ohm, part, &Sensor::r25_ohm);
    heater.append("sensor.beta_k", {500, 10'000}, part, &Sensor::beta_k);
    heater.append("sensor.celsius_per_unit", {1e-6, 100}, part, &Sensor::celsius_per_unit);
}

void append_guard(const HeaterKeys& heater) {
    const std::size_t n = heater.number;
    const auto part = [](Heater& h) -> GuardLimits& { return h.guard; };
    heater.keys.push_back(
        {heater.path + "range_c", false, false, [n](const toml::node& node, Draft& draft) {
             return apply_range(node, heater_of(draft, n).guard);
         }});
    const Range differences_c{0.5, 100};
    heater.append("guard.gain_c", differences_c, part, &GuardLimits::gain_c);
    heater.append("guard.gain_time_s", times_s, part, &GuardLimits::gain_time_s);
    heater.append("guard.stray_c", differences_c, part, &GuardLimits::stray_c);
    heater.append("guard.stray_time_s", times_s, part, &GuardLimits::stray_time_s);
    heater.append("guard.rate_c_s", {1, 1'000}, part, &GuardLimits::rate_c_s);
    heater.append("guard.frozen_time_s", times_s, part, &GuardLimits::frozen_time_s);
}

void append_model(const HeaterKeys& heater) {
    const auto part = [](Heater& h) -> HeatModel& { return h.model; };
    heater.append("model.power_w", {0, 1e5, true}, part, &HeatModel::power_w);
    heater.append("model.capacity_j_k", {0.1, 1e7}, part, &HeatModel::capacity_j_k);
    heater.append("model.loss_w_k", {1e-3, 1e4}, part, &HeatModel::loss_w_k);
    heater.append("model.fan_loss_w_k", {0, 1e4}, part, &HeatModel::fan_loss_w_k);
    heater.append("model.lag_s", {0, 600}, part, &HeatModel::lag_s);
}

void append_heater(std::vector<Key>& keys, std::size_t n) {
    const HeaterKeys heater{keys, n, "heater." + std::string(heater_names[n]) + '.'};
    const auto self = [](Heater& h) -> Heater& { return h; };
    const auto pid = [](Heater& h) -> Pid& { return h.pid; };
    append_output(keys, heater.path + "output",
                  [n](Draft& draft) -> std::optional<Pin>& { return heater_of(draft, n).output; });
    keys.push_back(text(heater.path + "pwm", [n](Draft& draft, const std::string& value) {
        heater_of(draft, n).pwm = value;
    }));
    heater.append("cycle_s", cycles_s, self, &Heater::cycle_s);
    heater.append("max_power", {0, 1, true}, self, &Heater::max_power);
    heater.append("kp", {0, 100}, pid, &Pid::kp);
    heater.append("ki", {0, 100}, pid, &Pid::ki);
    heater.append("kd", {0, 1'000}, pid, &Pid::kd);
    if (n == heater_tool) heater.append("min_extrude_c", {0, 1'000}, self, &Heater::min_extrude_c);
    append_sensor(heater);
    append_guard(heater);
    append_model(heater);
}

void append_two_ways(const std::string& section, const std::optional<Pin>& output,
                     const std::string& pwm, Problems& problems) {
    if (output && !pwm.empty())
        problems.emplace_back(section + ".pwm",
                              ": the heat goes out by a line or by a kernel PWM, and " + section +
                                  ".output is given too");
}

void append_range_problems(const std::string& section, const Heater& heater, bool is_tool,
                           const Given& given, Problems& problems) {
    const auto& [low_c, high_c] = std::pair(heater.guard.low_c, heater.guard.high_c);
    const std::string range = section + ".range_c";
    if (low_c > usual_room_c || high_c < usual_room_c + headroom_c)
        problems.emplace_back(
            range, formatted(": [%g, %g] leaves out a cold heater, which would be taken for a "
                             "broken sensor; it must reach from at most %g to at least %g",
                             low_c, high_c, usual_room_c, usual_room_c + headroom_c));
    const std::string push = section + ".min_extrude_c";
    if (!is_tool || heater.min_extrude_c <= high_c - headroom_c) return;
    const std::string why = formatted("the tool gets to %g °C at the most, %g below the end of ",
                                      high_c - headroom_c, headroom_c);
    if (given(push))
        problems.emplace_back(push, ": " + why + range);
    else
        problems.emplace_back(range, ": " + why +
                                         formatted("it, and %s is %g: no filament could be pushed",
                                                   push.c_str(), heater.min_extrude_c));
}

// A guard that would strike whatever the heater does.
void append_guard_problems(const std::string& section, const Heater& heater, const Given& given,
                           Problems& problems) {
    const GuardLimits& guard = heater.guard;
    if (heater.pid.kp == 0 && heater.pid.ki == 0)
        problems.emplace_back(section + ".kp",
                              ": with kp = 0 and ki = 0 the heater would never be switched on");
    const auto key = [&](const char* name, const char* other) {
        return section + (given(section + name) ? name : other);
    };
    if (guard.gain_c > guard.rate_c_s * guard.gain_time_s)
        problems.emplace_back(
            key(".guard.rate_c_s", ".guard.gain_c"),
            formatted(": guard.gain_c = %g in guard.gain_time_s = %g is faster than "
                      "guard.rate_c_s = %g, which no heater may be",
                      guard.gain_c, guard.gain_time_s, guard.rate_c_s));
    // Its power is moved in the second half of that time, and a whole cycle of pulses must show it.
    if (heater.pwm.empty() && guard.frozen_time_s / 2 < heater.cycle_s)
        problems.emplace_back(
            key(".guard.frozen_time_s", ".cycle_s"),
            formatted(": guard.frozen_time_s = %g must be at least two cycles of cycle_s = %g, or "
                      "a sound sensor could be taken for dead",
                      guard.frozen_time_s, heater.cycle_s));
}

// A simulated heater that is too weak ends every print that is simulated.
void append_model_problems(const std::string& section, const Heater& heater, bool is_tool,
                           const Given& given, Problems& problems) {
    const std::string key = section + ".model";
    if (!given(key)) return;
    const HeatModel& model = heater.model;
    const GuardLimits& guard = heater.guard;
    const double power_w = model.power_w * heater.max_power;
    const double gained_c = power_w / model.capacity_j_k * guard.gain_time_s;
    const double reached_c = usual_room_c + power_w / model.loss_w_k;
    if (gained_c < guard.gain_c)
        problems.emplace_back(
            key, formatted(": %g W warm capacity_j_k = %g by %.2g °C in guard.gain_time_s = %g at "
                           "the most, and guard.gain_c is %g",
                           power_w, model.capacity_j_k, gained_c, guard.gain_time_s, guard.gain_c));
    else if (is_tool && reached_c < heater.min_extrude_c)
        problems.emplace_back(
            key, formatted(": %g W against loss_w_k = %g get to %.0f °C at the most, and "
                           "heater.tool.min_extrude_c is %g",
                           power_w, model.loss_w_k, reached_c, heater.min_extrude_c));
}

}  // namespace

Problems heat_problems(const Printer& printer, const Given& given) {
    Problems problems;
    for (std::size_t i = 0; i < heater_count; ++i) {
        const std::optional<Heater>& heater = printer.heaters[i];
        if (!heater) continue;
        const std::string section = "heater." + std::string(heater_names[i]);
        append_two_ways(section, heater->output, heater->pwm, problems);
        append_sensor_problems(section, *heater, given, problems);
        append_range_problems(section, *heater, i == heater_tool, given, problems);
        append_guard_problems(section, *heater, given, problems);
        append_model_problems(section, *heater, i == heater_tool, given, problems);
    }
    if (const auto& fan = printer.part_fan)
        append_two_ways("fan.part", fan->output, fan->pwm, problems);
    return problems;
}

void append_heat_keys(std::vector<Key>& keys) {
    for (std::size_t n = 0; n < heater_count; ++n) append_heater(keys, n);
    append_output(keys, "fan.part.output",
                  [](Draft& draft) -> std::optional<Pin>& { return fan_of(draft).output; });
    keys.push_back(text("fan.part.pwm",
                        [](Draft& draft, const std::string& value) { fan_of(draft).pwm = value; }));
    keys.push_back(number("fan.part.cycle_s", cycles_s,
                          [](Draft& draft, double value) { fan_of(draft).cycle_s = value; }));
}

}  // namespace lyr::config
