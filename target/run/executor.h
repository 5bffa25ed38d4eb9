// Writes line events at their times: the one part of a print that runs on the real-time thread. The
// same code serves a board (real clock, real lines) and the simulator (virtual clock, mock lines).
//
// Contract
//  1. Every event is written once, in order, never before its time. The time base starts with the first
//     event, at the moment when execute() is first called.
//  2. A late step delays all that follow: from one step to a later one there is never less time than between their
//     events. No event is left out to catch up. The end of a pulse and a turn may come late without delaying more than 3
//     asks: where a write takes as long as a pulse, they always do.
//  3. From the end of one write to the begin of a later one there is at least the time between their events, or
//     edge_gap_ns if that is less. So the times of pulses and direction lines hold in any weather.
//  4. An event that comes later than late_limit_ns ends the print with a diagnostic (status machine).
//  5. After a first request to stop, time is stretched more and more, so that the head comes to rest on
//     its path within about braking_ns and no axis loses steps; then execute() returns false. A second
//     request stops at once. Pulses that are out then, as those of several axes may be all the time, are ended
//     together, edge_gap_ns after the last write; their steps are made and counted. A long wait is left within
//     wait_slice_ns. Before the first event a request ends it without a write. taken() events have been written then.
//  6. A failed write ends the print with its diagnostic.
//  7. At a mark the count of those reached is stored; at a gate no further event is written until as many orders are
//     done. The time spent there counts as neither time of events nor lateness. Without `marks` both are passed by.
//  8. Nothing is allocated, locked or logged, and no call is made but wait and write. Those calls are virtual; after
//     bind() those of each event are the types' own, which may take less time than a call.
//  9. Time runs at the pace that is wanted, a share of the planned one, and follows a new one as evenly as in
//     braking. A wanted pace of 0 brings the head to rest as 5 does; after go_on() the events from taken() on follow, and
//     the head gains speed as it lost it. No event is left out or doubled by that; the end of a pulse that was ended
//     at rest changes no line any more.
// 10. A trip is a train of events of its own, at rest on both ends, written between two events of the path at its own
//     full pace. A request to stop brings it to rest, too; a wanted pace does not.
// 11. positions() counts the rising edges of the path, trip_steps() those of trips.

#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>

#include "target/gpio/clock.h"
#include "target/gpio/gpio_chip.h"
#include "target/run/heat_order.h"
#include "target/run/pulse_decoder.h"
#include "target/run/pulse_schedule.h"

namespace lyr::run {

struct ExecutorTiming {
    std::int64_t edge_gap_ns = 0;  // the longest time that a driver needs between two edges
    std::int64_t late_limit_ns = 0;
    std::int64_t braking_ns = 0;  // from full speed to rest
};

// From that speed to rest.
std::int64_t braking_ns(const config::Axis& axis, double speed_mm_s);
ExecutorTiming executor_timing(const config::Printer& printer);

// Requests to stop so far; a signal handler counts it up.
using StopRequests = std::atomic<int>;
static_assert(StopRequests::is_always_lock_free);

// 0: rest; 1: as planned.
using WantedPace = std::atomic<float>;
static_assert(WantedPace::is_always_lock_free);

class Executor {
public:
    static constexpr std::int64_t wait_slice_ns = 50'000'000;

    Executor(gpio::GpioChip& chip, gpio::Clock& clock, ExecutorTiming timing,
             const StopRequests& stop_requests, Marks* marks = nullptr,
             const WantedPace* wanted_pace = nullptr);

    // The chip and the clock are of these types. Who calls it includes executor_loop.h.
    template <class Chip, class Timer>
    void bind() {
        run_ = &Executor::run<Chip, Timer>;
    }

    // True: all written. False: at rest on request; what is left of the events is for after go_on(), or for nobody.
    Result<bool> execute(std::span<const LineEvent> events) { return (this->*run_)(events); }
    // Of the last call of execute().
    std::size_t taken() const { return taken_; }
    void go_on();
    // In between, execute() is for a trip, whose events begin and end with levels().
    void begin_trip();
    void end_trip();

    // Of the event written last, on the time base of the events.
    std::int64_t time_ns() const { return on_trip_ ? path_ns_ : last_event_ns_; }
    // How much longer the print has taken than its events say; braking is not counted.
    std::int64_t stretched_ns() const { return stretched_ns_; }
    std::int64_t worst_late_ns() const { return worst_late_ns_; }
    std::uint64_t writes() const { return writes_; }
    // Spent at gates.
    std::int64_t waited_ns() const { return waited_ns_; }
    // What the clock showed, less the time of the event itself, when the path's last one was written, or is being written:
    // waits, rests and braking make it grow.
    std::int64_t behind_ns() const { return behind_ns_; }
    // How much of that has come since the path began.
    std::int64_t delayed_ns() const { return behind_ns_ - begun_behind_ns_; }

    bool started() const { return started_; }
    bool on_trip() const { return on_trip_; }
    gpio::LineMask levels() const { return levels_; }
    const StepPositions& positions() const { return positions_; }
    const StepPositions& trip_steps() const { return trip_steps_; }

private:
    using Run = Result<bool> (Executor::*)(std::span<const LineEvent> events);

    // In executor_loop.h, what is done for each event.
    template <class Chip, class Timer>
    Result<bool> run(std::span<const LineEvent> events);
    // Of a long wait. False: left on request.
    bool wait_for_last_slice(std::int64_t time_ns);
    // Of step lines that have risen.
    static void count(gpio::LineMask rises, gpio::LineMask levels, StepPositions& positions);
    float target_pace() const;

    void start(const LineEvent& event);
    // Clock time between the last event and one `gap_ns` after it, longer while braking; none if the
    // head is at rest and shall stay there.
    std::optional<std::int64_t> paced_gap_ns(std::int64_t gap_ns, float target);
    // Ends the pulses that are out. Always false, or what failed.
    Result<bool> rest();
    // False: left on request.
    bool pass_mark(gpio::LineMask toggled);
    Diagnostic too_late(std::int64_t late_ns) const;

    gpio::GpioChip& chip_;
    gpio::Clock& clock_;
    ExecutorTiming timing_;
    const StopRequests& stop_requests_;
    Marks* marks_;
    const WantedPace* wanted_pace_;
    Run run_;
    bool started_ = false;  // an event of the path has been written, or is about to
    bool rebased_ = true;   // the next event is the first of its time base
    bool on_trip_ = false;
    std::size_t taken_ = 0;
    gpio::LineMask levels_ = 0;
    gpio::LineMask ended_ =
        0;  // step lines that are low at rest, and high in the path's events until their pulse ends
    std::int64_t last_event_ns_ = 0;
    std::int64_t last_begin_ns_ =
        0;  // of the last write, on the clock; of one without a step, when it was due
    std::int64_t last_end_ns_ = 0;
    double pace_ = 1;  // of time: 1 full speed, 0 rest
    std::int64_t stretched_ns_ = 0;
    std::int64_t worst_late_ns_ = 0;
    std::uint64_t writes_ = 0;
    std::uint32_t marks_reached_ = 0;
    bool at_gate_ = false;  // reached, and not passed yet
    std::int64_t waited_ns_ = 0;
    std::int64_t path_ns_ = 0;  // time() of the path while on a trip
    std::int64_t behind_ns_ = 0, begun_behind_ns_ = 0;
    StepPositions positions_{}, trip_steps_{};
};

}  // namespace lyr::run
