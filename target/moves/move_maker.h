// What operations mean for the machine: moves for the planner, with speeds and filament, and times to
// rest. Holds the state that operations change and nothing else; where they come from, a file or
// memory, is the caller's.
//
// Contract
//  1. Every motion becomes one move; the way to a layer's start becomes two, z first if it rises and
//     last if it sinks. Motions of no length and without filament become none.
//  2. A move's filament is its length times the path's cross-section over that of the filament. Drawing
//     the filament back and forth is a move of the extruder alone, at the layer's retraction speeds. A piece of a wipe
//     is gone along at travel speed, or slower, so that the filament is drawn back no faster than that.
//  3. A move's tag is the layer's number from 1.
//  4. Temperatures, fans, tools and pauses are passed over.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <variant>

#include "format/operation.h"
#include "target/config/printer.h"
#include "target/motion/limits.h"

namespace lyr::moves {

struct Rest {
    double time_s = 0;
};

using Instruction = std::variant<motion::Move, Rest>;

motion::Limits motion_limits(const config::Printer& printer);

// That of the filament that is loaded; 0: neither the printer nor the file states it.
double filament_diameter_mm(const config::Printer& printer, double stated_by_file_mm);

motion::Point position(format::Quantum quantum, const format::Point& point);

// Where a machine is between two operations.
struct Head {
    motion::Point at;
    // How far the filament is drawn back; none: as far as the next layer says (a print begins).
    std::optional<double> drawn_back_mm;
};

Head head_at_start(const config::Printer& printer);

class MoveMaker {
public:
    MoveMaker(const config::Printer& printer, format::Quantum quantum, double filament_diameter_mm,
              const Head& head);

    // What the operation makes the machine do; valid until the next call. `layer` is the state of the
    // layer that it belongs to, `path` the style as of this operation.
    std::span<const Instruction> take(const format::Operation& operation,
                                      const format::LayerState& layer,
                                      const format::PathStyle& path);
    // The same again.
    std::span<const Instruction> made() const { return std::span(made_).first(count_); }

    Head head() const { return {at_, drawn_back_mm_}; }
    // Before the first operation.
    void begin_drawn_back(double mm) { drawn_back_mm_ = mm; }

private:
    motion::Point position(const format::Point& point) const {
        return moves::position(quantum_, point);
    }
    void begin_layer(const format::LayerStart& start, const format::LayerState& state);
    void extrude(motion::Path path, const format::PathStyle& style);
    void travel_to(const motion::Point& to);
    void draw_back(double depth_mm);
    void wipe(const format::Wipe& wipe);
    void append(const motion::Path& path, double speed_mm_s, double acceleration_mm_s2);

    format::Quantum quantum_;
    double filament_area_mm2_;
    double fastest_extruder_mm_s_;
    motion::Point at_;
    std::optional<double> drawn_back_mm_;
    double travel_speed_mm_s_ = 0, travel_acceleration_mm_s2_ = 0;
    double retract_speed_mm_s_ = 0, unretract_speed_mm_s_ = 0;
    std::uint32_t layer_ = 0;          // from 1
    std::array<Instruction, 4> made_;  // one operation makes no more
    std::size_t count_ = 0;
};

}  // namespace lyr::moves
