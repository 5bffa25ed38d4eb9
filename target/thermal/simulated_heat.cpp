// Times are counted in ticks, so that a long print does not add up roundings.

#include "target/thermal/simulated_heat.h"

#include <cmath>

namespace lyr::thermal {
namespace {

std::vector<std::size_t> heaters_of(const config::Printer& printer) {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < config::heater_count; ++i)
        if (printer.heaters[i]) numbers.push_back(i);
    return numbers;
}

// Far below a tick, far above the rounding of a time.
constexpr double time_rounding_s = 1e-6;

}  // namespace

SimulatedHeat::SimulatedHeat(const config::Printer& printer, std::vector<Fault> faults,
                             gpio::MockChip::Fault line_fault)
    : bodies_([&] {
          std::vector<Body> bodies;
          for (const std::size_t i : heaters_of(printer))
              bodies.push_back({i, HeatedBody(*printer.heaters[i])});
          return bodies;
      }()),
      has_fan_(printer.part_fan.has_value()),
      faults_(std::move(faults)),
      chip_(bodies_.size() + (has_fan_ ? 1 : 0), clock_, {}, std::move(line_fault)),
      stage_(outputs(printer), &chip_),
      control_(ports(printer), has_fan_, stage_) {}

std::vector<HeaterPort> SimulatedHeat::ports(const config::Printer& printer) {
    std::vector<HeaterPort> made;
    for (Body& body : bodies_)
        made.push_back({body.number, *printer.heaters[body.number],
                        std::make_unique<MockSensor>([&body] { return body.body.raw(); })});
    return made;
}

std::vector<Output> SimulatedHeat::outputs(const config::Printer& printer) const {
    std::vector<Output> made;
    for (const Body& body : bodies_)
        made.push_back(
            {LineOutput{made.size(), SlowPwm(printer.heaters[body.number]->cycle_s)}, true});
    if (has_fan_)
        made.push_back({LineOutput{made.size(), SlowPwm(printer.part_fan->cycle_s)}, false});
    return made;
}

void SimulatedHeat::advance_to(double time_s) {
    while (static_cast<double>(ticks_ + 1) * tick_s <= time_s + time_rounding_s) tick();
}

void SimulatedHeat::tick() {
    ++ticks_;
    time_s_ = static_cast<double>(ticks_) * tick_s;
    const gpio::LineMask levels = chip_.levels();
    const bool fan_on = is_fan_on();
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        bodies_[i].body.advance(tick_s, (levels & gpio::line_bit(i)) != 0, fan_on ? 1 : 0);
    for (; next_fault_ < faults_.size() && faults_[next_fault_].time_s <= time_s_; ++next_fault_) {
        const Fault& fault = faults_[next_fault_];
        if (fault.kind == FaultKind::silent) silent_ = true;
        for (Body& body : bodies_)
            if (body.number == fault.heater) apply(fault, body.body.faults());
    }
    clock_.advance_ns(static_cast<std::int64_t>(tick_s * 1e9));
    if (!silent_) control_.tick(time_s_);
    if (std::optional<Trip> silent = stage_.expire(time_s_)) control_.stop(std::move(*silent));
    if (control_.trip() && !tripped_s_) tripped_s_ = time_s_;
    if (tripped_s_ && !off_s_ && !any_heater_on()) off_s_ = time_s_;
    if (observer_) observer_(time_s_);
}

double SimulatedHeat::body_c(std::size_t number) const {
    for (const Body& body : bodies_)
        if (body.number == number) return body.body.body_c();
    return room_c;
}

}  // namespace lyr::thermal
