// Contract of target/run/timed_check.h, by number, where whole simulations do not get.

#include "target/run/timed_check.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/constants.h"
#include "target/moves/move_maker.h"

using namespace lyr;
using namespace lyr::run;

namespace {

// Some ms each, from the origin along x.
std::vector<motion::PlannedMove> short_moves(const config::Printer& printer, int count) {
    constexpr double length_mm = 5e-4;
    Result<motion::Planner> planner = motion::Planner::create(moves::motion_limits(printer));
    REQUIRE(planner.ok());
    for (int i = 0; i < count; ++i)
        REQUIRE(planner
                    ->push({motion::Line{{i * length_mm, 0, 0}, {(i + 1) * length_mm, 0, 0}, 0}, 10,
                            1'000, 1})
                    .ok());
    planner->flush();
    std::vector<motion::PlannedMove> planned(static_cast<std::size_t>(count));
    for (motion::PlannedMove& move : planned) REQUIRE(planner->pop(move));
    return planned;
}

std::int64_t end_ns(const motion::PlannedMove& move) {
    return move.start_ns + std::llround(move.profile.duration_s * ns_per_s);
}

}  // namespace

TEST_CASE("timed check 1: looks that come after all were taken are taken before the next step") {
    config::Printer printer = config::generic_printer();
    printer.shapers[config::axis_x] = {config::ShaperKind::zv, 40, 0.1};
    const ShapedPlan plan(printer);
    const auto moves = short_moves(printer, 3);
    // Nothing is forgotten before all of this is over.
    REQUIRE(end_ns(moves[2]) + plan.lead_ns() + 2 < moves[1].start_ns + plan.reach_ns());
    TimedCheck check(printer);
    StepPositions at{};
    check.expect(std::span(moves).first(2), {});
    check.step({end_ns(moves[1]) + plan.lead_ns() + 1, config::axis_x, at, true});
    check.expect(std::span(moves).last(1), {});
    check.step({end_ns(moves[2]) + plan.lead_ns() + 1, config::axis_x, at, false});
    at[config::axis_z] = 1'000;
    check.step({end_ns(moves[2]) + plan.reach_ns() + 1, config::axis_x, at, true});
    CHECK(check.off_plan()[config::axis_z] == 0);
}
