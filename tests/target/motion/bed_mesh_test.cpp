// Contract of target/motion/bed_mesh.h, by number, and of the generator over a crooked bed.

#include "target/motion/bed_mesh.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "timed_machine.h"

namespace lyr::motion {
namespace {

using test::Errors;
using test::errors_of;
using test::Job;
using test::moved_steps;
using test::Real;
using test::timed_run;
using test::TimedRun;

std::shared_ptr<const BedMesh> wavy(double pitch_mm, double height_mm, double fade_mm) {
    std::vector<double> heights_mm;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 5; ++column)
            heights_mm.push_back(height_mm * std::sin(2.1 * row * row + 1.3 * column));
    return std::make_shared<const BedMesh>(Point{-2 * pitch_mm, -1.5 * pitch_mm},
                                           Point{2 * pitch_mm, 1.5 * pitch_mm}, 5,
                                           std::move(heights_mm), fade_mm);
}

Job over_bed(unsigned seed, std::size_t count, double size_mm) {
    std::mt19937 random(seed);
    Job job;
    job.origin = {0.25, -1, 0.5};
    job.moves = test::random_moves(random, count, size_mm, job.origin, true);
    return job;
}

void check_steps(const TimedRun& timed) {
    for (std::size_t motor = 0; motor < motor_count; ++motor) {
        const Errors errors = errors_of(timed, motor);
        CHECK(errors.steps <= 0.5 + moved_steps);
        CHECK(errors.time_ns < 1000);
    }
}

}  // namespace

TEST_CASE("mesh 1, 2: cells say what the interpolation says, without jumps, and fade out") {
    const auto bed = wavy(10, 0.4, 8);
    for (double x = -27; x < 27; x += 2.731)
        for (double y = -21; y < 21; y += 1.917)
            for (const double z : {-1.0, 0.0, 0.3, 7.9, 8.0, 20.0}) {
                const MeshCell cell = bed->cell_at({x, y, z});
                const std::array<double, 3> place{x, y, z};
                for (std::size_t i = 0; i < 3; ++i) {
                    CHECK(cell.low_mm[i] <= place[i]);
                    CHECK(cell.high_mm[i] >= place[i]);
                }
                const double u = x - cell.x_mm, v = y - cell.y_mm;
                const double height_mm = cell.height_mm + cell.slope_x * u + cell.slope_y * v +
                                         cell.twist_per_mm * u * v;
                const double lift_mm = height_mm * (cell.share + cell.share_slope_per_mm * z);
                CHECK(lift_mm == doctest::Approx(bed->lift_mm({x, y, z})).epsilon(1e-12));
                const double beside_mm = bed->lift_mm({x + 1e-6, y - 1e-6, z + 1e-6});
                CHECK(std::abs(beside_mm - bed->lift_mm({x, y, z})) < 1e-6);
            }
    CHECK(bed->lift_mm({0, 0, 8}) == 0);
    CHECK(bed->lift_mm({-100, 3, 1}) == bed->lift_mm({-20, 3, 1}));
}

TEST_CASE("mesh 3: no path changes the lift faster than the shape says") {
    const auto bed = wavy(10, 0.4, 0);
    const double h = 1e-4;
    double steepest = 0;
    for (double x = -25; x < 25; x += 0.77)
        for (double y = -20; y < 20; y += 0.81)
            steepest =
                std::max(steepest, std::hypot(bed->lift_mm({x + h, y}) - bed->lift_mm({x, y}),
                                              bed->lift_mm({x, y + h}) - bed->lift_mm({x, y})) /
                                       h);
    CHECK(steepest <= bed->shape().slope * (1 + 1e-9));
    CHECK(steepest > bed->shape().slope / 2);
}

TEST_CASE("mesh: every step of every machine is within half a microstep of the lifted path" *
          doctest::test_suite("long")) {
    Delta delta{{100, 100, 100, 415.3}, {}};
    for (std::size_t i = 0; i < Delta::tower_count; ++i) {
        const double angle_rad = (210.0 + 120.0 * static_cast<double>(i)) * std::numbers::pi / 180;
        delta.towers[i] = {120 * std::cos(angle_rad), 120 * std::sin(angle_rad), 250};
    }
    for (const double fade_mm : {0.0, 5.0})
        for (const double size_mm : {0.02, 1.0, 12.0}) {
            const Job job = over_bed(5, size_mm > 10 ? 3 : 12, size_mm);
            Shaping shaping;
            shaping.bed = wavy(2.5, 0.3, fade_mm);
            check_steps(timed_run(job, job.cartesian, shaping));
            check_steps(timed_run(job, CoreXy{{80, 80, 400, 415}}, shaping));
            check_steps(timed_run(job, delta, shaping));
            if (fade_mm == 0) continue;
            for (std::size_t axis = 0; axis < 3; ++axis)
                shaping.axes[axis] = taps_of(Shaper{ShaperKind::mzv, 40, 0.1}, axis);
            check_steps(timed_run(job, job.cartesian, shaping));
        }
}

TEST_CASE("mesh: ways along the grid's lines, into its corners and to and fro over a line") {
    Job job;
    job.origin = {-5, -3.75, 0.2};
    Shaping shaping;
    shaping.bed = wavy(2.5, 0.3, 4);
    const std::array places{Point{5, -3.75, 0.2}, Point{5, 3.75, 0.2},   Point{-5, 3.75, 0.2},
                            Point{-5, -3.75, 0},  Point{0, 0, 0},        Point{2.5, 1.25, 4},
                            Point{2.5, -1.25, 4}, Point{2.5, 1.25, 0.2}, Point{2.500001, 1.25, 0.2},
                            Point{2.5, 1.25, 0.2}};
    Point at = job.origin;
    for (const Point& to : places) {
        job.moves.push_back({Line{at, to, 0.1}, 60, 0, 0});
        at = to;
    }
    // Arcs that touch a grid line from within.
    job.moves.push_back({circle_about(at, 1.25, 1.25, true, 0.2, 1), 80, 0, 0});
    job.moves.push_back({circle_about(at, 3.75, 1.25, false, 0.2, 1), 80, 0, 0});
    check_steps(timed_run(job, job.cartesian, shaping));
    check_steps(timed_run(job, CoreXy{{80, 80, 400, 415}}, shaping));
}

TEST_CASE("limits 4: over a steep bed no way asks more of z than it can") {
    Job job = over_bed(9, 40, 6);
    job.limits.axes[axis_z] = {2, 40};
    const auto bed = wavy(2.5, 0.3, 5);
    job.limits.bed = bed->shape();
    const test::Run plan{job, test::plan_of(job), {}, {}, 0};
    const test::Ideal ideal(plan);
    double fastest = 0, strongest = 0;
    for (std::size_t i = 0; i < plan.plan.size(); ++i) {
        const double duration_s = plan.plan[i].profile.duration_s;
        for (int look = 1; look < 60; ++look) {
            const double h = duration_s / 60;
            std::array<double, 3> z{};
            bool same_cell = true;
            std::optional<MeshCell> cell;
            for (int k = -1; k <= 1; ++k) {
                const auto at = ideal.in_move(i, static_cast<Real>((look + 0.2 * k) * h));
                const Point head{static_cast<double>(at[0]), static_cast<double>(at[1]),
                                 static_cast<double>(at[2])};
                const MeshCell here = bed->cell_at(head);
                same_cell = same_cell && (!cell || cell->low_mm == here.low_mm);
                cell = here;
                z[static_cast<std::size_t>(k + 1)] = head.z + bed->lift_mm(head);
            }
            const double dt = 0.2 * h;
            fastest = std::max(fastest, std::abs(z[2] - z[0]) / (2 * dt));
            // A look that spans the end of a phase sees a mean of two accelerations.
            if (same_cell && dt > 1e-4)
                strongest = std::max(strongest, std::abs(z[2] - 2 * z[1] + z[0]) / (dt * dt));
        }
    }
    CHECK(fastest <= 2 * 1.001);
    CHECK(fastest > 0.5);
    CHECK(strongest <= 40 * 1.01);
    CHECK(strongest > 5);
}

TEST_CASE("limits 4: on a tilted bed z turns with an arc, and keeps to its acceleration") {
    Limits limits = test::even_limits(1'000, 1e6);
    limits.bed_jump_mm_s = 1e3;
    const double slope = 0.02;
    for (const double z_mm_s2 : {10.0, 100.0}) {
        limits.axes[axis_z] = {1e3, z_mm_s2};
        const BedMesh bed({0, 0}, {100, 100}, 2, {0, slope * 100, 0, slope * 100}, 0);
        limits.bed = bed.shape();
        for (const double radius_mm : {1.0, 5.0, 40.0}) {
            const Path circle = circle_about({50 + radius_mm, 50, 0}, 50, 50, true, 0, 0);
            const MoveLimits own = limits_of({circle, 1'000, 0, 0}, limits);
            const double turning_mm_s2 = slope * own.speed_mm_s * own.speed_mm_s / radius_mm;
            const double gaining_mm_s2 = slope * own.acceleration_mm_s2;
            CHECK(std::hypot(turning_mm_s2, gaining_mm_s2) <= z_mm_s2 * (1 + 1e-9));
            CHECK(turning_mm_s2 > z_mm_s2 / 4);
        }
    }
}

TEST_CASE(
    "limits 4: what climbs over a tilted bed is as fast as z can follow both, along lines and "
    "arcs") {
    Limits limits = test::even_limits(1e6, 1e9);
    limits.axes[axis_z] = {2, 1e9};
    limits.bed_jump_mm_s = 1e6;
    constexpr double slope = 0.02, rise_mm = 5;
    const BedMesh bed({0, 0}, {100, 100}, 2, {0, slope * 100, 0, slope * 100}, 0);
    limits.bed = bed.shape();
    for (const Path& path : {Path{Line{{20, 20, 0}, {80, 20, rise_mm}}},
                             circle_about({60, 50, 0}, 50, 50, true, rise_mm, 0)}) {
        const double rise = rise_mm / length_of(path), level = std::sqrt(1 - rise * rise);
        const double speed_mm_s = limits_of({path, 1e6, 0, 0}, limits).speed_mm_s;
        CHECK(speed_mm_s * (rise + slope * level) ==
              doctest::Approx(limits.axes[axis_z].speed_mm_s));
    }
}

TEST_CASE("limits 4: the speed of z jumped where a bed had faded") {
    Limits limits = test::even_limits(200, 3'000);
    limits.axes[axis_z] = {40, 500};
    const double fade_mm = 1;
    // A flat bed that is 0.5 mm too high, one that is as crooked as that, and ways that meet both edges.
    const std::vector<double> flat(4, 0.5), crooked{0.5, -0.2, 0.1, 0.4};
    for (const std::vector<double>& heights_mm : {flat, crooked}) {
        const BedMesh bed({0, 0}, {100, 100}, 2, heights_mm, fade_mm);
        limits.bed = bed.shape();
        for (const double rise_mm : {2.0, -2.0})
            for (const Path& path :
                 {Path{Line{{5, 5, 1 - rise_mm / 2}, {5, 5, 1 + rise_mm / 2}}},
                  Path{Line{{5, 90, 1 - rise_mm / 2}, {5.5, 90, 1 + rise_mm / 2}}},
                  Path{circle_about({50, 20, 1 - rise_mm / 2}, 50.5, 20, true, 1 + rise_mm / 2,
                                    0)}}) {
                const double speed_mm_s = limits_of({path, 1'000, 0, 0}, limits).speed_mm_s;
                const double length_mm = length_of(path), h = 1e-5;
                double worst_mm_s = 0;
                for (const double edge_mm : {0.0, fade_mm}) {
                    const double s = length_mm * (edge_mm - start_of(path).z) / rise_mm;
                    if (s < 2 * h || s > length_mm - 2 * h) continue;
                    const auto slope = [&](double from) {
                        return (bed.lift_mm(point_at(path, from + h)) -
                                bed.lift_mm(point_at(path, from))) /
                               h;
                    };
                    worst_mm_s =
                        std::max(worst_mm_s, speed_mm_s * std::abs(slope(s) - slope(s - h)));
                }
                CHECK(worst_mm_s > 0.01);
                CHECK(worst_mm_s <= limits.bed_jump_mm_s * 1.001);
            }
        // What stays above is slowed by no edge.
        const Line above{{50, 50, 2}, {50, 50, 20}};
        CHECK(limits_of({above, 1'000, 0, 0}, limits).speed_mm_s > 20);
    }
}

}  // namespace lyr::motion
