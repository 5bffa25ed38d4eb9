#include "format/motion_packer.h"

#include <algorithm>
#include <utility>

#include "format/layout.h"

namespace lyr::format {
namespace {

// A motion takes at most 3 x 10 bytes in a plain run and no more in bits, so that an operation fits.
constexpr std::size_t most_motions = 1000;
static_assert(most_motions * (3 * longest_varint + 1) < MotionPacker::most_operation_bytes);

std::size_t varint_bytes(std::int64_t value) {
    const auto bits = static_cast<std::size_t>(std::bit_width(zigzag(value) | 1));
    return (bits + 6) / 7;
}

std::size_t plain_bytes(std::span<const PlaneMotion> motions) {
    std::size_t bytes = 0, run = 0;
    const PlaneMotion* before = nullptr;
    for (const PlaneMotion& motion : motions) {
        const bool goes_on =
            before && (before->sagitta == 0) == (motion.sagitta == 0) && run < opcode::longest_run;
        run = goes_on ? run + 1 : 1;
        if (!goes_on) ++bytes;
        bytes += varint_bytes(std::int64_t{motion.to_x} - motion.from_x) +
                 varint_bytes(std::int64_t{motion.to_y} - motion.from_y) +
                 (motion.sagitta == 0 ? 0 : varint_bytes(motion.sagitta));
        before = &motion;
    }
    return bytes;
}

struct Order {
    unsigned order = 0;
    std::size_t bits = 0;
};

// The order in which the numbers take the fewest bits, or nearly: the one from which neither neighbour is better. That
// of the mean is not far from it.
template <class Numbers>
Order best_order(const Numbers& numbers) {
    const auto with = [&](unsigned order) {
        std::size_t bits = 0;
        numbers([&](std::int64_t value) { bits += bit_count(zigzag(value), order); });
        return Order{order, bits};
    };
    double sum = 0, count = 0;
    numbers([&](std::int64_t value) { sum += static_cast<double>(zigzag(value)), ++count; });
    const auto mean = static_cast<std::uint64_t>(sum / count);
    Order best = with(std::min(static_cast<unsigned>(std::bit_width(mean / 2)), highest_order));
    const unsigned middle = best.order;
    for (unsigned order = middle; order > 0; --order) {
        const Order next = with(order - 1);
        if (next.bits >= best.bits) break;
        best = next;
    }
    for (unsigned order = middle + 1; best.order + 1 == order && order <= highest_order; ++order) {
        const Order next = with(order);
        if (next.bits < best.bits) best = next;
    }
    return best;
}

}  // namespace

std::size_t MotionPacker::put_operation(std::span<const PlaneMotion> motions) {
    offs_.clear();
    std::size_t count = 0;
    for (; count < motions.size() && count < most_motions; ++count) {
        if (!found_) found_ = finder_.find(motions.subspan(count));
        if (found_) break;
        offs_.push_back(off_smooth(motions[count]));
        finder_.add(motions[count]);
    }
    if (count == 0) {
        Alike alike = *std::exchange(found_, std::nullopt);
        alike.count = std::min(alike.count, most_motions);
        put_alike(motions.first(alike.count), alike);
        return alike.count;
    }
    put_apart(motions.first(count));
    return count;
}

MotionPacker::Off MotionPacker::off_smooth(const PlaneMotion& motion) const {
    const std::int64_t x = std::int64_t{motion.to_x} - motion.from_x;
    const std::int64_t y = std::int64_t{motion.to_y} - motion.from_y;
    const std::uint64_t count = finder_.history().count();
    if (count == 0) return {x, y, motion.sagitta};
    const PlaneMotion& last = finder_.history()[count - 1];
    if (last.to_x != motion.from_x || last.to_y != motion.from_y) return {x, y, motion.sagitta};
    const Vector before = chord_of(last), chord = chord_of(motion);
    const std::int64_t sagitta =
        smooth_sagitta(before, length_of(before), last.sagitta, chord, length_of(chord));
    return {x, y, motion.sagitta - sagitta};
}

void MotionPacker::put_alike(std::span<const PlaneMotion> motions, const Alike& alike) {
    const auto back = static_cast<std::int64_t>(finder_.history().count() - alike.what);
    put_byte(operation_, alike.repeated ? opcode::repeated : opcode::parallel);
    put_signed(operation_, back - back_);
    back_ = back;
    if (!alike.repeated) {
        put_signed(operation_, alike.distance - distance_);
        distance_ = alike.distance;
    }
    std::uint64_t what = alike.what;
    for (const PlaneMotion& motion : motions) {
        offs_.push_back(alike.repeated ? off_repeated(motion, what)
                                       : off_beside(motion, what, alike.distance));
        finder_.add(motion);
        ++what;
    }
    put_packed(best_packing());
}

MotionPacker::Off MotionPacker::off_repeated(const PlaneMotion& motion, std::uint64_t what) const {
    const PlaneMotion& old = finder_.history()[what];
    return {std::int64_t{motion.to_x} - motion.from_x - (std::int64_t{old.to_x} - old.from_x),
            std::int64_t{motion.to_y} - motion.from_y - (std::int64_t{old.to_y} - old.from_y),
            motion.sagitta - old.sagitta};
}

MotionPacker::Off MotionPacker::off_beside(const PlaneMotion& motion, std::uint64_t what,
                                           std::int64_t distance) const {
    const Place end = finder_.end_beside(what, distance);
    return {motion.to_x - end.x, motion.to_y - end.y,
            motion.sagitta - finder_.sagitta_beside(what, distance)};
}

// Like nothing before.
void MotionPacker::put_apart(std::span<const PlaneMotion> motions) {
    const Packing packing = best_packing();
    const std::size_t head = 3 + (motions.size() > 127 ? 1 : 0);
    if (head + (packing.bits + 7) / 8 < plain_bytes(motions)) {
        put_byte(operation_, opcode::smooth);
        put_packed(packing);
    } else {
        put_plain(motions);
    }
}

MotionPacker::Packing MotionPacker::best_packing() const {
    const Order position = best_order([&](auto take) {
        for (const Off& off : offs_) take(off.x), take(off.y);
    });
    const Order sagitta = best_order([&](auto take) {
        for (const Off& off : offs_) take(off.sagitta);
    });
    return {position.order, sagitta.order, position.bits + sagitta.bits};
}

void MotionPacker::put_packed(const Packing& packing) {
    put_varint(operation_, offs_.size());
    put_byte(operation_, packing.position_order | packing.sagitta_order << 4);
    BitWriter bits(operation_);
    for (const Off& off : offs_) {
        bits.put_signed(off.x, packing.position_order);
        bits.put_signed(off.y, packing.position_order);
        bits.put_signed(off.sagitta, packing.sagitta_order);
    }
}

void MotionPacker::put_plain(std::span<const PlaneMotion> motions) {
    while (!motions.empty()) {
        const bool arcs = motions[0].sagitta != 0;
        std::size_t count = 1;
        while (count < motions.size() && count < opcode::longest_run &&
               (motions[count].sagitta != 0) == arcs)
            ++count;
        put_byte(operation_, (arcs ? opcode::arc : opcode::line) + count - 1);
        for (const PlaneMotion& motion : motions.first(count)) {
            put_signed(operation_, std::int64_t{motion.to_x} - motion.from_x);
            put_signed(operation_, std::int64_t{motion.to_y} - motion.from_y);
            if (arcs) put_signed(operation_, motion.sagitta);
        }
        motions = motions.subspan(count);
    }
}

}  // namespace lyr::format
