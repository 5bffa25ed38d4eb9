#include "target/motion/move_window.h"

namespace lyr::motion {
namespace {

// Only differences of it count; kept small so that they stay exact.
constexpr double farthest_pressed_mm = 1000;

}  // namespace

void MoveWindow::push(const PlannedMove& planned) {
    if (size_ == ring_.size()) grow();
    ChannelMove& move = ring_[place(end())];
    ++size_;
    rests_until_ns_ = std::numeric_limits<std::int64_t>::min();
    const Path& path = planned.path;
    const double length_mm = planned.profile.length_mm, advance_mm = advance_of(path);
    const Point &from = start_of(path), &to = end_of(path);
    const bool presses = advance_mm > 0 && tangent_at(path, 0) != Point{};
    const double due_mm = advance_mm - fed_error_mm_, fed_mm = fed_mm_ + due_mm;
    fed_error_mm_ = (fed_mm - fed_mm_) - due_mm;
    move.start_ns = planned.start_ns;
    move.start_part_ns = planned.start_part_ns;
    move.profile = planned.profile;
    move.tag = planned.tag;
    move.start = from;
    move.from = {from.x, from.y, from.z, fed_mm_, pressed_mm_};
    move.to = {to.x, to.y, to.z, fed_mm, pressed_mm_ + (presses ? advance_mm : 0)};
    for (std::size_t i = 0; i < axis_e; ++i)
        move.slope[i] = (move.to[i] - move.from[i]) / length_mm;
    move.slope[axis_e] = advance_mm / length_mm;
    move.slope[pressed_channel] = presses ? advance_mm / length_mm : 0;
    const auto* arc = std::get_if<Arc>(&path);
    move.turns = arc != nullptr;
    if (arc) {
        move.radius_mm = arc->radius_mm;
        move.start_angle_rad = arc->start_angle_rad;
        move.rate = arc->sweep_rad / length_mm;
    }
    fed_mm_ = fed_mm;
    pressed_mm_ = move.to[pressed_channel];
}

void MoveWindow::drop_before(std::uint64_t number) {
    while (first_ < number && size_ > 1) {
        ++first_;
        --size_;
    }
    if (pressed_mm_ < farthest_pressed_mm) return;
    const double excess_mm = at(first_).from[pressed_channel];
    for (std::uint64_t i = first_; i < end(); ++i) {
        ChannelMove& move = ring_[place(i)];
        move.from[pressed_channel] -= excess_mm;
        move.to[pressed_channel] -= excess_mm;
    }
    pressed_mm_ -= excess_mm;
}

void MoveWindow::grow() {
    std::vector<ChannelMove> larger(2 * ring_.size());
    for (std::uint64_t i = first_; i < end(); ++i)
        larger[static_cast<std::size_t>(i) & (larger.size() - 1)] = at(i);
    ring_.swap(larger);
}

}  // namespace lyr::motion
