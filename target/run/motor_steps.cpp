#include "target/run/motor_steps.h"

#include <bit>

namespace lyr::run {
namespace {

using Generator = std::variant<motion::StepGenerator, motion::TimedGenerator>;

Generator generator_for(const config::Printer& printer) {
    const motion::Kinematics machine = moves::kinematics_of(printer);
    const motion::Point origin{printer.start_mm[0], printer.start_mm[1], printer.start_mm[2]};
    if (!moves::is_timed(printer)) {
        if (const auto* belts = std::get_if<motion::CoreXy>(&machine))
            return motion::StepGenerator(*belts, origin);
        if (const auto* axes = std::get_if<motion::Cartesian>(&machine))
            return motion::StepGenerator(*axes, origin);
    }
    return motion::TimedGenerator(machine, origin, moves::shaping_of(printer));
}

}  // namespace

MotorSteps::MotorSteps(const config::Printer& printer) : generator_(generator_for(printer)) {}

void MotorSteps::start(const motion::PlannedMove& planned) {
    std::visit([&](auto& generator) { generator.start(planned); }, generator_);
}

void MotorSteps::rest_until(std::int64_t plan_ns) {
    if (auto* timed = std::get_if<motion::TimedGenerator>(&generator_)) timed->rest_until(plan_ns);
}

void MotorSteps::finish() {
    if (auto* timed = std::get_if<motion::TimedGenerator>(&generator_)) timed->finish();
}

std::size_t MotorSteps::next(std::span<motion::StepEvent> events) {
    return std::visit([&](auto& generator) { return generator.next(events); }, generator_);
}

std::int64_t MotorSteps::tail_ns() const {
    const auto* timed = std::get_if<motion::TimedGenerator>(&generator_);
    return timed ? timed->tail_ns() : 0;
}

void append_steps(std::span<const motion::StepEvent> events, std::vector<Step>& steps) {
    for (const motion::StepEvent& event : events)
        for (unsigned motors = event.motors; motors; motors &= motors - 1) {
            const int motor = std::countr_zero(motors);
            steps.push_back({event.time_ns, static_cast<std::uint8_t>(motor),
                             (event.positive >> motor & 1) != 0});
        }
}

}  // namespace lyr::run
