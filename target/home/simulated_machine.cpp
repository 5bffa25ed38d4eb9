#include "target/home/simulated_machine.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/constants.h"
#include "target/home/touch.h"
#include "target/moves/machine.h"
#include "target/run/line_layout.h"

namespace lyr::home {
namespace {

using config::axis_x, config::axis_y, config::axis_z;

// A contact that bounces opens and closes so often.
constexpr double bounce_ms = 0.2;

config::Printer uncalibrated(const config::Printer& printer) {
    config::Printer own = printer.uncalibrated ? *printer.uncalibrated : printer;
    if (own.probe && own.simulated.probe_offset_mm)
        own.probe->offset_mm = *own.simulated.probe_offset_mm;
    return own;
}

config::Printer true_printer(config::Printer printer) {
    const config::SimulatedMachine& truth = printer.simulated;
    for (std::size_t i = 0; i < 3; ++i) {
        printer.delta.arm_mm[i] += truth.arm_error_mm[i];
        printer.delta.radius_mm[i] += truth.radius_error_mm[i];
        printer.delta.tower_angle_deg[i] += truth.angle_error_deg[i];
    }
    return printer;
}

motion::Point first_place(const config::Printer& printer) {
    if (const auto& head_mm = printer.simulated.head_mm)
        return {(*head_mm)[0], (*head_mm)[1], (*head_mm)[2]};
    const bool is_delta = printer.kinematics == config::Kinematics::delta;
    // Of a machine without end, near its start.
    const auto middle = [&](std::size_t axis) {
        return is_delta ? 0 : middle_mm(printer.axes[axis]);
    };
    const auto beside_mm = [&](std::size_t axis) {
        constexpr double most_mm = 30;
        const config::Axis& limits = printer.axes[axis];
        const double length_mm = is_delta ? printer.delta.reach_mm : limits.max_mm - limits.min_mm;
        return std::min(most_mm, length_mm / 3);
    };
    return {middle(axis_x) + beside_mm(axis_x), middle(axis_y) - beside_mm(axis_y),
            printer.axes[axis_z].min_mm + beside_mm(axis_z)};
}

// Where the endstops trigger; of a delta the height of the carriage.
std::array<double, 3> endstops_of(const config::Printer& printer) {
    std::array<double, 3> at_mm{};
    for (std::size_t i = 0; i < at_mm.size(); ++i) {
        const config::Endstop& endstop = printer.endstops[i];
        const config::Axis& limits = printer.axes[i];
        at_mm[i] = endstop.at_mm.value_or(endstop.at_high_end ? limits.max_mm : limits.min_mm);
        if (printer.kinematics != config::Kinematics::delta) continue;
        const double arm_mm = printer.delta.arm_mm[i], radius_mm = printer.delta.radius_mm[i];
        at_mm[i] = endstop.at_mm.value_or(printer.axes[axis_z].max_mm) +
                   printer.simulated.endstop_error_mm[i] +
                   std::sqrt(arm_mm * arm_mm - radius_mm * radius_mm);
    }
    return at_mm;
}

}  // namespace

SimulatedMachine::SimulatedMachine(const config::Printer& printer,
                                   const std::vector<thermal::Fault>& faults)
    : printer_(uncalibrated(printer)),
      truth_(moves::kinematics_of(true_printer(printer_))),
      endstops_mm_(endstops_of(printer_)),
      origin_mm_(motion::motors_at(truth_, first_place(printer_))),
      faults_(faults),
      has_(contacts_of(printer)),
      inputs_(has_.count(), clock_),
      chip_(run::line_layout(printer).names.size(), clock_,
            [this](const gpio::LineWrite& write) { observe(write); }) {
    std::size_t line = 0;
    for (std::size_t i = 0; i < line_of_.size(); ++i)
        if (has_[i]) line_of_[i] = line++;
    draw_noise();
    take_faults(0);
    look(0);
}

motion::Point SimulatedMachine::head() const {
    std::array<double, 3> motors_mm = origin_mm_;
    for (std::size_t i = 0; i < motors_mm.size(); ++i)
        motors_mm[i] += static_cast<double>(counts_[i]) / printer_.axes[i].steps_per_mm;
    return motion::head_at(truth_, motors_mm);
}

double SimulatedMachine::bed_mm(double x_mm, double y_mm) const {
    const config::SimulatedMachine& truth = printer_.simulated;
    double z_mm = truth.bed_mm + truth.bed_tilt[0] * x_mm + truth.bed_tilt[1] * y_mm;
    for (const auto& bump : truth.bumps) {
        // A cap that runs out level at its rim.
        const double off = std::hypot(x_mm - bump.x_mm, y_mm - bump.y_mm) / bump.radius_mm;
        if (off < 1) z_mm += bump.height_mm * (1 - off * off) * (1 - off * off);
    }
    return z_mm;
}

void SimulatedMachine::observe(const gpio::LineWrite& write) {
    take_faults(write.time_ns);
    const gpio::LineMask rising = write.levels & ~levels_ & run::all_step_bits;
    levels_ = write.levels;
    step(rising, write.levels);
    look(write.time_ns);
}

void SimulatedMachine::step(gpio::LineMask rising, gpio::LineMask levels) {
    for (; rising; rising &= rising - 1) {
        const auto axis = static_cast<std::size_t>(std::countr_zero(rising)) / 2;
        if (axis < to_lose_.size() && to_lose_[axis] > 0)
            --to_lose_[axis];
        else
            counts_[axis] += levels & run::direction_bit(axis) ? 1 : -1;
    }
}

void SimulatedMachine::take_faults(std::int64_t now_ns) {
    for (; next_fault_ < faults_.size() &&
           faults_[next_fault_].time_s * ns_per_s <= static_cast<double>(now_ns);
         ++next_fault_) {
        const thermal::Fault& fault = faults_[next_fault_];
        Contact& contact = contacts_[fault.contact];
        if (fault.kind == thermal::FaultKind::stuck) contact.stuck = true;
        if (fault.kind == thermal::FaultKind::dead) contact.dead = true;
        if (fault.kind == thermal::FaultKind::bounce) contact.bounce_ms = fault.value;
        if (fault.kind == thermal::FaultKind::lose)
            to_lose_[fault.contact] = std::llround(fault.value);
    }
}

bool SimulatedMachine::touches(std::size_t contact, const motion::Point& head) const {
    if (contact == config::contact_probe) {
        const auto& offset = printer_.probe->offset_mm;
        return head.z - offset[2] <= bed_mm(head.x + offset[0], head.y + offset[1]) + noise_mm_;
    }
    if (printer_.kinematics == config::Kinematics::delta) {
        const double carriage_mm = origin_mm_[contact] + static_cast<double>(counts_[contact]) /
                                                             printer_.axes[contact].steps_per_mm;
        return carriage_mm >= endstops_mm_[contact];
    }
    const double at_mm = contact == axis_x ? head.x : contact == axis_y ? head.y : head.z;
    return printer_.endstops[contact].at_high_end ? at_mm >= endstops_mm_[contact]
                                                  : at_mm <= endstops_mm_[contact];
}

void SimulatedMachine::look(std::int64_t now_ns) {
    const motion::Point at = head();
    lowest_mm_ = std::min(lowest_mm_, at.z - bed_mm(at.x, at.y));
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        if (!has_[i]) continue;
        const bool touched = touches(i, at);
        if (touched != contacts_[i].touched) {
            contacts_[i].touched = touched;
            contacts_[i].since_ns = now_ns;
            if (!touched && i == config::contact_probe) draw_noise();
        }
        tell(i, now_ns);
    }
}

void SimulatedMachine::tell(std::size_t index, std::int64_t now_ns) {
    const Contact& contact = contacts_[index];
    bool active = contact.touched;
    const double since_ms = static_cast<double>(now_ns - contact.since_ns) / ns_per_ms;
    if (since_ms < contact.bounce_ms) {
        const auto turn = static_cast<std::int64_t>(since_ms / bounce_ms);
        active = contact.touched == (turn % 2 == 0);
    }
    if (contact.stuck) active = true;
    if (contact.dead) active = false;
    inputs_.set(line_of_[index], active, now_ns);
}

// Evenly from -noise to noise, the same in every run.
void SimulatedMachine::draw_noise() {
    random_ = random_ * 1'664'525u + 1'013'904'223u;
    constexpr double most = 4'294'967'295.0;
    noise_mm_ = printer_.simulated.probe_noise_mm * (2 * static_cast<double>(random_) / most - 1);
}

}  // namespace lyr::home
