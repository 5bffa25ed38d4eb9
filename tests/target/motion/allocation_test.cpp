// Counts what this program allocates, to see that planning and stepping do not.

#include <doctest/doctest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "machine.h"
#include "target/motion/shaper.h"

namespace {

std::atomic<std::size_t> allocations{0};

}  // namespace

void* operator new(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace lyr::motion {

TEST_CASE("planner 5, steps 6: nothing is allocated once the machine is set up") {
    std::mt19937 random(12);
    test::Job job;
    job.moves = test::random_moves(random, 5000, 0.5, job.origin, true);
    Planner planner = *Planner::create(job.limits, 256);
    StepGenerator generator(job.cartesian, job.origin);
    std::array<StepEvent, 64> events;
    PlannedMove planned;
    const auto step_all = [&] {
        while (planner.pop(planned)) {
            generator.start(planned);
            while (generator.next(events) == events.size()) continue;
        }
    };
    const std::size_t before = allocations;
    bool refused = false;
    for (const Move& move : job.moves) {
        if (planner.full()) step_all();
        refused = refused || !planner.push(move).ok();
    }
    planner.dwell(1);
    planner.flush();
    step_all();
    CHECK(allocations == before);
    CHECK(!refused);
}

TEST_CASE("timed 5: nothing is allocated there either" * doctest::test_suite("long")) {
    std::mt19937 random(12);
    test::Job job;
    job.moves = test::random_moves(random, 3000, 0.5, job.origin, true);
    job.limits.jerk_mm_s3 = 1e5;
    Shaping shaping;
    for (std::size_t axis = 0; axis < 3; ++axis)
        shaping.axes[axis] = taps_of(Shaper{ShaperKind::ei, 40, 0.1}, axis);
    shaping.extruder = taps_of(PressureAdvance{0.05, 0.04});
    const std::vector<PlannedMove> plan = test::plan_of(job);
    for (const Kinematics& machine :
         {Kinematics{CoreXy{{80, 80, 400, 415}}},
          Kinematics{
              Delta{{80, 80, 80, 415}, {{{-200, 0, 600}, {100, 170, 600}, {100, -170, 600}}}}}}) {
        TimedGenerator generator(machine, job.origin, shaping);
        std::array<StepEvent, 64> events;
        const std::size_t before = allocations;
        for (const PlannedMove& planned : plan) {
            generator.start(planned);
            while (generator.next(events) == events.size()) continue;
        }
        generator.finish();
        while (generator.next(events) == events.size()) continue;
        CHECK(allocations == before);
    }
}

}  // namespace lyr::motion
