// Line events on their way from the thread that computes them to the real-time thread that writes them, in a print and in
// what moves before it.
//
// Contract
//  1. put() waits for as long as the ring is full, and no longer than until `finished`.
//  2. drain() begins when the ring is full or holds all there will be; one that is not within the time of 3 is dry.
//     Events come out a few at a time, so that there is room again early.
//  3. A ring that has run dry is waited for, and what comes late by that is late as any other event (executor.h, 2
//     and 4). Where a stop was asked for, drain() ends after a tenth of a second of that, and at once if it was
//     twice; in any case after `most_dry`, and ran_dry() is true then: heat must not stay on a head that stands.
//  4. In drain() nothing is allocated or locked. naps() grows as long as it waits for events.

#pragma once

#include <algorithm>
#include <chrono>
#include <utility>

#include "target/run/event_ring.h"
#include "target/run/executor.h"

namespace lyr::run {

class EventFlow {
public:
    // 1 MiB, and two edges a step: 0.2 s at the 300,000 edges/s that are about the most a board's kernel writes, 0.4 s of
    // four axes at 20,000 steps/s each.
    static constexpr std::size_t ring_events = std::size_t{1} << 16;

    // `finished`: the real-time thread has ended.
    EventFlow(const StopRequests& stop_requests, const std::atomic<bool>& finished,
              std::chrono::milliseconds most_dry = std::chrono::seconds(5))
        : stop_requests_(stop_requests), finished_(finished), most_dry_(most_dry) {}

    void put(std::span<const LineEvent> events);
    // There are no more.
    void close();

    // `execute` is Executor's, or more; where it ends, so does this.
    template <typename Execute>
    Result<bool> drain(const Execute& execute) {
        constexpr std::size_t batch = 64;
        Clock::time_point dry_since = Clock::now();
        for (; !filled_.load() && !stops(); nap())
            if (Clock::now() - dry_since > most_dry_) return dry();
        for (bool is_dry = false; !ring_.ended();) {
            std::span<const LineEvent> events = ring_.view();
            if (events.empty()) {
                const Clock::time_point now = Clock::now();
                if (!std::exchange(is_dry, true)) dry_since = now;
                const bool is_left = now - dry_since > stop_wait || stop_requests_.load() > 1;
                if (stops() && is_left) return false;
                if (now - dry_since > most_dry_) return dry();
                nap();
                continue;
            }
            is_dry = false;
            events = events.first(std::min(batch, events.size()));
            Result<bool> executed = execute(events);
            if (!executed || !*executed) return executed;
            ring_.drop(events.size());
        }
        return true;
    }

    std::uint32_t naps() const { return naps_.load(std::memory_order_relaxed); }
    // After drain().
    bool ran_dry() const { return ran_dry_; }
    static Diagnostic dry_error();

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds stop_wait{100};

    bool dry() {
        ran_dry_ = true;
        return false;
    }
    bool stops() const { return stop_requests_.load() != 0; }
    void nap();

    const StopRequests& stop_requests_;
    const std::atomic<bool>& finished_;
    const std::chrono::milliseconds most_dry_;
    bool ran_dry_ = false;
    std::atomic<std::uint32_t> naps_{0};
    EventRing ring_{ring_events};
    std::atomic<bool> filled_{false};  // the ring is full, or all there will be is in it
};

}  // namespace lyr::run
