// Contract of target/run/plan_check.h, by number: the plan's own steps, and what faults make of them.

#include "target/run/plan_check.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "target/run/print_files.h"
#include "target/run/step_stream.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

const AxisValues generic_steps_per_mm{80, 80, 400, 400};

struct Planned {
    std::vector<Step> steps;
    std::vector<motion::PlannedMove> moves;
};

Planned planned(const std::string& file) {
    Result<StepStream> stream = StepStream::open(file, config::generic_printer(), 1.75);
    REQUIRE(stream.ok());
    Planned result;
    for (bool more = true; more;) {
        const Result<bool> next = stream->next(result.steps);
        REQUIRE(next.ok());
        more = *next;
        result.moves.insert(result.moves.end(), stream->moves().begin(), stream->moves().end());
    }
    return result;
}

double worst(const std::vector<motion::PlannedMove>& moves, const std::vector<Step>& steps,
             std::span<const Shift> shifts = {}) {
    PlanCheck check(generic_steps_per_mm, {});
    check.expect(moves, shifts);
    StepPositions at{};
    for (const Step& step : steps) {
        check.step({step.time_ns, step.axis, at, step.positive});
        at[step.axis] += step.positive ? 1 : -1;
    }
    check.finish(at);
    return *std::max_element(check.deviation_steps().begin(), check.deviation_steps().end());
}

const std::vector<Drawing> drawings{draw_arcs, draw_climb};

}  // namespace

TEST_CASE("plan check 1: the plan's own steps are half a step off at most") {
    const Planned all = planned(write_print("plan", drawings));
    const double off = worst(all.moves, all.steps);
    CHECK(off > 0.4999);
    CHECK(off < 0.5001);
}

TEST_CASE("plan check 1: steps that are all late by a known shift are not off") {
    const Planned all = planned(write_print("plan", drawings));
    std::vector<Step> late = all.steps;
    const std::size_t half = late.size() / 2;
    for (std::size_t i = 0; i < late.size(); ++i)
        late[i].time_ns += i < half ? 5'000'000 : 7'000'000;
    const std::vector<Shift> shifts{{0, 5'000'000}, {late[half].time_ns, 7'000'000}};
    CHECK(worst(all.moves, late, shifts) < 0.5001);
    CHECK(worst(all.moves, late) > 5);
}

TEST_CASE("plan check 2: steps that are late, missing, doubled or turned round are found" *
          doctest::test_suite("long")) {
    const Planned all = planned(write_print("plan", drawings));
    std::mt19937 random(8);
    for (int trial = 0; trial < 40; ++trial) {
        std::vector<Step> steps = all.steps;
        const std::size_t at = random() % steps.size();
        const auto place = steps.begin() + static_cast<std::ptrdiff_t>(at);
        switch (trial % 3) {
            case 0:
                steps.erase(place);
                break;
            case 1:
                steps.insert(place, *place);
                break;
            case 2:
                place->positive = !place->positive;
                break;
        }
        CHECK(worst(all.moves, steps) > 0.9);
    }
    CHECK(worst(all.moves, {}) > 100);
    CHECK(worst({}, all.steps) > 100);
}

TEST_CASE("plan check 1: the filament of very many moves adds up without drifting") {
    // A step each, behind a hundred metres: every sum is rounded the same way.
    constexpr double far_mm = 1e5, step_mm = 0.0025, slow_mm_s = 0.5;
    constexpr int moves = 20'000;
    motion::Limits limits;
    for (motion::AxisLimits& axis : limits.axes) axis = {1e6, 1e8};
    auto planner = motion::Planner::create(limits);
    REQUIRE(planner.ok());
    PlanCheck check(generic_steps_per_mm, {});
    StepPositions at{};
    const auto plan = [&](double advance_mm) {
        REQUIRE(planner->push({motion::Line{{}, {}, advance_mm}, slow_mm_s}).ok());
        planner->flush();
        motion::PlannedMove planned;
        REQUIRE(planner->pop(planned));
        check.expect({&planned, 1}, {});
        return planned;
    };
    plan(far_mm);
    at[motion::axis_e] = std::llround(far_mm / step_mm);
    for (int i = 0; i < moves; ++i) {
        const motion::PlannedMove move = plan(step_mm);
        const double middle_ns = move.profile.time_at(step_mm / 2) * 1e9 + move.start_part_ns;
        check.step({move.start_ns + std::llround(middle_ns), motion::axis_e, at, true});
        ++at[motion::axis_e];
    }
    check.finish(at);
    CHECK(check.deviation_steps()[motion::axis_e] > 0.499);
    CHECK(check.deviation_steps()[motion::axis_e] < 0.50001);
}
