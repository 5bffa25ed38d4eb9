// How the real-time thread and the life of a print (life.h) share the path: one asks for rest, trips and a pace, the
// other says where it is. A simulation is both in turn.
//
// Contract
//  1. follow() writes all events, and in between rests and makes trips as asked; false: stopped for good. It returns
//     only then, or with an error.
//  2. While `at_rest`, nothing is written but a trip; that is taken off when it has been made. The numbers are those
//     at rest, but for the steps of a trip, which are told on the way.
//  3. Nothing is allocated or locked, and a trip is read only.
//  4. finish() writes the last event of the path, but rests before it, for trips, until `at_end` is taken back.

#pragma once

#include <array>
#include <atomic>
#include <deque>
#include <mutex>
#include <vector>

#include "target/run/executor.h"
#include "target/run/step_stream.h"

namespace lyr::run {

using Trip = std::vector<LineEvent>;

struct Course {
    WantedPace wanted_pace{1};
    std::atomic<float> plan_factor{1};  // of speeds, for what is planned from now on
    std::atomic<const Trip*> trip{nullptr};

    std::atomic<bool> at_rest{false};
    std::atomic<bool> at_end{false};       // of the path, but for its last event
    std::atomic<bool> started{false};      // the drivers are on, and the head is on its way
    std::atomic<std::int64_t> time_ns{0};  // of the events
    std::atomic<gpio::LineMask> levels{0};
    // Of the path, and of trips, since the start.
    std::array<std::atomic<std::int64_t>, config::axis_count> path_steps{}, trip_steps{};

    void tell(const Executor& executor);
    // Since the start.
    StepPositions steps() const;
    StepPositions steps_on_path() const;
};

Result<bool> follow(std::span<const LineEvent> events, Executor& executor, Course& course,
                    gpio::Clock& clock, const StopRequests& stop_requests);

Result<bool> finish(const LineEvent& last, Executor& executor, Course& course, gpio::Clock& clock,
                    const StopRequests& stop_requests);

// Which layer the head is in, and how fast it was planned: the planning thread knows long before.
class LayerLog {
public:
    void begin(std::span<const LayerBegin> layers, std::int64_t shift_ns);
    LayerBegin at(std::int64_t time_ns);

private:
    std::mutex mutex_;
    std::deque<LayerBegin> coming_;
    LayerBegin reached_;
};

}  // namespace lyr::run
