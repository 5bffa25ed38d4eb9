// What printer.toml says about heat: heaters with their sensors, guards and controllers, and the part fan.
//
// Contract
//  1. default_heater() gives what the field trusts for a hotend, a bed and a chamber; a file overrides it
//     key by key.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lyr::config {

// What holds an input that nothing drives.
enum class Pull : std::uint8_t { as_is, up, down, none };

// A line of a GPIO chip.
struct Pin {
    std::string chip;
    std::variant<std::uint32_t, std::string> line;
    bool active_low = false;
    bool open_drain = false;  // of an output
    Pull pull = Pull::as_is;  // of an input
};

// Of Printer::heaters.
enum HeaterNumber : std::size_t { heater_tool = 0, heater_bed = 1, heater_chamber = 2 };
inline constexpr std::size_t heater_count = 3;
inline constexpr std::array<std::string_view, heater_count> heater_names{"tool", "bed", "chamber"};

enum class SensorKind : std::uint8_t {
    epcos_100k,      // EPCOS/TDK B57560G104F
    semitec_104gt2,  // ATC Semitec 104GT-2
    ntc_100k_3950,   // the nameless 100 kOhm thermistor of most kits
    honeywell_100k,  // Honeywell 135-104LAG-J01
    pt1000,          // platinum, IEC 60751
    beta,            // r25_ohm and beta_k
    steinhart_hart,  // three points
    table,           // more points
    celsius,         // the kernel's driver gives the temperature itself
};
inline constexpr std::array<std::string_view, 9> sensor_kinds{
    "epcos_100k", "semitec_104gt2", "ntc_100k_3950", "honeywell_100k", "pt1000",
    "beta",       "steinhart_hart", "table",         "celsius"};

struct ResistancePoint {
    double temperature_c = 0, resistance_ohm = 0;
};

struct Sensor {
    SensorKind kind = SensorKind::ntc_100k_3950;
    std::string file;  // of sysfs; empty: none, which is enough to simulate
    double pullup_ohm = 4'700;
    double full_scale = 4'095;  // what the converter reads at its reference voltage
    double r25_ohm = 100'000, beta_k = 3'950;
    std::vector<ResistancePoint> points;  // in order of temperature
    double celsius_per_unit =
        0.001;  // of a file that holds a temperature; hwmon and 1-wire give m°C
};

// How closely a heater is watched; target/thermal/guard.h says what each figure guards.
struct GuardLimits {
    double low_c = 0, high_c = 275;
    double gain_c = 2, gain_time_s = 20;
    double stray_c = 4, stray_time_s = 40;
    double rate_c_s = 40;
    double frozen_time_s = 20;
};

// A controller overshoots a little, and range_c must not be met by that.
inline constexpr double headroom_c = 5;
// Nor by a heater that is cold.
inline constexpr double usual_room_c = 20;

struct Pid {
    double kp = 0;  // share of full power for 1 °C
    double ki = 0;  // ... for 1 °C over 1 s
    double kd = 0;  // ... for 1 °C/s
};

// Only for the simulator.
struct HeatModel {
    double power_w = 40;
    double capacity_j_k = 12;    // of the block
    double loss_w_k = 0.1;       // to the air around it
    double fan_loss_w_k = 0.05;  // more of that at full part fan
    double lag_s = 2;            // of the sensor
};

struct Heater {
    std::optional<Pin> output;
    std::string pwm;  // folder of a kernel PWM channel, instead of a line
    double cycle_s = 1;
    double max_power = 1;
    Pid pid;
    Sensor sensor;
    GuardLimits guard;
    double min_extrude_c = 170;  // of the tool: below, filament is not pushed
    HeatModel model;
};

Heater default_heater(std::size_t number);

struct Fan {
    std::optional<Pin> output;
    std::string pwm;
    double cycle_s = 1;
};

}  // namespace lyr::config
