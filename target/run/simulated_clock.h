// The simulator's clock: as it goes on, what is heated goes on with it.
//
// Contract
//  1. As a VirtualClock that is never late; and every thermal tick up to the time that a wait ends at is done, in order,
//     with its time.
//  2. A guard that fires is a request to stop.
//  3. After each tick `on_tick` is called with its time.

#pragma once

#include <algorithm>
#include <functional>

#include "target/gpio/clock.h"
#include "target/run/executor.h"
#include "target/run/heat_order.h"
#include "target/thermal/simulated_heat.h"

namespace lyr::run {

class SimulatedClock final : public gpio::Clock {
public:
    SimulatedClock(thermal::SimulatedHeat& heat, HeatAttendant& attendant, StopRequests& stop)
        : heat_(heat), attendant_(attendant), stop_(stop) {}

    std::function<void(double time_s)> on_tick;

    std::int64_t now_ns() const override { return now_ns_; }
    std::int64_t wait_until_ns(std::int64_t time_ns) override {
        if (next_tick_ns_ <= time_ns) tick_until(time_ns);
        return now_ns_ = std::max(now_ns_, time_ns);
    }

private:
    static constexpr std::int64_t tick_ns = 100'000'000;
    static_assert(thermal::tick_s == 0.1);

    void tick_until(std::int64_t time_ns);

    std::int64_t now_ns_ = 0;
    thermal::SimulatedHeat& heat_;
    HeatAttendant& attendant_;
    StopRequests& stop_;
    std::int64_t next_tick_ns_ = tick_ns;
};

}  // namespace lyr::run
