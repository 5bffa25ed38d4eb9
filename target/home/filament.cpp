// A trip of the extruder alone, made by a thread beside the one that looks after the heat.

#include "target/home/filament.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/text.h"
#include "target/gpio/gpiod_chip.h"
#include "target/gpio/mock_chip.h"
#include "target/home/beside.h"
#include "target/run/demands.h"
#include "target/run/real_time.h"
#include "target/run/tended_heat.h"
#include "target/run/trip.h"
#include "target/thermal/simulated_heat.h"

namespace lyr::home {
namespace {

using Push = std::vector<run::LineEvent>;

Status check(const config::Printer& printer, double feed_mm, const std::optional<double>& tool_c) {
    if (std::abs(feed_mm) > most_fed_mm)
        return machine_error(
            formatted("%g mm of filament at once are too many: move %g mm at the most, and go on "
                      "with the next",
                      feed_mm, most_fed_mm));
    const auto& tool = printer.heaters[config::heater_tool];
    if (!tool && tool_c)
        return machine_error("printer \"" + printer.name + "\" has no heater.tool");
    if (!tool || (tool->min_extrude_c <= 0 && !tool_c)) return Done{};
    const double most_c = tool->guard.high_c - run::headroom_c;
    if (tool_c && *tool_c >= tool->min_extrude_c && *tool_c <= most_c) return Done{};
    return machine_error(formatted("filament is moved with the tool at %g to %g °C: give --tool C",
                                   tool->min_extrude_c, most_c));
}

// Heat and whoever may stop it: a tick of thermal::tick_s.
using Tick = std::function<std::optional<Diagnostic>()>;

Status warm_up(thermal::HeatControl& control, const Tick& tick) {
    for (double waited_s = 0; !control.reached(config::heater_tool); waited_s += thermal::tick_s) {
        if (std::optional<Diagnostic> why = tick()) return std::move(*why);
        if (waited_s > run::longest_wait_s)
            return machine_error("the tool has not become warm within an hour");
    }
    return Done{};
}

double speed_mm_s(const config::Printer& printer) {
    return std::min(printer.filament.speed_mm_s, careful_mm_s);
}

// All of it, before there is heat: whoever plans looks after nothing else.
Result<Push> push_of(const config::Printer& printer, double feed_mm) {
    const motion::Point here{printer.start_mm[0], printer.start_mm[1], printer.start_mm[2]};
    const run::Leg leg{here, feed_mm, speed_mm_s(printer)};
    return run::plan_trip(printer, here, std::span(&leg, 1), run::line_layout(printer).enable);
}

// Where the motor's lines and the heat are.
struct Place {
    gpio::GpioChip& chip;
    gpio::Clock& clock;
    thermal::HeatControl& control;
    Tick tick;
};

using Execute = std::function<Result<bool>(run::Executor&, run::StopRequests&)>;

Result<Fed> feed_at(const Place& place, const config::Printer& printer, double tool_c,
                    const Execute& execute) {
    place.control.set_target(config::heater_tool, tool_c);
    if (const Status warm = warm_up(place.control, place.tick); !warm) return warm.error();
    run::StopRequests stop{0};
    run::Executor executor(place.chip, place.clock, run::executor_timing(printer), stop);
    const Result<bool> executed = execute(executor, stop);
    if (!executed) return executed.error();
    if (const Status released = place.chip.release(); !released) return released.error();
    return Fed{executor.positions()[config::axis_e], speed_mm_s(printer), {}};
}

Result<Fed> on_board(const config::Printer& printer, const Push& push, double tool_c) {
    if (const Status has = run::check_cpu(printer.timing.cpu); !has) return has.error();
    const Result<std::vector<gpio::LineRequest>> requests = run::line_requests(printer);
    if (!requests) return requests.error();
    const auto heat = run::TendedHeat::open(printer);
    if (!heat) return heat.error();
    const auto chip = gpio::open_gpiod_chip(*requests);
    if (!chip) return chip.error();
    gpio::MonotonicClock clock;
    Diagnostics warnings;
    run::lock_memory(warnings);
    run::try_precedence(printer.timing.cpu, warnings);
    const Tick tick = [&] { return (*heat)->tick(); };
    const Execute beside = [&](run::Executor& executor, run::StopRequests& stop) {
        Result<bool> executed = true;
        std::atomic<bool> finished{false};
        Beside threads{stop, finished};
        threads.edges = std::thread([&] {
            Diagnostics told_before;
            run::take_precedence(printer.timing.cpu, told_before);
            executed = executor.execute(push);
            finished.store(true);
        });
        std::optional<Diagnostic> why;
        while (!why && !finished.load()) why = tick();
        if (why) ++stop;
        threads.join();
        return why ? Result<bool>(std::move(*why)) : executed;
    };
    Result<Fed> fed = feed_at({**chip, clock, (*heat)->control(), tick}, printer, tool_c, beside);
    if (fed) fed->warnings = std::move(warnings);
    return fed;
}

Result<Fed> simulated(const Job& job, const Push& push, double tool_c) {
    thermal::SimulatedHeat heat(job.printer, job.faults);
    gpio::VirtualClock clock;
    gpio::MockChip chip(gpio::max_lines, clock, {});
    const Tick tick = [&]() -> std::optional<Diagnostic> {
        heat.advance_to(heat.time_s() + thermal::tick_s);
        if (!heat.control().trip()) return std::nullopt;
        return run::diagnostic_of(*heat.control().trip());
    };
    const Execute in_turn = [&](run::Executor& executor, run::StopRequests&) -> Result<bool> {
        for (double s = 0; s * ns_per_s < static_cast<double>(push.back().time_ns);
             s += thermal::tick_s)
            if (std::optional<Diagnostic> why = tick()) return std::move(*why);
        return executor.execute(push);
    };
    return feed_at({chip, clock, heat.control(), tick}, job.printer, tool_c, in_turn);
}

}  // namespace

Result<Fed> feed(const Job& job, double feed_mm, std::optional<double> tool_c) {
    if (const Status possible = check(job.printer, feed_mm, tool_c); !possible)
        return possible.error();
    const Result<Push> push = push_of(job.printer, feed_mm);
    if (!push) return push.error();
    const double target_c = tool_c.value_or(0);
    return job.simulate ? simulated(job, *push, target_c) : on_board(job.printer, *push, target_c);
}

}  // namespace lyr::home
