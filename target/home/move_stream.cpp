#include "target/home/move_stream.h"

#include <algorithm>

#include "target/moves/move_maker.h"
#include "target/run/event_stream.h"

namespace lyr::home {

Result<MoveStream> MoveStream::create(const config::Printer& machine,
                                      std::span<const motion::Move> moves) {
    Result<motion::Planner> planner = motion::Planner::create(
        moves::motion_limits(machine), std::max<std::size_t>(moves.size() + 1, 4));
    if (!planner) return planner.error();
    for (const motion::Move& move : moves)
        if (Status pushed = planner->push(move); !pushed) return pushed.error();
    planner->flush();
    return MoveStream(machine, std::move(*planner));
}

MoveStream::MoveStream(const config::Printer& machine, motion::Planner planner)
    : planner_(std::move(planner)),
      generator_(machine),
      schedule_(machine.pulse, run::line_layout(machine).enable) {}

bool MoveStream::next(std::vector<run::LineEvent>& events) {
    if (!begun_) schedule_.begin(run::EventStream::driver_wake_ns, events);
    begun_ = true;
    const std::size_t count = generator_.next(steps_);
    single_.clear();
    run::append_steps(std::span(steps_).first(count), single_);
    schedule_.append(single_, events);
    (void)schedule_.take_shifts();  // nobody asks for them
    if (count == steps_.size()) return true;
    motion::PlannedMove planned;
    if (planner_.pop(planned)) {
        generator_.start(planned);
    } else if (!planned_all_) {
        planned_all_ = true;
        generator_.finish();
    } else {
        schedule_.finish(planner_.time_ns() + generator_.tail_ns(), events);
        events.pop_back();  // the motors stay on
        return false;
    }
    return true;
}

}  // namespace lyr::home
