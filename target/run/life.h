// The life of a print: what becomes of commands, of pauses that the file asks for, and of the head and the heat
// meanwhile. It runs on an ordinary thread, beside the motion, and asks for all that it wants through a Course, a
// HeatDesk and the number of requests to stop; so it is the same in a print and in a simulation.
//
//     printing -> coming to rest -> going to the park place -> resting -> heating -> coming back -> printing
//
// and filament is drawn out and pushed in where it rests, each once the tool is warm.
//
// Contract
//  1. A pause brings the head to rest on its path; then the filament is drawn back, the head lifted and parked. What
//     resumes goes back the same way. All in all no motor has moved then, but the extruder's by what a change of
//     filament purges, and the path goes on with the event at which it was left. A pause that comes while the print
//     goes on, and the other way round, is carried out next, unless the opposite comes before.
//  2. Filament is moved only if the tool has min_extrude_c, before a resume it is heated and waited for. A tool that
//     was set to less in a pause must be set to more before it. Heat that has not come within an hour is taken away,
//     and the print rests on.
//  3. A pause that lasts for longer than printer.toml says lets tool, bed and chamber go cold; one whose temperature
//     is set then is warm for as long again, and for least_held_s. A tool that filament is to be drawn out of stays warm.
//  4. A cancel takes all heat away once no filament is under way, parks too, and ends by a request to stop; an
//     emergency stop does so at once, and calls `cut`. At the end of the path the head parks as for a pause, at the
//     heat that the file left; commands come too late then.
//  5. What cannot be done as things are is refused, and status().message says why.
//  6. Commands take effect within the next tick; a speed above that of the file does with moves that are not planned yet.
//  7. With a journal, each layer is noted there when the head begins it, where the head is parked, over a crooked bed
//     once a second where it is in the layer, and how high it came to rest when it was stopped; and of the filament,
//     how far it is drawn back while the head is away from the path or was stopped, and whether it was drawn out. A
//     journal that cannot be written is told, and is no reason to stop. Before the head leaves the place where it
//     rests, the journal has on the disk that it does: it never says a height that the head may have gone below; where
//     that cannot be written, the print rests on, and goes on when it is resumed once more. At the end of the path
//     there is nothing to resume any more, and it goes.
//  8. A print that resumes after it was cut off begins with heat, then the head is lifted, unless that was done. If the
//     filament was drawn out it rests then for the next one, which is pushed in before the path begins.

#pragma once

#include <functional>
#include <string>

#include "target/run/course.h"
#include "target/run/heat_desk.h"
#include "target/run/journal.h"
#include "target/run/print_control.h"
#include "target/run/resumption.h"
#include "target/run/trip.h"

namespace lyr::run {

// Why a command can never be carried out on this printer; none: it can, if the print is at the right point.
std::optional<std::string> objection(const Command& command, const config::Printer& printer);

struct LifeOf {
    std::string file;
    std::uint32_t layers = 0;
    double estimated_s = 0;
    std::string message{};  // what is known to be wrong from the start
};

class Life {
public:
    // So long a temperature that is set in a rest holds at least.
    static constexpr double least_held_s = 300;

    // All but `print` must outlive it.
    Life(const config::Printer& printer, PrintControl& control, Course& course, LayerLog& layers,
         HeatDesk& desk, LifeOf print);
    Life(const Life&) = delete;
    Life& operator=(const Life&) = delete;

    // Takes heat away at once, from any thread.
    std::function<void()> cut;
    // May be empty: hears what status().message says of a command that is refused.
    std::function<void(const std::string& why)> hear_of_refusal;
    // May be empty: a sensor says that there is no filament, and nothing is resumed.
    std::function<bool()> lacks_filament;
    // Both may be none. `identity` is that of the file.
    void keep_journal(JournalWriter* journal, const FileIdentity& identity);
    // Before the first tick; the printer's start is where the head is after the lift.
    void begin_with(const Resumption& resumption, bool is_lifted);
    // Asks for the heat that it begins with.
    void heat_for(const Resumption& resumption);

    void tick(double now_s);
    // What is wrong, as status().message from the next tick on.
    void tell(const std::string& why) { message_ = why; }
    // A button or sensor of the printer; of config's InputNumber.
    void press(std::size_t input);
    // The motion has ended before the path has, and where the head is is known.
    void note_rest();
    // What the print came to; the last status.
    void end(const Status& result, bool is_position_known);

    std::uint32_t layer() const { return layer_; }
    // Of the plan, since the print was first begun.
    double time_s() const;
    // From leaving the path to being back.
    double paused_s() const { return paused_s_; }
    // By command, at some time.
    bool has_set_speed() const { return has_set_speed_; }
    const std::optional<Diagnostic>& journal_error() const { return journal_error_; }
    bool rests() const { return phase_ == Phase::resting; }
    bool is_cancelled() const { return cancels(); }
    // Ended by command: what to say.
    const std::optional<std::string>& ended_by() const { return ended_by_; }

private:
    enum class Phase : std::uint8_t {
        printing,
        braking,
        parking,
        unloading,
        resting,
        heating,
        lifting,
        loading,
        returning,
        over,
    };

    void serve(const Command& command);
    void rest_for(Command reason);
    void finish();
    void resume();
    void set_temperature(const SetTemperature& set);
    void advance();
    void park();
    void parked();
    void rest();
    void go_back();
    void let_cool();
    double off_after_s(std::size_t heater) const;
    void brake(bool rests);
    bool leave();
    void lift();
    void lifted();
    void rest_for_filament();
    void look();
    void note();
    void post(const JournalEntry& entry);
    // Of a head that stands still away from the path.
    std::optional<std::int64_t> rest_nm() const;
    bool is_on_path() const;
    // By the path and by a pause.
    std::int32_t drawn_back_um() const;
    // As counted, also in the middle of a trip.
    double drawn_back_now_mm() const;
    std::int64_t fed_steps() const;
    // Before going back, and not for ever.
    void wait_for_heat();
    void hear_of_journal();
    motion::Point head() const;
    void returned();
    void unload();
    void load();
    void loaded();
    void heat_again();
    void rest_here();
    void drop_heat();
    void heated();
    bool moves_filament() const;
    bool may_leave();
    // The journal does, for as long as nobody moves the head.
    bool knows_height() const;
    bool make(std::span<const Leg> legs, const motion::Point& from);
    // This figure of the tool is what filament needs, or there is none.
    bool is_warm(double HeaterNow::*figure) const;
    bool can_push() const;
    // And stays so.
    bool keeps_warm() const;
    bool changes_filament() const { return std::holds_alternative<ChangeFilament>(reason_); }
    bool cancels() const { return std::holds_alternative<Cancel>(reason_); }
    bool comes_to_rest() const {
        return phase_ == Phase::braking || phase_ == Phase::parking || phase_ == Phase::unloading;
    }
    bool draws_out() const { return comes_to_rest() && changes_filament(); }
    float pace() const;
    void refuse(const Command& command, const std::string& why);
    PrintState state() const;
    void publish(PrintState state, bool is_position_known);

    const config::Printer& printer_;
    PrintControl& control_;
    Course& course_;
    LayerLog& layers_;
    HeatDesk& desk_;
    LifeOf print_;

    Phase phase_ = Phase::printing;
    Command reason_ = Pause{};       // of the rest
    std::optional<double> begun_s_;  // the first tick
    double now_s_ = 0, left_since_s_ = 0, paused_s_ = 0;
    std::array<double, config::heater_count> idle_since_s_{};  // in a rest
    std::optional<double> heating_since_s_;                    // for going on
    double speed_factor_ = 1, planned_factor_ = 1;  // wanted, and of the path where the head is
    bool has_set_speed_ = false;
    Trip trip_;  // while the motion makes it
    motion::Point left_at_, parked_at_;
    double drawn_back_mm_ = 0, drawn_back_on_path_mm_ = 0;
    std::int64_t pushed_steps_ =
        0;  // what trips had fed when the filament was not drawn back by them
    bool is_unloaded_ = false;
    bool awaits_filament_ = false;  // before the path begins
    bool has_finished_ = false;     // the path
    bool rests_again_ = false;      // as soon as it has returned
    bool goes_on_ = false;          // as soon as it is parked
    bool leaves_ = false;           // the rest, as far as is known
    bool heeds_file_ = false;       // rests since the path waits in a pause of its own
    bool resumes_ = false;          // a print that was cut off
    bool departs_ = false;          // from its height: that is noted no more
    bool leaves_unnoted_ = false;   // with the next resume, as the user knows
    bool is_to_unload_ = false;     // once it is known how warm the tool is
    std::array<bool, config::heater_count> standby_{};
    std::optional<double>
        cold_by_hand_c_;  // what the tool was set to in a rest, if no filament can be pushed then
    std::uint32_t layer_ = 0;
    JournalWriter* journal_ = nullptr;
    JournalEntry noted_;
    double noted_s_ = 0;
    std::optional<Diagnostic> journal_error_;
    std::int64_t before_ns_ = 0;    // of the plan, until it was cut off
    bool is_to_lift_ = false;       // before the path begins
    StepPositions lifted_steps_{};  // by that lift
    std::string message_;
    std::optional<std::string> ended_by_;
};

}  // namespace lyr::run
