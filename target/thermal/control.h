// All heaters of a machine together: once a tick every sensor is read, every guard asked, every controller
// worked, and the outputs are set.
//
// Contract
//  1. Heaters have no target until they are given one; without one they get no power.
//  2. The first guard that fires takes all heaters off in the same tick, for good: targets are 0 and set_target()
//     does nothing any more. trip() says why. So do a write that fails and a trip from outside (stop()).
//  3. A guard fires for a heater that is off, too, if its sensor is bad: a sensor that cannot be trusted when
//     cold will not be when hot.
//     A tool that had reached its target, and is colder than min_extrude_c and further off than stray_c,
//     trips at once: it may be pushing filament.
//  4. reached() is true when the reading has been within reached_c of the target for reached_s, or there is no
//     target; never after a trip.
//  5. Nothing here asks for the time: the same sequence of readings and times gives the same powers.

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "target/thermal/guard.h"
#include "target/thermal/pid.h"
#include "target/thermal/power_stage.h"
#include "target/thermal/sensor.h"
#include "target/thermal/tune.h"

namespace lyr::thermal {

inline constexpr double reached_c = 2, reached_s = 3;

struct HeaterPort {
    std::size_t number = 0;  // of config::Printer::heaters
    config::Heater settings;
    std::unique_ptr<TemperatureSensor> sensor;
};

struct HeaterStatus {
    double target_c = 0;
    double temperature_c = 0;
    double highest_c = -300;  // since the begin
    double power = 0;
    double on_s = 0;  // power summed over time: seconds at full power
};

class HeatControl {
public:
    // Outputs of the stage: the heaters in their order, then the part fan if there is one.
    HeatControl(std::vector<HeaterPort> heaters, bool has_fan, PowerStage& stage);

    // `number` is that of config; one that this machine does not have is ignored.
    void set_target(std::size_t number, double target_c);
    void set_fan(double duty) { fan_ = duty; }
    // Switches by the relay instead of the controller, until the relay has finished.
    void tune(std::size_t number, const RelayTune& relay);
    const std::optional<RelayTune>& relay() const { return relay_; }

    void tick(double time_s);
    void stop(Trip trip);

    bool reached(std::size_t number) const;
    const std::optional<Trip>& trip() const { return trip_; }
    // None: this machine does not have it.
    const HeaterStatus* status(std::size_t number) const;

private:
    struct Channel {
        HeaterPort port;
        SensorScale scale;
        PidController pid;
        GuardState guard;
        HeaterStatus status;
        double near_s = 0;  // for how long the reading has been near the target
    };

    void sample(Channel& channel, double time_s, double passed_s);
    void check_extrusion(const Channel& channel);
    void control(Channel& channel, double time_s, double passed_s);
    const Channel* find(std::size_t number) const;

    std::vector<Channel> channels_;
    bool has_fan_;
    PowerStage& stage_;
    double fan_ = 0;
    std::optional<RelayTune> relay_;
    std::size_t relay_number_ = 0;
    std::vector<double> shares_;
    std::optional<double> ticked_s_;  // the last tick's time
    std::optional<Trip> trip_;
};

}  // namespace lyr::thermal
