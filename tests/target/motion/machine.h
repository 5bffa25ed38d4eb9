// For the tests of motion: plans a list of moves, takes all steps, and knows where the axes ideally
// are at any time. The ideal is computed straight from the plan's paths and phases, apart from the
// code that finds the steps.

#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

#include "target/motion/step_generator.h"

namespace lyr::motion::test {

// The widest that the processor computes with itself. Wider ones (128 bits on arm64) are computed by
// a library, a hundred times slower.
using Real =
    std::conditional_t<std::numeric_limits<long double>::digits <= 64, long double, double>;
using AxisReals = std::array<Real, axis_count>;

// Contract 2 of both generators: no step is off its time by more.
inline constexpr Real exact_ns = 1000;

inline Limits even_limits(double speed_mm_s, double acceleration_mm_s2) {
    Limits limits;
    limits.axes.fill({speed_mm_s, acceleration_mm_s2});
    return limits;
}

struct Job {
    std::vector<Move> moves;
    Limits limits = even_limits(300, 3000);
    Cartesian cartesian{{80, 80, 400, 415.3}};
    Point origin;
    std::size_t capacity = Planner::default_capacity;
};

struct Run {
    Job job;
    std::vector<PlannedMove> plan;
    std::vector<StepEvent> events;
    StepCounts counts{};
    double end_ns = 0;

    double duration_s() const { return end_ns / 1e9; }
};

inline std::vector<PlannedMove> plan_of(const Job& job) {
    Result<Planner> planner = Planner::create(job.limits, job.capacity);
    REQUIRE(planner.ok());
    std::vector<PlannedMove> plan;
    PlannedMove planned;
    for (const Move& move : job.moves) {
        while (planner->full()) {
            REQUIRE(planner->pop(planned));
            plan.push_back(planned);
        }
        const Status pushed = planner->push(move);
        REQUIRE_MESSAGE(pushed.ok(), pushed.error().message);
    }
    planner->flush();
    while (planner->pop(planned)) plan.push_back(planned);
    return plan;
}

inline double end_ns_of(const PlannedMove& planned) {
    return static_cast<double>(planned.start_ns) + planned.start_part_ns +
           planned.profile.duration_s * 1e9;
}

inline Run run(const Job& job) {
    Run result{job, plan_of(job), {}, {}, 0};
    StepGenerator generator(job.cartesian, job.origin);
    std::array<StepEvent, 64> batch;
    for (const PlannedMove& planned : result.plan) {
        generator.start(planned);
        std::size_t count;
        do {
            count = generator.next(batch);
            result.events.insert(result.events.end(), batch.begin(), batch.begin() + count);
        } while (count == batch.size());
    }
    result.counts = generator.counts();
    if (!result.plan.empty()) result.end_ns = end_ns_of(result.plan.back());
    return result;
}

// Where the plan wants the axes to be.
class Ideal {
public:
    explicit Ideal(const Run& run) : run_(run) {
        Real advance = 0;
        for (const PlannedMove& planned : run.plan) {
            starts_ns_.push_back(static_cast<Real>(planned.start_ns) + planned.start_part_ns);
            advances_.push_back(advance);
            advance += advance_of(planned.path);
        }
    }

    // Axes in mm; between moves where the one before has ended.
    AxisReals at_ns(Real time_ns) {
        while (index_ + 1 < starts_ns_.size() && starts_ns_[index_ + 1] <= time_ns) ++index_;
        while (index_ > 0 && starts_ns_[index_] > time_ns) --index_;
        return in_move(index_, (time_ns - starts_ns_[index_]) / Real{1e9});
    }

    AxisReals in_move(std::size_t index, Real time_s) const {
        const PlannedMove& planned = run_.plan[index];
        const Real share = distance(planned.profile, time_s) / planned.profile.length_mm;
        AxisReals axes =
            std::visit([&](const auto& path) { return at(path, share); }, planned.path);
        axes[axis_e] = advances_[index] + share * advance_of(planned.path);
        return axes;
    }

    // Of a move's length, after a time.
    Real share(std::size_t index, Real time_s) const {
        const Profile& profile = run_.plan[index].profile;
        return distance(profile, time_s) / profile.length_mm;
    }

    // In steps from the origin.
    Real steps_at_ns(std::size_t motor, Real time_ns) { return steps(motor, at_ns(time_ns)); }
    Real steps(std::size_t motor, const AxisReals& axes) const {
        const Point& o = run_.job.origin;
        const std::array<Real, axis_count> origin{o.x, o.y, o.z, 0};
        return (axes[motor] - origin[motor]) * run_.job.cartesian.steps_per_mm[motor];
    }

private:
    static Real distance(const Profile& profile, Real time_s) {
        time_s = std::clamp<Real>(time_s, 0, profile.duration_s);
        std::size_t i = Profile::phase_count - 1;
        while (i > 0 && profile.phases[i].time_s > time_s) --i;
        const Phase& phase = profile.phases[i];
        const Real t = time_s - phase.time_s;
        return phase.distance_mm + t * (phase.speed_mm_s + t * (phase.acceleration_mm_s2 / 2 +
                                                                t * phase.jerk_mm_s3 / 6));
    }
    static AxisReals at(const Line& line, Real share) {
        const auto between = [share](Real from, Real to) { return from + share * (to - from); };
        return {between(line.from.x, line.to.x), between(line.from.y, line.to.y),
                between(line.from.z, line.to.z), 0};
    }
    static AxisReals at(const Arc& arc, Real share) {
        const Real half = share * arc.sweep_rad / 2;
        const Real chord = 2 * static_cast<Real>(arc.radius_mm) * std::sin(half);
        const Real middle = arc.start_angle_rad + half;
        return {arc.from.x - chord * std::sin(middle), arc.from.y + chord * std::cos(middle),
                arc.from.z + share * (static_cast<Real>(arc.to.z) - arc.from.z), 0};
    }

    const Run& run_;
    std::vector<Real> starts_ns_, advances_;
    std::size_t index_ = 0;
};

struct MotorStep {
    std::int64_t time_ns;
    int direction;
};

inline std::vector<MotorStep> steps_of(const Run& run, std::size_t motor) {
    std::vector<MotorStep> steps;
    for (const StepEvent& event : run.events)
        if (event.motors >> motor & 1)
            steps.push_back({event.time_ns, event.positive >> motor & 1 ? 1 : -1});
    return steps;
}

// How far a motor's position ever is from the ideal, in steps: looked at on both sides of every
// step and at a few times between each two.
inline Real largest_deviation(const Run& run, std::size_t motor) {
    constexpr int looks = 4;
    Ideal ideal(run);
    Real worst = 0, last_ns = 0;
    std::int64_t count = 0;
    const auto look_until = [&](Real time_ns) {
        for (int i = 0; i <= looks; ++i) {
            const Real at_ns = last_ns + (time_ns - last_ns) * i / looks;
            const Real off = ideal.steps_at_ns(motor, at_ns) - static_cast<Real>(count);
            worst = std::max(worst, std::abs(off));
        }
        last_ns = time_ns;
    };
    for (const MotorStep& step : steps_of(run, motor)) {
        look_until(static_cast<Real>(step.time_ns));
        count += step.direction;
    }
    look_until(run.end_ns);
    CHECK(count == run.counts[motor]);
    return worst;
}

// Half a step, and what the motor may move in the nanosecond to which times are rounded.
inline Real allowed_deviation(const Run& run, std::size_t motor) {
    return Real{0.5} +
           run.job.limits.axes[motor].speed_mm_s * std::abs(run.job.cartesian.steps_per_mm[motor]) *
               Real{1e-9} +
           Real{1e-6};
}

// Where `passed` becomes true between `low` and `high`, to `fine_ns` or between two numbers next to
// each other.
template <class Passed>
Real first_passed(Real low, Real high, Real fine_ns, const Passed& passed) {
    while (high - low > fine_ns) {
        const Real middle = (low + high) / 2;
        if (!(low < middle && middle < high)) break;
        (passed(middle) ? high : low) = middle;
    }
    return high;
}

// The largest error of any step's time against a bisection of the ideal, in ns.
inline Real largest_time_error_ns(const Run& run, std::size_t motor) {
    constexpr Real close_ns = 2, fine_ns = 1e-4;
    Ideal ideal(run);
    const std::vector<MotorStep> steps = steps_of(run, motor);
    Real worst = 0;
    std::int64_t count = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const Real middle = static_cast<Real>(count) + steps[i].direction / Real{2};
        const Real now = static_cast<Real>(steps[i].time_ns);
        const Real before = i > 0 ? static_cast<Real>(steps[i - 1].time_ns) : 0;
        const Real after = i + 1 < steps.size() ? static_cast<Real>(steps[i + 1].time_ns)
                                                : std::max<Real>(now, run.end_ns);
        Real low = (before + now) / 2, high = (now + after) / 2;
        const auto passed = [&](Real time_ns) {
            return (ideal.steps_at_ns(motor, time_ns) - middle) * steps[i].direction >= 0;
        };
        // Mostly the answer is near by.
        if (now - close_ns > low && !passed(now - close_ns)) low = now - close_ns;
        if (now + close_ns < high && passed(now + close_ns)) high = now + close_ns;
        if (passed(low) || !passed(high)) {
            // Steps closer together than times are rounded to.
            worst = std::max(worst, after - before);
        } else {
            worst = std::max(worst, std::abs(first_passed(low, high, fine_ns, passed) - now));
        }
        count += steps[i].direction;
    }
    return worst;
}

// Lines and arcs that hang together, from `start`; with z and the extruder if asked for.
inline std::vector<Move> random_moves(std::mt19937& random, std::size_t count, double size_mm,
                                      Point start, bool with_z_and_e) {
    std::uniform_real_distribution<double> even(-1, 1);
    std::vector<Move> moves;
    Point at = start;
    for (std::size_t i = 0; i < count; ++i) {
        Point to{at.x + size_mm * even(random), at.y + size_mm * even(random), at.z};
        // Not to wander out of the machine.
        if (std::abs(to.x) > 200) to.x = 200 * even(random);
        if (std::abs(to.y) > 200) to.y = 200 * even(random);
        if (with_z_and_e && i % 7 == 0) to.z = std::min(size_mm, 10.0) * std::abs(even(random));
        const double advance_mm = with_z_and_e ? size_mm * (0.03 + 0.02 * even(random)) : 0;
        Move move;
        if (i % 3 == 0)
            move.path = Line{at, to, advance_mm};
        else if (i % 11 == 0)
            move.path = circle_about(at, to.x, to.y, i % 2 == 0, to.z, advance_mm);
        else
            move.path = arc_through(at, to, size_mm * even(random), advance_mm);
        move.speed_mm_s = 20 + 130 * std::abs(even(random));
        move.acceleration_mm_s2 = i % 5 == 0 ? 1500 : 0;
        at = end_of(move.path);
        moves.push_back(move);
    }
    return moves;
}

inline Path reversed(const Path& path) {
    if (const auto* line = std::get_if<Line>(&path))
        return Line{line->to, line->from, -line->advance_mm};
    Arc arc = std::get<Arc>(path);
    std::swap(arc.from, arc.to);
    arc.advance_mm = -arc.advance_mm;
    arc.start_angle_rad += arc.sweep_rad;
    arc.sweep_rad = -arc.sweep_rad;
    return arc;
}

inline std::vector<Move> reversed(std::vector<Move> moves) {
    std::reverse(moves.begin(), moves.end());
    for (Move& move : moves) move.path = reversed(move.path);
    return moves;
}

}  // namespace lyr::motion::test
