// The same control as a print's, with the relay in the controller's place.

#include "target/run/tune.h"

#include <cstdio>

#include "base/text.h"
#include "target/run/demands.h"
#include "target/run/tended_heat.h"
#include "target/thermal/simulated_heat.h"

namespace lyr::run {
namespace {

// Of a heater so slow that a swing takes longer, or one that does not get colder than the target, there are no gains.
constexpr double longest_swing_s = 30 * 60;
// A room may be as warm, and without power no heater gets colder than that.
constexpr double coldest_target_c = 30;

Status check(const TuneJob& job) {
    const std::string name(config::heater_names[job.heater]);
    const auto& heater = job.printer.heaters[job.heater];
    if (!heater) return machine_error("printer \"" + job.printer.name + "\" has no heater." + name);
    const auto [low_c, high_c] = std::pair(heater->guard.low_c, heater->guard.high_c);
    if (job.target_c < coldest_target_c)
        return machine_error(
            formatted("heater %s cannot be tuned at %g °C: a heater must cool down below "
                      "its target, too, and a room is up to %g °C warm",
                      name.c_str(), job.target_c, coldest_target_c));
    if (job.target_c > low_c && job.target_c <= high_c - headroom_c) return Done{};
    char text[200];
    std::snprintf(text, sizeof text,
                  "heater %s cannot be tuned at %g °C: its range_c is %g to %g, and the last %g °C "
                  "are for overshoot",
                  name.c_str(), job.target_c, low_c, high_c, headroom_c);
    return machine_error(text);
}

void begin(const TuneJob& job, thermal::HeatControl& control) {
    control.set_target(job.heater, job.target_c);
    control.tune(job.heater,
                 thermal::RelayTune(job.target_c, job.printer.heaters[job.heater]->max_power));
}

// When a swing was seen last.
struct Swings {
    int seen = 0;
    double since_s = 0;
};

// None: not over yet.
std::optional<Result<thermal::TuneResult>> outcome(const TuneJob& job,
                                                   const thermal::HeatControl& control,
                                                   double time_s, Swings& swings) {
    const thermal::RelayTune& relay = *control.relay();
    if (job.progress)
        job.progress({time_s, control.status(job.heater)->temperature_c, relay.swings(),
                      thermal::RelayTune::settling_swings + thermal::RelayTune::measured_swings});
    if (control.trip()) return diagnostic_of(*control.trip());
    if (relay.finished()) {
        const auto result = relay.result();
        if (!result)
            return machine_error("the temperature did not swing: it follows the heater too fast");
        return *result;
    }
    if (relay.swings() != swings.seen) swings = {relay.swings(), time_s};
    if (time_s - swings.since_s > longest_swing_s)
        return machine_error(formatted(
            "the temperature did not swing about %g °C for %g minutes and is "
            "%.1f °C: the heater is too weak for it, or does not get colder",
            job.target_c, longest_swing_s / 60, control.status(job.heater)->temperature_c));
    return std::nullopt;
}

Result<thermal::TuneResult> simulated(const TuneJob& job) {
    thermal::SimulatedHeat heat(job.printer, job.faults);
    begin(job, heat.control());
    Swings swings;
    for (;;) {
        heat.advance_to(heat.time_s() + 1);
        if (auto over = outcome(job, heat.control(), heat.time_s(), swings))
            return std::move(*over);
    }
}

Result<thermal::TuneResult> real(const TuneJob& job) {
    const auto heat = TendedHeat::open(job.printer);
    if (!heat) return heat.error();
    begin(job, (*heat)->control());
    const double from_s = heat_time_s();
    Swings swings;
    for (;;) {
        if (std::optional<Diagnostic> why = (*heat)->tick()) return std::move(*why);
        if (auto over = outcome(job, (*heat)->control(), heat_time_s() - from_s, swings))
            return std::move(*over);
    }
}

}  // namespace

Result<thermal::TuneResult> tune(const TuneJob& job) {
    if (const Status possible = check(job); !possible) return possible.error();
    return job.simulate ? simulated(job) : real(job);
}

}  // namespace lyr::run
