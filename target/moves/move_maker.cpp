// Each operation appends its instructions to a short list, which take() gives out.

#include "target/moves/move_maker.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "target/moves/machine.h"

namespace lyr::moves {
namespace {

constexpr double ms_per_s = 1e3;

// Only its length is asked for: the filament is not known yet.
constexpr double no_advance = 0;

// 0 in the file leaves it to the machine.
double speed_or(double stated_mm_s, double own_mm_s) {
    return stated_mm_s > 0 ? stated_mm_s : own_mm_s;
}

template <class... Calls>
struct Overloaded : Calls... {
    using Calls::operator()...;
};

}  // namespace

motion::Limits motion_limits(const config::Printer& printer) {
    motion::Limits limits;
    for (std::size_t i = 0; i < limits.axes.size(); ++i)
        limits.axes[i] = {config::held_speed_mm_s(printer, i),
                          printer.axes[i].max_acceleration_mm_s2};
    limits.junction_deviation_mm = printer.junction_deviation_mm;
    limits.jerk_mm_s3 = printer.max_jerk_mm_s3;
    limits.minimum_cruise_ratio = printer.minimum_cruise_ratio;
    if (const auto bed = bed_of(printer)) limits.bed = bed->shape();
    return limits;
}

double filament_diameter_mm(const config::Printer& printer, double stated_by_file_mm) {
    return printer.filament_diameter_mm.value_or(stated_by_file_mm);
}

motion::Point position(format::Quantum quantum, const format::Point& point) {
    return {quantum.mm(point.x), quantum.mm(point.y), quantum.mm(point.z)};
}

Head head_at_start(const config::Printer& printer) {
    return {{printer.start_mm[0], printer.start_mm[1], printer.start_mm[2]}, {}};
}

MoveMaker::MoveMaker(const config::Printer& printer, format::Quantum quantum,
                     double filament_diameter_mm, const Head& head)
    : quantum_(quantum),
      filament_area_mm2_(std::numbers::pi / 4 * filament_diameter_mm * filament_diameter_mm),
      fastest_extruder_mm_s_(printer.axes[config::axis_e].max_speed_mm_s),
      at_(head.at),
      drawn_back_mm_(head.drawn_back_mm) {}

std::span<const Instruction> MoveMaker::take(const format::Operation& operation,
                                             const format::LayerState& layer,
                                             const format::PathStyle& path) {
    count_ = 0;
    const Overloaded calls{
        [&](const format::LayerStart& start) { begin_layer(start, layer); },
        [&](const format::Line& line) {
            extrude(motion::Line{at_, position(line.to), no_advance}, path);
        },
        [&](const format::Arc& arc) {
            const double sagitta_mm = quantum_.mm(arc.sagitta);
            extrude(motion::arc_through(at_, position(arc.to), sagitta_mm, no_advance), path);
        },
        [&](const format::Circle& circle) {
            const double x_mm = quantum_.mm(circle.center_x), y_mm = quantum_.mm(circle.center_y);
            extrude(motion::circle_about(at_, x_mm, y_mm, circle.counter_clockwise,
                                         quantum_.mm(circle.to.z), no_advance),
                    path);
        },
        [&](const format::Travel& travel) { travel_to(position(travel.to)); },
        [&](const format::TravelSpeed& speed) { travel_speed_mm_s_ = speed.speed_mm_s; },
        [&](const format::TravelAcceleration& acceleration) {
            travel_acceleration_mm_s2_ = acceleration.acceleration_mm_s2;
        },
        [&](const format::Retract& retract) { draw_back(retract.depth_mm); },
        [&](const format::Wipe& piece) { wipe(piece); },
        [&](const format::Dwell& dwell) { made_[count_++] = Rest{dwell.time_ms / ms_per_s}; },
        [](const auto&) {}};
    std::visit(calls, operation);
    return made();
}

void MoveMaker::begin_layer(const format::LayerStart& layer, const format::LayerState& state) {
    travel_speed_mm_s_ = state.travel_speed_mm_s;
    travel_acceleration_mm_s2_ = state.travel_acceleration_mm_s2;
    retract_speed_mm_s_ = speed_or(state.retract_speed_mm_s, fastest_extruder_mm_s_);
    unretract_speed_mm_s_ = speed_or(state.unretract_speed_mm_s, retract_speed_mm_s_);
    const motion::Point start = position(layer.start);
    // A head that is still below the layer is not in it yet.
    const bool rises = start.z > at_.z;
    if (!rises || layer_ == 0) layer_ = layer.index + 1;
    draw_back(state.retracted_mm);
    travel_to(rises ? motion::Point{at_.x, at_.y, start.z}
                    : motion::Point{start.x, start.y, at_.z});
    layer_ = layer.index + 1;
    travel_to(start);
}

void MoveMaker::extrude(motion::Path path, const format::PathStyle& style) {
    const double volume_mm3 = motion::length_of(path) * format::cross_section_mm2(style);
    const double feed_mm = volume_mm3 / filament_area_mm2_;
    std::visit([&](auto& shape) { shape.advance_mm = feed_mm; }, path);
    append(path, style.speed_mm_s, style.acceleration_mm_s2);
}

void MoveMaker::travel_to(const motion::Point& to) {
    append(motion::Line{at_, to, no_advance}, travel_speed_mm_s_, travel_acceleration_mm_s2_);
}

void MoveMaker::draw_back(double depth_mm) {
    const double feed_mm = drawn_back_mm_.value_or(depth_mm) - depth_mm;
    drawn_back_mm_ = depth_mm;
    append(motion::Line{at_, at_, feed_mm},
           feed_mm < 0 ? retract_speed_mm_s_ : unretract_speed_mm_s_, 0);
}

void MoveMaker::wipe(const format::Wipe& wipe) {
    motion::Path path =
        motion::arc_through(at_, position(wipe.to), quantum_.mm(wipe.sagitta), no_advance);
    const double length_mm = motion::length_of(path);
    const double before_mm = drawn_back_mm_.value_or(wipe.depth_mm);
    // A further piece would be a quantum long.
    const bool is_last = wipe.left_mm - length_mm < quantum_.mm(1) / 2;
    const double share = is_last ? 1 : length_mm / wipe.left_mm;
    const double feed_mm = share * (before_mm - wipe.depth_mm);
    drawn_back_mm_ = is_last ? wipe.depth_mm : before_mm - feed_mm;
    const double own_mm_s = feed_mm < 0 ? retract_speed_mm_s_ : unretract_speed_mm_s_;
    const double speed_mm_s =
        feed_mm == 0 ? travel_speed_mm_s_
                     : std::min(travel_speed_mm_s_, own_mm_s * length_mm / std::abs(feed_mm));
    std::visit([&](auto& shape) { shape.advance_mm = feed_mm; }, path);
    append(path, speed_mm_s, travel_acceleration_mm_s2_);
}

void MoveMaker::append(const motion::Path& path, double speed_mm_s, double acceleration_mm_s2) {
    at_ = motion::end_of(path);
    if (motion::length_of(path) > 0)
        made_[count_++] = motion::Move{path, speed_mm_s, acceleration_mm_s2, layer_};
}

}  // namespace lyr::moves
