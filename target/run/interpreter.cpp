// Each operation appends its instructions to a short queue, which next() hands out.

#include "target/run/interpreter.h"

#include <cmath>
#include <numbers>

namespace lyr::run {
namespace {

constexpr double ms_per_s = 1e3;

// Only its length is asked for: the filament is not known yet.
constexpr double no_advance = 0;

// 0 in the file leaves it to the machine.
double speed_or(double stated_mm_s, double own_mm_s) {
    return stated_mm_s > 0 ? stated_mm_s : own_mm_s;
}

}  // namespace

motion::Limits motion_limits(const config::Printer& printer) {
    motion::Limits limits;
    for (std::size_t i = 0; i < limits.axes.size(); ++i)
        limits.axes[i] = {printer.axes[i].max_speed_mm_s, printer.axes[i].max_acceleration_mm_s2};
    limits.junction_deviation_mm = printer.junction_deviation_mm;
    return limits;
}

Interpreter::Interpreter(format::Reader reader, const config::Printer& printer,
                         double filament_diameter_mm)
    : reader_(std::move(reader)),
      quantum_(reader_.header().quantum),
      filament_area_mm2_(std::numbers::pi / 4 * filament_diameter_mm * filament_diameter_mm),
      fastest_extruder_mm_s_(printer.axes[config::axis_e].max_speed_mm_s),
      at_{printer.start_mm[0], printer.start_mm[1], printer.start_mm[2]} {}

Result<std::optional<Instruction>> Interpreter::next() {
    while (waiting_from_ == waiting_to_) {
        waiting_from_ = waiting_to_ = 0;
        const Result<std::optional<format::Operation>> operation = reader_.next();
        if (!operation) return operation.error();
        if (!*operation) return std::optional<Instruction>();
        std::visit([this](const auto& what) { visit(what); }, **operation);
    }
    return std::optional(waiting_[waiting_from_++]);
}

void Interpreter::visit(const format::LayerStart& layer) {
    const format::LayerState& state = reader_.layer().state;
    travel_speed_mm_s_ = state.travel_speed_mm_s;
    travel_acceleration_mm_s2_ = state.travel_acceleration_mm_s2;
    retract_speed_mm_s_ = speed_or(state.retract_speed_mm_s, fastest_extruder_mm_s_);
    unretract_speed_mm_s_ = speed_or(state.unretract_speed_mm_s, retract_speed_mm_s_);
    // Where the print begins, the filament is taken to be where the file says.
    if (layer_ == 0) drawn_back_mm_ = state.retracted_mm;
    layer_ = layer.index + 1;
    draw_back(state.retracted_mm);
    const motion::Point start = position(layer.start);
    if (start.z > at_.z)
        travel_to({at_.x, at_.y, start.z});
    else
        travel_to({start.x, start.y, at_.z});
    travel_to(start);
}

void Interpreter::visit(const format::Line& line) {
    extrude(motion::Line{at_, position(line.to), no_advance});
}

void Interpreter::visit(const format::Arc& arc) {
    const double sagitta_mm = quantum_.mm(arc.sagitta);
    extrude(motion::arc_through(at_, position(arc.to), sagitta_mm, no_advance));
}

void Interpreter::visit(const format::Circle& circle) {
    extrude(motion::circle_about(at_, quantum_.mm(circle.center_x), quantum_.mm(circle.center_y),
                                 circle.counter_clockwise, quantum_.mm(circle.to.z), no_advance));
}

void Interpreter::visit(const format::Travel& travel) {
    travel_to(position(travel.to));
}

void Interpreter::visit(const format::TravelSpeed& speed) {
    travel_speed_mm_s_ = speed.speed_mm_s;
}

void Interpreter::visit(const format::TravelAcceleration& acceleration) {
    travel_acceleration_mm_s2_ = acceleration.acceleration_mm_s2;
}

void Interpreter::visit(const format::Retract& retract) {
    draw_back(retract.depth_mm);
}

void Interpreter::visit(const format::Dwell& dwell) {
    waiting_[waiting_to_++] = Rest{dwell.time_ms / ms_per_s};
}

motion::Point Interpreter::position(const format::Point& point) const {
    return {quantum_.mm(point.x), quantum_.mm(point.y), quantum_.mm(point.z)};
}

double Interpreter::advance_mm(const motion::Path& path) const {
    const double volume_mm3 = motion::length_of(path) * format::cross_section_mm2(reader_.path());
    return volume_mm3 / filament_area_mm2_;
}

void Interpreter::extrude(motion::Path path) {
    const double feed_mm = advance_mm(path);
    std::visit([&](auto& shape) { shape.advance_mm = feed_mm; }, path);
    append(path, reader_.path().speed_mm_s, reader_.path().acceleration_mm_s2);
}

void Interpreter::travel_to(const motion::Point& to) {
    append(motion::Line{at_, to, no_advance}, travel_speed_mm_s_, travel_acceleration_mm_s2_);
}

void Interpreter::draw_back(double depth_mm) {
    const double feed_mm = drawn_back_mm_ - depth_mm;
    drawn_back_mm_ = depth_mm;
    append(motion::Line{at_, at_, feed_mm},
           feed_mm < 0 ? retract_speed_mm_s_ : unretract_speed_mm_s_, 0);
}

void Interpreter::append(const motion::Path& path, double speed_mm_s, double acceleration_mm_s2) {
    at_ = motion::end_of(path);
    if (motion::length_of(path) > 0)
        waiting_[waiting_to_++] = motion::Move{path, speed_mm_s, acceleration_mm_s2, layer_};
}

}  // namespace lyr::run
