// The one queue between planning and the real-time thread: a bounded ring of line events with one
// producer and one consumer.
//
// Contract
//  1. Events come out once each, in the order in which they went in.
//  2. Neither side takes a lock or allocates. push() and view()/drop() return at once.
//  3. After close(), ended() is true for the consumer once everything has come out.

#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

#include "target/run/pulse_schedule.h"

namespace lyr::run {

class EventRing {
public:
    // `capacity` is a power of two.
    explicit EventRing(std::size_t capacity) : events_(capacity) {}

    // Producer: appends what there is room for and returns how many that were.
    std::size_t push(std::span<const LineEvent> events) {
        const std::size_t written = written_.load(std::memory_order_relaxed);
        const std::size_t room = events_.size() - (written - read_.load(std::memory_order_acquire));
        const std::size_t count = std::min(room, events.size());
        for (std::size_t i = 0; i < count; ++i)
            events_[(written + i) & (events_.size() - 1)] = events[i];
        written_.store(written + count, std::memory_order_release);
        return count;
    }
    void close() { closed_.store(true, std::memory_order_release); }

    // Consumer: the longest run of waiting events that lie side by side; valid until they are dropped.
    std::span<const LineEvent> view() const {
        const std::size_t read = read_.load(std::memory_order_relaxed);
        const std::size_t waiting = written_.load(std::memory_order_acquire) - read;
        const std::size_t from = read & (events_.size() - 1);
        return {events_.data() + from, std::min(waiting, events_.size() - from)};
    }
    void drop(std::size_t count) {
        read_.store(read_.load(std::memory_order_relaxed) + count, std::memory_order_release);
    }
    // Closed and empty.
    bool ended() const { return closed_.load(std::memory_order_acquire) && view().empty(); }

private:
    std::vector<LineEvent> events_;
    // Apart, so that the two threads do not wait for each other's cache line.
    static constexpr std::size_t cache_line_bytes = 64;
    alignas(cache_line_bytes) std::atomic<std::size_t> written_{0};
    alignas(cache_line_bytes) std::atomic<std::size_t> read_{0};
    alignas(cache_line_bytes) std::atomic<bool> closed_{false};
};

}  // namespace lyr::run
