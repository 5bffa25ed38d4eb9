// Measures, and so is skipped unless asked for: test_motion --no-skip --test-case="speed*"

#include <doctest/doctest.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>

#include "machine.h"
#include "target/motion/shaper.h"

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

Rate timed_rate_of(const test::Job& job, const Kinematics& machine, const Shaping& shaping) {
    const std::vector<PlannedMove> plan = test::plan_of(job);
    TimedGenerator generator(machine, job.origin, shaping);
    std::array<StepEvent, 2048> events;
    std::uint64_t steps = 0;
    const auto step_all = [&] {
        std::size_t count;
        do {
            count = generator.next(events);
            for (std::size_t i = 0; i < count; ++i)
                steps += static_cast<unsigned>(std::popcount(events[i].motors));
        } while (count == events.size());
    };
    const auto start = std::chrono::steady_clock::now();
    for (const PlannedMove& planned : plan) {
        generator.start(planned);
        step_all();
    }
    generator.finish();
    step_all();
    const std::chrono::duration<double> took_s = std::chrono::steady_clock::now() - start;
    return {static_cast<double>(steps) / took_s.count(),
            static_cast<double>(plan.size()) / took_s.count()};
}

void report(const std::string& what, const Rate& rate) {
    MESSAGE(what, ": ", rate.steps_per_s / 1e6, " million steps/s, ", rate.moves_per_s / 1e6,
            " million moves/s");
}

void report(const std::string& what, const test::Job& job) {
    report(what, rate_of(job));
}

Delta delta_to_measure(double steps_per_mm) {
    Delta delta{{steps_per_mm, steps_per_mm, steps_per_mm, 415}, {}};
    for (std::size_t i = 0; i < Delta::tower_count; ++i) {
        const double angle_rad = (210.0 + 120.0 * static_cast<double>(i)) * std::numbers::pi / 180;
        delta.towers[i] = {120 * std::cos(angle_rad), 120 * std::sin(angle_rad), 288};
    }
    return delta;
}

Shaping all_shaped() {
    Shaping shaping;
    for (std::size_t axis = 0; axis < 3; ++axis)
        shaping.axes[axis] = taps_of(Shaper{ShaperKind::ei, 40, 0.1}, axis);
    shaping.extruder = taps_of(PressureAdvance{0.05, 0.04});
    return shaping;
}

// As crooked as beds are: 0.15 mm up and down, a height every 30 mm.
Shaping over_bed(Shaping shaping) {
    std::vector<double> heights_mm;
    for (int i = 0; i < 49; ++i) heights_mm.push_back(0.15 * std::sin(1.7 * i));
    shaping.bed = std::make_shared<const BedMesh>(Point{-90, -90}, Point{90, 90}, 7,
                                                  std::move(heights_mm), 10);
    return shaping;
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

TEST_CASE("speed: the same with every option" * doctest::skip()) {
    const Point a{-30, -40, 0}, b{50, 20, 0};
    for (const double jerk_mm_s3 : {0.0, 1e5}) {
        test::Job lines;
        lines.limits.jerk_mm_s3 = jerk_mm_s3;
        for (int i = 0; i < 200; ++i)
            lines.moves.push_back({i % 2 ? Line{b, a, 4} : Line{a, b, 4}, 100, 0, 0});
        test::Job circles = lines;
        for (std::size_t i = 0; i < circles.moves.size(); ++i)
            circles.moves[i].path = circle_about(a, -20, -30, i % 2 == 0, 0, 4);
        test::Job brief = lines;
        brief.moves.clear();
        Point at;
        for (int i = 0; i < 40'000; ++i) {
            const Point to{at.x + (i / 80 % 2 ? -0.5 : 0.5), i % 2 ? 0.01 : 0, 0};
            brief.moves.push_back({Line{at, to, 0.015}, 100, 0, 0});
            at = to;
        }
        const std::array<double, axis_count> steps{80, 80, 400, 415};
        for (const auto& [what, job] :
             {std::pair<std::string, const test::Job&>{"lines of 100 mm", lines},
              {"circles of radius 14 mm", circles},
              {"lines of 0.5 mm", brief}}) {
            const std::string with = what + (jerk_mm_s3 > 0 ? ", S-curves" : "");
            report(with + ", CoreXY", timed_rate_of(job, CoreXy{steps}, {}));
            report(with + ", CoreXY, EI, pressure advance",
                   timed_rate_of(job, CoreXy{steps}, all_shaped()));
            report(with + ", CoreXY, mesh", timed_rate_of(job, CoreXy{steps}, over_bed({})));
            report(with + ", delta, mesh", timed_rate_of(job, delta_to_measure(80), over_bed({})));
            report(with + ", delta, mesh, EI, pressure advance",
                   timed_rate_of(job, delta_to_measure(80), over_bed(all_shaped())));
            report(with + ", delta", timed_rate_of(job, delta_to_measure(80), {}));
            report(with + ", delta, EI, pressure advance",
                   timed_rate_of(job, delta_to_measure(80), all_shaped()));
        }
    }
}

}  // namespace lyr::motion
