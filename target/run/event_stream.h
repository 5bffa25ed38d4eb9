// From a .lyr file to line events: everything that a print computes ahead of time, pulled by whoever
// writes the lines. The real-time thread's feeder and the simulator run this same code.
//
// Contract
//  1. The first event switches the motor drivers on, `driver_wake_ns` before the first step may come.
//  2. Memory is bounded: it does not grow with the file.
//  3. Events are in order of time.

#pragma once

#include <vector>

#include "target/run/pulse_schedule.h"
#include "target/run/step_stream.h"

namespace lyr::run {

class EventStream {
public:
    // Drivers answer about this long after their enable line; a few ms are a good millisecond more than
    // data sheets state.
    static constexpr std::int64_t driver_wake_ns = 5'000'000;

    static Result<EventStream> open(const std::string& path, const config::Printer& printer,
                                    double filament_diameter_mm, OrderQueue* orders = nullptr,
                                    std::uint32_t first_layer = 0);
    // `path` is for messages.
    static Result<EventStream> open(format::Reader reader, const std::string& path,
                                    const config::Printer& printer, double filament_diameter_mm,
                                    OrderQueue* orders);

    // Appends the next events; false: these were the last.
    Result<bool> next(std::vector<LineEvent>& events);
    // The halves of that, which share nothing: the next steps, and the events that they become; the last ones with the time
    // at which they end.
    Result<bool> next(std::vector<Step>& steps) { return steps_.next(steps); }
    void append(std::span<const Step> steps, std::optional<std::int64_t> end_ns,
                std::vector<LineEvent>& events);

    void heed_speed(const std::atomic<float>& factor) { steps_.heed_speed(factor); }
    void begin_drawn_back(double mm) { steps_.begin_drawn_back(mm); }

    const StepStream& steps() const { return steps_; }
    const PulseSchedule& schedule() const { return schedule_; }
    PulseSchedule& schedule() { return schedule_; }

private:
    EventStream(StepStream steps, PulseSchedule schedule)
        : steps_(std::move(steps)), schedule_(std::move(schedule)) {}

    StepStream steps_;
    PulseSchedule schedule_;
    std::vector<Step> batch_;
    bool begun_ = false;
};

}  // namespace lyr::run
