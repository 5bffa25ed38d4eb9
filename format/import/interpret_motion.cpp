// Positions are those of the machine: G92 only moves what is written against them.

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/text.h"
#include "format/import/gcode_interpreter.h"

namespace lyr::format {
namespace {

constexpr double s_per_min = 60;
// A depth less than this is rounding: filament is counted in 0.00001 mm, depths in 0.001.
constexpr double least_depth_mm = 0.0005;
// No machine is larger (docs/configuration.md), and no coordinate of the format.
constexpr double farthest_mm = 10'000;
// Between the halves of one circle: what I and J are rounded by.
constexpr double same_center_mm = 0.0005;
// Between the radii of an arc's ends. Three digits leave 0.003 mm, two of some programs 0.03; ArcWelder fits within 0.05.
constexpr double same_radius_mm = 0.05;

}  // namespace

GcodePoint GcodeInterpreter::target(const GcodeWords& words) const {
    const auto axis = [&](char letter, double at, double offset) {
        if (!words[letter]) return at;
        return absolute_ ? *words[letter] * unit_mm_ - offset : at + *words[letter] * unit_mm_;
    };
    return {axis('X', at_.x, offset_.x), axis('Y', at_.y, offset_.y), axis('Z', at_.z, offset_.z)};
}

double GcodeInterpreter::filament(const GcodeWords& words) {
    if (!words['E']) return 0;
    const double value = *words['E'] * unit_mm_;
    const double pushed = absolute_filament_ ? value - filament_ : value;
    filament_ = absolute_filament_ ? value : filament_ + value;
    return pushed * flows_[tool_];
}

void GcodeInterpreter::take_speed(const GcodeWords& words) {
    if (words['F'] && *words['F'] > 0) speed_mm_s_ = *words['F'] * unit_mm_ / s_per_min;
}

Status GcodeInterpreter::move(const GcodeWords& words) {
    take_speed(words);
    const GcodePoint to = target(words);
    for (const double value : {to.x, to.y, to.z})
        if (!(std::abs(value) <= farthest_mm)) return error("a position of more than 10 m");
    if (to == at_)
        draw(filament(words));
    else
        go({.from = at_, .to = to}, words);
    return Done{};
}

Status GcodeInterpreter::turn(const GcodeWords& words, bool counter_clockwise) {
    if (words['P'].value_or(0) != 0) return error("an arc of several turns (P)");
    take_speed(words);
    GcodeGo arc{.from = at_, .to = target(words)};
    const double dx = arc.to.x - at_.x, dy = arc.to.y - at_.y, chord = std::hypot(dx, dy);
    double i = words['I'].value_or(0) * unit_mm_, j = words['J'].value_or(0) * unit_mm_;
    if (words['R']) {
        const double radius = *words['R'] * unit_mm_;
        if (!(chord > 0)) return error("a circle needs I or J, not R");
        if (std::abs(radius) < chord / 2 * (1 - 1e-6))
            return error("an arc's ends are farther apart than twice its radius");
        const double rise = std::sqrt(std::max(0.0, radius * radius - chord * chord / 4));
        // The shorter way round if R is positive.
        const double side = (radius > 0) == counter_clockwise ? 1 : -1;
        i = dx / 2 - side * rise * dy / chord;
        j = dy / 2 + side * rise * dx / chord;
    }
    if (i == 0 && j == 0) return error("an arc needs I, J or R");
    arc.center_x = at_.x + i;
    arc.center_y = at_.y + j;
    const double end_radius_mm = std::hypot(arc.to.x - arc.center_x, arc.to.y - arc.center_y);
    if (std::abs(std::hypot(i, j) - end_radius_mm) > same_radius_mm)
        return error("an arc's ends are " +
                     formatted("%.3f and %.3f", std::hypot(i, j), end_radius_mm) +
                     " mm from its centre");
    for (const double value : {arc.to.x, arc.to.y, arc.to.z, arc.center_x, arc.center_y})
        if (!(std::abs(value) <= farthest_mm)) return error("a position of more than 10 m");
    const double begin = std::atan2(-j, -i);
    const double end = std::atan2(arc.to.y - arc.center_y, arc.to.x - arc.center_x);
    double sweep = counter_clockwise ? end - begin : begin - end;
    while (sweep < 0) sweep += full_turn_rad;
    if (chord == 0) sweep = full_turn_rad;
    arc.sweep_rad = counter_clockwise ? sweep : -sweep;
    go(arc, words);
    return Done{};
}

// Klipper's circles are two halves.
bool GcodeInterpreter::joins(const GcodeGo& half) {
    if (layer_.items.empty()) return false;
    auto* before = std::get_if<GcodeGo>(&layer_.items.back());
    constexpr double slack_rad = 1e-3;
    const auto is_half = [](const GcodeGo& go) {
        return std::abs(std::abs(go.sweep_rad) - full_turn_rad / 2) < slack_rad;
    };
    if (!before || !before->extrudes() || !half.extrudes() || !is_half(*before) || !is_half(half) ||
        !(half.to == before->from) || (half.sweep_rad > 0) != (before->sweep_rad > 0) ||
        std::hypot(half.center_x - before->center_x, half.center_y - before->center_y) >
            same_center_mm ||
        before->role != half.role || before->width_mm != half.width_mm ||
        before->height_mm != half.height_mm || before->speed_mm_s != half.speed_mm_s)
        return false;
    before->to = half.to;
    before->sweep_rad = half.sweep_rad > 0 ? full_turn_rad : -full_turn_rad;
    before->filament_mm += half.filament_mm;
    return true;
}

void GcodeInterpreter::go(GcodeGo go, const GcodeWords& words) {
    go.filament_mm = filament(words);
    if (go.wipes()) drawn_back_mm_ -= go.filament_mm;
    go.drawn_back_mm = drawn_back_mm_;
    go.speed_mm_s = speed_mm_s_ * speed_;
    go.acceleration_mm_s2 = go.extrudes() ? print_mm_s2_ : travel_mm_s2_;
    go.role = role_;
    go.width_mm = width_mm_;
    go.height_mm = height_mm_;
    go.line = line_;
    at_ = go.to;
    layer_.extrudes = layer_.extrudes || go.extrudes();
    extrudes_ = extrudes_ || go.extrudes();
    if (!joins(go)) layer_.items.emplace_back(go);
}

void GcodeInterpreter::draw(double filament_mm) {
    if (filament_mm == 0) return;
    const double depth_mm = drawn_back_mm_ - filament_mm;
    if (depth_mm < 0) push_aside(-depth_mm);
    drawn_back_mm_ = depth_mm < least_depth_mm ? 0 : depth_mm;
    layer_.items.emplace_back(GcodeDraw{drawn_back_mm_, speed_mm_s_ * speed_});
}

void GcodeInterpreter::push_aside(double filament_mm) {
    if (filament_mm > least_depth_mm) {
        if (pushed_aside_line_ == 0) pushed_aside_line_ = line_;
        ++pushed_aside_count_;
    }
    pushed_aside_mm_ += filament_mm;
}

void GcodeInterpreter::set_position(const GcodeWords& words) {
    const bool all = !words['X'] && !words['Y'] && !words['Z'] && !words['E'];
    const auto axis = [&](char letter, double at, double& offset) {
        if (all || words[letter]) offset = words[letter].value_or(0) * unit_mm_ - at;
    };
    axis('X', at_.x, offset_.x);
    axis('Y', at_.y, offset_.y);
    axis('Z', at_.z, offset_.z);
    if (all || words['E']) filament_ = words['E'].value_or(0) * unit_mm_;
}

// Where the switches are is the machine's matter: 0.
void GcodeInterpreter::home(const GcodeWords& words) {
    const bool all = !words['X'] && !words['Y'] && !words['Z'];
    const GcodePoint from = at_;
    const auto axis = [&](char letter, double& at, double& offset) {
        if (all || words[letter]) at = offset = 0;
    };
    axis('X', at_.x, offset_.x);
    axis('Y', at_.y, offset_.y);
    axis('Z', at_.z, offset_.z);
    if (layer_.extrudes && !(from == at_))
        go({.from = from, .to = at_}, GcodeWords());
    else if (layer_.items.empty())
        layer_.begin = at_;
}

}  // namespace lyr::format
