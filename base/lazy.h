// A value that is made when it is first asked for.
//
// Contract
//  1. get(make) returns the value; make() is called once, whichever thread comes first, the others wait for it.
//  2. Where make() throws, nothing is made, and the next one tries again. (std::call_once would look for the unwinder of a
//     thread library then, which ends the process when memory is what is missing.)

#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <utility>

namespace lyr {

template <class T>
class Lazy {
public:
    template <class Make>
    const T& get(Make&& make) const {
        if (!made_.load(std::memory_order_acquire)) {
            const std::lock_guard lock(making_);
            if (!value_) value_.emplace(std::forward<Make>(make)());
            made_.store(true, std::memory_order_release);
        }
        return *value_;
    }

private:
    mutable std::mutex making_;
    mutable std::atomic<bool> made_ = false;
    mutable std::optional<T> value_;
};

}  // namespace lyr
