// Contract of target/run/event_flow.h, by number.

#include "target/run/event_flow.h"

#include <doctest/doctest.h>

#include <thread>

using namespace lyr;
using namespace lyr::run;

namespace {

// Nothing is ever put there; the time for that is short.
bool runs_dry_at_begin(const StopRequests& stop_requests) {
    const std::atomic<bool> finished{false};
    EventFlow flow(stop_requests, finished, std::chrono::milliseconds(1));
    const Result<bool> drained =
        flow.drain([](std::span<const LineEvent>) -> Result<bool> { return true; });
    REQUIRE(drained.ok());
    CHECK_FALSE(*drained);
    return flow.ran_dry();
}

}  // namespace

TEST_CASE(
    "event flow 3: a planner that hung left the head where it was, and the heat on, for ever") {
    const StopRequests stop_requests{0};
    std::atomic<bool> finished{false};
    EventFlow flow(stop_requests, finished, std::chrono::seconds(1));
    std::vector<LineEvent> events(EventFlow::ring_events);
    for (std::size_t i = 0; i < events.size(); ++i)
        events[i].time_ns = static_cast<std::int64_t>(i);
    std::thread planner([&] {
        flow.put(events);
        flow.put(std::span(events).first(1));  // full now: it may begin
    });
    std::size_t taken = 0;
    const Result<bool> drained = flow.drain([&](std::span<const LineEvent> few) -> Result<bool> {
        taken += few.size();
        return true;
    });
    finished.store(true);
    planner.join();
    REQUIRE(drained.ok());
    CHECK_FALSE(*drained);
    CHECK(flow.ran_dry());
    CHECK(EventFlow::dry_error().status == ExitStatus::machine);
    CHECK(taken == events.size() + 1);
}

TEST_CASE("event flow 2, 3: all comes out, and a second request to stop ends it at once") {
    for (const int requests : {0, 2}) {
        const StopRequests stop_requests{requests};
        const std::atomic<bool> finished{false};
        EventFlow flow(stop_requests, finished);
        const std::vector<LineEvent> events(1000);
        flow.put(events);
        if (requests == 0) flow.close();
        std::size_t taken = 0;
        const Result<bool> drained =
            flow.drain([&](std::span<const LineEvent> few) -> Result<bool> {
                taken += few.size();
                return true;
            });
        REQUIRE(drained.ok());
        CHECK(*drained == (requests == 0));
        CHECK_FALSE(flow.ran_dry());
        CHECK(taken == events.size());
    }
}

TEST_CASE("event flow 2: a planner that hung before the path began kept the heat on for ever") {
    CHECK(runs_dry_at_begin(StopRequests(0)));
}

TEST_CASE("event flow 3: a ring that is dry is left at once where a stop was asked for twice") {
    CHECK_FALSE(runs_dry_at_begin(StopRequests(2)));
}
