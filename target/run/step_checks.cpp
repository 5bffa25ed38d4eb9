#include "target/run/step_checks.h"

namespace lyr::run {
namespace {

AxisValues steps_per_mm(const config::Printer& printer) {
    AxisValues values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = printer.axes[i].steps_per_mm;
    return values;
}

AxisValues start_mm(const config::Printer& printer) {
    return {printer.start_mm[0], printer.start_mm[1], printer.start_mm[2], 0};
}

bool is_plain(const config::Printer& printer) {
    return printer.kinematics == config::Kinematics::cartesian && !moves::is_timed(printer);
}

}  // namespace

StepChecks::StepChecks(const config::Printer& printer, CurveSource source)
    : checks_(std::in_place_type<MachineCheck>, printer,
              is_plain(printer) ? CurveSource() : source) {
    if (is_plain(printer))
        checks_ = AxisChecks{PathCheck(steps_per_mm(printer), start_mm(printer), std::move(source)),
                             PlanCheck(steps_per_mm(printer), start_mm(printer))};
}

void StepChecks::expect(std::span<const motion::PlannedMove> moves, std::span<const Shift> shifts) {
    if (auto* axes = std::get_if<AxisChecks>(&checks_)) axes->plan.expect(moves, shifts);
    if (auto* machine = std::get_if<MachineCheck>(&checks_)) machine->expect(moves, shifts);
}

void StepChecks::step(const DecodedStep& step) {
    if (auto* machine = std::get_if<MachineCheck>(&checks_)) return machine->step(step);
    auto& axes = std::get<AxisChecks>(checks_);
    axes.path.step(step);
    axes.plan.step(step);
}

Status StepChecks::finish(const StepPositions& positions) {
    if (auto* machine = std::get_if<MachineCheck>(&checks_)) return machine->finish(positions);
    auto& axes = std::get<AxisChecks>(checks_);
    axes.path.finish(positions);
    axes.plan.finish(positions);
    return axes.path.status();
}

Deviation StepChecks::off_file() const {
    const auto* axes = std::get_if<AxisChecks>(&checks_);
    return axes ? axes->path.deviation() : std::get<MachineCheck>(checks_).off_file();
}

const AxisValues& StepChecks::off_plan() const {
    const auto* axes = std::get_if<AxisChecks>(&checks_);
    return axes ? axes->plan.deviation_steps() : std::get<MachineCheck>(checks_).off_plan();
}

}  // namespace lyr::run
