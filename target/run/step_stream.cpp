// A batch ends when its buffer is full or the file is; moves of few steps share a batch.

#include "target/run/step_stream.h"

#include <bit>

#include "target/run/inspect.h"

namespace lyr::run {
namespace {

constexpr std::size_t batch_events = 2048;

void append_steps(const motion::StepEvent& event, std::vector<Step>& steps) {
    for (unsigned motors = event.motors; motors; motors &= motors - 1) {
        const int motor = std::countr_zero(motors);
        steps.push_back(
            {event.time_ns, static_cast<std::uint8_t>(motor), (event.positive >> motor & 1) != 0});
    }
}

}  // namespace

Result<StepStream> StepStream::open(const std::string& path, const config::Printer& printer,
                                    double filament_diameter_mm) {
    Result<format::Reader> reader = open_file(path);
    if (!reader) return reader.error();
    Result<motion::Planner> planner = motion::Planner::create(motion_limits(printer));
    if (!planner) return planner.error();
    return StepStream(path, Interpreter(std::move(*reader), printer, filament_diameter_mm),
                      std::move(*planner), MotorSteps(printer));
}

StepStream::StepStream(std::string path, Interpreter interpreter, motion::Planner planner,
                       MotorSteps generator)
    : path_(std::move(path)),
      interpreter_(std::move(interpreter)),
      planner_(std::move(planner)),
      generator_(std::move(generator)),
      events_(batch_events) {}

Result<bool> StepStream::next(std::vector<Step>& steps) {
    moves_.clear();
    std::size_t room = batch_events;
    while (room > 0) {
        const std::span<motion::StepEvent> wanted(events_.data(), room);
        const std::size_t count = generator_.next(wanted);
        for (const motion::StepEvent& event : wanted.first(count)) append_steps(event, steps);
        room -= count;
        if (room == 0) break;
        motion::PlannedMove& move = moves_.emplace_back();
        while (!planner_.pop(move)) {
            if (read_all_) {
                moves_.pop_back();
                return finish(steps);
            }
            if (const Status planned = plan(); !planned) return planned.error();
        }
        layer_ = move.tag;
        generator_.start(move);
    }
    return true;
}

// The steps that come after the last move; false when there are no more.
bool StepStream::finish(std::vector<Step>& steps) {
    generator_.finish();
    const std::size_t count = generator_.next(events_);
    for (const motion::StepEvent& event : std::span(events_).first(count))
        append_steps(event, steps);
    return count == events_.size();
}

// Feeds the planner until it is full or the file ends.
Status StepStream::plan() {
    while (!planner_.full()) {
        if (!held_) {
            Result<std::optional<Instruction>> instruction = interpreter_.next();
            if (!instruction) return instruction.error();
            held_ = *instruction;
        }
        if (!held_) {
            read_all_ = true;
            planner_.flush();
            return Done{};
        }
        if (const auto* rest = std::get_if<Rest>(&*held_)) planner_.dwell(rest->time_s);
        if (const auto* move = std::get_if<motion::Move>(&*held_))
            if (const Status pushed = planner_.push(*move); !pushed) {
                Diagnostic error = pushed.error();
                error.where.file = path_;
                error.where.layer = static_cast<int>(move->tag);
                return error;
            }
        held_.reset();
    }
    return Done{};
}

}  // namespace lyr::run
