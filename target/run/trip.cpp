// A machine of its own whose origin is where the head is: steps count from there.

#include "target/run/trip.h"

#include <array>

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
    const motion::Kinematics machine = moves::kinematics_of(printer);
    std::array<double, 3> motors_mm =
        motion::motors_at(machine, {printer.start_mm[0], printer.start_mm[1], printer.start_mm[2]});
    for (std::size_t i = 0; i < motors_mm.size(); ++i)
        motors_mm[i] += static_cast<double>(steps[i]) / printer.axes[i].steps_per_mm;
    return motion::head_at(machine, motors_mm);
}

}  // namespace lyr::run
