// Each phase waits for one thing: the motion to rest, a trip to end, a command, or heat.

#include "target/run/life.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "base/text.h"
#include "target/run/demands.h"

namespace lyr::run {
namespace {

std::string name_of(std::size_t heater) {
    return std::string(config::heater_names[heater]);
}

std::optional<std::string> objection_to(const SetTemperature& set, const config::Printer& printer) {
    const std::optional<config::Heater>& heater = printer.heaters[set.heater];
    if (!heater) return "the printer has no heater " + name_of(set.heater);
    const double most_c = heater->guard.high_c - headroom_c;
    if (set.target_c > most_c)
        return formatted("heater %s goes up to %g °C", name_of(set.heater).c_str(), most_c);
    return std::nullopt;
}

// What the axis lets the head rise.
double lifted_z_mm(const config::Printer& printer, double z_mm) {
    return std::max(z_mm,
                    std::min(z_mm + printer.pause.lift_mm, printer.axes[config::axis_z].max_mm));
}

}  // namespace

std::optional<std::string> objection(const Command& command, const config::Printer& printer) {
    if (const auto* set = std::get_if<SetTemperature>(&command)) return objection_to(*set, printer);
    if (std::holds_alternative<SetFan>(command) && !printer.part_fan)
        return "the printer has no part fan";
    return std::nullopt;
}

Life::Life(const config::Printer& printer, PrintControl& control, Course& course, LayerLog& layers,
           HeatDesk& desk, LifeOf print)
    : printer_(printer),
      control_(control),
      course_(course),
      layers_(layers),
      desk_(desk),
      print_(std::move(print)),
      message_(print_.message) {}

double Life::time_s() const {
    return static_cast<double>(before_ns_ + course_.time_ns.load()) / ns_per_s;
}

void Life::tick(double now_s) {
    if (!begun_s_) begun_s_ = left_since_s_ = now_s;
    now_s_ = now_s;
    look();
    while (const std::optional<Command> command = control_.take()) serve(*command);
    if (const auto pause = desk_.now().pause; pause && phase_ == Phase::printing) {
        if (*pause == format::PauseReason::filament_change)
            rest_for(ChangeFilament{});
        else
            rest_for(Pause{});
        heeds_file_ = true;
        message_ =
            "the file asks for " + std::string(changes_filament() ? "another filament" : "a pause");
    }
    advance();
    note();
    publish(state(), true);
}

// Where the path is.
void Life::look() {
    const LayerBegin place = layers_.at(course_.time_ns.load(std::memory_order_acquire));
    if (place.layer == 0) return;
    layer_ = std::max(layer_, place.layer);
    planned_factor_ = static_cast<double>(place.speed_factor);
    drawn_back_on_path_mm_ = static_cast<double>(place.drawn_back_mm);
}

void Life::serve(const Command& command) {
    if (phase_ == Phase::over) return refuse(command, "the print is over");
    if (const auto why = objection(command, printer_)) return refuse(command, *why);
    if (std::holds_alternative<EmergencyStop>(command)) {
        if (cut) cut();
        ended_by_ =
            std::string(std::get<EmergencyStop>(command).by_line
                            ? "emergency stop, by input.emergency: "
                            : "emergency stop: ") +
            "steps and heaters are off, and the position of the head is lost; " +
            (knows_height() ? "leave z where it is to go on with --resume, or remove the print's "
                              ".journal file and home the printer before the next print"
                            : "home the printer before the next print");
        phase_ = Phase::over;
    } else if (std::holds_alternative<Resume>(command)) {
        resume();
    } else if (const auto* set = std::get_if<SetTemperature>(&command)) {
        set_temperature(*set);
    } else if (const auto* fan = std::get_if<SetFan>(&command)) {
        desk_.set_fan(fan->duty);
    } else if (const auto* speed = std::get_if<SetSpeedFactor>(&command)) {
        speed_factor_ = speed->factor;
        has_set_speed_ = true;
        course_.plan_factor.store(static_cast<float>(std::max(1.0, speed_factor_)));
    } else {
        rest_for(command);
    }
}

void Life::refuse(const Command& command, const std::string& why) {
    message_ = "refused `" + text_of(command) + "`: " + why;
    if (hear_of_refusal) hear_of_refusal(message_);
}

float Life::pace() const {
    return static_cast<float>(std::min(1.0, speed_factor_ / planned_factor_));
}

// Pause, ChangeFilament or Cancel.
void Life::rest_for(Command reason) {
    if (phase_ != Phase::printing && cancels()) return refuse(reason, "it is being cancelled");
    if (has_finished_) return refuse(reason, "the path is done");
    // A change of filament that is under way is a pause, too.
    const bool is_on_its_way = phase_ != Phase::printing && phase_ != Phase::resting;
    if (is_on_its_way && changes_filament() && std::holds_alternative<Pause>(reason)) {
        goes_on_ = false;
        return;
    }
    const bool unloads = std::holds_alternative<ChangeFilament>(reason) && !is_unloaded_;
    // One that rests does so already, and one that is about to go on rests again.
    if (phase_ == Phase::heating) rest_here();
    rests_again_ =
        phase_ == Phase::lifting || phase_ == Phase::loading || phase_ == Phase::returning;
    goes_on_ = false;
    reason_ = reason;
    message_.clear();
    // What is left to do needs no heat but that which is there.
    if (cancels() && !moves_filament()) drop_heat();
    if (phase_ == Phase::resting && unloads) unload();
    if (phase_ != Phase::printing) return;
    left_since_s_ = now_s_;
    idle_since_s_.fill(now_s_);
    phase_ = Phase::braking;
}

bool Life::moves_filament() const {
    return phase_ == Phase::unloading || phase_ == Phase::loading || phase_ == Phase::returning;
}

void Life::drop_heat() {
    standby_.fill(true);
    desk_.set_standby(standby_);
}

// A pause that has not come to rest before the end of the path comes too late.
void Life::finish() {
    has_finished_ = true;
    goes_on_ = false;
    reason_ = Pause{};
    if (journal_) journal_->remove();
    park();
}

void Life::unload() {
    if (!course_.started.load()) {
        message_ = "filament is changed once the path has begun; the print rests";
        return;
    }
    is_to_unload_ = !desk_.has_seen();
    if (is_to_unload_) return;
    if (!keeps_warm()) {
        message_ = "the tool is too cold to move filament: heat it, or change it by hand";
        if (hear_of_refusal) hear_of_refusal(message_);
        return;
    }
    const Leg leg{parked_at_, -printer_.filament.unload_mm, printer_.filament.speed_mm_s};
    if (!make(std::span(&leg, 1), parked_at_)) return;
    is_unloaded_ = true;
    phase_ = Phase::unloading;
}

void Life::load() {
    const config::FilamentSettings& filament = printer_.filament;
    const double again_mm_s = printer_.axes[config::axis_e].max_speed_mm_s;
    const std::array<Leg, 2> legs{
        {{parked_at_, filament.load_mm + filament.purge_mm, filament.speed_mm_s},
         {parked_at_, -drawn_back_mm_, again_mm_s}}};
    phase_ = Phase::loading;
    if (!make(legs, parked_at_)) rest_here();
}

void Life::loaded() {
    is_unloaded_ = false;
    pushed_steps_ =
        fed_steps() + std::llround(drawn_back_mm_ * printer_.axes[config::axis_e].steps_per_mm);
    heat_again();
}

// One step of going on is done, unless it was to be the last.
void Life::heat_again() {
    phase_ = Phase::heating;
    heating_since_s_.reset();
    if (cancels() || std::exchange(rests_again_, false)) parked();
}

void Life::rest_here() {
    phase_ = Phase::resting;
    // What was set by hand a while ago may hold for longer.
    for (double& idle_s : idle_since_s_) idle_s = std::max(idle_s, now_s_);
}

void Life::resume() {
    if ((comes_to_rest() || rests_again_) && !cancels() && !has_finished_) {
        if (draws_out()) return refuse(Resume{}, "the filament is still being drawn out");
        // Both take their turn where the head is on its way.
        goes_on_ = comes_to_rest();
        rests_again_ = false;
        return;
    }
    if (phase_ != Phase::resting) return refuse(Resume{}, "the print does not rest");
    if (lacks_filament && lacks_filament())
        return refuse(Resume{},
                      "the filament sensor says that there is none: put it in first; if the sensor "
                      "is wrong, stop the print, take input.filament out of the printer's file and "
                      "go on with --resume");
    if (cold_by_hand_c_)
        return refuse(
            Resume{},
            formatted("the tool was set to %g °C, and filament is pushed from %g °C on",
                      *cold_by_hand_c_, printer_.heaters[config::heater_tool]->min_extrude_c));
    message_.clear();
    is_to_unload_ = false;
    standby_.fill(false);
    desk_.set_standby(standby_);
    reason_ = Pause{};
    phase_ = Phase::heating;
    departs_ = false;
    heating_since_s_.reset();
}

void Life::wait_for_heat() {
    if (desk_.settled()) heated();
    if (phase_ != Phase::heating) return;
    if (!heating_since_s_) heating_since_s_ = now_s_;
    if (now_s_ - *heating_since_s_ < longest_wait_s) return;
    // What has not come by then never will, and nobody may be there.
    message_ = std::string(desk_.settled() ? "the journal's disk has not answered"
                                           : "the heaters have not reached their targets") +
               " within an hour, the heaters are off, and the print rests";
    phase_ = Phase::resting;
    idle_since_s_.fill(now_s_ - std::max(printer_.pause.tool_off_s, printer_.pause.bed_off_s));
    rest();
}

// What comes next on the way back to the path.
void Life::heated() {
    if (is_to_lift_) return lift();
    if (awaits_filament_) return rest_for_filament();
    if ((is_unloaded_ && !keeps_warm()) || (drawn_back_mm_ > 0 && !can_push())) {
        message_ =
            formatted("the tool is too cold to push filament: set it to %g °C or more, then resume",
                      printer_.heaters[config::heater_tool]->min_extrude_c);
        return rest_here();
    }
    if (is_unloaded_) return load();
    if (may_leave()) go_back();
}

// The journal's thread tells what it has written a tick later at the earliest.
bool Life::may_leave() {
    if (!journal_) return true;
    if (!std::exchange(departs_, true) || !journal_->is_idle()) return false;
    const bool is_accepted = std::exchange(leaves_unnoted_, false);
    if (!journal_->has_failed() || is_accepted) return true;
    leaves_unnoted_ = true;
    hear_of_journal();
    message_ =
        "the journal cannot be written and says for ever that the head is here: resume once more "
        "to go on, and after that do not go on with --resume";
    rest_here();
    return false;
}

void Life::set_temperature(const SetTemperature& set) {
    const config::Heater& heater = *printer_.heaters[set.heater];
    const bool is_tool = set.heater == config::heater_tool;
    const bool is_cold = is_tool && set.target_c < heater.min_extrude_c;
    if (is_cold && phase_ != Phase::resting)
        return refuse(
            set, formatted("filament is pushed from %g °C on; pause first", heater.min_extrude_c));
    if (is_tool) cold_by_hand_c_ = is_cold ? std::optional(set.target_c) : std::nullopt;
    desk_.set_target(set.heater, set.target_c);
    idle_since_s_[set.heater] = now_s_ + std::max(0.0, least_held_s - off_after_s(set.heater));
}

void Life::advance() {
    const bool rests = course_.at_rest.load(std::memory_order_acquire);
    const bool travels = course_.trip.load(std::memory_order_acquire) != nullptr;
    if (!rests) leaves_ = false;
    if (phase_ == Phase::printing && course_.wanted_pace.load() != pace())
        course_.wanted_pace.store(pace());
    const bool ends = course_.at_end.load() && !cancels();
    if (ends && rests && (phase_ == Phase::printing || phase_ == Phase::braking)) return finish();
    if (phase_ == Phase::braking) return brake(rests);
    if ((phase_ == Phase::parking || phase_ == Phase::unloading) && !travels) return parked();
    if (phase_ == Phase::lifting && !travels) return lifted();
    if (phase_ == Phase::loading && !travels) return loaded();
    if (phase_ == Phase::resting) return rest();
    if (phase_ == Phase::heating) return wait_for_heat();
    if (phase_ == Phase::returning && !travels) return returned();
}

bool Life::is_warm(double HeaterNow::*figure) const {
    const HeaterNow tool = desk_.now().heaters[config::heater_tool];
    const auto& settings = printer_.heaters[config::heater_tool];
    return !tool.is_present || !settings || tool.*figure >= settings->min_extrude_c;
}

bool Life::can_push() const {
    return is_warm(&HeaterNow::temperature_c);
}

bool Life::keeps_warm() const {
    return can_push() && is_warm(&HeaterNow::target_c);
}

// It leaves the rest before the next one can begin: what is at rest then is so for this pause.
void Life::brake(bool rests) {
    if (leaves_ && rests) return;
    leaves_ = false;
    course_.wanted_pace.store(0);
    if (rests) return park();
    // A path of which no more comes does not come to rest, either.
    if (!cancels()) let_cool();
}

bool Life::make(std::span<const Leg> legs, const motion::Point& from) {
    // Before the path, the drivers are switched on by it.
    const gpio::LineMask levels =
        course_.started.load() ? course_.levels.load() : line_layout(printer_).enable;
    Result<Trip> trip = plan_trip(printer_, from, legs, levels);
    if (!trip) {
        message_ = "the head stays where it is: " + trip.error().message;
        return false;
    }
    trip_ = std::move(*trip);
    course_.trip.store(&trip_, std::memory_order_release);
    return true;
}

void Life::park() {
    phase_ = Phase::parking;
    if (cancels()) drop_heat();
    left_at_ = parked_at_ = head();
    pushed_steps_ = fed_steps();
    // Before the first motion there is nothing to come away from.
    if (!course_.started.load()) return;
    const config::PauseSettings& pause = printer_.pause;
    const double filament_mm_s = printer_.axes[config::axis_e].max_speed_mm_s;
    drawn_back_mm_ = can_push() ? pause.retract_mm : 0;
    const double z_mm = lifted_z_mm(printer_, left_at_.z);
    if (pause.park_mm)
        parked_at_ = {(*pause.park_mm)[0], (*pause.park_mm)[1], z_mm};
    else
        parked_at_.z = z_mm;
    const std::array<Leg, 3> legs{{{left_at_, -drawn_back_mm_, filament_mm_s},
                                   {{left_at_.x, left_at_.y, z_mm}, 0, pause.speed_mm_s},
                                   {parked_at_, 0, pause.speed_mm_s}}};
    if (make(legs, left_at_)) return;
    parked_at_ = left_at_;
    drawn_back_mm_ = 0;
}

void Life::parked() {
    if (phase_ == Phase::unloading)
        message_ = "the filament is drawn out: put the new one in, then resume";
    rest_here();
    if (changes_filament() && !is_unloaded_) unload();
    if (has_finished_) {
        phase_ = Phase::over;
        course_.wanted_pace.store(1);
        course_.at_end.store(false, std::memory_order_release);
    }
    if (std::exchange(goes_on_, false)) resume();
    if (!cancels()) return;
    drop_heat();
    const bool stopped = control_.stop_requests().load() != 0;
    ended_by_ = stopped                  ? "cancelled, and stopped"
                : course_.started.load() ? "cancelled; the head is parked"
                                         : "cancelled";
    phase_ = Phase::over;
    ++control_.stop_requests();
}

void Life::rest() {
    if (cancels()) return parked();
    if (std::exchange(is_to_unload_, false)) unload();
    if (phase_ == Phase::resting && !is_to_unload_) let_cool();
}

double Life::off_after_s(std::size_t heater) const {
    return heater == config::heater_tool ? printer_.pause.tool_off_s : printer_.pause.bed_off_s;
}

void Life::let_cool() {
    std::array<bool, config::heater_count> standby{};
    for (std::size_t i = 0; i < standby.size(); ++i)
        standby[i] = now_s_ - idle_since_s_[i] >= off_after_s(i);
    // Filament that is to be drawn out needs it, but not for ever.
    if (phase_ == Phase::braking && changes_filament() && !is_unloaded_)
        standby[config::heater_tool] &= now_s_ - idle_since_s_[config::heater_tool] >= least_held_s;
    if (standby == standby_) return;
    standby_ = standby;
    desk_.set_standby(standby_);
}

motion::Point Life::head() const {
    StepPositions steps = course_.steps();
    for (std::size_t i = 0; i < steps.size(); ++i) steps[i] -= lifted_steps_[i];
    motion::Point head = head_at(printer_, steps);
    // The printer's start is where the lift leads.
    if (is_to_lift_) head.z -= printer_.start_mm[config::axis_z] - parked_at_.z;
    return head;
}

void Life::lift() {
    const Leg leg{{parked_at_.x, parked_at_.y, printer_.start_mm[2]}, 0, printer_.pause.speed_mm_s};
    phase_ = Phase::lifting;
    if (!make(std::span(&leg, 1), parked_at_)) rest_here();
}

void Life::lifted() {
    is_to_lift_ = false;
    lifted_steps_ = course_.steps();
    parked_at_.z = printer_.start_mm[config::axis_z];
    heat_again();
}

// Lifted, and before the path.
void Life::rest_for_filament() {
    awaits_filament_ = false;
    reason_ = ChangeFilament{};
    rest_here();
    message_ = "the filament was drawn out when the print was cut off: put it in, then resume";
}

void Life::press(std::size_t input) {
    const bool goes_on = phase_ == Phase::resting && input == config::input_pause;
    const std::array<Command, config::input_count> meant{
        goes_on ? Command(Resume{}) : Command(Pause{}), Cancel{}, EmergencyStop{true},
        ChangeFilament{}};
    (void)control_.post(meant[input]);
}

void Life::go_back() {
    phase_ = Phase::returning;
    if (!leave()) rest_here();
}

// False: it cannot, and the message says why.
bool Life::leave() {
    if (!course_.started.load()) return true;
    const double filament_mm_s = printer_.axes[config::axis_e].max_speed_mm_s;
    const double mm_s = printer_.pause.speed_mm_s;
    const std::array<Leg, 3> legs{{{{left_at_.x, left_at_.y, parked_at_.z}, 0, mm_s},
                                   {left_at_, 0, mm_s},
                                   {left_at_, drawn_back_mm_, filament_mm_s}}};
    return make(legs, parked_at_);
}

void Life::returned() {
    drawn_back_mm_ = 0;
    if (std::exchange(rests_again_, false)) return park();
    phase_ = Phase::printing;
    paused_s_ += now_s_ - left_since_s_;
    if (std::exchange(heeds_file_, false)) desk_.end_pause();
    leaves_ = true;
    course_.wanted_pace.store(pace());
}

}  // namespace lyr::run
