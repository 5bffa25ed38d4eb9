// What a G-code file does, one thing after the other, before it is known how a layer begins. Private to this room.

#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "format/operation.h"

namespace lyr::format {

// Of a strand's width and height; a comment that says something else says nothing.
inline constexpr double thinnest_mm = 0.001, thickest_mm = 100;

struct GcodePoint {
    double x = 0, y = 0, z = 0;  // mm
    bool operator==(const GcodePoint&) const = default;
};

// A motion: it extrudes if filament is pushed, wipes if it is drawn back, travels otherwise.
struct GcodeGo {
    GcodePoint from{}, to{};
    double center_x = 0, center_y = 0, sweep_rad = 0;  // of an arc; sweep 0: straight
    double filament_mm = 0;
    double drawn_back_mm = 0;  // behind it
    double speed_mm_s = 0, acceleration_mm_s2 = 0;
    Role role = Role::other;
    double width_mm = 0, height_mm = 0;  // 0: not stated
    std::uint32_t line = 0;              // of the file

    bool extrudes() const { return filament_mm > 0; }
    bool wipes() const { return filament_mm < 0; }
    bool travels() const { return filament_mm == 0; }
};

// The filament is drawn back or pushed forward at a standstill.
struct GcodeDraw {
    double depth_mm = 0, speed_mm_s = 0;
};

// Temperature, Fan, Dwell, Tool, Pause or Object.
using GcodeItem = std::variant<GcodeGo, GcodeDraw, Operation>;

struct GcodeLayer {
    std::vector<GcodeItem> items{};
    GcodePoint begin{};  // where the head is before them
    bool extrudes = false;
    std::optional<double> stated_z_mm{}, stated_height_mm{};
};

}  // namespace lyr::format
