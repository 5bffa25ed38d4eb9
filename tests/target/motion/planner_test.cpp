#include "target/motion/planner.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "machine.h"

namespace lyr::motion {
namespace {

using test::even_limits;
using test::Job;
using test::plan_of;

using std::numbers::pi;
// Of squared speeds, relative.
constexpr double relative_rounding = 1e-9;

double start_speed(const PlannedMove& planned) {
    return planned.profile.phases[0].speed_mm_s;
}

double duration_s(const std::vector<PlannedMove>& plan) {
    return plan.empty() ? 0 : test::end_ns_of(plan.back()) / 1e9;
}

// Gone at an even speed, in all or after something has braked.
double even_mm(const std::vector<PlannedMove>& plan, bool has_braked = true) {
    double sum_mm = 0;
    for (const PlannedMove& planned : plan)
        for (std::size_t i = 0; i < Profile::phase_count; ++i) {
            const Phase& phase = planned.profile.phases[i];
            const double end_mm = i + 1 < Profile::phase_count
                                      ? planned.profile.phases[i + 1].distance_mm
                                      : planned.profile.length_mm;
            const double way_mm = end_mm - phase.distance_mm;
            // More than by the rounding of a speed.
            has_braked = has_braked || (phase.acceleration_mm_s2 < 0 && way_mm > Planner::join_mm);
            if (phase.acceleration_mm_s2 == 0 && phase.jerk_mm_s3 == 0 && has_braked)
                sum_mm += way_mm;
        }
    return sum_mm;
}

Job random_job(unsigned seed, std::size_t count, double size_mm) {
    std::mt19937 random(seed);
    Job job;
    job.limits.axes = {AxisLimits{250, 3000}, AxisLimits{200, 2000}, AxisLimits{20, 200},
                       AxisLimits{60, 4000}};
    job.moves = test::random_moves(random, count, size_mm, job.origin, true);
    job.capacity = count + 1;
    return job;
}

// Contract 1 and 2 for a plan whose moves are those of the job.
void check_plan(const Job& job, const std::vector<PlannedMove>& plan) {
    REQUIRE(plan.size() == job.moves.size());
    double last_speed = 0, last_end_ns = 0;
    for (std::size_t i = 0; i < plan.size(); ++i) {
        const Profile& profile = plan[i].profile;
        const MoveLimits own = limits_of(job.moves[i], job.limits);
        REQUIRE(start_speed(plan[i]) == last_speed);
        for (const Phase& phase : profile.phases) {
            REQUIRE(phase.speed_mm_s <= own.speed_mm_s * (1 + relative_rounding));
            // Of S-curves rounding may make the ramps a little steeper.
            const double steeper = job.limits.jerk_mm_s3 > 0 ? relative_rounding : 0;
            REQUIRE(std::abs(phase.acceleration_mm_s2) <= own.acceleration_mm_s2 * (1 + steeper));
        }
        REQUIRE(std::abs(profile.speed_at(profile.duration_s) - profile.end_speed_mm_s) <
                1e-7 * own.speed_mm_s);
        if (i > 0)
            REQUIRE(last_speed <= corner_speed_mm_s(job.moves[i - 1], job.moves[i], job.limits) *
                                      (1 + relative_rounding));
        const double start_ns = static_cast<double>(plan[i].start_ns) + plan[i].start_part_ns;
        REQUIRE(start_ns == doctest::Approx(last_end_ns).epsilon(1e-14));
        REQUIRE(plan[i].start_part_ns >= 0);
        REQUIRE(plan[i].start_part_ns < 1);
        last_speed = profile.end_speed_mm_s;
        last_end_ns = test::end_ns_of(plan[i]);
    }
    CHECK(last_speed == 0);
}

}  // namespace

TEST_CASE("planner 1, 2: speeds are continuous and within every limit") {
    for (unsigned seed = 0; seed < 20; ++seed)
        for (const double size_mm : {0.01, 0.5, 20.0}) {
            const Job job = random_job(seed, 500, size_mm);
            check_plan(job, plan_of(job));
        }
}

TEST_CASE("planner 1, 2: so they are with a small window, which costs time only" *
          doctest::test_suite("long")) {
    for (unsigned seed = 0; seed < 5; ++seed)
        for (const double size_mm : {0.01, 0.5, 20.0}) {
            Job job = random_job(seed, 2000, size_mm);
            const double best_s = duration_s(plan_of(job));
            double last_s = std::numeric_limits<double>::infinity();
            for (const std::size_t capacity : {4u, 16u, 64u, 256u}) {
                job.capacity = capacity;
                const std::vector<PlannedMove> plan = plan_of(job);
                check_plan(job, plan);
                CHECK(duration_s(plan) >= best_s * (1 - relative_rounding));
                CHECK(duration_s(plan) <= last_s * (1 + 0.01));
                last_s = duration_s(plan);
            }
        }
}

TEST_CASE("planner 3: no junction could be passed faster") {
    for (unsigned seed = 0; seed < 20; ++seed)
        for (const double size_mm : {0.01, 0.5, 20.0}) {
            const Job job = random_job(seed, 300, size_mm);
            const std::vector<PlannedMove> plan = plan_of(job);
            for (std::size_t i = 1; i < plan.size(); ++i) {
                const MoveLimits before = limits_of(job.moves[i - 1], job.limits);
                const MoveLimits after = limits_of(job.moves[i], job.limits);
                const double own =
                    std::min({before.speed_mm_s, after.speed_mm_s,
                              corner_speed_mm_s(job.moves[i - 1], job.moves[i], job.limits)});
                const double come = start_speed(plan[i - 1]), here = start_speed(plan[i]);
                const double leave = plan[i].profile.end_speed_mm_s;
                const double gain = 2 * before.acceleration_mm_s2 * plan[i - 1].profile.length_mm;
                const double loss = 2 * after.acceleration_mm_s2 * plan[i].profile.length_mm;
                const double most = std::min({own * own, come * come + gain, leave * leave + loss});
                REQUIRE(here * here == doctest::Approx(most).epsilon(relative_rounding));
            }
        }
}

TEST_CASE("planner 3: a line alone takes the time of its trapezoid") {
    Job job;
    job.limits = even_limits(1000, 1000);
    job.moves = {{Line{{0, 0, 0}, {100, 0, 0}, 0}, 50, 0, 0}};
    CHECK(duration_s(plan_of(job)) == doctest::Approx(0.05 + 2).epsilon(1e-12));
    job.moves = {{Line{{0, 0, 0}, {1, 0, 0}, 0}, 500, 0, 0}};
    CHECK(duration_s(plan_of(job)) == doctest::Approx(2 * std::sqrt(1e-3)).epsilon(1e-12));
}

TEST_CASE("planner 3: a line takes the same time whole and in a thousand pieces") {
    for (const double length_mm : {0.01, 1.0, 100.0}) {
        Job job;
        job.moves = {{Line{{0, 0, 0}, {length_mm, 0, 0}, 1}, 80, 0, 0}};
        const double whole_s = duration_s(plan_of(job));
        job.moves.clear();
        constexpr int pieces = 1000;
        const auto place = [&](int i) { return Point{length_mm * i / pieces, 0, 0}; };
        for (int i = 0; i < pieces; ++i)
            job.moves.push_back({Line{place(i), place(i + 1), 1.0 / pieces}, 80, 0, 0});
        CHECK(duration_s(plan_of(job)) == doctest::Approx(whole_s).epsilon(1e-9));
    }
}

TEST_CASE("planner 3: a circle takes the same time whole and in 2, 3 and 100 arcs") {
    for (const double radius_mm : {0.05, 1.0, 10.0, 200.0})
        for (const double sign : {1.0, -1.0}) {
            Job job;
            // The acceleration that is asked for is the same all around.
            job.limits = even_limits(1000, 1e5);
            std::vector<double> times;
            for (const int pieces : {1, 2, 3, 100}) {
                job.moves.clear();
                for (int i = 0; i < pieces; ++i) {
                    const double angle = 2 * pi / pieces * sign;
                    const Path arc =
                        arc_about(0, 0, radius_mm, angle * i, angle, 0, 0, 0.1 / pieces);
                    job.moves.push_back({arc, 100, 1000, 0});
                }
                times.push_back(duration_s(plan_of(job)));
            }
            for (const double time_s : times)
                CHECK(time_s == doctest::Approx(times.front()).epsilon(1e-3));
        }
}

TEST_CASE("planner 3: where axes limit a circle, splitting it does not slow it down") {
    Job job;
    job.limits.axes[axis_y] = {100, 1000};
    double whole_s = 0;
    for (const int pieces : {1, 2, 3, 100}) {
        job.moves.clear();
        const double angle = 2 * pi / pieces;
        for (int i = 0; i < pieces; ++i)
            job.moves.push_back({arc_about(0, 0, 10, angle * i, angle, 0, 0, 0), 200, 0, 0});
        const double time_s = duration_s(plan_of(job));
        if (pieces == 1) whole_s = time_s;
        CHECK(time_s <= whole_s * 1.001);
    }
}

TEST_CASE("planner 3: a path and its reverse take the same time") {
    for (unsigned seed = 0; seed < 10; ++seed) {
        Job job = random_job(seed, 400, 2);
        job.limits.minimum_cruise_ratio = seed % 2 == 0 ? 0 : 0.5;
        const double time_s = duration_s(plan_of(job));
        job.moves = test::reversed(job.moves);
        CHECK(duration_s(plan_of(job)) == doctest::Approx(time_s).epsilon(1e-9));
    }
}

TEST_CASE(
    "planner 1, 2: so they are with a ratio of cruising, with S-curves and small windows too" *
    doctest::test_suite("long")) {
    for (unsigned seed = 0; seed < 4; ++seed)
        for (const double size_mm : {0.01, 0.5, 20.0})
            for (const double jerk_mm_s3 : {0.0, 1e5}) {
                Job job = random_job(seed, 400, size_mm);
                job.limits.jerk_mm_s3 = jerk_mm_s3;
                double last_s = 0;
                for (const double ratio : {0.0, 0.3, 0.5, 0.9}) {
                    job.limits.minimum_cruise_ratio = ratio;
                    job.capacity = job.moves.size() + 1;
                    const double best_s = duration_s(plan_of(job));
                    CHECK(best_s >= last_s * (1 - relative_rounding));
                    last_s = best_s;
                    for (const std::size_t capacity : {4u, 16u, 256u, 401u}) {
                        job.capacity = capacity;
                        const std::vector<PlannedMove> plan = plan_of(job);
                        check_plan(job, plan);
                        // A peak that is gone holds to the next slow place, and in a wider view there may be one before.
                        CHECK(duration_s(plan) >= best_s * (1 - 1e-3));
                    }
                }
            }
}

TEST_CASE("planner 7: a line alone cruises for its ratio, with S-curves and in pieces too") {
    constexpr double length_mm = 8;
    for (const double ratio : {0.2, 0.5, 0.9})
        for (const int pieces : {1, 2, 7, 500})
            for (const double jerk_mm_s3 : {0.0, 3e4}) {
                if (pieces > 1 && jerk_mm_s3 > 0) continue;
                Job job;
                job.limits.minimum_cruise_ratio = ratio;
                job.limits.jerk_mm_s3 = jerk_mm_s3;
                const auto place = [&](int i) { return Point{length_mm * i / pieces, 0, 0}; };
                for (int i = 0; i < pieces; ++i)
                    job.moves.push_back({Line{place(i), place(i + 1), 0}, 290, 0, 0});
                CHECK(even_mm(plan_of(job)) == doctest::Approx(ratio * length_mm).epsilon(1e-6));
            }
}

TEST_CASE("planner 7: so does every side of a zigzag, of whatever pieces") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> even(0, 1);
    for (const double ratio : {0.3, 0.5, 0.9}) {
        Job job;
        job.limits.minimum_cruise_ratio = ratio;
        // All but stopping at every corner, so that nothing but the sides' lengths counts.
        job.limits.junction_deviation_mm = 1e-9;
        double length_mm = 0;
        Point at;
        for (int side = 0; side < 300; ++side) {
            const double angle_rad = (side % 2 == 0 ? 0.2 : 2.9) + 0.1 * even(random);
            const double way_mm = 0.05 + 4 * even(random);
            const int pieces = 1 + side % 5;
            for (int i = 0; i < pieces; ++i) {
                const Point to{at.x + way_mm / pieces * std::cos(angle_rad),
                               at.y + way_mm / pieces * std::sin(angle_rad), 0};
                // Far from the top speed, and the same acceleration in all directions.
                job.moves.push_back({Line{at, to, 0}, 200, 1000, 0});
                at = to;
            }
            length_mm += way_mm;
        }
        job.capacity = job.moves.size() + 1;
        CHECK(even_mm(plan_of(job)) == doctest::Approx(ratio * length_mm).epsilon(1e-6));
    }
}

TEST_CASE("planner 7: windows that hold a slow place plan as one that holds all") {
    for (const double jerk_mm_s3 : {0.0, 1e5}) {
        Job job = random_job(3, 1500, 5);
        job.limits.minimum_cruise_ratio = 0.5;
        job.limits.jerk_mm_s3 = jerk_mm_s3;
        const std::vector<PlannedMove> whole = plan_of(job);
        for (const std::size_t capacity : {100u, 333u}) {
            job.capacity = capacity;
            const std::vector<PlannedMove> plan = plan_of(job);
            REQUIRE(plan.size() == whole.size());
            for (std::size_t i = 0; i < plan.size(); ++i) {
                REQUIRE(start_speed(plan[i]) == doctest::Approx(start_speed(whole[i])));
                REQUIRE(plan[i].profile.duration_s ==
                        doctest::Approx(whole[i].profile.duration_s).epsilon(relative_rounding));
            }
        }
    }
}

TEST_CASE("planner 7: what goes straight on beyond a window brakes once, when it has to") {
    // The peak of a wider view has gone out when the end comes in sight.
    for (const double ratio : {0.3, 0.9}) {
        Job job;
        job.limits.minimum_cruise_ratio = ratio;
        job.capacity = 64;
        constexpr int pieces = 300;
        const auto place = [](int i) { return Point{0.1 * i, 0, 0}; };
        for (int i = 0; i < pieces; ++i)
            job.moves.push_back({Line{place(i), place(i + 1), 0}, 290, 0, 0});
        CHECK(even_mm(plan_of(job), false) < Planner::join_mm);
    }
}

TEST_CASE(
    "planner 7: a line after a flush cruises for its ratio, however fast the ones before were") {
    Limits limits = even_limits(300, 3000);
    limits.minimum_cruise_ratio = 0.5;
    Planner planner = *Planner::create(limits, 8);
    Point at;
    // The ring is full of pieces that are passed at speed, and then shorter runs take a part of it.
    for (const int pieces : {8, 3, 1}) {
        for (int i = 0; i < pieces; ++i) {
            const Point to{at.x + 1, 0, 0};
            REQUIRE(planner.push({Line{at, to, 0}, 290, 0, 0}).ok());
            at = to;
        }
        planner.flush();
        std::vector<PlannedMove> plan;
        for (PlannedMove planned; planner.pop(planned);) plan.push_back(planned);
        CHECK(even_mm(plan) == doctest::Approx(0.5 * pieces));
    }
}

TEST_CASE("planner 7: drawing filament back is not slowed") {
    Job job;
    job.moves = {{Line{{0, 0, 0}, {0, 0, 0}, -1}, 200, 0, 0}};
    const double free_s = duration_s(plan_of(job));
    job.limits.minimum_cruise_ratio = 0.9;
    CHECK(duration_s(plan_of(job)) == free_s);
}

TEST_CASE("planner 1: a dwell stops the machine for its time, a flush for none") {
    const Line first{{0, 0, 0}, {10, 0, 0}, 0}, second{{10, 0, 0}, {20, 0, 0}, 0};
    Planner planner = *Planner::create(even_limits(100, 1000));
    PlannedMove planned;
    REQUIRE(planner.push({first, 50, 0, 1}).ok());
    planner.dwell(2);
    planner.dwell(-1);
    planner.dwell(std::nan(""));
    planner.dwell(0.5);
    REQUIRE(planner.push({second, 50, 0, 2}).ok());
    CHECK(!planner.pop(planned));
    planner.flush();
    REQUIRE(planner.push({test::reversed(second), 50, 0, 3}).ok());
    const double each_s = 10.0 / 50 + 50.0 / 1000;
    for (const double start_s : {0.0, each_s + 2.5}) {
        REQUIRE(planner.pop(planned));
        CHECK(start_speed(planned) == 0);
        CHECK(planned.profile.end_speed_mm_s == 0);
        CHECK(static_cast<double>(planned.start_ns) / 1e9 == doctest::Approx(start_s));
    }
    CHECK(planned.tag == 2);
    // What came after the flush is not part of it.
    CHECK(!planner.pop(planned));
    planner.flush();
    REQUIRE(planner.pop(planned));
    CHECK(!planner.pop(planned));
    CHECK(static_cast<double>(planner.time_ns()) / 1e9 == doctest::Approx(3 * each_s + 2.5));
}

TEST_CASE("planner 3: a full planner gives at least a quarter and keeps the rest in view") {
    Planner planner = *Planner::create(even_limits(100, 1000), 64);
    Point at;
    const auto fill = [&] {
        while (!planner.full()) {
            const Point next{at.x + 1e-3, 0, 0};
            REQUIRE(planner.push({Line{at, next, 0}, 50, 0, 0}).ok());
            at = next;
        }
    };
    fill();
    PlannedMove planned;
    int given = 0;
    while (planner.pop(planned)) ++given;
    CHECK(given == 16);
    CHECK(planned.profile.end_speed_mm_s > 0);
}

TEST_CASE("planner 4: start times do not drift over a million moves" *
          doctest::test_suite("long")) {
    Planner planner = *Planner::create(even_limits(100, 1000), 16);
    PlannedMove planned;
    // In whole nanoseconds and parts of them, so that the sum loses nothing either.
    std::int64_t whole_ns = 0;
    double part_ns = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        const Line out{{0, 0, 0}, {0.013, 0, 0}, 0};
        REQUIRE(planner.push({i % 2 ? test::reversed(out) : Path(out), 50, 0, 0}).ok());
        planner.flush();
        REQUIRE(planner.pop(planned));
        const double duration_ns = planned.profile.duration_s * 1e9;
        whole_ns += std::llround(duration_ns);
        part_ns += duration_ns - std::round(duration_ns);
    }
    CHECK(std::abs(static_cast<double>(planner.time_ns() - whole_ns) - part_ns) <= 1.01);
}

TEST_CASE("planner 6: what cannot be a move is refused and changes nothing") {
    Planner planner = *Planner::create(even_limits(100, 1000), 4);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Line good{{0, 0, 0}, {10, 0, 0}, 0};
    const auto refuses = [&](const Path& path, double speed, double acceleration) {
        const Status pushed = planner.push({path, speed, acceleration, 0});
        CHECK(!pushed.ok());
        if (!pushed) CHECK(pushed.error().status == ExitStatus::machine);
    };
    for (const double bad : {nan, infinity, -infinity, 2e5}) {
        refuses(Line{{0, 0, 0}, {bad, 0, 0}, 0}, 10, 0);
        refuses(Line{{0, bad, 0}, {1, 0, 0}, 0}, 10, 0);
        refuses(Line{{0, 0, 0}, {1, 0, 0}, bad}, 10, 0);
        refuses(arc_through({0, 0, 0}, {1, 0, bad}, 1, 0), 10, 0);
    }
    for (const double bad : {nan, infinity, -1.0, 0.0, 1e-9}) refuses(good, bad, 0);
    for (const double bad : {nan, -1.0}) refuses(good, 10, bad);
    refuses(good, 10, 1e-12);
    Arc arc = std::get<Arc>(arc_through({0, 0, 0}, {1, 0, 0}, 0.1, 0));
    arc.to.y = 1e-3;
    refuses(arc, 10, 0);
    arc = std::get<Arc>(circle_about({0, 0, 0}, 1, 0, true, 0, 0));
    arc.sweep_rad *= 2;
    refuses(arc, 10, 0);
    arc.sweep_rad = nan;
    refuses(arc, 10, 0);

    REQUIRE(planner.push({good, 10, 0, 0}).ok());
    refuses(Line{{10.1, 0, 0}, {20, 0, 0}, 0}, 10, 0);
    REQUIRE(planner.push({Line{{10, 0, 0}, {10, 0, 0}, 0}, 10, 0, 0}).ok());
    REQUIRE(planner.push({test::reversed(good), 10, 0, 0}).ok());
    REQUIRE(planner.push({good, 10, 0, 0}).ok());
    REQUIRE(planner.push({test::reversed(good), 10, 0, 0}).ok());
    CHECK(planner.full());
    refuses(good, 10, 0);
    planner.flush();
    PlannedMove planned;
    int given = 0;
    while (planner.pop(planned)) ++given;
    CHECK(given == 4);
    CHECK(!Planner::create(even_limits(100, 0)).ok());
    CHECK(!Planner::create(even_limits(100, 1), 3).ok());
}

}  // namespace lyr::motion
