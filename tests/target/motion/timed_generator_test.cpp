#include "target/motion/timed_generator.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "timed_machine.h"

namespace lyr::motion {
namespace {

using test::Errors;
using test::errors_of;
using test::Job;
using test::MotorStep;
using test::Real;
using test::Run;
using test::steps_of;
using test::timed_run;
using test::TimedRun;

constexpr double pi = std::numbers::pi;
// Contract 2.
constexpr Real exact_ns = 1000;
// In the nanosecond that times are rounded to a motor at 300 mm/s and 800 steps/mm, twice as fast on
// crossed belts, moves so much.
constexpr Real moved_steps = 5e-4L;

Delta delta_of(double steps_per_mm) {
    Delta delta{{steps_per_mm, steps_per_mm, steps_per_mm, 415.3}, {}};
    for (std::size_t i = 0; i < Delta::tower_count; ++i) {
        const double angle_rad = (210.0 + 120.0 * static_cast<double>(i)) * pi / 180;
        delta.towers[i] = {120 * std::cos(angle_rad), 120 * std::sin(angle_rad), 250};
    }
    return delta;
}

Job near_middle(unsigned seed, std::size_t count, double size_mm) {
    std::mt19937 random(seed);
    Job job;
    job.origin = {1.25, -2, 3};
    job.moves = test::random_moves(random, count, size_mm, job.origin, true);
    return job;
}

Real check_steps(const TimedRun& timed) {
    const std::vector<StepEvent>& events = timed.run.events;
    CHECK(std::is_sorted(events.begin(), events.end(), [](const StepEvent& a, const StepEvent& b) {
        return a.time_ns < b.time_ns;
    }));
    Real worst_ns = 0;
    for (std::size_t motor = 0; motor < motor_count; ++motor) {
        const Errors errors = errors_of(timed, motor);
        CHECK(errors.steps <= 0.5L + moved_steps);
        CHECK(errors.time_ns < exact_ns);
        worst_ns = std::max(worst_ns, errors.time_ns);
    }
    return worst_ns;
}

}  // namespace

TEST_CASE("timed 1, 2: a plain Cartesian machine steps as the step generator has it") {
    for (const double size_mm : {0.02, 1.0, 20.0}) {
        const Job job = near_middle(3, size_mm > 10 ? 20 : 200, size_mm);
        const Run plain = test::run(job);
        const TimedRun timed = timed_run(job, job.cartesian, {});
        CHECK(timed.lead_ns == 0);
        for (std::size_t motor = 0; motor < motor_count; ++motor) {
            const std::vector<MotorStep> a = steps_of(plain, motor), b = steps_of(timed.run, motor);
            REQUIRE(a.size() == b.size());
            for (std::size_t i = 0; i < a.size(); ++i) {
                REQUIRE(a[i].direction == b[i].direction);
                REQUIRE(std::abs(a[i].time_ns - b[i].time_ns) <= 10);
            }
        }
    }
}

TEST_CASE("timed 1, 2: crossed belts and a delta, on lines and arcs of all sizes") {
    Real worst_ns = 0;
    for (unsigned seed = 0; seed < 3; ++seed)
        for (const double size_mm : {0.02, 1.0, 12.0}) {
            const Job job = near_middle(seed, size_mm > 10 ? 8 : 80, size_mm);
            worst_ns =
                std::max(worst_ns, check_steps(timed_run(job, CoreXy{{80, 80, 400, 415}}, {})));
            worst_ns = std::max(worst_ns, check_steps(timed_run(job, delta_of(100), {})));
        }
    MESSAGE("largest error of a step's time: ", static_cast<double>(worst_ns), " ns");
}

}  // namespace lyr::motion
