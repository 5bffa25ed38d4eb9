// What printer.toml says about the machine: its axes, their limits and their lines. The page
// docs/configuration.md explains every key to users.
//
// Contract
//  1. What a Printer holds is within the ranges that docs/configuration.md states, whatever file it
//     came from; numbers are finite. No step pulse at full speed is shorter than the driver needs.
//  2. A key that is not known, stands twice, has the wrong type or is out of range is an error (status
//     input) with file, line and column; an unknown key comes with the nearest known one. Of several
//     errors the first in the file is given.
//  3. A file must say of each axis what no machine shares with another: steps_per_mm, max_speed_mm_s,
//     max_acceleration_mm_s2 and, but for the extruder, range_mm. All else has a default.
//  4. No two lines of a Printer are the same line of the same chip.
//  5. known_keys() lists every key that a file may have, "axis.*." standing for each axis.
//  6. No input makes it crash.
//  7. A file that calibration_file names has some of the same keys (is_calibration_key()), which stand above those of the
//     printer's file; it need not be there yet. A name without a slash is one beside the printer's file.
//  8. A delta's arms reach the whole of its reach_mm, at flattest_arm_share of their length at the most, and
//     its start lies within.
//  9. held_speed_mm_s() of all axes together asks no motor for more than held_steps_per_s().
// 10. No key of a file is one that nothing looks at, and none contradicts another as docs/configuration.md says.

#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/diagnostic.h"
#include "target/config/heater.h"
#include "target/config/homing.h"
#include "target/config/life.h"

namespace lyr::config {

enum class Kinematics : std::uint8_t { cartesian, corexy, delta };

// Of Printer::axes.
enum AxisNumber : std::size_t { axis_x = 0, axis_y = 1, axis_z = 2, axis_e = 3 };
inline constexpr std::size_t axis_count = 4;
inline constexpr std::array<std::string_view, axis_count> axis_names{"x", "y", "z", "e"};

struct Axis {
    double steps_per_mm = 0;  // microsteps, as the driver counts them
    double max_speed_mm_s = 0;
    double max_acceleration_mm_s2 = 0;
    double min_mm = 0, max_mm = 0;  // where the axis may go; not used for the extruder
    bool invert = false;            // the motor is wired the other way round
    std::optional<Pin> step, direction, enable;
};

// What the motor drivers need between edges.
struct PulseTiming {
    std::int64_t high_ns = 2'000;
    std::int64_t low_ns = 2'000;
    std::int64_t direction_setup_ns = 1'000;  // direction steady before the step's rising edge
    std::int64_t direction_hold_ns = 1'000;   // and after it
    std::int64_t late_limit_ns = 5'000'000;   // an edge later than this ends the print
};

// How well this board keeps time, as `lyrrun --measure-latency` finds.
struct BoardTiming {
    std::optional<std::int64_t> late_ns;  // of one edge in 10,000; none: not measured
    std::int64_t write_ns = 2'000;        // what one write of lines takes
    std::optional<unsigned> cpu;          // that writes the lines; none: any
    bool is_given = false;                // the printer's file has a [timing]
};

// An arm this much of whose length lies level is 10 degrees from flat; beyond, it pulls rather than lifts.
inline constexpr double flattest_arm_share = 0.985;

// Of a delta: three towers about the middle of the bed.
struct DeltaFrame {
    std::array<double, 3> arm_mm{}, radius_mm{};
    std::array<double, 3> tower_angle_deg{210, 330, 90};
    double reach_mm = 0;  // how far from the middle the head may go
};

enum class ShaperKind : std::uint8_t { none, zv, mzv, ei };

struct InputShaper {
    ShaperKind kind = ShaperKind::none;
    double frequency_hz = 0;
    double damping = 0.1;
};

struct Printer {
    std::string name;
    Kinematics kinematics = Kinematics::cartesian;
    DeltaFrame delta;
    std::array<InputShaper, 3> shapers;  // of x, y and z
    double pressure_advance_s = 0, pressure_smooth_s = 0.04;
    double max_jerk_mm_s3 = 0;  // 0: no limit
    double minimum_cruise_ratio = 0;
    std::array<double, 3> backlash_mm{};  // of the motors of x, y and z
    double junction_deviation_mm = 0.02;
    std::array<double, 3> start_mm{};            // where the head stands when a print begins
    std::optional<double> filament_diameter_mm;  // none: as the file says
    PulseTiming pulse;
    BoardTiming timing;
    std::array<Axis, axis_count> axes;
    std::array<std::optional<Heater>, heater_count> heaters;
    std::optional<Fan> part_fan;
    std::array<Endstop, 3> endstops;  // of x, y and z, or of a delta's towers
    Homing homing;
    std::optional<Probe> probe;
    BedMesh mesh;
    SimulatedMachine simulated;
    std::string calibration_file;  // empty: none
    // What the file says by itself, and which keys of the calibration stand above it.
    std::shared_ptr<const Printer> uncalibrated{};
    std::vector<std::string> calibrated{};
    Inputs inputs;
    PauseSettings pause;
    FilamentSettings filament;
    std::string recovery_folder;  // of the journals of prints; empty: beside each print
    WatchdogSettings watchdog;
};

// A middling Cartesian printer without lines and with room for any part, to simulate without a file.
Printer generic_printer();

// "-" is standard input.
Result<Printer> read_printer(const std::string& path);
// `file` names the text in messages.
Result<Printer> parse_printer(std::string_view text, const std::string& file);

std::vector<std::string> known_keys();

// What may be in a calibration file.
bool is_calibration_key(std::string_view path);

// Every line of the printer, with the key that names it.
std::vector<std::pair<std::string, Pin>> used_lines(const Printer& printer);
// Of its PWM channels, the folders, without a slash at the end, and of its heaters' sensors.
std::vector<std::pair<std::string, std::string>> used_files(const Printer& printer);

// Whether the head can stand where the printer's probe is over the place.
bool probe_reaches(const Printer& printer, double x_mm, double y_mm);

// The fastest that the motor of an axis ever moves, in mm of its steps_per_mm: a belt of a CoreXY follows
// two axes, a carriage of a delta is fastest where its arm is flattest.
double fastest_motor_mm_s(const Printer& printer, std::size_t motor);

// How often every motor can step, all at the same time, if a step that is as late as the board is now and then shall
// not delay the next one. Infinite where nothing was measured.
double held_steps_per_s(const Printer& printer);
// The axis's max_speed_mm_s, or less if its motors, with all axes at full speed, would step more often than that.
double held_speed_mm_s(const Printer& printer, std::size_t axis);

}  // namespace lyr::config
