// Finds what the next motions of a layer run beside (an inner wall along the wall around it, say) or repeat (the turns of
// a fill). It looks at those motions of the history whose ends have nearly the same direction, kept by that direction.
//
// Contract
//  1. What is found depends on the motions only.
//  2. A motion costs a bounded number of looks, however many motions there are.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "format/motion_history.h"

namespace lyr::format {

// The first `count` of the motions that were asked for run beside those from `what` on, or repeat them elsewhere.
struct Alike {
    std::uint64_t what = 0;
    std::int64_t distance = 0;  // in 1/16 quanta
    std::size_t count = 0;
    bool repeated = false;
};

class ParallelFinder {
public:
    ParallelFinder() { newest_.fill(none); }

    const MotionHistory& history() const { return history_; }
    // Of a motion that the history keeps.
    const Course& course(std::uint64_t number) const { return at(courses_, number); }
    void add(const PlaneMotion& motion);

    // None: not as many as would pay. `motions` follow the history.
    std::optional<Alike> find(std::span<const PlaneMotion> motions) const;

    // Where the end of the motion beside this one is expected, and its sagitta.
    Place end_beside(std::uint64_t number, std::int64_t distance) const;
    std::int64_t sagitta_beside(std::uint64_t number, std::int64_t distance) const;

private:
    static constexpr std::size_t sectors = 64;
    static constexpr std::uint64_t none = ~std::uint64_t{0};

    template <class T>
    static T& at(std::vector<T>& ring, std::uint64_t number) {
        return ring[static_cast<std::size_t>(number % MotionHistory::window)];
    }
    template <class T>
    static const T& at(const std::vector<T>& ring, std::uint64_t number) {
        return ring[static_cast<std::size_t>(number % MotionHistory::window)];
    }

    static std::size_t sector(const Vector& direction, double turned);
    const Course* next(std::uint64_t number) const;
    std::optional<double> distance(const PlaneMotion& motion, std::uint64_t number) const;
    std::size_t extent(std::span<const PlaneMotion> motions, const Alike& beside) const;
    std::size_t repeated(std::span<const PlaneMotion> motions, std::uint64_t what) const;
    std::int64_t mean_distance(std::span<const PlaneMotion> motions, const Alike& beside) const;

    MotionHistory history_;
    std::vector<Course> courses_ = std::vector<Course>(MotionHistory::window);
    std::vector<std::uint64_t> older_ = std::vector<std::uint64_t>(MotionHistory::window);
    std::array<std::uint64_t, sectors> newest_;  // motion that ends in a direction of the sector
};

}  // namespace lyr::format
