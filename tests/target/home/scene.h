// Machines to home in tests: a simulated one with a mover on it.

#pragma once

#include <doctest/doctest.h>

#include "target/home/homing.h"
#include "target/home/simulated_machine.h"
#include "target/moves/machine.h"

namespace lyr::tests {

inline config::Printer machine_of(config::Kinematics kinematics) {
    config::Printer printer = config::generic_printer();
    printer.kinematics = kinematics;
    printer.axes[config::axis_x] = {80, 200, 3'000, 0, 220, false, {}, {}, {}};
    printer.axes[config::axis_y] = {100, 200, 3'000, -5, 210, false, {}, {}, {}};
    printer.axes[config::axis_z] = {400, 12, 300, 0, 100, false, {}, {}, {}};
    for (config::Endstop& endstop : printer.endstops) endstop.input = config::Pin{"c", 1u, false};
    if (kinematics != config::Kinematics::delta) return printer;
    for (const std::size_t axis : {config::axis_x, config::axis_y})
        printer.axes[axis] = {100, 200, 3'000, -90, 90, false, {}, {}, {}};
    printer.axes[config::axis_z] = {100, 200, 3'000, 0, 200, false, {}, {}, {}};
    printer.delta = {{250, 250, 250}, {120, 120, 120}, {210, 330, 90}, 90};
    for (config::Endstop& endstop : printer.endstops) endstop.back_off_mm = 2;
    return printer;
}

inline config::Printer with_probe(config::Printer printer) {
    printer.probe.emplace();
    printer.probe->input = config::Pin{"c", 9u, false};
    printer.probe->offset_mm = {20, -10, 0.8};
    return printer;
}

struct Scene {
    config::Printer printer;
    home::SimulatedMachine machine;
    home::Mover mover;

    explicit Scene(const config::Printer& of, const std::vector<thermal::Fault>& faults = {})
        : printer(of),
          machine(of, faults),
          mover(of, machine.chip(), machine.clock(), &machine.inputs(), nullptr) {}

    Result<home::Homed> home() { return home::home(mover, printer, home::homable(printer)); }

    // The largest distance of a motor from where it should be, in microsteps.
    double off_steps(const motion::Point& head) const {
        const motion::Kinematics kinematics = moves::kinematics_of(printer);
        const auto is = motion::motors_at(kinematics, machine.head());
        const auto should = motion::motors_at(kinematics, head);
        double off = 0;
        for (std::size_t i = 0; i < is.size(); ++i)
            off = std::max(off, std::abs(is[i] - should[i]) * printer.axes[i].steps_per_mm);
        return off;
    }
};

inline thermal::Fault fault(double time_s, thermal::FaultKind kind, std::size_t contact,
                            double value = 0) {
    thermal::Fault fault{time_s, kind};
    fault.contact = contact;
    fault.value = value;
    return fault;
}

inline std::vector<motion::Move> along_x(const config::Printer& printer, double way_mm,
                                         double speed_mm_s) {
    const auto& [x, y, z] = printer.start_mm;
    return {{motion::Line{{x, y, z}, {x + way_mm, y, z}}, speed_mm_s}};
}

// Lines of a machine that is looked at after each write.
class HighestPlace final : public gpio::GpioChip {
public:
    explicit HighestPlace(home::SimulatedMachine& machine)
        : machine_(machine), highest_mm_(machine.head().z) {}
    std::size_t line_count() const override { return machine_.chip().line_count(); }
    Status write(gpio::LineMask changed, gpio::LineMask levels) override {
        Status written = machine_.chip().write(changed, levels);
        highest_mm_ = std::max(highest_mm_, machine_.head().z);
        return written;
    }
    Status release() override { return machine_.chip().release(); }
    double highest_mm() const { return highest_mm_; }

private:
    home::SimulatedMachine& machine_;
    double highest_mm_;
};

}  // namespace lyr::tests
