// Everything but the hatch: each call checks, rounds, writes the difference to what is known and
// counts.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "format/arc.h"
#include "format/encoder_state.h"
#include "format/layer_record.h"
#include "format/layout.h"

namespace lyr::format {
namespace {

// Layer, chunk and count stand in front of a chunk's operations.
constexpr std::size_t most_chunk_bytes = longest_buffered_payload - 3 * longest_varint;
// No single operation but a hatch is longer.
constexpr std::size_t most_operation_bytes = 64;
// Beyond the widest arc by less than this is rounding of the caller's.
constexpr double sagitta_slack = 1e-6;

double distance(const Point& a, const Point& b) {
    return std::hypot(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y),
                      static_cast<double>(b.z - a.z));
}

}  // namespace

std::int64_t narrowed(const Point& from, const Point& to, std::int64_t sagitta) {
    const double chord =
        std::hypot(static_cast<double>(to.x - from.x), static_cast<double>(to.y - from.y));
    const auto most = static_cast<std::int64_t>(widest_sagitta_per_chord * chord);
    return std::clamp(sagitta, -most, most);
}

void LayerEncoder::Implementation::mistake(const std::string& what) {
    if (error_) return;
    error_ =
        Diagnostic{Severity::error, ExitStatus::internal, "cannot encode a layer: " + what, {}};
    if (std::isfinite(state_.z_mm)) error_->where.z_mm = state_.z_mm;
}

bool LayerEncoder::Implementation::has_path() {
    if (!has_path_) mistake("extrusion before a path begins");
    return has_path_ && !error_;
}

std::optional<std::uint64_t> LayerEncoder::Implementation::checked(double value, double per_unit,
                                                                   const char* name) {
    if (!error_ && value >= 0 && value * per_unit <= static_cast<double>(largest_setting))
        return setting(value, per_unit);
    mistake(std::string(name) + " is out of range: " + std::to_string(value));
    return std::nullopt;
}

std::optional<std::int64_t> LayerEncoder::Implementation::quanta(double mm) {
    if (!error_ && std::abs(mm) * 1e6 / quantum_.nm <= static_cast<double>(coordinate_limit))
        return quantum_.quanta(mm);
    mistake("a position is out of range: " + std::to_string(mm) + " mm");
    return std::nullopt;
}

std::optional<Point> LayerEncoder::Implementation::point(double x_mm, double y_mm,
                                                         const double* z_mm) {
    const auto x = quanta(x_mm), y = quanta(y_mm);
    const auto z = z_mm ? quanta(*z_mm) : std::optional(at_.z);
    if (!x || !y || !z) return std::nullopt;
    given_x_mm_ = x_mm;
    given_y_mm_ = y_mm;
    return Point{*x, *y, *z};
}

void LayerEncoder::Implementation::close_chunk() {
    const std::size_t end = out_.bytes.size();
    if (end == chunk_begin_) return;
    out_.chunks.push_back({chunk_begin_, end, chunk_operations_});
    out_.totals.operations += chunk_operations_;
    chunk_begin_ = end;
    chunk_operations_ = 0;
    run_at_.reset();
}

void LayerEncoder::Implementation::begin_operation(std::size_t most_bytes) {
    flush_motions();
    make_room(most_bytes);
    ++chunk_operations_;
    run_at_.reset();
}

void LayerEncoder::Implementation::make_room(std::size_t most_bytes) {
    if (out_.bytes.size() - chunk_begin_ + most_bytes > most_chunk_bytes) close_chunk();
}

void LayerEncoder::Implementation::flush_motions() {
    if (!packer_.waits()) return;
    packer_.flush([&](std::span<const std::byte> bytes, std::size_t motions) {
        make_room(bytes.size());
        chunk_operations_ += motions;
        out_.bytes.insert(out_.bytes.end(), bytes.begin(), bytes.end());
    });
    run_at_.reset();
}

// Climbing lines and arcs share the opcode of the one before, as long as its count has room.
void LayerEncoder::Implementation::begin_run(std::uint8_t code, std::size_t most_bytes) {
    const std::optional<std::size_t> run = run_at_;
    begin_operation(most_bytes);
    if (run && *run >= chunk_begin_) {
        const auto before = static_cast<std::uint8_t>(out_.bytes[*run]);
        if ((before & opcode::run_mask) == code && before - code + 1 < opcode::longest_run) {
            out_.bytes[*run] = static_cast<std::byte>(before + 1);
            run_at_ = run;
            return;
        }
    }
    run_at_ = out_.bytes.size();
    put_byte(out_.bytes, code);
}

void LayerEncoder::Implementation::put_step(const Point& to, bool with_z) {
    put_signed(out_.bytes, to.x - at_.x);
    put_signed(out_.bytes, to.y - at_.y);
    if (with_z) put_signed(out_.bytes, to.z - at_.z);
}

void LayerEncoder::Implementation::begin_path(const PathStyle& style) {
    const auto width = checked(style.width_mm, scale::width, "a path's width");
    const auto height = checked(style.height_mm, scale::width, "a path's height");
    const auto flow = checked(style.flow, scale::flow, "a path's flow");
    const auto speed = checked(style.speed_mm_s, scale::speed, "a path's speed");
    const auto acceleration =
        checked(style.acceleration_mm_s2, scale::acceleration, "a path's acceleration");
    if (static_cast<std::size_t>(style.role) >= role_count) mistake("a path's role is not known");
    if (error_) return;
    begin_operation(most_operation_bytes);
    put_byte(out_.bytes, opcode::path);
    put_byte(out_.bytes, static_cast<std::uint8_t>(style.role));
    const std::size_t fields_at = out_.bytes.size();
    std::uint8_t fields = 0;
    put_byte(out_.bytes, fields);
    const auto put = [&](std::uint8_t bit, std::uint64_t value, double per_unit, double& known) {
        if (setting(known, per_unit) == value) return;
        fields |= bit;
        put_varint(out_.bytes, value);
        known = static_cast<double>(value) / per_unit;
    };
    put(style_bit::width, *width, scale::width, style_.width_mm);
    put(style_bit::height, *height, scale::width, style_.height_mm);
    put(style_bit::flow, *flow, scale::flow, style_.flow);
    put(style_bit::speed, *speed, scale::speed, style_.speed_mm_s);
    put(style_bit::acceleration, *acceleration, scale::acceleration, style_.acceleration_mm_s2);
    out_.bytes[fields_at] = static_cast<std::byte>(fields);
    style_.role = style.role;
    has_path_ = true;
}

void LayerEncoder::Implementation::travel_to(double x_mm, double y_mm, const double* z_mm) {
    const auto to = point(x_mm, y_mm, z_mm);
    if (!to || *to == at_) return;
    const bool with_z = to->z != at_.z;
    begin_operation(most_operation_bytes);
    put_byte(out_.bytes, with_z ? opcode::travel_z : opcode::travel);
    put_step(*to, with_z);
    count_travel(*to);
}

void LayerEncoder::Implementation::line_to(double x_mm, double y_mm, const double* z_mm) {
    const auto to = point(x_mm, y_mm, z_mm);
    if (to && has_path()) put_line(*to);
}

void LayerEncoder::Implementation::put_line(const Point& to) {
    if (to == at_) return;
    put_motion(to, 0);
    count_line(to);
}

// Of sagitta 0: a line.
void LayerEncoder::Implementation::put_motion(const Point& to, std::int64_t sagitta) {
    if (to.z == at_.z) {
        packer_.add(plane_motion(at_, to, sagitta));
        run_at_.reset();
        return;
    }
    begin_run(sagitta == 0 ? opcode::line_z : opcode::arc_z, most_operation_bytes);
    put_step(to, true);
    if (sagitta != 0) put_signed(out_.bytes, sagitta);
}

void LayerEncoder::Implementation::arc_to(double x_mm, double y_mm, const double* z_mm,
                                          double sagitta_mm) {
    const double chord_mm = std::hypot(x_mm - given_x_mm_, y_mm - given_y_mm_);
    const auto to = point(x_mm, y_mm, z_mm);
    const auto sagitta = quanta(sagitta_mm);
    if (!to || !sagitta || !has_path()) return;
    if (std::abs(sagitta_mm) >
        widest_sagitta_per_chord * chord_mm * (1 + sagitta_slack) + quantum_.mm(1)) {
        mistake("an arc turns by more than 3/2 pi");
        return;
    }
    const std::int64_t rounded = narrowed(at_, *to, *sagitta);
    if (rounded == 0) {
        put_line(*to);
        return;
    }
    put_motion(*to, rounded);
    const ArcShape shape = arc_shape(Arc{at_, *to, rounded});
    include_arc(shape.center_x, shape.center_y, shape.radius, shape.start_angle_rad,
                shape.sweep_rad);
    count_extrusion(std::hypot(shape.length(), static_cast<double>(to->z - at_.z)));
    include(*to);
    at_ = *to;
}

void LayerEncoder::Implementation::circle(double center_x_mm, double center_y_mm,
                                          bool counter_clockwise) {
    const auto x = quanta(center_x_mm), y = quanta(center_y_mm);
    if (!x || !y || !has_path()) return;
    if (*x == at_.x && *y == at_.y) return;
    begin_operation(most_operation_bytes);
    put_byte(out_.bytes, counter_clockwise ? opcode::circle_ccw : opcode::circle_cw);
    put_step({*x, *y, at_.z}, false);
    const auto center_x = static_cast<double>(*x), center_y = static_cast<double>(*y);
    const double radius =
        std::hypot(static_cast<double>(at_.x) - center_x, static_cast<double>(at_.y) - center_y);
    include_arc(center_x, center_y, radius, 0, 2 * std::numbers::pi);
    count_extrusion(2 * std::numbers::pi * radius);
}

void LayerEncoder::Implementation::put_setting(std::uint8_t code, double value, double per_unit,
                                               double* target) {
    if (target && !has_path()) return;
    const auto number = checked(value, per_unit, "a setting");
    if (!number) return;
    begin_operation(most_operation_bytes);
    put_byte(out_.bytes, code);
    put_varint(out_.bytes, *number);
    if (target) *target = static_cast<double>(*number) / per_unit;
}

void LayerEncoder::Implementation::retract_to(double depth_mm) {
    put_setting(opcode::retract, depth_mm, scale::filament);
    depth_mm_ = depth_mm;
}

void LayerEncoder::Implementation::put_number(std::uint8_t code, std::uint32_t value) {
    if (error_) return;
    begin_operation(most_operation_bytes);
    put_byte(out_.bytes, code);
    put_varint(out_.bytes, value);
}

void LayerEncoder::Implementation::temperature(Heater heater, double target_c, bool wait) {
    const auto target = checked(target_c, scale::temperature, "a temperature");
    if (!target) return;
    begin_operation(most_operation_bytes);
    put_byte(out_.bytes, opcode::temperature);
    put_byte(out_.bytes, static_cast<std::uint8_t>(heater.kind));
    put_varint(out_.bytes, heater.tool);
    put_varint(out_.bytes, *target);
    put_byte(out_.bytes, wait ? 1 : 0);
}

void LayerEncoder::Implementation::fan(std::uint32_t fan, double duty) {
    const auto value = checked(duty, scale::duty, "a fan's duty");
    if (duty > 1) mistake("a fan's duty is above 1");
    if (!value || error_) return;
    begin_operation(most_operation_bytes);
    put_byte(out_.bytes, opcode::fan);
    put_varint(out_.bytes, fan);
    put_varint(out_.bytes, *value);
}

void LayerEncoder::Implementation::pause(PauseReason reason) {
    if (error_) return;
    begin_operation(most_operation_bytes);
    put_byte(out_.bytes, opcode::pause);
    put_byte(out_.bytes, static_cast<std::uint8_t>(reason));
}

void LayerEncoder::Implementation::count_extrusion(double length_quanta) {
    extruded_ += length_quanta;
    out_.totals.volume_mm3 += length_quanta * quantum_.mm(1) * cross_section_mm2(style_);
}

void LayerEncoder::Implementation::count_line(const Point& to) {
    count_extrusion(distance(at_, to));
    include(to);
    at_ = to;
}

void LayerEncoder::Implementation::count_travel(const Point& to) {
    travelled_ += distance(at_, to);
    include(to);
    at_ = to;
}

void LayerEncoder::Implementation::include(const Point& point) {
    Bounds& box = out_.totals.motion;
    box.low = {std::min(box.low.x, point.x), std::min(box.low.y, point.y),
               std::min(box.low.z, point.z)};
    box.high = {std::max(box.high.x, point.x), std::max(box.high.y, point.y),
                std::max(box.high.z, point.z)};
}

// An arc reaches beyond its ends where it passes a whole quarter turn.
void LayerEncoder::Implementation::include_arc(double center_x, double center_y, double radius,
                                               double from_rad, double sweep_rad) {
    constexpr double quarter = std::numbers::pi / 2;
    const double low = std::min(from_rad, from_rad + sweep_rad) / quarter;
    const double high = std::max(from_rad, from_rad + sweep_rad) / quarter;
    const auto inside = [](double value) {
        constexpr auto limit = static_cast<double>(coordinate_limit);
        return std::llround(std::clamp(value, -limit, limit));
    };
    const int last = static_cast<int>(std::floor(high));
    for (int turn = static_cast<int>(std::ceil(low)); turn <= last; ++turn) {
        const int side = turn & 3;
        const double reach = side < 2 ? radius : -radius;
        const double x = center_x + (side % 2 == 0 ? reach : 0);
        const double y = center_y + (side % 2 == 1 ? reach : 0);
        // A side only: the other coordinate is the centre's, which the arc need not reach.
        include({side % 2 == 0 ? inside(x) : at_.x, side % 2 == 1 ? inside(y) : at_.y, at_.z});
    }
}

}  // namespace lyr::format
