// Measures, and so is skipped unless asked for: test_motion --no-skip --test-case="speed*"

#include <doctest/doctest.h>

#include <bit>
#include <chrono>
#include <string>

#include "machine.h"

namespace lyr::motion {
namespace {

// Of planning and stepping together.
struct Rate {
    double steps_per_s, moves_per_s;
};

Rate rate_of(const test::Job& job) {
    Planner planner = *Planner::create(job.limits);
    StepGenerator generator(job.cartesian, job.origin);
    std::array<StepEvent, 2048> events;
    PlannedMove planned;
    std::uint64_t steps = 0;
    const auto step_all = [&] {
        while (planner.pop(planned)) {
            generator.start(planned);
            std::size_t count;
            do {
                count = generator.next(events);
                for (std::size_t i = 0; i < count; ++i)
                    steps += static_cast<unsigned>(std::popcount(events[i].motors));
            } while (count == events.size());
        }
    };
    const auto start = std::chrono::steady_clock::now();
    for (const Move& move : job.moves) {
        if (planner.full()) step_all();
        REQUIRE(planner.push(move).ok());
    }
    planner.flush();
    step_all();
    const std::chrono::duration<double> took_s = std::chrono::steady_clock::now() - start;
    return {static_cast<double>(steps) / took_s.count(),
            static_cast<double>(job.moves.size()) / took_s.count()};
}

void report(const std::string& what, const test::Job& job) {
    const Rate rate = rate_of(job);
    MESSAGE(what, ": ", rate.steps_per_s / 1e6, " million steps/s, ", rate.moves_per_s / 1e6,
            " million moves/s");
}

}  // namespace

TEST_CASE("speed: steps and moves per second on one core" * doctest::skip()) {
    const Point a{0, 0, 0}, b{100, 70, 0};
    test::Job lines;
    lines.cartesian.steps_per_mm = {800, 800, 400, 415};
    for (int i = 0; i < 100; ++i)
        lines.moves.push_back({i % 2 ? Line{b, a, 4} : Line{a, b, 4}, 100, 0, 0});
    report("lines of 122 mm", lines);

    test::Job circles = lines;
    for (std::size_t i = 0; i < circles.moves.size(); ++i)
        circles.moves[i].path = circle_about(a, 20, 3, i % 2 == 0, 0, 4);
    report("circles of radius 20 mm", circles);

    test::Job tiny;
    Point at;
    for (int i = 0; i < 1'000'000; ++i) {
        const Point to{at.x + (i / 1000 % 2 ? -0.1 : 0.1), i % 2 ? 0.001 : 0, 0};
        tiny.moves.push_back({Line{at, to, 0.003}, 100, 0, 0});
        at = to;
    }
    report("lines of 0.1 mm", tiny);
}

}  // namespace lyr::motion
