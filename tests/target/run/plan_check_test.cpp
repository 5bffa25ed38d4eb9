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

const AxisValues steps_per_mm{80, 80, 400, 400};

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
    PlanCheck check(steps_per_mm, {});
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

TEST_CASE("plan check 2: steps that are late, missing, doubled or turned round are found") {
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
