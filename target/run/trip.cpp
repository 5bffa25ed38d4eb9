// A machine of its own whose origin is where the head is: steps count from there.

#include "target/run/trip.h"

#include <array>
#include <cmath>

#include "target/motion/planner.h"
#include "target/moves/move_maker.h"
#include "target/run/event_stream.h"
#include "target/run/motor_steps.h"

namespace lyr::run {
namespace {

config::Printer plain_machine_at(const config::Printer& printer, const motion::Point& origin) {
    config::Printer machine = printer;
    machine.start_mm = {origin.x, origin.y, origin.z};
    machine.shapers = {};
    machine.pressure_advance_s = 0;
    machine.backlash_mm = {};
    machine.mesh.heights_mm.clear();  // head_at() has the bed's height in it
    return machine;
}

void drain(MotorSteps& generator, std::vector<Step>& steps) {
    std::array<motion::StepEvent, 256> events;
    for (std::size_t count = events.size(); count == events.size();) {
        count = generator.next(events);
        append_steps(std::span(events).first(count), steps);
    }
}

// The head of a delta from the heights of its carriages: Newton's method, from `head` on. Each carriage is
// z + sqrt(arm^2 - d^2) high, which falls by (x - tower) / sqrt(arm^2 - d^2) for each mm in x.
motion::Point under_carriages(const motion::Delta& delta, const std::array<double, 3>& heights_mm,
                              motion::Point head) {
    // Its error is squared with each round: from a bed's width to rounding takes fewer.
    constexpr int rounds = 12;
    for (int round = 0; round < rounds; ++round) {
        std::array<std::array<double, 3>, 3> rows{};  // slope in x, in y, what is missing
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const motion::Delta::Tower& tower = delta.towers[i];
            const double is_mm = motion::carriage_mm(tower, head), rise_mm = is_mm - head.z;
            rows[i] = {(tower.x_mm - head.x) / rise_mm, (tower.y_mm - head.y) / rise_mm,
                       heights_mm[i] - is_mm};
        }
        // Rows less the first are free of z.
        const auto less = [&](std::size_t i, std::size_t k) { return rows[i][k] - rows[0][k]; };
        const double det = less(1, 0) * less(2, 1) - less(2, 0) * less(1, 1);
        const double dx = (less(1, 2) * less(2, 1) - less(2, 2) * less(1, 1)) / det;
        const double dy = (less(1, 0) * less(2, 2) - less(2, 0) * less(1, 2)) / det;
        head = {head.x + dx, head.y + dy, head.z + rows[0][2] - rows[0][0] * dx - rows[0][1] * dy};
    }
    return head;
}

}  // namespace

Result<std::vector<LineEvent>> plan_trip(const config::Printer& printer, const motion::Point& from,
                                         std::span<const Leg> legs, gpio::LineMask levels) {
    const config::Printer machine = plain_machine_at(printer, from);
    Result<motion::Planner> planner = motion::Planner::create(moves::motion_limits(machine));
    if (!planner) return planner.error();
    motion::Point at = from;
    for (const Leg& leg : legs) {
        const motion::Move move{motion::Line{at, leg.to, leg.feed_mm}, leg.speed_mm_s, 0, 0};
        if (const Status pushed = planner->push(move); !pushed) return pushed.error();
        planner->dwell(0);
        at = leg.to;
    }
    planner->flush();
    MotorSteps generator(machine);
    std::vector<Step> steps;
    for (motion::PlannedMove move; planner->pop(move);) {
        generator.start(move);
        drain(generator, steps);
    }
    generator.finish();
    drain(generator, steps);
    PulseSchedule schedule(machine.pulse, levels);
    std::vector<LineEvent> events;
    // Where a print begins with a trip, this switches the drivers on.
    schedule.begin(EventStream::driver_wake_ns, events);
    schedule.append(steps, events);
    schedule.finish_as_begun(events);
    return events;
}

motion::Point head_at(const config::Printer& printer, const StepPositions& steps) {
    const motion::Point start{printer.start_mm[0], printer.start_mm[1], printer.start_mm[2]};
    std::array<double, 3> moved_mm{};
    for (std::size_t i = 0; i < moved_mm.size(); ++i)
        moved_mm[i] = static_cast<double>(steps[i]) / printer.axes[i].steps_per_mm;
    const motion::Kinematics machine = moves::kinematics_of(printer);
    if (const auto* delta = std::get_if<motion::Delta>(&machine)) {
        std::array<double, 3> heights_mm{};
        for (std::size_t i = 0; i < heights_mm.size(); ++i)
            heights_mm[i] = motion::carriage_mm(delta->towers[i], start) + moved_mm[i];
        return under_carriages(*delta, heights_mm, start);
    }
    const auto& [a, b, z] = moved_mm;
    if (std::holds_alternative<motion::CoreXy>(machine))
        return {start.x + (a + b) / 2, start.y + (a - b) / 2, start.z + z};
    return {start.x + a, start.y + b, start.z + z};
}

}  // namespace lyr::run
