#include "target/run/simulated_clock.h"

#include "base/constants.h"

namespace lyr::run {

void SimulatedClock::tick_until(std::int64_t time_ns) {
    for (; next_tick_ns_ <= time_ns; next_tick_ns_ += tick_ns) {
        now_ns_ = std::max(now_ns_, next_tick_ns_);
        const double time_s = static_cast<double>(next_tick_ns_) / ns_per_s;
        heat_.advance_to(time_s);
        attendant_.tick();
        if (heat_.control().trip() && stop_.load() == 0) ++stop_;
        if (on_tick) on_tick(time_s);
    }
}

}  // namespace lyr::run
