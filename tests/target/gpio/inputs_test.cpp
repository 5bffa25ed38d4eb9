// Contracts of InputLines as the mock keeps it, of the trace around it, of debouncing and of what can be told of real
// inputs without a board, by number.

#include <doctest/doctest.h>

#include <array>
#include <random>
#include <vector>

#include "target/gpio/debounce.h"
#include "target/gpio/gpiod_inputs.h"
#include "target/gpio/mock_inputs.h"
#include "target/gpio/tracing_inputs.h"

using namespace lyr;
using namespace lyr::gpio;

TEST_CASE(
    "inputs 1, 2, 3: every change is one edge with its time, in order, and none is lost for want "
    "of room") {
    VirtualClock clock;
    MockInputs inputs(2, clock);
    REQUIRE(*inputs.read() == 0);
    CHECK_FALSE(*inputs.wait_ns(0));
    clock.advance_ns(100);
    inputs.set(1, true);
    inputs.set(1, true);  // no change
    clock.advance_ns(50);
    inputs.set(0, true);
    inputs.set(1, false, 170);
    inputs.set(7, true);  // no such line
    CHECK(*inputs.read() == 0b01);
    CHECK(*inputs.wait_ns(0));
    std::array<InputEdge, 2> edges{};
    REQUIRE(*inputs.collect(edges) == 2);
    CHECK(edges[0].time_ns == 100);
    CHECK(edges[0].line == 1);
    CHECK(edges[0].active);
    CHECK(edges[1].time_ns == 150);
    REQUIRE(*inputs.collect(edges) == 1);
    CHECK(edges[0].time_ns == 170);
    CHECK_FALSE(edges[0].active);
    CHECK(*inputs.collect(edges) == 0);
}

TEST_CASE("mock inputs 2, 4: faults are answers, and edges that nobody took are told") {
    VirtualClock clock;
    bool broken = true;
    MockInputs inputs(1, clock, [&]() -> std::optional<Diagnostic> {
        if (!broken) return std::nullopt;
        return Diagnostic{Severity::error, ExitStatus::machine, "unplugged", {}};
    });
    std::array<InputEdge, 4> edges{};
    CHECK(inputs.read().error().message == "unplugged");
    CHECK(inputs.collect(edges).error().message == "unplugged");
    CHECK(inputs.wait_ns(0).error().message == "unplugged");
    broken = false;
    for (std::size_t i = 0; i <= MockInputs::most_edges; ++i) inputs.set(0, i % 2 == 0);
    CHECK_FALSE(inputs.collect(edges).ok());
}

TEST_CASE("tracing inputs 1: the observer sees what was collected") {
    VirtualClock clock;
    MockInputs mock(2, clock);
    std::vector<InputEdge> seen;
    TracingInputs inputs(mock, [&](const InputEdge& edge) { seen.push_back(edge); });
    mock.set(1, true);
    mock.set(0, true);
    std::array<InputEdge, 1> edges{};
    CHECK(inputs.line_count() == 2);
    CHECK(*inputs.wait_ns(0));
    CHECK(*inputs.collect(edges) == 1);
    CHECK(seen.size() == 1);
    CHECK(*inputs.collect(edges) == 1);
    CHECK(*inputs.collect(edges) == 0);
    REQUIRE(seen.size() == 2);
    CHECK(seen[0].line == 1);
    CHECK(seen[1].line == 0);
    CHECK(*inputs.read() == 0b11);
}

TEST_CASE("debounce 1: a contact that bounces counts from its first touch, once it has settled") {
    Debounce debounce(1'000, false);
    bool active = true;
    for (const std::int64_t time_ns : {5'000, 5'100, 5'300, 5'350, 5'900}) {
        debounce.edge({time_ns, 3, active});
        CHECK_FALSE(debounce.settled(time_ns + 10));
        active = !active;
    }
    CHECK_FALSE(debounce.settled(6'899));
    const auto told = debounce.settled(6'900);
    REQUIRE(told);
    CHECK(told->time_ns == 5'000);
    CHECK(told->line == 3);
    CHECK(told->active);
    CHECK(debounce.active());
    CHECK_FALSE(debounce.settled(9'000));
}

TEST_CASE(
    "debounce 2: a pulse by itself is none, and does not count for a contact that comes later") {
    Debounce debounce(1'000, false);
    debounce.edge({5'000, 0, true});
    debounce.edge({5'200, 0, false});
    CHECK_FALSE(debounce.settled(8'000));
    debounce.edge({9'000, 0, true});
    const auto told = debounce.settled(10'000);
    REQUIRE(told);
    CHECK(told->time_ns == 9'000);
    Debounce raw(0, false);
    raw.edge({7, 0, true});
    REQUIRE(raw.settled(7));
}

TEST_CASE(
    "debounce: told levels alternate, and each is that of the line since it settled, whatever the "
    "edges") {
    std::mt19937 random(6);
    for (int run = 0; run < 200; ++run) {
        Debounce debounce(1'000, false);
        std::vector<InputEdge> edges;
        std::int64_t time_ns = 0;
        for (int i = 0; i < 30; ++i) {
            time_ns += 1 + static_cast<std::int64_t>(random() % 2'500);
            edges.push_back({time_ns, 0, i % 2 == 0});
        }
        bool told_level = false;
        std::size_t fed = 0;
        for (std::int64_t now_ns = 0; now_ns < time_ns + 2'000; now_ns += 50) {
            for (; fed < edges.size() && edges[fed].time_ns <= now_ns; ++fed)
                debounce.edge(edges[fed]);
            const auto told = debounce.settled(now_ns);
            if (!told) continue;
            CHECK(told->active != told_level);
            told_level = told->active;
            CHECK(told->active == edges[fed - 1].active);
            CHECK(now_ns - edges[fed - 1].time_ns >= 1'000);
            CHECK(now_ns - edges[fed - 1].time_ns < 1'050 + 50);
            CHECK(told->time_ns <= edges[fed - 1].time_ns);
        }
    }
}

TEST_CASE("gpiod inputs 1: what cannot be had is refused with purpose, chip and what to do") {
    const std::vector<InputRequest> requests{{{"x.endstop", "gpiochip987", 3u, false}, Pull::up}};
    const auto opened = open_gpiod_inputs(requests);
    REQUIRE_FALSE(opened.ok());
    CHECK(opened.error().status == ExitStatus::machine);
    CHECK(opened.error().message.find("x.endstop") != std::string::npos);
    CHECK(opened.error().message.find("gpiochip987") != std::string::npos);
    CHECK(opened.error().message.find("gpiodetect") != std::string::npos);
    CHECK_FALSE(open_gpiod_inputs({}).ok());
    CHECK_FALSE(open_gpiod_inputs(std::vector<InputRequest>(65, requests[0])).ok());
}
