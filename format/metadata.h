// What a .lyr file says about itself, in front of its layers.
//
// Contract
//  1. Metadata is what the slicer states, Summary what the writer counted. Both are in the file's
//     first block as lines of UTF-8 text, `key=value`; unknown keys are kept in `extra`, in order.
//     The configuration and the thumbnails are blocks of their own.
//  2. No time of day and no machine name is stored: the same print gives the same bytes.

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace lyr::format {

struct Thumbnail {
    std::uint32_t width = 0, height = 0;  // pixels
    std::vector<std::byte> png;
};

struct Metadata {
    std::string generator;      // program and version
    std::string source_name;    // file name of the model, without folder
    std::string source_sha256;  // of the model file, 64 hexadecimal digits; empty: not known
    std::string printer, material, profile;
    double tolerance_mm = 0;  // 0: not stated
    double filament_diameter_mm = 1.75;
    double filament_density_g_cm3 = 0;  // 0: not stated
    std::vector<std::string> objects;   // names of objects 1, 2, ...
    std::vector<std::pair<std::string, std::string>> extra;
    std::string configuration;  // the full resolved configuration, verbatim
    std::vector<Thumbnail> thumbnails;
};

struct Summary {
    std::uint32_t layers = 0;
    // Box of all motions (not of the part), mm. Empty file: all 0.
    double low_x_mm = 0, low_y_mm = 0, low_z_mm = 0, high_x_mm = 0, high_y_mm = 0, high_z_mm = 0;
    double volume_mm3 = 0;        // extruded
    double filament_mm = 0;       // volume over the filament's cross-section
    double mass_g = 0;            // 0: density not stated
    double estimated_time_s = 0;  // 0: a layer was not estimated
};

}  // namespace lyr::format
