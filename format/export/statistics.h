// What a .lyr file consists of: operations by kind and role, lengths, bytes.
//
// Contract
//  1. Every operation is counted once, and every byte of the file belongs to one kind: the bytes of
//     lines, arcs, circles, hatch lines, travels, wipes, paths, settings, layer heads and the rest
//     add up to `bytes`.
//  2. Lengths are those of the file's paths (arcs along the arc, ramps along the slope), volumes
//     are length x cross-section.

#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "base/diagnostic.h"
#include "format/reader.h"

namespace lyr::format {

struct KindStatistics {
    std::uint64_t count = 0, bytes = 0;
};

struct RoleStatistics {
    std::uint64_t paths = 0, lines = 0, arcs = 0, circles = 0;
    std::uint64_t hatch_lines = 0;  // intervals and links of hatch runs
    double length_mm = 0, volume_mm3 = 0;
    double moving_time_s = 0;  // way over speed

    std::uint64_t motions() const { return lines + arcs + circles + hatch_lines; }
};

struct Statistics {
    FileHeader header;
    std::uint64_t bytes = 0;  // of the file
    std::uint32_t layers = 0;
    double lowest_layer_mm = 0, highest_layer_mm = 0;  // z
    double least_height_mm = 0, most_height_mm = 0;    // thickness
    double hottest_tool_c = 0, hottest_bed_c = 0;
    std::uint64_t chunks = 0, operations = 0;

    std::array<RoleStatistics, role_count> roles{};
    // Hatch lines carry the bytes of the run that they belong to, its travels included. Settings
    // are changes of width, speed and acceleration; the rest is other operations and the file's
    // frame.
    KindStatistics lines, arcs, circles, hatch_lines, travels, paths, settings, layer_heads, rest;
    KindStatistics wipes;  // their pieces
    std::uint64_t hatch_runs = 0, hatch_travels = 0, retractions = 0;

    double travel_mm = 0;      // wipes included
    double moving_time_s = 0;  // way over speed
    double dwell_time_s = 0;
};

// Reads the file to its end. Errors: the reader's.
Result<Statistics> statistics_of(Reader& reader);

// For people: several lines. `name` is the file's.
std::string to_text(const Statistics& statistics, const std::string& name);

}  // namespace lyr::format
