// What the user wants of a print, as plain values: the settings that material profiles and --set state. The table in
// profile/key_table.cpp gives each its key, range and help; docs/profiles.md lists them for users.
//
// Contract
//  1. A Profile{} is what holds where nobody says anything: a 0.4 mm nozzle and PLA.
//  2. A Profile that profile::resolve() gives is within the ranges of docs/profiles.md, its numbers are finite, and no
//     two of its values contradict each other.
//  3. Where 0 means something of its own (no limit, the machine's own), the member's comment says so.
//
// Units are in the names; what has none is a count, a choice or a fraction, 1 being the whole.

#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace lyr::profile {

enum class WallOrder : std::uint8_t { inner, outer };
enum class Seam : std::uint8_t { nearest, rear, aligned, sharp };
enum class Corner : std::uint8_t { round, mitre };
enum class SkinPattern : std::uint8_t { rectilinear, aligned, concentric };
enum class InfillPattern : std::uint8_t {
    rectilinear,
    aligned,
    grid,
    triangles,
    concentric,
    honeycomb,
    gyroid,
    cubic
};
enum class SupportKind : std::uint8_t { none, grid, tree };
enum class AdhesionKind : std::uint8_t { none, skirt, brim, raft };
enum class GcodeFlavor : std::uint8_t { marlin, klipper };
enum class GcodeExtrusion : std::uint8_t { relative, absolute };

struct Nozzle {
    double diameter_mm = 0.4;
    bool operator==(const Nozzle&) const = default;
};

struct Filament {
    std::string material = "PLA";
    double diameter_mm = 1.75;
    double density_g_cm3 = 1.24;             // 0: not stated
    double cost_per_kg = 0;                  // in the user's currency; 0: not stated
    double max_volumetric_speed_mm3_s = 15;  // 0: no limit
    double flow = 1;                         // extrusion multiplier
    bool operator==(const Filament&) const = default;
};

struct Layer {
    double height_mm = 0.2;
    double first_height_mm = 0.2;
    bool adaptive = false;
    // Of adaptive layers: how deep the steps between them may be, and how thin and thick layers.
    double cusp_mm = 0.05;
    double min_height_mm = 0.1;
    double max_height_mm = 0.3;
    bool operator==(const Layer&) const = default;
};

struct Perimeters {
    std::uint32_t count = 3;
    double width_mm = 0.45;
    WallOrder first = WallOrder::inner;
    // How much of the rounded flanks neighbouring lines share: 1 spaces them by width - height (1 - pi/4), which leaves
    // no gap, 0 by their width.
    double overlap = 1;
    bool thin_walls = true;
    bool gap_fill = true;
    double min_width_mm = 0.2;  // of thin walls
    double min_gap_mm = 0.1;    // between walls, to be filled
    double max_width_mm = 0.8;
    Seam seam = Seam::aligned;
    Corner corner = Corner::round;
    bool operator==(const Perimeters&) const = default;
};

struct Skin {
    std::uint32_t top_layers = 5;
    std::uint32_t bottom_layers = 4;
    double width_mm = 0.45;
    SkinPattern pattern = SkinPattern::rectilinear;
    double angle_deg = 45;     // of the first layer's lines; every other layer's lie across
    double min_area_mm2 = 15;  // sparse fill of less is made solid
    bool operator==(const Skin&) const = default;
};

struct Infill {
    double density = 0.15;
    InfillPattern pattern = InfillPattern::grid;
    double width_mm = 0.45;
    double angle_deg = 45;
    double overlap = 0.25;  // with the innermost wall, of the line's width
    bool operator==(const Infill&) const = default;
};

struct Bridge {
    bool walls = true;  // are printed as bridges where they are over air
    double flow = 1;
    double fan = 1;
    bool operator==(const Bridge&) const = default;
};

struct Support {
    SupportKind kind = SupportKind::none;
    double angle_deg = 50;  // from the vertical: what leans out further is supported
    double gap_z_mm = 0.2;
    double gap_xy_mm = 0.4;
    std::uint32_t interface_layers = 2;
    double density = 0.15;
    bool on_bed_only = false;
    std::vector<std::string> blockers;  // names or #ids of faces under which there is no support
    bool operator==(const Support&) const = default;
};

struct Adhesion {
    AdhesionKind kind = AdhesionKind::none;
    std::uint32_t skirt_loops = 1;
    double skirt_distance_mm = 6;
    double brim_width_mm = 5;
    std::uint32_t raft_layers = 3;
    double raft_gap_mm = 0.2;
    bool operator==(const Adhesion&) const = default;
};

struct Speed {
    double outer_wall_mm_s = 50;
    double inner_wall_mm_s = 80;
    double small_mm_s = 25;     // walls shorter than 40 mm
    double gap_fill_mm_s = 30;  // and thin walls
    double solid_infill_mm_s = 100;
    double sparse_infill_mm_s = 120;
    double top_skin_mm_s = 50;
    double bridge_mm_s = 30;
    double support_mm_s = 60;
    double first_layer_mm_s = 20;  // at most, whatever is extruded there
    double travel_mm_s = 150;
    bool operator==(const Speed&) const = default;
};

// Each 0: the machine's own.
struct Acceleration {
    double outer_wall_mm_s2 = 0;
    double inner_wall_mm_s2 = 0;
    double solid_infill_mm_s2 = 0;
    double sparse_infill_mm_s2 = 0;
    double top_skin_mm_s2 = 0;
    double bridge_mm_s2 = 0;
    double support_mm_s2 = 0;
    double first_layer_mm_s2 = 0;
    double travel_mm_s2 = 0;
    bool operator==(const Acceleration&) const = default;
};

struct Travel {
    double retract_length_mm = 0.8;
    double retract_speed_mm_s = 35;
    double unretract_speed_mm_s = 35;
    double retract_min_travel_mm = 2;
    double retract_inside_mm = 30;   // travels that cross nothing; 0: never
    double wipe_mm = 0;              // back along what was just printed; 0: none
    double retract_before_wipe = 0;  // share of a retraction
    double z_hop_mm = 0;
    bool avoid_crossing = true;
    bool operator==(const Travel&) const = default;
};

// Each 0: off.
struct Temperature {
    double nozzle_c = 210;
    double nozzle_first_layer_c = 210;
    double bed_c = 60;
    double bed_first_layer_c = 60;
    double chamber_c = 0;
    bool operator==(const Temperature&) const = default;
};

// A layer that takes ramp_time or longer has the fan at min; the quicker it is, the more, up to max at min_layer_time.
// Quicker ones are slowed down to that time, but not below min_speed.
struct Fan {
    double min = 1;
    double max = 1;
    std::uint32_t off_layers = 1;
    double ramp_time_s = 60;
    double min_layer_time_s = 10;
    double min_speed_mm_s = 15;
    bool operator==(const Fan&) const = default;
};

struct Plate {
    std::uint32_t copies = 1;
    double spacing_mm = 6;
    bool sequential = false;  // one part after the other instead of layer by layer
    // Of the head, around the nozzle, and of the gantry, over it.
    double clearance_radius_mm = 45;
    double clearance_height_mm = 25;
    std::array<double, 2> at_mm{};    // of the lower left corner of the first part's box
    std::array<double, 2> size_mm{};  // 0, 0: not stated
    bool operator==(const Plate&) const = default;
};

struct Slicing {
    double tolerance_mm = 0.005;
    bool operator==(const Slicing&) const = default;
};

// Of a print that is written as G-code; docs/exports.md.
struct Gcode {
    GcodeFlavor flavor = GcodeFlavor::marlin;
    GcodeExtrusion extrusion = GcodeExtrusion::relative;
    std::vector<std::string> start;  // lines before and after the print; empty: the built-in ones
    std::vector<std::string> end;
    bool operator==(const Gcode&) const = default;
};

struct Profile {
    Nozzle nozzle;
    Filament filament;
    Layer layer;
    Perimeters perimeters;
    Skin skin;
    Infill infill;
    Bridge bridge;
    Support support;
    Adhesion adhesion;
    Speed speed;
    Acceleration acceleration;
    Travel travel;
    Temperature temperature;
    Fan fan;
    Plate plate;
    Slicing slicing;
    Gcode gcode;
    bool operator==(const Profile&) const = default;
};

}  // namespace lyr::profile
