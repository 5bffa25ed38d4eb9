// Speeds and accelerations of the axes as the steps carry them out: by differences of the ideal
// motion over time, apart from everything that computed the limits.

#include <doctest/doctest.h>

#include <cmath>

#include "machine.h"

namespace lyr::motion {
namespace {

using test::AxisReals;
using test::Ideal;
using test::Job;
using test::Real;
using test::Run;

// A difference is a mean of what it is taken for, so that only rounding can put it above the limit:
// four positions of up to 200 mm, over the square of a time of at least 0.1 us, or 5 us where a Real
// has the digits of a double.
constexpr Real share_of_rounding = 1e-6;
constexpr Real rounding_mm_s2 = 0.02;
constexpr Real shortest_s = 1e-4;
constexpr Real share_of_phase = std::numeric_limits<Real>::digits >= 64 ? 1e-3 : 0.05;

struct Largest {
    AxisReals speed{}, acceleration{};
    Real along_path = 0;  // speed over the one that was asked for
};

// Looks at many times within each phase of each move.
Largest largest(const Run& run) {
    constexpr int looks = 16;
    const Ideal ideal(run);
    Largest found;
    for (std::size_t move = 0; move < run.plan.size(); ++move) {
        const Profile& profile = run.plan[move].profile;
        for (std::size_t phase = 0; phase < Profile::phase_count; ++phase) {
            const Real from = profile.phases[phase].time_s;
            const Real to = phase + 1 < Profile::phase_count ? profile.phases[phase + 1].time_s
                                                             : profile.duration_s;
            if (to - from < shortest_s) continue;
            const Real h = (to - from) * share_of_phase;
            for (int look = 0; look < looks; ++look) {
                const Real at = from + h + (to - from - 2 * h) * look / (looks - 1);
                const AxisReals a = ideal.in_move(move, at - h), b = ideal.in_move(move, at),
                                c = ideal.in_move(move, at + h);
                Real squared = 0;
                for (std::size_t i = 0; i < axis_count; ++i) {
                    const Real speed = (c[i] - a[i]) / (2 * h);
                    const Real acceleration = (a[i] - 2 * b[i] + c[i]) / (h * h);
                    found.speed[i] = std::max(found.speed[i], std::abs(speed));
                    found.acceleration[i] = std::max(found.acceleration[i], std::abs(acceleration));
                    if (i != axis_e) squared += speed * speed;
                }
                found.along_path =
                    std::max(found.along_path, std::sqrt(squared) / run.job.moves[move].speed_mm_s);
            }
        }
    }
    return found;
}

}  // namespace

TEST_CASE("limits 1, planner 2: no axis is ever faster or accelerated more than its limit") {
    for (unsigned seed = 0; seed < 8; ++seed)
        for (const double size_mm : {0.1, 2.0, 40.0}) {
            std::mt19937 random(seed);
            Job job;
            job.limits.axes = {AxisLimits{120, 3000}, AxisLimits{80, 1200}, AxisLimits{8, 100},
                               AxisLimits{5, 500}};
            job.moves = test::random_moves(random, 300, size_mm, job.origin, true);
            const Run run{job, test::plan_of(job), {}, {}, 0};
            const Largest found = largest(run);
            for (std::size_t i = 0; i < axis_count; ++i) {
                CHECK(found.speed[i] <= job.limits.axes[i].speed_mm_s * (1 + share_of_rounding));
                CHECK(found.acceleration[i] <=
                      job.limits.axes[i].acceleration_mm_s2 * (1 + share_of_rounding) +
                          rounding_mm_s2);
            }
            CHECK(found.along_path <= 1 + share_of_rounding);
        }
}

TEST_CASE("limits 3, planner 2: a line into a tangent arc and out again keeps its speed") {
    Job job;
    job.limits = test::even_limits(500, 3000);
    // A stadium: two lines of 50 mm and two half circles of radius 5 mm; 60 mm/s need 720 mm/s^2
    // there.
    const Point a{0, 0, 0}, b{50, 0, 0}, c{50, 10, 0}, d{0, 10, 0};
    for (int round = 0; round < 3; ++round) {
        job.moves.push_back({Line{a, b, 1}, 60, 0, 0});
        job.moves.push_back({arc_through(b, c, 5, 0.02 * 5 * 3.14159265358979), 60, 0, 0});
        job.moves.push_back({Line{c, d, 1}, 60, 0, 0});
        job.moves.push_back({arc_through(d, a, 5, 0.02 * 5 * 3.14159265358979), 60, 0, 0});
    }
    const std::vector<PlannedMove> plan = test::plan_of(job);
    for (std::size_t i = 1; i < plan.size(); ++i) CHECK(plan[i].profile.phases[0].speed_mm_s == 60);
}

}  // namespace lyr::motion
