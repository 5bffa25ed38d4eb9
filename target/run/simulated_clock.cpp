#include "target/run/simulated_clock.h"

#include "base/constants.h"

namespace lyr::run {

std::int64_t SimulatedClock::wait_until_ns(std::int64_t time_ns) {
    for (; next_tick_ns_ <= time_ns; next_tick_ns_ += tick_ns) {
        clock_.wait_until_ns(next_tick_ns_);
        const double time_s = static_cast<double>(next_tick_ns_) / ns_per_s;
        heat_.advance_to(time_s);
        attendant_.tick();
        if (heat_.control().trip() && stop_.load() == 0) ++stop_;
        if (on_tick) on_tick(time_s);
    }
    return clock_.wait_until_ns(time_ns);
}

}  // namespace lyr::run
