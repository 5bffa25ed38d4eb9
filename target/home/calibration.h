// Measures with the probe what a printer's file cannot know: the probe's height, a delta's frame, the bed's heights.
//
// Contract
//  1. calibrate() homes, probes, and gives the printer with what was found. Nothing else of it changes.
//     probe: z must have been homed by an endstop, so that z = 0 is where the nozzle meets the bed; then the probe's
//       offset in z is where it triggers there.
//     delta: 13 places; the mesh is void afterwards and left out.
//     mesh: the grid of mesh.points over mesh.area_mm, by default what the probe reaches.
//  2. calibration_toml() is all that was ever calibrated, as a file that calibration_file names.

#pragma once

#include <string>

#include "target/home/job.h"

namespace lyr::home {

enum class Calibration : std::uint8_t { probe, delta, mesh };
inline constexpr std::array<std::string_view, 3> calibration_names{"probe", "delta", "mesh"};

struct Calibrated {
    config::Printer printer;
    std::string text;  // what was found, for people
    Diagnostics warnings;
};

using ProbeProgress = std::function<void(std::size_t done, std::size_t of)>;

Result<Calibrated> calibrate(const Job& job, Calibration what, const ProbeProgress& progress = {});

std::string calibration_toml(const config::Printer& printer);

}  // namespace lyr::home
