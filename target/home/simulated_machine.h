// A machine that is not there: its motors turn with the pulses on mock lines, its endstops and its probe touch where the
// head really is, and its bed is as crooked as [simulate] of the printer's file says.
//
// Contract
//  1. The head begins at simulate.head_mm. Nothing but pulses moves it; it knows nothing of what the program takes for
//     its position.
//  2. Contacts change at the time of the step that touches or leaves them.
//  3. Faults come at their times; those of heaters are passed over.
//  4. lowest_mm() is how far the nozzle ever was over the bed, at the least.

#pragma once

#include <limits>

#include "target/config/printer.h"
#include "target/gpio/mock_chip.h"
#include "target/gpio/mock_inputs.h"
#include "target/home/contacts.h"
#include "target/motion/kinematics.h"
#include "target/motion/step_generator.h"
#include "target/thermal/faults.h"

namespace lyr::home {

class SimulatedMachine {
public:
    SimulatedMachine(const config::Printer& printer, const std::vector<thermal::Fault>& faults);

    gpio::MockChip& chip() { return chip_; }
    gpio::MockInputs& inputs() { return inputs_; }
    gpio::Clock& clock() { return clock_; }

    motion::Point head() const;
    double bed_mm(double x_mm, double y_mm) const;
    double lowest_mm() const { return lowest_mm_; }

private:
    // Edges of a contact that bounces: as long as it does, it opens and closes.
    struct Contact {
        bool touched = false;  // by what is in its way
        bool stuck = false, dead = false;
        double bounce_ms = 0;
        std::int64_t since_ns = 0;
    };

    void observe(const gpio::LineWrite& write);
    void step(gpio::LineMask rising, gpio::LineMask levels);
    void take_faults(std::int64_t now_ns);
    void look(std::int64_t now_ns);
    bool touches(std::size_t contact, const motion::Point& head) const;
    void tell(std::size_t contact, std::int64_t now_ns);
    void draw_noise();

    config::Printer printer_;
    motion::Kinematics truth_;
    std::array<double, 3> endstops_mm_{};  // of the axes, or of carriages
    std::array<double, 3> origin_mm_{};    // of the motors
    motion::StepCounts counts_{};
    std::array<std::int64_t, 3> to_lose_{};
    gpio::LineMask levels_ = 0;
    std::vector<thermal::Fault> faults_;
    std::size_t next_fault_ = 0;
    std::array<Contact, config::contact_count> contacts_;
    std::array<std::size_t, config::contact_count> line_of_{};
    Contacts has_;
    double noise_mm_ = 0;
    std::uint32_t random_ = 1;
    double lowest_mm_ = std::numeric_limits<double>::infinity();
    gpio::VirtualClock clock_;
    gpio::MockInputs inputs_;
    gpio::MockChip chip_;
};

}  // namespace lyr::home
