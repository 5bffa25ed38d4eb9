// Contract of target/gpio/clock.h, by number.

#include "target/gpio/clock.h"

#include <doctest/doctest.h>

#include <array>
#include <numeric>

using namespace lyr::gpio;

TEST_CASE("clock 1, 2: the monotonic clock never goes back and never ends a wait early") {
    MonotonicClock clock;
    std::int64_t last = clock.now_ns();
    for (const std::int64_t wait_ns : {0, 1'000, 50'000, 250'000, 2'000'000, -5'000}) {
        const std::int64_t target = clock.now_ns() + wait_ns;
        const std::int64_t now = clock.wait_until_ns(target);
        CHECK(now >= target);
        CHECK(now >= last);
        last = now;
    }
}

TEST_CASE("clock 3: waits by absolute time do not add up their errors") {
    MonotonicClock clock;
    const std::int64_t start = clock.now_ns();
    constexpr int waits = 50;
    constexpr std::int64_t step_ns = 300'000;
    for (int i = 1; i <= waits; ++i) clock.wait_until_ns(start + i * step_ns);
    // A loaded machine may be late once, but not fifty times over.
    CHECK(clock.now_ns() - start >= waits * step_ns);
    CHECK(clock.now_ns() - start < 2 * waits * step_ns);
}

TEST_CASE("clock 4: virtual waits end exactly at their time, and the past takes none") {
    VirtualClock clock;
    CHECK(clock.wait_until_ns(1'000) == 1'000);
    CHECK(clock.wait_until_ns(400) == 1'000);
    clock.advance_ns(50);
    CHECK(clock.now_ns() == 1'050);
    clock.advance_ns(-50);
    CHECK(clock.now_ns() == 1'050);
}

TEST_CASE("clock 4: virtual lateness is added to the wait, and is never negative") {
    VirtualClock clock([](std::int64_t time_ns) { return time_ns == 200 ? 70 : -10; });
    CHECK(clock.wait_until_ns(100) == 100);
    CHECK(clock.wait_until_ns(200) == 270);
    CHECK(clock.wait_until_ns(250) == 270);
}

TEST_CASE("clock 5: the tracing clock counts every wait by how late it ended") {
    std::int64_t late_ns = 0;
    VirtualClock inner([&](std::int64_t) { return late_ns; });
    TracingClock clock(inner);
    std::int64_t time_ns = 0;
    for (const std::int64_t late :
         std::array<std::int64_t, 5>{0, 999, 1'000, 3'000, 40'000'000'000'000}) {
        late_ns = late;
        time_ns = clock.wait_until_ns(time_ns + 10);
    }
    CHECK(clock.histogram()[0] == 2);
    CHECK(clock.histogram()[1] == 1);
    CHECK(clock.histogram()[2] == 1);
    CHECK(clock.histogram()[TracingClock::buckets - 1] == 1);
    CHECK(std::accumulate(clock.histogram().begin(), clock.histogram().end(), 0ULL) == 5);
    CHECK(clock.worst_ns() == 40'000'000'000'000);
    CHECK(clock.now_ns() == inner.now_ns());
}
