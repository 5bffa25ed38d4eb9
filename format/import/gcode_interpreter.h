// The firmware's part: modes, offsets, units and positions, from which lines become items. Private to this room;
// gcode_import.h has the contract.

#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "format/import/gcode_facts.h"
#include "format/import/gcode_items.h"
#include "format/import/gcode_line.h"

namespace lyr::format {

class GcodeInterpreter {
public:
    GcodeInterpreter(const std::string& name, const GcodeFacts& facts)
        : name_(name), facts_(facts) {}

    // Appends to layer(). Errors (status input): the line is none.
    Status take(std::string_view line, std::uint32_t number);
    // Whether the line that comes next begins a layer. The layer so far is then taken by the caller.
    bool begins_layer(std::string_view line) const;
    GcodeLayer& layer() { return layer_; }
    GcodeLayer take_layer();
    // The same, where what came before goes on.
    void begin_layer() { height_is_layers_ = true; }

    // Whether anything has been extruded by a motion.
    bool extrudes() const { return extrudes_; }
    // What was passed over, when all is read.
    void report(Diagnostics& diagnostics) const;

private:
    struct Unknown {
        std::string command;
        std::uint32_t line = 0, count = 0;
    };
    enum Axis { x_axis, y_axis, z_axis, e_axis };

    Diagnostic error(const std::string& message) const;
    void take_comment(std::string_view comment);
    void take_height(std::string_view value);
    Status command(const GcodeLine& line);
    Status set_factor(const std::string& command, const GcodeWords& words);
    // False: not known.
    bool set_mode(const std::string& command);
    bool set_machine(const GcodeLine& line, const GcodeWords& words);
    bool heat(const std::string& command, const GcodeWords& words);
    Status move(const GcodeWords& words);
    Status turn(const GcodeWords& words, bool counter_clockwise);
    void go(GcodeGo go, const GcodeWords& words);
    void draw(double filament_mm);
    void push_aside(double filament_mm);
    void set_position(const GcodeWords& words);
    void home(const GcodeWords& words);
    void take_speed(const GcodeWords& words);
    GcodePoint target(const GcodeWords& words) const;
    double filament(const GcodeWords& words);
    void add_object(std::string_view name);
    void take_object_number(std::string_view rest);
    void append(const Operation& operation) { layer_.items.emplace_back(operation); }
    void unknown(const std::string& command);
    bool joins(const GcodeGo& half);

    const std::string& name_;
    const GcodeFacts& facts_;
    GcodeLayer layer_{};
    std::uint32_t line_ = 0;
    bool extrudes_ = false;

    GcodePoint at_{}, offset_{};  // physical; what is written is at_ + offset_
    double unit_mm_ = 1;
    bool absolute_ = true, absolute_filament_ = true;
    double filament_ = 0;  // E as the file counts it, mm
    double drawn_back_mm_ = 0, speed_mm_s_ = 0;
    double speed_ = 1, kept_speed_ = 1;  // M220
    // M221, by tool; Klipper's is one for all.
    std::vector<double> flows_ = std::vector<double>(256, 1.0);
    std::uint32_t tool_ = 0;
    double print_mm_s2_ = 0, travel_mm_s2_ = 0;
    double firmware_depth_mm_ = 0, firmware_mm_s_ = 0;
    Role role_ = Role::other;
    double width_mm_ = 0, height_mm_ = 0;
    bool height_is_layers_ = false;

    std::vector<Unknown> unknown_{};
    double pushed_aside_mm_ = 0;
    std::uint32_t pushed_aside_line_ = 0, pushed_aside_count_ = 0;
};

}  // namespace lyr::format
