// What a print tells of itself, its status and its journal, and what it begins with where it has such a journal.

#include <cmath>
#include <utility>

#include "base/constants.h"
#include "target/run/heat_order.h"
#include "target/run/life.h"

namespace lyr::run {

void Life::keep_journal(JournalWriter* journal, const FileIdentity& identity) {
    journal_ = journal;
    noted_ = {identity, identity_of(printer_), layer_,      print_.layers, before_ns_, rest_nm(),
              {},       drawn_back_um(),       is_unloaded_};
    // What an earlier print left there must not be resumed any more.
    if (journal_) journal_->post(noted_);
}

void Life::hear_of_journal() {
    const std::optional<Diagnostic> error = journal_ ? journal_->take_error() : std::nullopt;
    if (!error) return;
    journal_error_ = error;
    journal_error_->severity = Severity::warning;
    message_ = error->message;
}

// A height that is too low prints in the air; one that is too high would drive the nozzle into the part: while the
// head is lifted that from before holds.
std::optional<std::int64_t> Life::rest_nm() const {
    const bool stands = phase_ == Phase::unloading || phase_ == Phase::resting ||
                        (phase_ == Phase::heating && !departs_) || phase_ == Phase::lifting ||
                        phase_ == Phase::loading;
    if (!stands) return std::nullopt;
    return std::llround(parked_at_.z * nm_per_mm);
}

bool Life::knows_height() const {
    return journal_ && !journal_->has_failed() && phase_ != Phase::lifting && rest_nm();
}

bool Life::is_on_path() const {
    return course_.started.load() && (phase_ == Phase::printing || phase_ == Phase::braking);
}

std::int32_t Life::drawn_back_um() const {
    return static_cast<std::int32_t>(
        std::lround((drawn_back_on_path_mm_ + drawn_back_mm_) * um_per_mm));
}

std::int64_t Life::fed_steps() const {
    return course_.trip_steps[config::axis_e].load(std::memory_order_relaxed);
}

double Life::drawn_back_now_mm() const {
    return static_cast<double>(pushed_steps_ - fed_steps()) /
           printer_.axes[config::axis_e].steps_per_mm;
}

void Life::note() {
    if (!journal_) return;
    hear_of_journal();
    // What stops at once leaves the journal as it is: it knows a head that stands.
    if (phase_ == Phase::over) return;
    JournalEntry entry = noted_;
    entry.layer = layer_;
    entry.rest_nm = rest_nm();
    // On the path it changes too often to be kept, and is mostly not drawn back at all.
    entry.drawn_back_um = is_on_path() ? 0 : drawn_back_um();
    entry.is_unloaded = is_unloaded_;
    // Over a crooked bed the height of the head depends on its place, which is worth a write now and then.
    constexpr double place_interval_s = 1;
    if (!printer_.mesh.heights_mm.empty() && now_s_ - noted_s_ >= place_interval_s) {
        const motion::Point on_path = head_at(printer_, course_.steps_on_path());
        entry.place_um = {static_cast<std::int32_t>(std::lround(on_path.x * um_per_mm)),
                          static_cast<std::int32_t>(std::lround(on_path.y * um_per_mm))};
    }
    if (entry.rest_nm) entry.place_um.reset();
    if (entry != noted_) post(entry);
}

void Life::post(const JournalEntry& entry) {
    noted_ = entry;
    noted_.time_ns = before_ns_ + course_.time_ns.load();
    noted_s_ = now_s_;
    journal_->post(noted_);
}

void Life::note_rest() {
    if (!journal_ || (!course_.started.load() && !resumes_)) return;
    look();
    JournalEntry entry = noted_;
    entry.layer = layer_;
    entry.rest_nm = std::llround(head().z * nm_per_mm);
    entry.drawn_back_um = static_cast<std::int32_t>(
        std::lround((drawn_back_on_path_mm_ + drawn_back_now_mm()) * um_per_mm));
    entry.is_unloaded = is_unloaded_;
    entry.place_um.reset();
    post(entry);
}

PrintState Life::state() const {
    if (control_.stop_requests().load() != 0 || cancels()) return PrintState::stopping;
    if (has_finished_) return PrintState::printing;
    switch (phase_) {
        case Phase::printing:
            return desk_.now().waits ? PrintState::heating : PrintState::printing;
        case Phase::braking:
        case Phase::parking:
        case Phase::unloading:
            return goes_on_ ? PrintState::resuming : PrintState::pausing;
        case Phase::resting:
            return PrintState::paused;
        case Phase::heating:
        case Phase::lifting:
        case Phase::loading:
        case Phase::returning:
            return rests_again_ ? PrintState::pausing : PrintState::resuming;
        case Phase::over:
            break;
    }
    return PrintState::stopping;
}

void Life::publish(PrintState state, bool is_position_known) {
    const motion::Point head = this->head();
    const HeatNow heat = desk_.now();
    PrintStatus status;
    status.state = state;
    status.message = message_;
    status.draws_out = draws_out();
    status.file = print_.file;
    status.layer = layer_;
    status.layers = print_.layers;
    status.position_mm = {head.x, head.y, head.z};
    status.is_position_known = is_position_known;
    status.time_s = time_s();
    status.elapsed_s = now_s_ - begun_s_.value_or(now_s_);
    status.estimated_s = print_.estimated_s;
    status.heaters = heat.heaters;
    status.fan = heat.fan;
    status.speed_factor = speed_factor_;
    status.filament_mm = static_cast<double>(course_.steps_on_path()[config::axis_e]) /
                         printer_.axes[config::axis_e].steps_per_mm;
    control_.publish(std::move(status));
}

void Life::heat_for(const Resumption& resumption) {
    for (const format::HeaterTarget& target : resumption.state.temperatures)
        if (const auto heater = heater_number(target.heater))
            desk_.set_target(*heater, target.target_c);
}

void Life::begin_with(const Resumption& resumption, bool is_lifted) {
    layer_ = resumption.first_layer + 1;
    parked_at_ = {printer_.start_mm[0], printer_.start_mm[1], printer_.start_mm[2]};
    if (!is_lifted) parked_at_.z = resumption.stopped_z_mm;
    is_to_lift_ = !is_lifted;
    before_ns_ = resumption.entry.time_ns;
    drawn_back_on_path_mm_ = resumption.drawn_back_mm;
    is_unloaded_ = awaits_filament_ = resumption.entry.is_unloaded;
    resumes_ = true;
    course_.wanted_pace.store(0);
    phase_ = Phase::heating;
}

void Life::end(const Status& result, bool is_position_known) {
    phase_ = Phase::over;
    hear_of_journal();
    if (!result) message_ = result.error().message;
    const bool is_stopped = !result && result.error().status == ExitStatus::stopped;
    publish(result       ? PrintState::done
            : is_stopped ? PrintState::stopped
                         : PrintState::failed,
            is_position_known);
}

}  // namespace lyr::run
