#include "target/run/course.h"

#include <algorithm>

namespace lyr::run {
namespace {

// How long the real-time thread sleeps at rest before it looks for what comes next.
constexpr std::int64_t rest_nap_ns = 5'000'000;

// A few events at a time, and where the head is by then.
Result<bool> make(std::span<const LineEvent> trip, Executor& executor, Course& course) {
    constexpr std::size_t batch = 64;
    Result<bool> made = true;
    executor.begin_trip();
    for (; made && *made && !trip.empty(); trip = trip.subspan(std::min(batch, trip.size()))) {
        made = executor.execute(trip.first(std::min(batch, trip.size())));
        course.tell(executor);
    }
    executor.end_trip();
    return made;
}

// True: go on along the path.
Result<bool> rest(Executor& executor, Course& course, gpio::Clock& clock,
                  const StopRequests& stop_requests) {
    course.tell(executor);
    course.at_rest.store(true, std::memory_order_release);
    while (stop_requests.load(std::memory_order_relaxed) == 0) {
        if (const Trip* trip = course.trip.load(std::memory_order_acquire)) {
            const Result<bool> made = make(*trip, executor, course);
            if (!made || !*made) return made;
            course.trip.store(nullptr, std::memory_order_release);
        } else if (course.wanted_pace.load(std::memory_order_relaxed) > 0 &&
                   !course.at_end.load(std::memory_order_acquire)) {
            course.at_rest.store(false, std::memory_order_release);
            executor.go_on();
            return true;
        } else {
            clock.wait_until_ns(clock.now_ns() + rest_nap_ns);
        }
    }
    return false;
}

}  // namespace

void Course::tell(const Executor& executor) {
    for (std::size_t i = 0; i < path_steps.size(); ++i) {
        path_steps[i].store(executor.positions()[i], std::memory_order_relaxed);
        trip_steps[i].store(executor.trip_steps()[i], std::memory_order_relaxed);
    }
    levels.store(executor.levels(), std::memory_order_relaxed);
    started.store(executor.started(), std::memory_order_relaxed);
    time_ns.store(executor.time_ns(), std::memory_order_release);
}

StepPositions Course::steps() const {
    StepPositions steps = steps_on_path();
    for (std::size_t i = 0; i < steps.size(); ++i)
        steps[i] += trip_steps[i].load(std::memory_order_relaxed);
    return steps;
}

StepPositions Course::steps_on_path() const {
    StepPositions steps{};
    for (std::size_t i = 0; i < steps.size(); ++i)
        steps[i] = path_steps[i].load(std::memory_order_relaxed);
    return steps;
}

Result<bool> follow(std::span<const LineEvent> events, Executor& executor, Course& course,
                    gpio::Clock& clock, const StopRequests& stop_requests) {
    for (;;) {
        const Result<bool> executed = executor.execute(events);
        course.tell(executor);
        if (!executed || *executed) return executed;
        events = events.subspan(executor.taken());
        const Result<bool> goes_on = rest(executor, course, clock, stop_requests);
        if (!goes_on || !*goes_on) return goes_on;
    }
}

Result<bool> finish(const LineEvent& last, Executor& executor, Course& course, gpio::Clock& clock,
                    const StopRequests& stop_requests) {
    course.at_end.store(true);
    const Result<bool> goes_on = rest(executor, course, clock, stop_requests);
    if (!goes_on || !*goes_on) return goes_on;
    return follow(std::span(&last, 1), executor, course, clock, stop_requests);
}

void LayerLog::begin(std::span<const LayerBegin> layers, std::int64_t shift_ns) {
    const std::lock_guard lock(mutex_);
    for (const LayerBegin& layer : layers) {
        coming_.push_back(layer);
        coming_.back().time_ns += shift_ns;
    }
}

LayerBegin LayerLog::at(std::int64_t time_ns) {
    const std::lock_guard lock(mutex_);
    for (; !coming_.empty() && coming_.front().time_ns <= time_ns; coming_.pop_front())
        reached_ = coming_.front();
    return reached_;
}

}  // namespace lyr::run
