// What a sensor can measure follows from its kind, its points, or the driver that its file belongs to.

#include "target/config/sensor_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/text.h"
#include "target/config/thermistor.h"

namespace lyr::config {
namespace {

using enum SensorKind;

// Of the data sheets: beyond, the glass or the solder goes.
constexpr double thermistor_end_c = 300, platinum_end_c = 600;
// Where the digits of a DS18B20 and its relatives end.
constexpr double one_wire_end_c = 125;
// So far beyond the last point a curve through the two nearest is a few degrees off.
constexpr double beyond_points_c = 50;

// Keys that only some kinds of sensor look at.
void append_kind_problems(const std::string& section, const Sensor& sensor, const Given& given,
                          Problems& problems) {
    struct Owner {
        const char* key;
        SensorKind kind, or_kind;
        const char* names;
    };
    constexpr std::array<Owner, 4> owners{
        {{".sensor.r25_ohm", beta, beta, "\"beta\""},
         {".sensor.beta_k", beta, beta, "\"beta\""},
         {".sensor.points", steinhart_hart, table, "\"steinhart_hart\" or \"table\""},
         {".sensor.celsius_per_unit", celsius, celsius, "\"celsius\""}}};
    for (const Owner& owner : owners)
        if (given(section + owner.key) && sensor.kind != owner.kind && sensor.kind != owner.or_kind)
            problems.emplace_back(section + owner.key,
                                  ": only for " + section + ".sensor.kind = " + owner.names);
    for (const char* key : {".sensor.pullup_ohm", ".sensor.full_scale"})
        if (given(section + key) && sensor.kind == celsius)
            problems.emplace_back(section + key, ": not for " + section +
                                                     ".sensor.kind = \"celsius\", whose driver "
                                                     "states the temperature itself");
}

// Whether the points are as many as the kind needs.
bool check_points(const std::string& section, const Sensor& sensor, Problems& problems) {
    const std::string key = section + ".sensor.points";
    if (sensor.kind == steinhart_hart && sensor.points.size() != 3)
        problems.emplace_back(key, formatted(": a steinhart_hart sensor needs 3 points, found %zu",
                                             sensor.points.size()));
    else if (sensor.kind == table && sensor.points.size() < 2)
        problems.emplace_back(key, ": a table needs at least 2 points");
    else
        return true;
    return false;
}

// What the kernel's drivers call their files.
struct SensorFile {
    bool is_one_wire = false;
    bool is_temperature = false;
    bool is_counts = false;
};

SensorFile file_of(const std::string& path) {
    const auto has = [&](const char* part) { return path.find(part) != std::string::npos; };
    const std::string name = path.substr(path.rfind('/') + 1);
    SensorFile file;
    // The families of the digital thermometers; others behind the same bus end elsewhere.
    file.is_one_wire = has("/w1/") && (has("/10-") || has("/22-") || has("/28-") || has("/42-"));
    file.is_temperature = path.starts_with("/sys/") && name.find("temp") != std::string::npos;
    file.is_counts = name.ends_with("_raw");
    return file;
}

void append_file_problems(const std::string& section, const Sensor& sensor, const Given& given,
                          Problems& problems) {
    const SensorFile file = file_of(sensor.file);
    if (sensor.kind != celsius && file.is_temperature)
        problems.emplace_back(
            section + ".sensor.file",
            ": this file holds a temperature: it needs " + section + ".sensor.kind = \"celsius\"");
    if (sensor.kind == celsius && file.is_counts && !given(section + ".sensor.celsius_per_unit"))
        problems.emplace_back(
            section + ".sensor.file",
            ": this file holds counts: it needs " + section +
                ".sensor.celsius_per_unit, which is 0.25 for a MAX31855 or MAX6675");
}

// Where the sensor itself ends, and why; none: nobody knows.
struct End {
    double at_c = 0;
    std::string why;
};

std::optional<End> end_of(const Sensor& sensor) {
    switch (sensor.kind) {
        case epcos_100k:
        case semitec_104gt2:
        case ntc_100k_3950:
        case honeywell_100k:
            return End{thermistor_end_c,
                       formatted("a thermistor lasts to %g °C", thermistor_end_c)};
        case pt1000:
            return End{platinum_end_c, formatted("a pt1000 lasts to %g °C", platinum_end_c)};
        case steinhart_hart:
        case table: {
            const double last_c = sensor.points.back().temperature_c;
            return End{last_c + beyond_points_c,
                       formatted("sensor.points end at %g °C, and more than %g beyond them the "
                                 "curve is a guess",
                                 last_c, beyond_points_c)};
        }
        case celsius:
            if (!file_of(sensor.file).is_one_wire) return std::nullopt;
            // Nothing would tell that it is hotter.
            return End{one_wire_end_c - headroom_c,
                       formatted("a 1-wire thermometer counts to %g °C and could not tell %g more",
                                 one_wire_end_c, headroom_c)};
        case beta:
            break;
    }
    return std::nullopt;
}

void append_range_problems(const std::string& section, const Heater& heater, Problems& problems) {
    const double highest_c = heater.guard.high_c - headroom_c;
    const Sensor& sensor = heater.sensor;
    if (const std::optional<End> end = end_of(sensor); end && highest_c > end->at_c)
        problems.emplace_back(section + ".range_c",
                              formatted(": it lets the heater get to %g °C, and ", highest_c) +
                                  end->why +
                                  formatted("; it may end at %g", end->at_c + headroom_c));
    const bool has_points = sensor.kind == steinhart_hart || sensor.kind == table;
    if (has_points && sensor.points.front().temperature_c > usual_room_c + beyond_points_c)
        problems.emplace_back(
            section + ".sensor.points",
            formatted(": a cold heater has %g °C, and they begin at %g; more than %g before them "
                      "the curve is a guess",
                      usual_room_c, sensor.points.front().temperature_c, beyond_points_c));
}

// Of a resistor in its divider.
void append_divider_problems(const std::string& section, const Heater& heater, const Given& given,
                             Problems& problems) {
    const Sensor& sensor = heater.sensor;
    if (sensor.kind == celsius) return;
    const Resistor resistor = resistor_of(sensor);
    const auto share_at = [&](double at_c) {
        return share_of(resistance_ohm(resistor, at_c), sensor.pullup_ohm);
    };
    const auto key_or_kind = [&](const char* key) {
        return section + ".sensor." + (given(section + ".sensor." + key) ? key : "kind");
    };
    const double high_c = heater.guard.high_c, highest_c = high_c - headroom_c;
    for (const double at_c : {usual_room_c, high_c}) {
        const double share = share_at(at_c);
        if (share > shorted_share && share < open_share) continue;
        if (std::isfinite(share))
            problems.emplace_back(
                key_or_kind("pullup_ohm"),
                formatted(
                    ": at %g °C the sensor has %.3g Ohm, and under pullup_ohm = %g that reads "
                    "as %s",
                    at_c, resistance_ohm(resistor, at_c), sensor.pullup_ohm,
                    share < open_share ? "a short circuit" : "a broken wire"));
        else
            problems.emplace_back(
                section + ".sensor.points",
                formatted(": the curve through them has no resistance for %g °C", at_c));
        return;
    }
    const double counts_per_c =
        std::abs(share_at(highest_c) - share_at(highest_c - 1)) * sensor.full_scale;
    if (counts_per_c * heater.guard.stray_c >= 1) return;
    problems.emplace_back(
        key_or_kind(given(section + ".sensor.full_scale") ? "full_scale" : "pullup_ohm"),
        formatted(": at %g °C one count of the converter is %.1f °C, and guard.stray_c is %g: it "
                  "takes a smaller pullup_ohm, or a converter with more counts",
                  highest_c, 1 / counts_per_c, heater.guard.stray_c));
}

}  // namespace

void append_sensor_problems(const std::string& section, const Heater& heater, const Given& given,
                            Problems& problems) {
    append_kind_problems(section, heater.sensor, given, problems);
    append_file_problems(section, heater.sensor, given, problems);
    if (!check_points(section, heater.sensor, problems)) return;
    append_range_problems(section, heater, problems);
    append_divider_problems(section, heater, given, problems);
}

}  // namespace lyr::config
