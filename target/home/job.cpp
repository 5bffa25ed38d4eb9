#include "target/home/job.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "base/text.h"
#include "target/gpio/gpiod_chip.h"
#include "target/gpio/gpiod_inputs.h"
#include "target/home/simulated_machine.h"
#include "target/home/touch.h"
#include "target/moves/machine.h"
#include "target/run/buttons.h"
#include "target/run/real_time.h"

namespace lyr::home {
namespace {

motion::Point start_of(const config::Printer& printer) {
    return {printer.start_mm[0], printer.start_mm[1], printer.start_mm[2]};
}

// Where an owner is told to push the head by hand.
motion::Point middle_of(const config::Printer& printer) {
    const auto& axes = printer.axes;
    return {middle_mm(axes[config::axis_x]), middle_mm(axes[config::axis_y]),
            middle_mm(axes[config::axis_z])};
}

Result<std::unique_ptr<gpio::InputLines>> open_inputs(const config::Printer& printer) {
    const std::vector<gpio::InputRequest> requests = contact_requests(printer);
    if (requests.empty()) return std::unique_ptr<gpio::InputLines>();
    return gpio::open_gpiod_inputs(requests);
}

Status on_board(const config::Printer& printer, Diagnostics& warnings, const Work& work) {
    if (const Status has = run::check_cpu(printer.timing.cpu); !has) return has.error();
    const Result<std::vector<gpio::LineRequest>> requests = run::line_requests(printer);
    if (!requests) return requests.error();
    // Before lines are held: one that comes meanwhile must not leave them as they are.
    const run::StopSignals signals;
    const Result<std::unique_ptr<gpio::InputLines>> inputs = open_inputs(printer);
    if (!inputs) return inputs.error();
    Result<std::optional<run::Buttons>> buttons = run::open_buttons(printer);
    if (!buttons) return buttons.error();
    const Result<std::unique_ptr<gpio::GpioChip>> chip = gpio::open_gpiod_chip(*requests);
    if (!chip) return chip.error();
    run::lock_memory(warnings);
    run::try_precedence(printer.timing.cpu, warnings);
    gpio::MonotonicClock clock;
    std::optional<Diagnostic> emergency;
    const auto stop = [&]() -> unsigned {
        constexpr unsigned at_once = 2;
        if (*buttons && !emergency) emergency = run::emergency(**buttons, clock.now_ns());
        if (emergency) return at_once;
        return signals.wait_ms(0) ? 1 : 0;
    };
    Mover mover(printer, **chip, clock, inputs->get(), stop);
    Status done = work(mover);
    Status released = (*chip)->release();
    if (done) return released;
    if (!emergency || done.error().status != ExitStatus::stopped) return done;
    return *emergency;
}

// Within the ranges, and within a delta's reach.
Status check_place(const config::Printer& printer, const motion::Point& to) {
    const std::array<double, 3> at_mm{to.x, to.y, to.z};
    for (std::size_t i = 0; i < at_mm.size(); ++i) {
        const config::Axis& axis = printer.axes[i];
        if (at_mm[i] >= axis.min_mm && at_mm[i] <= axis.max_mm) continue;
        const std::string name(config::axis_names[i]);
        return machine_error(formatted("%s would go to %g mm, and axis.%s.range_mm is %g to %g",
                                       name.c_str(), at_mm[i], name.c_str(), axis.min_mm,
                                       axis.max_mm));
    }
    const double off_mm = std::hypot(to.x, to.y);
    if (printer.kinematics == config::Kinematics::delta && off_mm > printer.delta.reach_mm)
        return machine_error(
            formatted("the head would go %g mm from the middle, and delta.reach_mm is %g", off_mm,
                      printer.delta.reach_mm));
    return Done{};
}

}  // namespace

Status with_machine(const Job& job, Diagnostics& warnings, const Work& work) {
    if (!job.simulate) return on_board(job.printer, warnings, work);
    SimulatedMachine machine(job.printer, job.faults);
    gpio::InputLines* inputs = contacts_of(job.printer).any() ? &machine.inputs() : nullptr;
    Mover mover(job.printer, machine.chip(), machine.clock(), inputs, {});
    return work(mover);
}

Result<Report> home(const Job& job, AxisSet axes, const std::optional<motion::Point>& jog_mm) {
    Report report;
    const motion::Point start = axes.any() ? start_of(job.printer) : middle_of(job.printer);
    report.head = start;
    report.homed = axes;
    if (jog_mm) {
        report.head = {start.x + jog_mm->x, start.y + jog_mm->y, start.z + jog_mm->z};
        if (Status possible = check_place(job.printer, report.head); !possible)
            return possible.error();
    }
    const Status done = with_machine(job, report.warnings, [&](Mover& mover) -> Status {
        const std::int64_t from_ns = mover.now_ns();
        motion::Point at = start;
        if (axes.any()) {
            const Result<Homed> homed = home(mover, job.printer, axes);
            if (!homed) return homed.error();
            report.repeat_mm = homed->repeat_mm;
            at = homed->head;
        }
        if (Status there = travel(mover, job.printer, at, start); !there) return there;
        if (Status there = travel(mover, job.printer, start, report.head); !there) return there;
        report.time_s = static_cast<double>(mover.now_ns() - from_ns) / ns_per_s;
        return Done{};
    });
    if (!done) return done.error();
    return report;
}

AxisSet homed_before_print(const config::Printer& printer, bool resumes) {
    if (!printer.homing.before_print) return {};
    AxisSet axes = homable(printer);
    if (resumes && printer.kinematics != config::Kinematics::delta) axes.reset(config::axis_z);
    return axes;
}

run::Before home_before_print(const config::Printer& printer,
                              const std::optional<run::Resumption>& resumption,
                              gpio::GpioChip& chip, gpio::Clock& clock, const run::StopSource& stop,
                              const run::NoteRisen& note) {
    const Result<std::unique_ptr<gpio::InputLines>> inputs = open_inputs(printer);
    if (!inputs) return Status(inputs.error());
    Mover mover(printer, chip, clock, inputs->get(), stop);
    Status homed = home_before_print(mover, printer, resumption, note);
    // A delta homes z, and asks for no height.
    if (printer.kinematics == config::Kinematics::delta) return homed;
    return {std::move(homed), static_cast<double>(mover.counts()[config::axis_z]) /
                                  printer.axes[config::axis_z].steps_per_mm};
}

Status home_before_print(Mover& mover, const config::Printer& printer,
                         const std::optional<run::Resumption>& resumption,
                         const run::NoteRisen& note) {
    const AxisSet axes = homed_before_print(printer, resumption.has_value());
    config::Printer machine = resumption ? run::lifted(printer, *resumption) : printer;
    motion::Point start = start_of(machine);
    // The print begins with this lift.
    const auto bed = moves::bed_of(printer);
    const double lift_mm = bed ? bed->lift_mm(start) : 0;
    start.z += lift_mm;
    const bool keeps_height = resumption && !axes[config::axis_z];
    const double found_mm = keeps_height ? resumption->stopped_z_mm + lift_mm : start.z;
    const auto noted = [&](double z_mm) {
        return keeps_height && note ? note(z_mm - found_mm) : Status(Done{});
    };
    if (keeps_height) {
        // All at once what the homing would lift.
        motion::Point up = start;
        up.z = std::max(start.z, std::min(start.z + std::exchange(machine.homing.lift_mm, 0.0),
                                          printer.axes[config::axis_z].max_mm));
        const motion::Point found{start.x, start.y, found_mm};
        if (Status lifted = travel(mover, printer, found, up); !lifted) return lifted;
        machine.start_mm[config::axis_z] = up.z;
        if (Status is_known = noted(up.z); !is_known) return is_known;
    }
    const Result<Homed> homed = home(mover, machine, axes);
    if (!homed) return homed.error();
    if (Status is_known = noted(start.z); !is_known) return is_known;
    return travel(mover, printer, homed->head, start);
}

std::string text_of(const Report& report) {
    std::string text;
    if (report.homed.any()) {
        text = "  homed ";
        for (std::size_t i = 0; i < report.homed.size(); ++i)
            if (report.homed[i]) text += config::axis_names[i];
        text += formatted(" in %.1f s; two approaches agree within %.3f mm\n", report.time_s,
                          report.repeat_mm);
    }
    text += "  the head is at";
    const std::array<double, 3> at_mm{report.head.x, report.head.y, report.head.z};
    const char* gap = " ";
    for (std::size_t i = 0; i < at_mm.size(); ++i) {
        if (report.homed.any() && !report.homed[i]) continue;
        text += gap + std::string(config::axis_names[i]) + formatted(" %.3f", at_mm[i]);
        gap = ", ";
    }
    text += " mm";
    if (report.homed.none()) text += ", if it was in the middle of its ranges";
    if (report.homed.any() && !report.homed.all()) text += "; where it is else was not found";
    return text + '\n';
}

}  // namespace lyr::home
