// Packed runs: lines and arcs as small differences, in bits, from what the motions before let expect.

#include "format/arc.h"
#include "format/chunk_decoder.h"
#include "format/layout.h"

namespace lyr::format {

bool ChunkDecoder::decode_smooth(Operation& out) {
    packed_ = Packed::smooth;
    smooth_ = false;
    if (history_->count() > 0) {
        const PlaneMotion& last = (*history_)[history_->count() - 1];
        smooth_ = last.to_x == at_.x && last.to_y == at_.y;
        last_chord_ = chord_of(last);
        last_length_ = length_of(last_chord_);
    }
    return begin_packed(out);
}

// Differences out of range are refused before they are added, so that no sum overflows.
bool ChunkDecoder::reach_back(std::int64_t least) {
    constexpr auto window = static_cast<std::int64_t>(MotionHistory::window);
    const std::int64_t back = cursor_.signed_varint();
    if (beyond(back, window)) return fail("a run leans on motions out of reach");
    back_ += back;
    if (back_ < least || back_ > static_cast<std::int64_t>(history_->kept()))
        return fail("a run leans on motions out of reach");
    old_ = history_->count() - static_cast<std::uint64_t>(back_);
    return true;
}

bool ChunkDecoder::decode_parallel(Operation& out) {
    // The motion behind the old one must be known as well.
    if (!reach_back(2)) return false;
    const std::int64_t distance = cursor_.signed_varint();
    if (beyond(distance, 2 * farthest_beside) || beyond(distance_ + distance, farthest_beside))
        return fail("a run is too far from what it is parallel to");
    distance_ += distance;
    packed_ = Packed::parallel;
    old_course_ = course_of((*history_)[old_]);
    next_course_ = course_of((*history_)[old_ + 1]);
    return begin_packed(out);
}

bool ChunkDecoder::decode_repeated(Operation& out) {
    packed_ = Packed::repeated;
    return reach_back(1) && begin_packed(out);
}

bool ChunkDecoder::begin_packed(Operation& out) {
    packed_left_ = cursor_.varint();
    const std::uint8_t orders = cursor_.byte();
    position_order_ = orders & 15;
    sagitta_order_ = orders >> 4;
    if (!may_extrude()) return false;
    if (packed_left_ == 0) return fail("a packed run has no motions");
    // Each takes three bits at least.
    if (packed_left_ > cursor_.left() * 8 / 3) return fail("a packed run is cut short");
    operations_ += packed_left_ - 1;
    return decode_packed(out);
}

inline ChunkDecoder::Expected ChunkDecoder::expect_smooth(std::int64_t x, std::int64_t y) {
    const Vector chord{static_cast<double>(x), static_cast<double>(y)};
    const double length = length_of(chord);
    const PlaneMotion& last = (*history_)[history_->count() - 1];
    const std::int64_t sagitta =
        smooth_ ? smooth_sagitta(last_chord_, last_length_, last.sagitta, chord, length) : 0;
    smooth_ = true;
    last_chord_ = chord;
    last_length_ = length;
    return {at_.x, at_.y, sagitta};
}

inline ChunkDecoder::Expected ChunkDecoder::expect_beside() {
    const PlaneMotion& old = (*history_)[old_];
    const PlaneMotion& next = (*history_)[old_ + 1];
    const bool joined = next.from_x == old.to_x && next.from_y == old.to_y;
    const double distance = static_cast<double>(distance_) / scale::distance;
    const Place end = end_beside(old, old_course_, joined ? next_course_.start : old_course_.end,
                                 joined ? next_course_.size : old_course_.size, distance);
    return {end.x, end.y, sagitta_beside(old, old_course_, distance)};
}

// A motion ahead of its use, so that the processor reckons both at the same time.
inline void ChunkDecoder::go_on_beside() {
    old_course_ = next_course_;
    next_course_ = course_of((*history_)[++old_ + 1]);
}

inline ChunkDecoder::Expected ChunkDecoder::expect_repeated() {
    const PlaneMotion& old = (*history_)[old_++];
    return {at_.x + old.to_x - old.from_x, at_.y + old.to_y - old.from_y, old.sagitta};
}

inline bool ChunkDecoder::give_packed(const Point& to, std::int64_t sagitta, Operation& out) {
    const Point from = at_;
    if (beyond(to.x, coordinate_limit) || beyond(to.y, coordinate_limit))
        return fail("a position is out of range");
    if (sagitta == 0 && from == to) return fail("a motion of a packed run has no length");
    if (!is_arc(from, to, sagitta)) return fail("an arc has no or too large a sagitta");
    history_->add(plane_motion(from, to, sagitta));
    at_ = to;
    if (sagitta == 0) {
        Line& line = out.emplace<Line>();
        line.from = from;
        line.to = to;
    } else {
        Arc& arc = out.emplace<Arc>();
        arc.from = from;
        arc.to = to;
        arc.sagitta = sagitta;
    }
    return true;
}

bool ChunkDecoder::decode_packed(Operation& out) {
    const auto [x, y, sagitta] = cursor_.bit_numbers(position_order_, sagitta_order_);
    if (--packed_left_ == 0) cursor_.end_bits();
    if (cursor_.bad()) return fail("");
    const Expected expected = packed_ == Packed::parallel ? expect_beside()
                              : packed_ == Packed::smooth ? expect_smooth(x, y)
                                                          : expect_repeated();
    if (!give_packed({expected.x + x, expected.y + y, at_.z}, expected.sagitta + sagitta, out))
        return false;
    if (packed_ == Packed::parallel) go_on_beside();
    return true;
}

}  // namespace lyr::format
