// Where the heaters' thread and the rest of a print meet, beside the orders that come with the path: what a user or a
// pause asks of heaters, and how warm they are.
//
// Contract
//  1. What is asked is carried out with the next tick of HeatAttendant, before the orders of the path. A target that was
//     set holds until the next one, be it asked for here or by the path.
//  2. A heater on standby gets no power and keeps the target that it will have again; while one is, no order of the path
//     is carried out.
//  3. has_seen(): all that was asked has been carried out, and now() is after that; settled(): and every heater has
//     reached its target or is warmer.

#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <optional>

#include "format/operation.h"
#include "target/config/printer.h"

namespace lyr::run {

struct HeaterNow {
    bool is_present = false;
    double temperature_c = 0, target_c = 0;  // as measured; 0: off
};
using HeatersNow = std::array<HeaterNow, config::heater_count>;

struct HeatNow {
    HeatersNow heaters{};
    double fan = 0;
    bool waits = false;                          // the path does, for a temperature
    bool reached = false;                        // all targets, or passed
    std::optional<format::PauseReason> pause{};  // that the path asks for and waits in
};

struct HeatWish {
    std::array<std::optional<double>, config::heater_count> targets_c{};
    std::optional<double> fan{};
    std::array<bool, config::heater_count> standby{};
    bool pause_is_over = false;
};

class HeatDesk {
public:
    void set_target(std::size_t heater, double target_c);
    void set_fan(double duty);
    void set_standby(const std::array<bool, config::heater_count>& standby);
    // Of the path: it goes on.
    void end_pause();
    HeatNow now() const;
    bool has_seen() const;
    bool settled() const;

    // For the attendant.
    HeatWish take();
    void publish(const HeatNow& now);

private:
    mutable std::mutex mutex_;
    HeatWish wish_;
    HeatNow now_;
    std::uint64_t asked_ = 0, taken_ = 0, seen_ = 0;  // wishes: made, taken, and in effect in now_
};

}  // namespace lyr::run
