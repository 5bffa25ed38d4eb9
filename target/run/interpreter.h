// What a file's operations mean for the machine: moves for the planner, with speeds and filament, and
// times to rest. Holds the state that operations change and nothing else.
//
// Contract
//  1. Every motion of the file becomes one move; the way to a layer's start becomes two, z first if it
//     rises and last if it sinks. Motions of no length and without filament become none.
//  2. A move's filament is its length times the path's cross-section over that of the filament. Drawing
//     the filament back and forth is a move of the extruder alone, at the layer's retraction speeds.
//  3. A move's tag is the layer's number from 1.
//  4. Temperatures, fans, tools and pauses are passed over; whether that is allowed has been decided
//     before (check_demands).

#pragma once

#include <array>
#include <optional>
#include <variant>

#include "format/reader.h"
#include "target/config/printer.h"
#include "target/motion/limits.h"

namespace lyr::run {

struct Rest {
    double time_s = 0;
};

using Instruction = std::variant<motion::Move, Rest>;

motion::Limits motion_limits(const config::Printer& printer);

class Interpreter {
public:
    Interpreter(format::Reader reader, const config::Printer& printer, double filament_diameter_mm);

    // The next instruction, or none at the end of the file.
    Result<std::optional<Instruction>> next();

private:
    void visit(const format::LayerStart& layer);
    void visit(const format::Line& line);
    void visit(const format::Arc& arc);
    void visit(const format::Circle& circle);
    void visit(const format::Travel& travel);
    void visit(const format::TravelSpeed& speed);
    void visit(const format::TravelAcceleration& acceleration);
    void visit(const format::Retract& retract);
    void visit(const format::Dwell& dwell);
    template <class Other>
    void visit(const Other&) {}

    motion::Point position(const format::Point& point) const;
    double advance_mm(const motion::Path& path) const;
    void extrude(motion::Path path);
    void travel_to(const motion::Point& to);
    void draw_back(double depth_mm);
    void append(const motion::Path& path, double speed_mm_s, double acceleration_mm_s2);

    format::Reader reader_;
    format::Quantum quantum_;
    double filament_area_mm2_;
    double fastest_extruder_mm_s_;
    motion::Point at_;
    double drawn_back_mm_ = 0;
    double travel_speed_mm_s_ = 0, travel_acceleration_mm_s2_ = 0;
    double retract_speed_mm_s_ = 0, unretract_speed_mm_s_ = 0;
    std::uint32_t layer_ = 0;             // from 1
    std::array<Instruction, 4> waiting_;  // one operation makes no more
    std::size_t waiting_from_ = 0, waiting_to_ = 0;
};

}  // namespace lyr::run
