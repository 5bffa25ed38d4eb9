#include "target/motion/step_generator.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "machine.h"

namespace lyr::motion {
namespace {

using test::allowed_deviation;
using test::even_limits;
using test::exact_ns;
using test::Job;
using test::largest_deviation;
using test::largest_time_error_ns;
using test::MotorStep;
using test::Real;
using test::Run;
using test::run;
using test::steps_of;

using std::numbers::pi;

// Contract 1, 2 and 5. Returns the largest error of a step's time.
Real check_steps(const Run& done) {
    CHECK(std::is_sorted(
        done.events.begin(), done.events.end(),
        [](const StepEvent& a, const StepEvent& b) { return a.time_ns < b.time_ns; }));
    CHECK(std::all_of(done.events.begin(), done.events.end(), [](const StepEvent& event) {
        return event.motors != 0 && (event.positive & ~event.motors) == 0;
    }));
    Real worst_ns = 0;
    for (std::size_t motor = 0; motor < motor_count; ++motor) {
        CHECK(largest_deviation(done, motor) <= allowed_deviation(done, motor));
        worst_ns = std::max(worst_ns, largest_time_error_ns(done, motor));
    }
    CHECK(worst_ns < exact_ns);
    return worst_ns;
}

Move at_speed(const Path& path, double speed_mm_s) {
    return {path, speed_mm_s, 0, 0};
}

}  // namespace

TEST_CASE("steps 1, 2: lines and arcs of all sizes, against a bisection of the ideal motion" *
          doctest::test_suite("long")) {
    Real worst_ns = 0;
    struct Size {
        double mm;
        std::size_t moves;
    };
    for (unsigned seed = 0; seed < 3; ++seed)
        for (const Size& size : {Size{0.02, 300}, Size{1, 100}, Size{50, 12}}) {
            std::mt19937 random(seed);
            Job job;
            job.origin = {1.2345, -20, 0.3};
            job.moves = test::random_moves(random, size.moves, size.mm, job.origin, true);
            worst_ns = std::max(worst_ns, check_steps(run(job)));
        }
    MESSAGE("largest error of a step's time: ", static_cast<double>(worst_ns), " ns");
}

TEST_CASE("steps 1, 2: circles from 0.05 to 200 mm" * doctest::test_suite("long")) {
    for (const double radius_mm : {0.05, 0.3, 2.0, 15.0, 60.0, 200.0})
        for (const bool counter_clockwise : {true, false})
            for (const double angle : {0.0, 0.7, pi / 2, 3.0}) {
                if (radius_mm > 20 && angle != 0.7) continue;
                const Point start{radius_mm * std::cos(angle), radius_mm * std::sin(angle), 0};
                Job job;
                job.origin = start;
                job.moves = {at_speed(circle_about(start, 0, 0, counter_clockwise, 0, 1), 100)};
                const Run done = run(job);
                check_steps(done);
                for (std::size_t motor = 0; motor < 3; ++motor) CHECK(done.counts[motor] == 0);
                // As many as the width of the circle, to and fro, and at most one turning point
                // more.
                for (std::size_t motor = 0; motor < 2; ++motor) {
                    const double expected = 4 * radius_mm * job.cartesian.steps_per_mm[motor];
                    CHECK(std::abs(static_cast<double>(steps_of(done, motor).size()) - expected) <=
                          3);
                }
            }
}

TEST_CASE("steps 1: the drawn circle stays within half a step of the round one") {
    Job job;
    job.origin = {30, 0, 0};
    job.moves = {at_speed(circle_about({30, 0, 0}, 0, 0, true, 0, 0), 60)};
    StepCounts counts{};
    const double cell_mm = std::hypot(0.5 / 80, 0.5 / 80);
    double worst_mm = 0;
    for (const StepEvent& event : run(job).events) {
        for (std::size_t motor = 0; motor < 2; ++motor)
            if (event.motors >> motor & 1) counts[motor] += event.positive >> motor & 1 ? 1 : -1;
        const double x = 30 + static_cast<double>(counts[0]) / 80;
        const double y = static_cast<double>(counts[1]) / 80;
        worst_mm = std::max(worst_mm, std::abs(std::hypot(x, y) - 30));
    }
    CHECK(worst_mm <= cell_mm);
    CHECK(worst_mm > cell_mm / 4);
}

TEST_CASE("steps 1, 2: arcs that are nearly straight" * doctest::test_suite("long")) {
    for (double sagitta_mm = 1e-14; sagitta_mm < 30; sagitta_mm *= 100)
        for (const double sign : {1.0, -1.0})
            for (const Point& to : {Point{100, 0, 0}, Point{0, -100, 0}, Point{61, 33, 0}}) {
                Job job;
                job.moves = {at_speed(arc_through({0, 0, 0}, to, sign * sagitta_mm, 1), 100)};
                const Run done = run(job);
                check_steps(done);
                CHECK(done.counts[0] == std::llround(to.x * 80));
                CHECK(done.counts[1] == std::llround(to.y * 80));
            }
}

TEST_CASE("steps 2: an arc without height steps as the line does") {
    Job flat, straight;
    const Point to{61, 33, 0};
    flat.moves = {at_speed(arc_through({0, 0, 0}, to, 1e-12, 1), 100)};
    straight.moves = {at_speed(Line{{0, 0, 0}, to, 1}, 100)};
    // The arc is slower where axes limit it; here they do not.
    flat.limits = straight.limits = even_limits(300, 1e5);
    flat.moves[0].acceleration_mm_s2 = straight.moves[0].acceleration_mm_s2 = 2000;
    const Run a = run(flat), b = run(straight);
    for (std::size_t motor = 0; motor < motor_count; ++motor) {
        const std::vector<MotorStep> of_a = steps_of(a, motor), of_b = steps_of(b, motor);
        REQUIRE(of_a.size() == of_b.size());
        for (std::size_t i = 0; i < of_a.size(); ++i)
            REQUIRE(std::abs(of_a[i].time_ns - of_b[i].time_ns) <= 2);
    }
}

TEST_CASE("steps 1, 3: thousands of random moves and the way back end where they began" *
          doctest::test_suite("long")) {
    std::mt19937 random(11);
    Job job;
    job.moves = test::random_moves(random, 30'000, 0.2, job.origin, true);
    Point end = end_of(job.moves.back().path);
    double fed_mm = 0;
    for (const Move& move : job.moves) fed_mm += advance_of(move.path);
    job.moves.push_back(at_speed(Line{end, {0, 0, 0}, -fed_mm}, 100));
    const Run done = run(job);
    for (std::size_t motor = 0; motor < motor_count; ++motor) {
        CHECK(largest_deviation(done, motor) <= allowed_deviation(done, motor));
        CHECK(done.counts[motor] == 0);
    }
}

TEST_CASE("steps 1, 3: segments of 1 um add up to a straight line") {
    Job job;
    Point at;
    for (int i = 1; i <= 20'000; ++i) {
        const Point to{i * 1e-3, i * 0.5e-3, 0};
        job.moves.push_back(at_speed(Line{at, to, 4e-5}, 100));
        at = to;
    }
    const Run done = run(job);
    for (std::size_t motor = 0; motor < motor_count; ++motor)
        CHECK(largest_deviation(done, motor) <= allowed_deviation(done, motor));
    CHECK(done.counts[0] == 1600);
    CHECK(done.counts[1] == 800);
    CHECK(done.counts[3] == std::llround(20'000 * 4e-5 * 415.3));
    // And in the same time as in one piece, but for what the window cannot see.
    Job whole;
    whole.moves = {at_speed(Line{{0, 0, 0}, at, 0.8}, 100)};
    CHECK(done.duration_s() == doctest::Approx(run(whole).duration_s()).epsilon(0.05));
}

TEST_CASE("steps 2: one metre at 0.01 mm/s takes a day and is exact throughout") {
    Job job;
    job.moves = {at_speed(Line{{0, 0, 0}, {1000, 0, 0}, 0}, 0.01)};
    const Run done = run(job);
    CHECK(done.counts[0] == 80'000);
    CHECK(done.duration_s() == doctest::Approx(1e5).epsilon(1e-6));
    CHECK(check_steps(done) < 2);
    const std::vector<MotorStep> steps = steps_of(done, 0);
    for (std::size_t i = 1; i < steps.size(); ++i)
        REQUIRE(std::abs(steps[i].time_ns - steps[i - 1].time_ns - 1'250'000'000) <= 2);
}

TEST_CASE("steps 2: the analytic times of a trapezoid") {
    Job job;
    job.limits = even_limits(1000, 1000);
    job.moves = {at_speed(Line{{0, 0, 0}, {10, 0, 0}, 0}, 50)};
    const std::vector<MotorStep> steps = steps_of(run(job), 0);
    REQUIRE(steps.size() == 800);
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const double s = (static_cast<double>(k) + 0.5) / 80;
        const double time_s = s < 1.25   ? std::sqrt(2 * s / 1000)
                              : s < 8.75 ? 0.05 + (s - 1.25) / 50
                                         : 0.25 - std::sqrt(2 * (10 - s) / 1000);
        CHECK(std::abs(static_cast<double>(steps[k].time_ns) - time_s * 1e9) < 1);
    }
}

TEST_CASE("steps 3: the extruder's parts of steps are not lost in a million moves" *
          doctest::test_suite("long")) {
    Planner planner = *Planner::create(even_limits(300, 3000), 8);
    StepGenerator generator(Cartesian{{80, 80, 400, 415.3}}, Point{});
    std::array<StepEvent, 16> events;
    PlannedMove planned;
    const Line out{{0, 0, 0}, {0.05, 0, 0}, 0.000123};
    Line back{out.to, out.from, out.advance_mm};
    long double fed_mm = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        REQUIRE(planner.push({i % 2 ? back : out, 100, 0, 0}).ok());
        fed_mm += out.advance_mm;
        while (planner.full() && planner.pop(planned)) {
            generator.start(planned);
            while (generator.next(events) == events.size()) continue;
        }
    }
    planner.flush();
    while (planner.pop(planned)) {
        generator.start(planned);
        while (generator.next(events) == events.size()) continue;
    }
    const long double ideal = fed_mm * 415.3L;
    CHECK(std::abs(static_cast<long double>(generator.counts()[extruder_motor]) - ideal) <
          0.5L + 1e-6L);
    CHECK(generator.counts()[0] == 0);
}

TEST_CASE("steps: the way there and the way back have mirrored times") {
    std::mt19937 random(5);
    Job job;
    job.cartesian.steps_per_mm[axis_e] = 400;
    job.moves = test::random_moves(random, 300, 3, job.origin, false);
    const Point end = end_of(job.moves.back().path);
    job.moves.push_back(at_speed(Line{end, job.origin, 0}, 100));
    for (Move& move : job.moves)
        std::visit([](auto& shape) { shape.advance_mm = 0.25; }, move.path);
    const Run there = run(job);
    job.moves = test::reversed(job.moves);
    const Run back = run(job);
    for (std::size_t motor = 0; motor < 3; ++motor) {
        const std::vector<MotorStep> a = steps_of(there, motor), b = steps_of(back, motor);
        REQUIRE(a.size() == b.size());
        double worst_ns = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            REQUIRE(a[i].direction == -b[b.size() - 1 - i].direction);
            const double mirrored_ns =
                there.end_ns - static_cast<double>(b[b.size() - 1 - i].time_ns);
            worst_ns =
                std::max(worst_ns, std::abs(static_cast<double>(a[i].time_ns) - mirrored_ns));
        }
        CHECK(worst_ns < 100);
    }
    CHECK(there.counts[extruder_motor] == -back.counts[extruder_motor]);
}

TEST_CASE("steps: turned by 90 degrees or mirrored, the times stay") {
    std::mt19937 random(6);
    Job job;
    job.moves = test::random_moves(random, 300, 3, job.origin, true);
    const Run plain = run(job);
    struct Image {
        double xx, xy, yx, yy;
    };
    for (const Image& m :
         {Image{0, -1, 1, 0}, Image{-1, 0, 0, -1}, Image{1, 0, 0, -1}, Image{0, 1, 1, 0}}) {
        Job turned = job;
        const double handed = m.xx * m.yy - m.xy * m.yx;
        const auto map = [&](Point& p) {
            p = {m.xx * p.x + m.xy * p.y, m.yx * p.x + m.yy * p.y, p.z};
        };
        for (Move& move : turned.moves) {
            if (auto* line = std::get_if<Line>(&move.path)) {
                map(line->from), map(line->to);
                continue;
            }
            Arc& arc = std::get<Arc>(move.path);
            map(arc.from), map(arc.to);
            Point start{std::cos(arc.start_angle_rad), std::sin(arc.start_angle_rad), 0};
            map(start);
            arc.start_angle_rad = std::atan2(start.y, start.x);
            arc.sweep_rad *= handed;
        }
        const Run image = run(turned);
        for (std::size_t motor = 0; motor < motor_count; ++motor) {
            const bool swapped = motor < 2 && m.xx == 0;
            const std::vector<MotorStep> a = steps_of(plain, swapped ? 1 - motor : motor);
            const std::vector<MotorStep> b = steps_of(image, motor);
            REQUIRE(a.size() == b.size());
            std::int64_t worst_ns = 0;
            for (std::size_t i = 0; i < a.size(); ++i)
                worst_ns = std::max(worst_ns, std::abs(a[i].time_ns - b[i].time_ns));
            CHECK(worst_ns < 100);
        }
    }
}

TEST_CASE("steps: a motor the other way round steps at the same times" *
          doctest::test_suite("long")) {
    std::mt19937 random(8);
    Job job;
    job.moves = test::random_moves(random, 100, 5, job.origin, true);
    const Run plain = run(job);
    for (double& steps : job.cartesian.steps_per_mm) steps = -steps;
    const Run turned = run(job);
    check_steps(turned);
    for (std::size_t motor = 0; motor < motor_count; ++motor) {
        const std::vector<MotorStep> a = steps_of(plain, motor), b = steps_of(turned, motor);
        REQUIRE(a.size() == b.size());
        CHECK(plain.counts[motor] == -turned.counts[motor]);
        for (std::size_t i = 0; i < a.size(); ++i) {
            REQUIRE(a[i].direction == -b[i].direction);
            REQUIRE(std::abs(a[i].time_ns - b[i].time_ns) <= 20);
        }
    }
}

TEST_CASE("steps 4: touching a middle between microsteps makes no step, passing it does") {
    Job job;
    job.cartesian.steps_per_mm.fill(100);
    // 0.005 mm is the first middle.
    const Line touch{{0, 0, 0}, {0.005, 0, 0}, 0};
    job.moves = {at_speed(touch, 10), at_speed(test::reversed(touch), 10)};
    CHECK(run(job).events.empty());
    const Line pass{{0, 0, 0}, {0.0051, 0, 0}, 0};
    job.moves = {at_speed(pass, 10), at_speed(test::reversed(pass), 10)};
    CHECK(run(job).events.size() == 2);
    // From the middle at 1.5 steps around a circle from 0.5 to 2.5 steps: all three are touched,
    // and only the one at 1.5 is passed, to and fro.
    job.moves = {at_speed(Line{{0, 0, 0}, {0.015, 0, 0}, 0}, 10),
                 at_speed(circle_about({0.015, 0, 0}, 0.015, 0.01, true, 0, 0), 10)};
    const Run done = run(job);
    CHECK(steps_of(done, 0).size() == 3);
    CHECK(done.counts[0] == 1);
    CHECK(steps_of(done, 1).size() == 4);
    CHECK(done.counts[1] == 0);
}

TEST_CASE("steps 4: a stop at a middle delays its step until the motion goes on") {
    Planner planner = *Planner::create(even_limits(100, 1000));
    StepGenerator generator(Cartesian{{100, 100, 100, 100}}, Point{});
    REQUIRE(planner.push({Line{{0, 0, 0}, {0.005, 0, 0}, 0}, 10, 0, 0}).ok());
    planner.dwell(1);
    REQUIRE(planner.push({Line{{0.005, 0, 0}, {0.009, 0, 0}, 0}, 10, 0, 0}).ok());
    planner.flush();
    std::array<StepEvent, 4> events;
    PlannedMove planned;
    REQUIRE(planner.pop(planned));
    generator.start(planned);
    CHECK(generator.next(events) == 0);
    REQUIRE(planner.pop(planned));
    generator.start(planned);
    REQUIRE(generator.next(events) == 1);
    CHECK(events[0].time_ns - planned.start_ns <= 1);
    CHECK(generator.counts()[0] == 1);
}

TEST_CASE("steps 5: motors that step together share an event") {
    Job job;
    job.cartesian.steps_per_mm.fill(100);
    job.moves = {at_speed(Line{{0, 0, 0}, {10, -10, 10}, 0}, 50)};
    const Run done = run(job);
    CHECK(done.events.size() == 1000);
    for (const StepEvent& event : done.events) {
        REQUIRE(event.motors == 7);
        REQUIRE(event.positive == 5);
    }
}

TEST_CASE("steps 6: batches of any size give the same events") {
    std::mt19937 random(9);
    Job job;
    job.moves = test::random_moves(random, 50, 5, job.origin, true);
    const Run whole = run(job);
    StepGenerator generator(job.cartesian, job.origin);
    std::array<StepEvent, 7> batch;
    CHECK(generator.next(batch) == 0);
    std::size_t at = 0;
    for (const PlannedMove& planned : whole.plan) {
        generator.start(planned);
        for (std::size_t size = 1;; size = size % batch.size() + 1) {
            const std::size_t count = generator.next(std::span(batch).first(size));
            for (std::size_t i = 0; i < count; ++i, ++at) {
                REQUIRE(batch[i].time_ns == whole.events[at].time_ns);
                REQUIRE(batch[i].motors == whole.events[at].motors);
                REQUIRE(batch[i].positive == whole.events[at].positive);
            }
            if (count < size) break;
        }
    }
    CHECK(at == whole.events.size());
}

TEST_CASE("steps: a motor with no steps per mm stands still") {
    Job job;
    job.cartesian.steps_per_mm = {0, 80, 0, 0};
    job.moves = {at_speed(circle_about({1, 0, 0}, 0, 0, true, 3, 2), 50)};
    for (const StepEvent& event : run(job).events) REQUIRE(event.motors == 2);
}

}  // namespace lyr::motion
