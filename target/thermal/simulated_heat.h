// The heated half of a printer without one: models behind mock lines and mock sensors, worked by the same
// control and guards as a real one, in virtual time.
//
// Contract
//  1. advance_to() does every tick up to that time, in order: faults that are due, the bodies' warming by what
//     the lines say, the control (unless it is silent) and the look whether it is.
//  2. The bodies are warmed by the lines alone, not by what the control meant.
//  3. heaters_off_s() is when the last heater line went off after a trip.

#pragma once

#include <functional>
#include <vector>

#include "target/gpio/clock.h"
#include "target/gpio/mock_chip.h"
#include "target/thermal/control.h"
#include "target/thermal/faults.h"

namespace lyr::thermal {

class SimulatedHeat {
public:
    // After each tick.
    using Observer = std::function<void(double time_s)>;

    // `line_fault`: of the heaters' lines.
    SimulatedHeat(const config::Printer& printer, std::vector<Fault> faults,
                  gpio::MockChip::Fault line_fault = {});
    SimulatedHeat(const SimulatedHeat&) = delete;
    SimulatedHeat& operator=(const SimulatedHeat&) = delete;

    void advance_to(double time_s);
    void observe(Observer observer) { observer_ = std::move(observer); }

    // The lines go off and are handed back, as at the end of a print.
    void release() { (void)stage_.release(); }

    HeatControl& control() { return control_; }
    const HeatControl& control() const { return control_; }
    double time_s() const { return time_s_; }
    bool any_heater_on() const { return (chip_.levels() & heater_lines()) != 0; }
    bool is_fan_on() const {
        return has_fan_ && (chip_.levels() & gpio::line_bit(bodies_.size())) != 0;
    }
    std::optional<double> tripped_s() const { return tripped_s_; }
    std::optional<double> heaters_off_s() const { return off_s_; }
    // Of a heater that the printer has.
    double body_c(std::size_t number) const;

private:
    struct Body {
        std::size_t number;
        HeatedBody body;
    };

    gpio::LineMask heater_lines() const { return gpio::all_lines(bodies_.size()); }
    std::vector<HeaterPort> ports(const config::Printer& printer);
    std::vector<Output> outputs(const config::Printer& printer) const;
    void tick();

    std::vector<Body> bodies_;
    bool has_fan_;
    std::vector<Fault> faults_;
    std::size_t next_fault_ = 0;
    bool silent_ = false;
    gpio::VirtualClock clock_;
    gpio::MockChip chip_;
    PowerStage stage_;
    HeatControl control_;
    std::uint64_t ticks_ = 0;
    double time_s_ = 0;
    std::optional<double> tripped_s_, off_s_;
    Observer observer_;
};

}  // namespace lyr::thermal
