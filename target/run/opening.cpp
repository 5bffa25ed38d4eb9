#include "target/run/opening.h"

#include <utility>

#include "target/run/heating.h"

namespace lyr::run {

Opening::Opening(PrintControl& control, HeatDesk& desk, const StopSignals& signals,
                 PrintStatus status, std::function<void(double)> look)
    : control_(control),
      desk_(desk),
      signals_(signals),
      status_(std::move(status)),
      look_(std::move(look)),
      begun_s_(heat_time_s()) {
    status_.message = "homing before the print";
    status_.is_position_known = false;
}

unsigned Opening::asked() {
    StopRequests& stop = control_.stop_requests();
    if (signals_.wait_ms(0)) ++stop;
    const double now_s = heat_time_s();
    if (now_s >= next_s_) {
        next_s_ = now_s + look_s;
        look_(now_s);
        if (control_.ends() && stop.load() == 0) ++stop;
        publish(now_s);
    }
    const unsigned before = std::exchange(seen_, static_cast<unsigned>(stop.load()));
    return seen_ - before;
}

void Opening::publish(double now_s) {
    status_.state = control_.stop_requests().load() ? PrintState::stopping : PrintState::heating;
    status_.heaters = desk_.now().heaters;
    status_.elapsed_s = now_s - begun_s_;
    control_.publish(status_);
}

}  // namespace lyr::run
