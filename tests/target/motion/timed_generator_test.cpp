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
using test::moved_steps;
using test::Real;
using test::Run;
using test::steps_of;
using test::timed_run;
using test::TimedRun;

using std::numbers::pi;

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

// Half a nanosecond of rounding, a tenth that a root may be off, and what is left for rounding of sums.
constexpr Real closest_ns = 0.5 + 1e9 * TimeWalk::exact_s + 0.05;

Real check_exact(const TimedRun& timed) {
    const std::vector<StepEvent>& events = timed.run.events;
    CHECK(std::is_sorted(events.begin(), events.end(), [](const StepEvent& a, const StepEvent& b) {
        return a.time_ns < b.time_ns;
    }));
    Real worst_ns = 0;
    for (std::size_t motor = 0; motor < motor_count; ++motor) {
        const Errors errors = errors_of(timed, motor);
        CHECK(errors.steps <= 0.5 + moved_steps);
        CHECK(errors.time_ns < closest_ns);
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

TEST_CASE("timed 1, 2: crossed belts and a delta, on lines and arcs of all sizes" *
          doctest::test_suite("long")) {
    Real worst_ns = 0;
    for (unsigned seed = 0; seed < 2; ++seed)
        for (const double size_mm : {0.02, 1.0, 12.0}) {
            const Job job = near_middle(seed, size_mm > 10 ? 3 : 25, size_mm);
            worst_ns =
                std::max(worst_ns, check_exact(timed_run(job, CoreXy{{80, 80, 400, 415}}, {})));
            worst_ns = std::max(worst_ns, check_exact(timed_run(job, delta_of(100), {})));
        }
    MESSAGE("largest error of a step's time: ", static_cast<double>(worst_ns), " ns");
}

TEST_CASE("timed 1, 2: with shapers, pressure advance and a limit of jerk" *
          doctest::test_suite("long")) {
    Shaping shaping;
    for (std::size_t axis = 0; axis < 3; ++axis)
        shaping.axes[axis] = taps_of(Shaper{ShaperKind::mzv, 40, 0.1}, axis);
    Shaping uneven = shaping;
    uneven.axes[axis_y] = taps_of(Shaper{ShaperKind::ei, 31, 0.05}, axis_y);
    uneven.axes[axis_z] = {};
    shaping.extruder = uneven.extruder = taps_of(PressureAdvance{0.05, 0.04});
    Real worst_ns = 0;
    for (const double size_mm : {0.02, 1.0, 12.0})
        for (const double jerk_mm_s3 : {0.0, 1e5}) {
            Job job = near_middle(7, size_mm > 10 ? 2 : 12, size_mm);
            job.limits.jerk_mm_s3 = jerk_mm_s3;
            for (const Kinematics& machine :
                 {Kinematics{job.cartesian}, Kinematics{CoreXy{{80, 80, 400, 415}}}})
                worst_ns = std::max(worst_ns, check_exact(timed_run(job, machine, uneven)));
            worst_ns = std::max(worst_ns, check_exact(timed_run(job, delta_of(100), shaping)));
            worst_ns = std::max(worst_ns, check_exact(timed_run(job, delta_of(100), {})));
        }
    MESSAGE("largest error of a step's time: ", static_cast<double>(worst_ns), " ns");
}

TEST_CASE("timed 3: three thousand random moves and the way back end where they began" *
          doctest::test_suite("long")) {
    std::mt19937 random(11);
    Job job;
    job.moves = test::random_moves(random, 3'000, 0.2, job.origin, true);
    double fed_mm = 0;
    for (const Move& move : job.moves) fed_mm += advance_of(move.path);
    job.moves.push_back({Line{end_of(job.moves.back().path), {0, 0, 0}, -fed_mm}, 100, 0, 0});
    Shaping shaping;
    for (std::size_t axis = 0; axis < 3; ++axis)
        shaping.axes[axis] = taps_of(Shaper{ShaperKind::ei, 50, 0.1}, axis);
    shaping.extruder = taps_of(PressureAdvance{0.05, 0.04});
    for (const Kinematics& machine :
         {Kinematics{CoreXy{{80, 80, 400, 415}}}, Kinematics{delta_of(100)}})
        for (const std::int64_t count : timed_run(job, machine, shaping).run.counts)
            CHECK(count == 0);
}

TEST_CASE("timed 5: batches of any size, and a rest that is known early, give the same events") {
    const Job job = near_middle(2, 60, 1);
    Shaping shaping;
    shaping.axes[axis_x] = taps_of(Shaper{ShaperKind::zv, 40, 0.1}, axis_x);
    const TimedRun whole = timed_run(job, delta_of(100), shaping);
    TimedGenerator generator(delta_of(100), job.origin, shaping);
    std::array<StepEvent, 7> batch;
    CHECK(generator.next(batch) == 0);
    std::size_t at = 0;
    const auto take_all = [&](std::size_t size) {
        for (;; size = size % batch.size() + 1) {
            const std::size_t count = generator.next(std::span(batch).first(size));
            for (std::size_t i = 0; i < count; ++i, ++at) {
                REQUIRE(batch[i].time_ns - whole.lead_ns == whole.run.events[at].time_ns);
                REQUIRE(batch[i].motors == whole.run.events[at].motors);
                REQUIRE(batch[i].positive == whole.run.events[at].positive);
            }
            if (count < size) return;
        }
    };
    for (const PlannedMove& planned : whole.run.plan) {
        generator.rest_until(planned.start_ns);
        take_all(3);
        generator.start(planned);
        take_all(1);
    }
    generator.finish();
    take_all(2);
    CHECK(at == whole.run.events.size());
}

TEST_CASE("timed 4: steps that lag behind come out when the plan is known to rest") {
    Job job;
    job.moves = {{Line{{0, 0, 0}, {10, 0, 0}, 1}, 50, 0, 0}};
    Shaping shaping;
    shaping.axes[axis_x] = taps_of(Shaper{ShaperKind::ei, 20, 0.1}, axis_x);
    TimedGenerator generator(job.cartesian, job.origin, shaping);
    const PlannedMove planned = test::plan_of(job).front();
    std::array<StepEvent, 2048> events;
    generator.start(planned);
    (void)generator.next(events);
    CHECK(generator.counts()[axis_x] < 800);
    generator.rest_until(planned.start_ns + 1'000'000'000);
    (void)generator.next(events);
    CHECK(generator.counts()[axis_x] == 800);
    CHECK(generator.lead_ns() + generator.tail_ns() > 40'000'000);
}

TEST_CASE("timed 1: a mechanism with play follows, and lags by a fifth of it after turns only") {
    Job job = near_middle(5, 40, 3);
    Shaping shaping;
    shaping.play_steps = {8, 12.4, 30};
    const TimedRun timed = timed_run(job, job.cartesian, shaping);
    const test::TimedIdeal ideal(timed);
    for (std::size_t motor = 0; motor < 3; ++motor) {
        const double play = shaping.play_steps[motor];
        const auto position = [&](std::int64_t time_ns) {
            return static_cast<double>(ideal.steps_at_ns(motor, static_cast<Real>(time_ns)));
        };
        double axis = 0, turned_at = 0, last = 0, going = 0;
        std::int64_t count = 0;
        for (const MotorStep& step : steps_of(timed.run, motor)) {
            const double now = position(step.time_ns);
            if (going != step.direction) turned_at = last;
            going = step.direction;
            last = now;
            const double before = std::abs(now - axis);
            count += step.direction;
            const auto at = static_cast<double>(count);
            axis = std::clamp(axis, at - play, at);
            const double after = std::abs(now - axis);
            REQUIRE(std::max(before, after) <= 0.501 + Play::lag(play));
            // A step's own width of doubt about where it turned.
            if (std::abs(now - turned_at) > play / Play::eagerness + 1)
                REQUIRE(std::max(before, after) <= 0.501);
        }
        CHECK(steps_of(timed.run, motor).size() > 100);
    }
}

TEST_CASE("timed 3: play does not add up") {
    Job job;
    Line out{{0, 0, 0}, {3.3, 1.7, 0}, 0.1};
    for (int i = 0; i < 200; ++i)
        job.moves.push_back({i % 2 ? Line{out.to, out.from, 0.1} : out, 100, 0, 0});
    Shaping shaping;
    shaping.play_steps = {8, 8.3, 4};
    const TimedRun timed = timed_run(job, job.cartesian, shaping);
    CHECK(timed.run.counts[axis_x] == 0);
    CHECK(timed.run.counts[axis_y] == 0);
    CHECK(timed.run.counts[axis_z] == 0);
    // There and back with the play each time: 264 + 8 steps and 136 + 8.3.
    CHECK(steps_of(timed.run, axis_x).size() == 200 * (264 + 8));
    CHECK(steps_of(timed.run, axis_y).size() == 200 * (136 + 8));
}

}  // namespace lyr::motion
