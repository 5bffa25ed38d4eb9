// Time as the printer side knows it: a clock that can be read and waited on. The real one is the
// kernel's monotonic clock; the virtual one makes the simulator out of the real program.
//
// Contract
//  1. now_ns() never goes back.
//  2. wait_until_ns(t) returns the time after the wait, and never before t.
//  3. MonotonicClock sleeps by absolute time, so that errors of single waits do not add up, and
//  spends
//     the last stretch of a wait awake, since waking up takes longer than a step may be late.
//  4. VirtualClock takes no real time. A wait ends exactly at t, or later by what the lateness
//  function
//     says; a wait for the past takes no time.
//  5. TracingClock passes everything on to another clock and keeps a histogram of how late waits
//  ended. Any thread may look at the number of waits(), which tells whether its owner goes on.

#pragma once

#include <time.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>

namespace lyr::gpio {

// As the kernel's calls have it.
constexpr std::int64_t ns_of(const timespec& time) {
    return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}
constexpr timespec timespec_of(std::int64_t time_ns) {
    return {static_cast<time_t>(time_ns / 1'000'000'000),
            static_cast<long>(time_ns % 1'000'000'000)};
}

class Clock {
public:
    virtual ~Clock() = default;
    virtual std::int64_t now_ns() const = 0;
    virtual std::int64_t wait_until_ns(std::int64_t time_ns) = 0;
};

class MonotonicClock final : public Clock {
public:
    // A stock kernel wakes a sleeper up to about this much too late; a wait stays awake for the
    // last so many nanoseconds instead.
    static constexpr std::int64_t awake_ns = 100'000;

    std::int64_t now_ns() const override;
    std::int64_t wait_until_ns(std::int64_t time_ns) override;
};

class VirtualClock final : public Clock {
public:
    // How much later than asked the wait for `time_ns` ends; negative values count as 0.
    using Lateness = std::function<std::int64_t(std::int64_t time_ns)>;

    explicit VirtualClock(Lateness lateness = {}) : lateness_(std::move(lateness)) {}
    std::int64_t now_ns() const override { return now_ns_; }
    std::int64_t wait_until_ns(std::int64_t time_ns) override;
    // Time that something other than a wait takes, such as a slow write.
    void advance_ns(std::int64_t duration_ns);

private:
    std::int64_t now_ns_ = 0;
    Lateness lateness_;
};

class TracingClock final : public Clock {
public:
    // Bucket 0 counts waits less than 1 us late, bucket k those from 2^(k-1) up to 2^k us; the last
    // bucket has no upper end.
    static constexpr std::size_t buckets = 20;

    explicit TracingClock(Clock& inner) : inner_(inner) {}
    std::int64_t now_ns() const override { return inner_.now_ns(); }
    std::int64_t wait_until_ns(std::int64_t time_ns) override;

    const std::array<std::uint64_t, buckets>& histogram() const { return histogram_; }
    std::int64_t worst_ns() const { return worst_ns_; }
    std::uint32_t waits() const { return waits_.load(std::memory_order_relaxed); }

private:
    Clock& inner_;
    std::array<std::uint64_t, buckets> histogram_{};
    std::int64_t worst_ns_ = 0;
    std::atomic<std::uint32_t> waits_{0};
};

}  // namespace lyr::gpio
