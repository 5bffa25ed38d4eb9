// Absolute waits on CLOCK_MONOTONIC, and their virtual and counting counterparts.

#include "target/gpio/clock.h"

#include <time.h>

#include <algorithm>
#include <bit>

namespace lyr::gpio {
namespace {

constexpr std::int64_t ns_per_us = 1'000;

}  // namespace

std::int64_t MonotonicClock::now_ns() const {
    timespec time{};
    ::clock_gettime(CLOCK_MONOTONIC, &time);
    return ns_of(time);
}

std::int64_t MonotonicClock::wait_until_ns(std::int64_t time_ns) {
    std::int64_t now = now_ns();
    while (time_ns - now > awake_ns) {
        const timespec wake = timespec_of(time_ns - awake_ns);
        // A signal ends the sleep early; the loop then sleeps on for what is left.
        ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr);
        now = now_ns();
    }
    while (now < time_ns) now = now_ns();
    return now;
}

std::int64_t VirtualClock::wait_until_ns(std::int64_t time_ns) {
    const std::int64_t late_ns = lateness_ ? std::max<std::int64_t>(0, lateness_(time_ns)) : 0;
    now_ns_ = std::max(now_ns_, time_ns + late_ns);
    return now_ns_;
}

void VirtualClock::advance_ns(std::int64_t duration_ns) {
    now_ns_ += std::max<std::int64_t>(0, duration_ns);
}

std::int64_t TracingClock::wait_until_ns(std::int64_t time_ns) {
    const std::int64_t now = inner_.wait_until_ns(time_ns);
    const std::int64_t late_ns = std::max<std::int64_t>(0, now - time_ns);
    const auto late_us = static_cast<std::uint64_t>(late_ns / ns_per_us);
    ++histogram_[std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(late_us)),
                                       buckets - 1)];
    worst_ns_ = std::max(worst_ns_, late_ns);
    waits_.fetch_add(1, std::memory_order_relaxed);
    return now;
}

}  // namespace lyr::gpio
