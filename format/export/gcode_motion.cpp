// Positions are rounded each by itself, so that errors do not add up; what rounding leaves of the filament is carried on.

#include "format/export/gcode_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "format/export/fixed_point.h"

namespace lyr::format {
namespace {

constexpr int most_decimals = 4, nm_decimals = 6, speed_decimals = 2;
constexpr double s_per_min = 60;

// The fewest digits that hold the quantum, at most `most_decimals`.
int decimals_for(Quantum quantum) {
    int decimals = 0;
    while (decimals < most_decimals && quantum.nm % power_of_ten(nm_decimals - decimals) != 0)
        ++decimals;
    return decimals;
}

std::int64_t divided(std::int64_t nm, std::int64_t unit_nm) {
    const std::int64_t half = unit_nm / 2;
    return nm >= 0 ? (nm + half) / unit_nm : -((-nm + half) / unit_nm);
}

}  // namespace

GcodeMotion::GcodeMotion(const GcodeOptions& options, Quantum quantum, std::string& out)
    : out_(out),
      quantum_(quantum),
      flavor_(options.flavor),
      relative_(options.relative_extrusion),
      decimals_(decimals_for(quantum)),
      unit_nm_(power_of_ten(nm_decimals - decimals_)) {}

GcodeMotion::Place GcodeMotion::place(const Point& point) const {
    return {divided(point.x * quantum_.nm, unit_nm_), divided(point.y * quantum_.nm, unit_nm_),
            divided(point.z * quantum_.nm, unit_nm_)};
}

double GcodeMotion::mm(std::int64_t units) const {
    return static_cast<double>(units) / static_cast<double>(power_of_ten(decimals_));
}

void GcodeMotion::append_word(char letter, std::int64_t count, int decimals) {
    out_ += ' ';
    out_ += letter;
    append_fixed(out_, count, decimals);
}

void GcodeMotion::append_place(const Place& to, bool always) {
    if (always || to.x != at_.x) append_word('X', to.x, decimals_);
    if (always || to.y != at_.y) append_word('Y', to.y, decimals_);
    if (to.z != at_.z) append_word('Z', to.z, decimals_);
    at_ = to;
}

void GcodeMotion::append_filament(double filament_mm) {
    const double exact =
        filament_mm * static_cast<double>(power_of_ten(filament_decimals)) + unwritten_;
    const std::int64_t rounded = std::llround(exact);
    unwritten_ = exact - static_cast<double>(rounded);
    filament_ += rounded;
    append_word('E', relative_ ? rounded : filament_, filament_decimals);
}

void GcodeMotion::append_speed(double speed_mm_s) {
    const std::int64_t speed = std::llround(speed_mm_s * s_per_min * power_of_ten(speed_decimals));
    if (speed == speed_ || speed == 0) return;
    speed_ = speed;
    append_word('F', speed, speed_decimals);
}

void GcodeMotion::go(const char* command, const Place& to, double filament_mm, double speed_mm_s) {
    if (to == at_ && filament_mm == 0) return;
    out_ += command;
    append_place(to, false);
    if (filament_mm != 0) append_filament(filament_mm);
    append_speed(speed_mm_s);
    out_ += '\n';
}

void GcodeMotion::line(const Point& to, double filament_mm, double speed_mm_s) {
    go("G1", place(to), filament_mm, speed_mm_s);
}

void GcodeMotion::travel(const Point& to, double speed_mm_s) {
    go("G0", place(to), 0, speed_mm_s);
}

void GcodeMotion::begin_at(const Point& to, double speed_mm_s) {
    at_ = place(to);
    out_ += "G0";
    append_word('Z', at_.z, decimals_);
    append_speed(speed_mm_s);
    out_ += "\nG0";
    append_word('X', at_.x, decimals_);
    append_word('Y', at_.y, decimals_);
    out_ += '\n';
}

void GcodeMotion::push(double filament_mm, double speed_mm_s) {
    if (filament_mm == 0) return;
    out_ += "G1";
    append_filament(filament_mm);
    append_speed(speed_mm_s);
    out_ += '\n';
}

void GcodeMotion::reset_filament() {
    if (relative_) return;
    filament_ = 0;
    out_ += "G92 E0\n";
}

void GcodeMotion::arc(const Arc& arc, double filament_mm, double speed_mm_s) {
    const ArcShape shape = arc_shape(arc);
    const double unit = quantum_.mm(1);
    turn({shape.center_x * unit, shape.center_y * unit, shape.radius * unit, shape.start_angle_rad,
          shape.sweep_rad},
         place(arc.to), filament_mm, speed_mm_s);
}

void GcodeMotion::circle(const Circle& circle, double filament_mm, double speed_mm_s) {
    constexpr double half_turn = std::numbers::pi;
    const Point& from = circle.from;
    const double dx = quantum_.mm(from.x - circle.center_x);
    const double dy = quantum_.mm(from.y - circle.center_y);
    const double sense = circle.counter_clockwise ? 1 : -1;
    Round round{quantum_.mm(circle.center_x), quantum_.mm(circle.center_y), std::hypot(dx, dy),
                std::atan2(dy, dx), sense * 2 * half_turn};
    const Place end = place(circle.to);
    if (flavor_ == GcodeFlavor::marlin) {
        turn(round, end, filament_mm, speed_mm_s);
        return;
    }
    const Place middle = place({2 * circle.center_x - from.x, 2 * circle.center_y - from.y,
                                from.z + (circle.to.z - from.z) / 2});
    round.sweep_rad = sense * half_turn;
    turn(round, middle, filament_mm / 2, speed_mm_s);
    round.start_rad += half_turn;
    turn(round, end, filament_mm / 2, speed_mm_s);
}

void GcodeMotion::turn(const Round& round, const Place& to, double filament_mm, double speed_mm_s) {
    const bool is_whole = std::abs(round.sweep_rad) > 1.75 * std::numbers::pi;
    const bool is_closed = to.x == at_.x && to.y == at_.y;
    if (round.radius > largest_arc_mm || round.radius < smallest_arc_mm || is_closed != is_whole) {
        chords(round, to, filament_mm, speed_mm_s);
        return;
    }
    const auto offset = [&](double center, std::int64_t from) {
        return std::llround((center - mm(from)) * static_cast<double>(power_of_ten(decimals_ + 1)));
    };
    const std::int64_t i = offset(round.center_x, at_.x), j = offset(round.center_y, at_.y);
    out_ += round.sweep_rad > 0 ? "G3" : "G2";
    append_place(to, true);
    append_word('I', i, decimals_ + 1);
    append_word('J', j, decimals_ + 1);
    if (filament_mm != 0) append_filament(filament_mm);
    append_speed(speed_mm_s);
    out_ += '\n';
}

// A chord of angle a is off the arc by radius (1 - cos(a / 2)).
void GcodeMotion::chords(const Round& round, const Place& to, double filament_mm,
                         double speed_mm_s) {
    const double off_mm = mm(1), sweep = std::abs(round.sweep_rad);
    const double widest = 2 * std::acos(std::max(0.0, 1 - off_mm / round.radius));
    const auto count = static_cast<int>(std::max(1.0, std::ceil(sweep / widest)));
    const Place from = at_;
    for (int i = 1; i <= count; ++i) {
        const double share = static_cast<double>(i) / count;
        const double angle = round.start_rad + share * round.sweep_rad;
        const auto units = [&](double value) {
            return std::llround(value * static_cast<double>(power_of_ten(decimals_)));
        };
        const Place next{units(round.center_x + round.radius * std::cos(angle)),
                         units(round.center_y + round.radius * std::sin(angle)),
                         from.z + std::llround(share * static_cast<double>(to.z - from.z))};
        go("G1", i == count ? to : next, filament_mm / count, speed_mm_s);
    }
}

}  // namespace lyr::format
