// Runs and hatches are unrolled step by step from a few counters, so that no list is ever held.

#include "format/chunk_decoder.h"

#include <algorithm>

#include "format/arc.h"
#include "format/layout.h"

namespace lyr::format {
namespace {

constexpr std::int64_t largest_row = std::int64_t{1} << 32;

}  // namespace

void ChunkDecoder::begin_layer(const Point& start, Quantum quantum) {
    history_->clear();
    *this = ChunkDecoder(*history_);
    quantum_ = quantum;
    at_ = start;
}

void ChunkDecoder::begin_chunk(std::span<const std::byte> bytes, std::uint64_t operations) {
    cursor_ = Cursor(bytes);
    stated_operations_ = operations;
    operations_ = 0;
}

bool ChunkDecoder::fail(const char* error) {
    if (!error_) error_ = cursor_.bad() ? "a number is cut short or too long" : error;
    packed_left_ = 0;
    return false;
}

ChunkDecoder::Step ChunkDecoder::find_next(Operation& out) {
    while (!error_) {
        bool given = false;
        if (run_left_ > 0) {
            given = decode_run(out);
        } else if (stage_ != HatchStage::none) {
            given = decode_hatch_step(out);
        } else if (wipe_left_ > 0) {
            given = decode_wipe_piece(out);
        } else if (cursor_.at_end()) {
            if (operations_ == stated_operations_) return Step::end;
            fail("it has another number of operations than it says");
        } else {
            ++operations_;
            given = decode(cursor_.byte(), out);
        }
        if (cursor_.bad()) fail("");
        if (given && !error_) return Step::operation;
    }
    return Step::error;
}

bool ChunkDecoder::decode(std::uint8_t code, Operation& out) {
    if (code < opcode::travel) {
        run_code_ = code & opcode::run_mask;
        run_left_ = static_cast<std::uint8_t>(code - run_code_ + 1);
        operations_ += static_cast<std::uint64_t>(run_left_ - 1);
        return decode_run(out);
    }
    if (code <= opcode::wipe) return decode_motion(code, out);
    if (code <= opcode::travel_acceleration) return decode_style(code, out);
    if (code >= opcode::first_skippable) {
        cursor_.skip(cursor_.varint());
        return false;
    }
    return decode_machine(code, out);
}

bool ChunkDecoder::decode_run(Operation& out) {
    --run_left_;
    switch (run_code_) {
        case opcode::line:
            return decode_line(false, out);
        case opcode::line_z:
            return decode_line(true, out);
        case opcode::arc:
            return decode_arc(false, out);
        default:
            return decode_arc(true, out);
    }
}

bool ChunkDecoder::decode_motion(std::uint8_t code, Operation& out) {
    switch (code) {
        case opcode::travel:
            return decode_travel(false, out);
        case opcode::travel_z:
            return decode_travel(true, out);
        case opcode::circle_ccw:
            return decode_circle(true, false, out);
        case opcode::circle_cw:
            return decode_circle(false, false, out);
        case opcode::helix_ccw:
            return decode_circle(true, true, out);
        case opcode::helix_cw:
            return decode_circle(false, true, out);
        case opcode::grid:
            return decode_grid();
        case opcode::smooth:
            return decode_smooth(out);
        case opcode::parallel:
            return decode_parallel(out);
        case opcode::repeated:
            return decode_repeated(out);
        case opcode::wipe:
            return decode_wipe(out);
        default:
            return decode_hatch(out);
    }
}

bool ChunkDecoder::decode_style(std::uint8_t code, Operation& out) {
    switch (code) {
        case opcode::path:
            return decode_path(out);
        case opcode::travel_speed:
            out = TravelSpeed{setting(scale::speed)};
            return true;
        case opcode::travel_acceleration:
            out = TravelAcceleration{setting(scale::acceleration)};
            return true;
        default:
            break;
    }
    if (!has_path_) return fail("a style is changed before a path begins");
    switch (code) {
        case opcode::width:
            style_.width_mm = setting(scale::width);
            out = Width{style_.width_mm};
            return true;
        case opcode::speed:
            style_.speed_mm_s = setting(scale::speed);
            out = Speed{style_.speed_mm_s};
            return true;
        case opcode::acceleration:
            style_.acceleration_mm_s2 = setting(scale::acceleration);
            out = Acceleration{style_.acceleration_mm_s2};
            return true;
        default:
            return fail("unknown operation");
    }
}

bool ChunkDecoder::decode_path(Operation& out) {
    const std::uint8_t role = cursor_.byte(), fields = cursor_.byte();
    if (fields & ~style_bit::all) return fail("a path has a field that is not known");
    style_.role = role < role_count ? static_cast<Role>(role) : Role::other;
    if (fields & style_bit::width) style_.width_mm = setting(scale::width);
    if (fields & style_bit::height) style_.height_mm = setting(scale::width);
    if (fields & style_bit::flow) style_.flow = setting(scale::flow);
    if (fields & style_bit::speed) style_.speed_mm_s = setting(scale::speed);
    if (fields & style_bit::acceleration) style_.acceleration_mm_s2 = setting(scale::acceleration);
    has_path_ = true;
    out = PathStart{style_};
    return true;
}

bool ChunkDecoder::decode_machine(std::uint8_t code, Operation& out) {
    switch (code) {
        case opcode::retract:
            out = Retract{setting(scale::filament)};
            return true;
        case opcode::temperature: {
            const std::uint8_t kind = cursor_.byte();
            const std::uint32_t tool = number();
            const double target_c = setting(scale::temperature);
            const std::uint8_t wait = cursor_.byte();
            if (kind > static_cast<std::uint8_t>(HeaterKind::tool)) return fail("unknown heater");
            out = Temperature{{static_cast<HeaterKind>(kind), tool}, target_c, wait != 0};
            return true;
        }
        case opcode::fan: {
            const std::uint32_t fan = number();
            const double duty = setting(scale::duty);
            if (duty > 1) return fail("a fan's duty is above 1");
            out = Fan{fan, duty};
            return true;
        }
        case opcode::dwell:
            out = Dwell{number()};
            return true;
        case opcode::tool:
            out = Tool{number()};
            return true;
        case opcode::pause: {
            const std::uint8_t reason = cursor_.byte();
            const bool known = reason <= static_cast<std::uint8_t>(PauseReason::filament_change);
            out = Pause{known ? static_cast<PauseReason>(reason) : PauseReason::user};
            return true;
        }
        case opcode::object:
            out = Object{number()};
            return true;
        default:
            return fail("unknown operation");
    }
}

bool ChunkDecoder::may_extrude() {
    return has_path_ || fail("extrusion before a path begins");
}

bool ChunkDecoder::decode_line(bool with_z, Operation& out) {
    const Point from = at_, to = step(with_z);
    if (!may_extrude()) return false;
    if (!in_range(to) || from == to) return false;
    out = Line{from, to, false};
    if (!with_z) history_->add(plane_motion(from, to, 0));
    at_ = to;
    return true;
}

bool ChunkDecoder::decode_arc(bool with_z, Operation& out) {
    const Point from = at_, to = step(with_z);
    const std::int64_t sagitta = cursor_.signed_varint();
    if (!may_extrude()) return false;
    if (!in_range(to)) return false;
    if (sagitta == 0 || !is_arc(from, to, sagitta))
        return fail("an arc has no or too large a sagitta");
    out = Arc{from, to, sagitta};
    if (!with_z) history_->add(plane_motion(from, to, sagitta));
    at_ = to;
    return true;
}

bool ChunkDecoder::decode_travel(bool with_z, Operation& out) {
    const Point from = at_, to = step(with_z);
    if (!in_range(to)) return false;
    at_ = to;
    out = Travel{from, to, false};
    return from != to;
}

bool ChunkDecoder::decode_circle(bool counter_clockwise, bool with_z, Operation& out) {
    const Point from = at_, center = step(with_z);
    if (!may_extrude()) return false;
    if (!in_range(center)) return false;
    if (center.x == from.x && center.y == from.y) return fail("a circle has no radius");
    at_.z = center.z;
    out = Circle{from, at_, center.x, center.y, counter_clockwise};
    return true;
}

bool ChunkDecoder::decode_grid() {
    grid_.a = cursor_.signed_varint();
    grid_.b = cursor_.signed_varint();
    grid_.offset = cursor_.signed_varint();
    grid_.pitch = cursor_.signed_varint();
    has_grid_ = grid_.direction_is_unit() && !beyond(grid_.offset, offset_limit) &&
                !beyond(grid_.pitch, offset_limit);
    return has_grid_ ? false : fail("a grid is out of range");
}

bool ChunkDecoder::decode_hatch(Operation& out) {
    const std::uint8_t flags = cursor_.byte();
    row_ = cursor_.signed_varint();
    rows_left_ = cursor_.varint();
    if (flags & ~hatch_bit::all) return fail("a hatch has a flag that is not known");
    if (!has_path_) return fail("extrusion before a path begins");
    if (!has_grid_) return fail("a hatch without a grid");
    if (beyond(row_, largest_row) || rows_left_ > static_cast<std::uint64_t>(largest_row))
        return fail("a hatch row is out of range");
    group_rows_left_ = 0;
    one_way_ = (flags & hatch_bit::one_way) != 0;
    forward_ = (flags & hatch_bit::backward) == 0;
    stage_ = HatchStage::row;
    predictor_.begin_run();
    out = HatchStart{static_cast<double>(grid_.a) / scale::direction,
                     static_cast<double>(grid_.b) / scale::direction,
                     quantum_.mm(grid_.pitch) / scale::offset};
    return true;
}

bool ChunkDecoder::begin_hatch_row() {
    if (rows_left_ == 0) {
        stage_ = HatchStage::none;
        return false;
    }
    if (group_rows_left_ == 0 && !begin_hatch_group()) return false;
    const std::optional<std::int64_t> offset = grid_.row(row_);
    if (!offset) return fail("a hatch row is out of range");
    row_offset_ = *offset;
    predictor_.begin_row(intervals_);
    linked_ = group_linked_;
    ends_left_ = 2 * intervals_;
    stage_ = HatchStage::start;
    return true;
}

// False: the group has empty rows only, which are passed over here, or an error.
bool ChunkDecoder::begin_hatch_group() {
    const std::uint64_t head = cursor_.varint();
    group_rows_left_ = cursor_.varint();
    group_linked_ = (head & 1) != 0;
    intervals_ = head >> 1;
    if (group_rows_left_ == 0 || group_rows_left_ > rows_left_)
        return fail("a hatch has another number of rows than it says");
    if (intervals_ == 0) {
        // The predictor looks back two rows.
        for (std::uint64_t i = 0; i < std::min<std::uint64_t>(group_rows_left_, 2); ++i)
            predictor_.begin_row(0);
        pass_hatch_rows(group_rows_left_);
        return false;
    }
    // Each interval has two values of a byte at least.
    const std::uint64_t most = cursor_.left() / 2;
    if (intervals_ > most || group_rows_left_ > most / intervals_)
        return fail("a hatch row is cut short");
    return true;
}

void ChunkDecoder::pass_hatch_rows(std::uint64_t rows) {
    stage_ = HatchStage::row;
    rows_left_ -= rows;
    group_rows_left_ -= rows;
    row_ += static_cast<std::int64_t>(rows);
    if (!one_way_ && rows % 2 == 1) forward_ = !forward_;
}

bool ChunkDecoder::hatch_point(Point& point) {
    const std::uint64_t j = forward_ ? 2 * intervals_ - ends_left_ : ends_left_ - 1;
    const std::int64_t off = cursor_.signed_varint();
    // Predictions are at most three times the limit away.
    const std::int64_t along = beyond(off, 8 * hatch_limit) ? off : predictor_.predict(j) + off;
    if (beyond(along, hatch_limit)) return fail("a hatch line is out of range");
    predictor_.note(j, along);
    --ends_left_;
    point = {grid_.x(along, row_offset_), grid_.y(along, row_offset_), at_.z};
    return in_range(point);
}

bool ChunkDecoder::decode_hatch_step(Operation& out) {
    if (stage_ == HatchStage::row && !begin_hatch_row()) return false;
    const Point from = at_;
    Point to;
    if (!hatch_point(to)) return false;
    at_ = to;
    if (stage_ == HatchStage::start) {
        stage_ = HatchStage::end;
        const bool links = linked_;
        linked_ = false;
        if (from == to) return false;
        if (links)
            out = Line{from, to, true};
        else
            out = Travel{from, to, true};
        return true;
    }
    stage_ = HatchStage::start;
    if (ends_left_ == 0) pass_hatch_rows(1);
    if (from == to) return false;
    out = Line{from, to, true};
    return true;
}

Point ChunkDecoder::step_from(const Point& from, bool with_z) {
    // Wide enough steps are refused by in_range(); the sum must only not overflow.
    const auto add = [](std::int64_t begin, std::int64_t step) {
        return beyond(step, 2 * coordinate_limit) ? 2 * coordinate_limit : begin + step;
    };
    Point to = from;
    to.x = add(from.x, cursor_.signed_varint());
    to.y = add(from.y, cursor_.signed_varint());
    if (with_z) to.z = add(from.z, cursor_.signed_varint());
    return to;
}

std::uint32_t ChunkDecoder::number() {
    const std::uint64_t value = cursor_.varint();
    if (value > largest_setting) fail("a number is out of range");
    return static_cast<std::uint32_t>(value);
}

double ChunkDecoder::setting(double per_unit) {
    return number() / per_unit;
}

}  // namespace lyr::format
