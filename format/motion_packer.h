// Lines and arcs that follow each other, as the operations that take the fewest bytes: runs beside earlier motions, smooth
// runs, or plain ones.
//
// Contract
//  1. A reader finds the same motions, whatever they are.
//  2. The bytes depend on the motions of the layer only.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/bytes.h"
#include "format/parallel_finder.h"

namespace lyr::format {

class MotionPacker {
public:
    // No bytes given out at once are more.
    static constexpr std::size_t most_operation_bytes = 32768;

    void add(const PlaneMotion& motion) { waiting_.push_back(motion); }
    bool waits() const { return !waiting_.empty(); }

    // Gives out all that waits: put(bytes of one or more operations, how many motions they have).
    template <class Put>
    void flush(Put put) {
        for (std::span<const PlaneMotion> left(waiting_); !left.empty();) {
            Bytes& bytes = operation_;
            bytes.clear();
            const std::size_t count = put_operation(left);
            put(std::span<const std::byte>(bytes), count);
            left = left.subspan(count);
        }
        waiting_.clear();
    }

private:
    // What a motion is stored as in a packed run.
    struct Off {
        std::int64_t x = 0, y = 0, sagitta = 0;
    };

    struct Packing {
        unsigned position_order = 0, sagitta_order = 0;
        std::size_t bits = 0;
    };

    std::size_t put_operation(std::span<const PlaneMotion> motions);
    Off off_smooth(const PlaneMotion& motion) const;
    Off off_repeated(const PlaneMotion& motion, std::uint64_t what) const;
    Off off_beside(const PlaneMotion& motion, std::uint64_t what, std::int64_t distance) const;
    void put_alike(std::span<const PlaneMotion> motions, const Alike& alike);
    void put_apart(std::span<const PlaneMotion> motions);
    void put_plain(std::span<const PlaneMotion> motions);
    Packing best_packing() const;
    void put_packed(const Packing& packing);

    ParallelFinder finder_;
    std::vector<PlaneMotion> waiting_;
    Bytes operation_;
    std::vector<Off> offs_;
    std::optional<Alike> found_;            // for the first motion that waits
    std::int64_t back_ = 0, distance_ = 0;  // of the last run that had them
};

}  // namespace lyr::format
