// Following references from instance to instance without running in circles or out of stack.
//
//     auto step = trail.enter(instance);   if (!step) return step.error();
//     ... follow the references of `instance`; the step leaves it when it goes out of scope ...
//
// Contract
//  1. Entering an instance that has been entered and not left is an error that spells the cycle
//     out: "#5 refers to itself: #5 -> #7 -> #5".
//  2. Entering more than max_length instances at once is an error. (The longest honest chains,
//     assembly trees down to a coordinate, are a few dozen long.)
//  3. Entering and leaving take constant time and, after the first use, no allocation.

#pragma once

#include <vector>

#include "parser/part21/part21.h"

namespace lyr::part21 {

class Trail {
public:
    static constexpr std::size_t max_length = 1000;

    explicit Trail(const File& file) : file_(&file), entered_(file.instance_count()) {}

    class [[nodiscard]] Step {
    public:
        Step(Step&& other) noexcept : trail_(std::exchange(other.trail_, nullptr)) {}
        Step& operator=(Step&&) = delete;
        ~Step() {
            if (trail_) trail_->leave();
        }

    private:
        friend class Trail;
        explicit Step(Trail* trail) : trail_(trail) {}
        Trail* trail_;
    };

    Result<Step> enter(InstanceIndex instance);

private:
    void leave();

    const File* file_;
    std::vector<bool> entered_;
    std::vector<InstanceIndex> path_;
};

}  // namespace lyr::part21
