// What printer.toml says about finding the machine's place: endstops, the probe, the height map of the bed, and what the
// simulator takes for the truth about all of them.
//
// Contract
//  1. Heights of a mesh come with an area and points that fit them.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "target/config/heater.h"

namespace lyr::config {

// What can touch: the endstops of x, y and z (of a delta's towers), and the probe.
enum ContactNumber : std::size_t { contact_probe = 3 };
inline constexpr std::size_t contact_count = 4;
inline constexpr std::array<std::string_view, contact_count> contact_names{"x", "y", "z", "probe"};

// Of one axis; on a delta of one tower.
struct Endstop {
    std::optional<Pin> input;
    bool at_high_end = false;
    // Where the axis is when it triggers; none: that end of its range. On a delta the height of the head if all
    // carriages stood as high.
    std::optional<double> at_mm;
    double fast_mm_s = 20, slow_mm_s = 2;
    double back_off_mm = 3;
};

struct Homing {
    std::array<std::size_t, 3> order{0, 1, 2};  // of axes
    double lift_mm = 5;                         // of z before anything else moves
    double margin_mm = 10;       // beyond the axis's length, until an endstop is taken for dead
    double tolerance_mm = 0.05;  // between two approaches
    double settle_ms = 2;        // a contact must last so long
    bool before_print = true;
};

struct Probe {
    std::optional<Pin> input;
    std::array<double, 3> offset_mm{};  // from the nozzle; z: the nozzle's height when it triggers
    std::optional<std::array<double, 2>>
        home_mm{};  // where the probe homes z; none: the middle of the bed
    double fast_mm_s = 5, slow_mm_s = 1;
    double lift_mm = 5;          // over the bed between two places
    int samples = 2;             // slow approaches at a place
    double tolerance_mm = 0.02;  // between them
    double reach_mm = 10;        // below the bed, until it is taken for dead
};

struct BedMesh {
    std::array<double, 4> area_mm{};  // x and y of the first corner, x and y of the opposite one
    bool has_area = false;
    std::array<int, 2> points{5, 5};  // along x and y
    double fade_mm = 0;               // where nothing is left of it; 0: never
    std::vector<std::vector<double>>
        heights_mm{};  // rows along x, the first at the lowest y; empty: flat
};

// What is true of a simulated machine and not known to the program.
struct SimulatedMachine {
    struct Bump {
        double x_mm = 0, y_mm = 0, height_mm = 0, radius_mm = 0;
    };
    std::optional<std::array<double, 3>> head_mm;  // when the machine is switched on
    double bed_mm = 0;
    std::array<double, 2> bed_tilt{};  // mm of height for each mm of x and of y
    std::vector<Bump> bumps;
    double probe_noise_mm = 0;  // the probe's contact is off by up to so much
    // Of a delta: by how much the towers are not as the file says.
    std::array<double, 3> arm_error_mm{}, radius_error_mm{}, angle_error_deg{}, endstop_error_mm{};
};

}  // namespace lyr::config
