// Four threads: this one, which lives the print's life, the planning one that fills the ring, the real-time one that
// empties it, and the one that tends the heaters. They share the ring, the course, the marks of orders and the number of
// requests to stop.

#include "target/run/print.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "base/constants.h"
#include "base/text.h"
#include "target/gpio/gpiod_chip.h"
#include "target/gpio/gpiod_inputs.h"
#include "target/run/event_flow.h"
#include "target/run/event_stream.h"
#include "target/run/executor.h"
#include "target/run/life.h"
#include "target/run/opening.h"
#include "target/run/print_preparation.h"
#include "target/run/real_time.h"
#include "target/run/stop_signals.h"
#include "target/run/watchdog.h"
#include "target/run/worker.h"

namespace lyr::run {
namespace {

// How soon a command is served.
constexpr int signal_wait_ms = 20;
constexpr double progress_s = 0.1;

// What the threads share.
struct Shared {
    Shared(PrintControl& print_control, OrderQueue::Heeded heeded)
        : control(print_control), orders(heeded) {}

    PrintControl& control;
    StopRequests& stop_requests = control.stop_requests();
    // From when the path begins: what moves before it has one of its own.
    std::optional<EventFlow> flow;
    std::optional<LineEvent> last;  // of the path, once the flow is closed
    Course course;
    LayerLog layers;
    HeatDesk desk;
    std::atomic<bool> finished{false};  // the real-time thread has ended
    std::atomic<std::uint32_t> heat_ticks{0};
    OrderQueue orders;
    Marks marks;

    // The print's own reasons to end: the head comes to rest, and only somebody's second request stops it at once.
    void come_to_rest() {
        int none = 0;
        stop_requests.compare_exchange_strong(none, 1);
    }
    // The first that fires does.
    void tripped(const thermal::Trip& trip) {
        const std::lock_guard lock(trip_mutex_);
        if (trip_) return;
        trip_ = trip;
        come_to_rest();
    }
    std::optional<thermal::Trip> trip() {
        const std::lock_guard lock(trip_mutex_);
        return trip_;
    }

private:
    std::mutex trip_mutex_;
    std::optional<thermal::Trip> trip_;
};

// The planning thread. Of a file that was changed after its inspection nothing gets into the ring.
Status fill(const PrintFile& file, EventStream& stream, Shared& shared) {
    std::vector<LineEvent> events;
    Status status = Done{};
    for (bool more = true; more && !shared.finished.load();) {
        events.clear();
        Result<bool> next = stream.next(events);
        if (Status same = file.check(); !same) next = same.error();
        if (!next) {
            status = next.error();
            events.clear();
            // What the ring still holds is enough to brake on.
            shared.come_to_rest();
        }
        more = next.ok() && *next;
        if (next && !more) {
            shared.last = events.back();
            events.pop_back();
        }
        shared.layers.begin(stream.steps().begun(), stream.schedule().shift_ns());
        shared.flow->put(events);
    }
    shared.flow->close();
    return status;
}

// Nobody tends heaters: pauses that the file asks for are still seen to.
class IdleTending {
public:
    explicit IdleTending(Shared& shared)
        : attendant_(shared.orders, shared.marks, nullptr, &shared.desk) {}
    void tick(double now_s) {
        if (now_s < next_s_) return;
        next_s_ = now_s + thermal::tick_s;
        attendant_.tick();
    }

private:
    HeatAttendant attendant_;
    double next_s_ = 0;
};

void press(Buttons& buttons, std::int64_t now_ns, Life& life, Shared& shared) {
    const Result<std::vector<std::size_t>> pressed = buttons.pressed(now_ns);
    if (!pressed) return shared.tripped({thermal::GuardKind::silent, pressed.error().message});
    for (const std::size_t input : *pressed) life.press(input);
}

std::string status_text(const PrintStatus& status) {
    const auto state = static_cast<std::size_t>(status.state);
    return std::string(print_state_names[state]) +
           formatted(", layer %u of %u", status.layer, status.layers);
}

// What the first thread looks after.
struct Watched {
    const StopSignals& signals;
    Shared& shared;
    Life& life;
    Heating* heating;
    Buttons* buttons;
    Supervision& supervision;
};

// What goes on beside the motion of a print and that before it.
void look_after(const Watched& watched, double now_s) {
    auto& [signals, shared, life, heating, buttons, supervision] = watched;
    if (heating)
        if (const auto silent = heating->stage->expire(now_s)) shared.tripped(*silent);
    if (buttons) press(*buttons, gpio::MonotonicClock().now_ns(), life, shared);
    // A head that comes to rest may take its time.
    if (heating && shared.stop_requests.load() > 0) (void)heating->stage->all_off();
    if (const auto trip = shared.trip()) life.tell(trip->message);
}

void feed(const Watched& watched, double now_s) {
    auto& [signals, shared, life, heating, buttons, supervision] = watched;
    supervision.feed(now_s, heating ? std::optional(shared.heat_ticks.load()) : std::nullopt,
                     status_text(shared.control.status()));
}

// Why it was stopped before its path.
Diagnostic stopped_before(const Watched& watched) {
    const Life& life = watched.life;
    const auto trip = watched.shared.trip();
    Diagnostic ended{Severity::error, ExitStatus::stopped, "stopped on request", {}};
    if (trip) ended = diagnostic_of(*trip);
    if (!trip && life.is_cancelled()) ended.message = "cancelled";
    // An emergency stop says itself what is lost.
    if (!trip && !life.is_cancelled() && life.ended_by())
        ended.message = *life.ended_by();
    else
        ended.message += "; it was homing, and the position of the head is lost";
    ended.message += "; before the path began, all lines are released";
    return ended;
}

// Of a head that waits for its path: how high it is by then.
Status note_risen(const PrintJob& job, std::optional<Journal>& journal, double risen_mm) {
    if (!job.resumption || !journal) return Done{};
    JournalEntry entry = job.resumption->entry;
    entry.rest_nm = std::llround((job.resumption->stopped_z_mm + risen_mm) * nm_per_mm);
    entry.place_um.reset();
    return journal->write(entry);
}

// What is to be done before the path, and whether that may begin.
Before open(const Watched& watched, const PrintJob& job, Prepared& prepared, gpio::GpioChip& chip,
            gpio::Clock& clock) {
    if (Status begun = begin_journals(job, prepared.journal); !begun) return begun;
    if (!job.before) return {};
    const Inspection& inspection = prepared.inspection;
    Shared& shared = watched.shared;
    PrintStatus status = shared.control.status();
    status.layers = inspection.totals.layers;
    status.estimated_s = inspection.header.summary.estimated_time_s;
    status.time_s = watched.life.time_s();
    Opening opening(shared.control, shared.desk, watched.signals, std::move(status),
                    [&](double now_s) {
                        look_after(watched, now_s);
                        feed(watched, now_s);
                    });
    const Before before = job.before(
        chip, clock, [&] { return opening.asked(); },
        [&](double risen_mm) { return note_risen(job, prepared.journal.journal, risen_mm); });
    (void)opening.asked();
    if (shared.stop_requests.load() == 0) return before;
    // Serves what ends it.
    watched.life.tick(heat_time_s());
    return {stopped_before(watched), before.risen_mm};
}

// A print whose path does not begin.
Diagnostic left_unbegun(const PrintJob& job, PrintJournal& journal, const Before& opened,
                        gpio::GpioChip& chip, Life& life) {
    (void)chip.release();
    const bool resumes = job.resumption && journal.journal;
    if (resumes && life.is_cancelled()) journal.journal->remove();
    // What went wrong before is the message.
    else if (opened.risen_mm != 0)
        (void)note_risen(job, journal.journal, opened.risen_mm);
    life.end(opened.status, false);
    return opened.status.error();
}

// Until the real-time thread has ended.
void watch(const Watched& watched, const PrintJob& job, const Inspection& inspection,
           const gpio::TracingClock& clock) {
    auto& [signals, shared, life, heating, buttons, supervision] = watched;
    IdleTending idle(shared);
    Heartbeat heartbeat;
    double next_progress_s = heat_time_s() + progress_s;
    while (!shared.finished.load()) {
        if (signals.wait_ms(signal_wait_ms)) ++shared.stop_requests;
        const double now_s = heat_time_s();
        if (!heating) idle.tick(now_s);
        const bool hangs = heartbeat.is_missed(clock.waits() + shared.flow->naps(), now_s);
        if (hangs)
            shared.tripped({thermal::GuardKind::silent,
                            "no step has been written for more than 3 s: a write to the lines "
                            "hangs; all heaters are off"});
        look_after(watched, now_s);
        if (!hangs) feed(watched, now_s);
        life.tick(now_s);
        if (!job.progress || now_s < next_progress_s) continue;
        next_progress_s = now_s + progress_s;
        job.progress({life.layer(), inspection.totals.layers, life.time_s(),
                      inspection.header.summary.estimated_time_s});
    }
}

Diagnostic stopped(const Shared& shared, const Life& life) {
    std::string why = life.ended_by().value_or(life.is_cancelled() ? "cancelled, and stopped"
                                                                   : "stopped on request");
    if (!life.ended_by() && shared.stop_requests > 1)
        why += " at once, so that the position of the head is lost";
    return {Severity::error,
            ExitStatus::stopped,
            why + formatted("; in layer %u after %.1f s; all lines are released", life.layer(),
                            life.time_s()),
            {}};
}

// The head stands after a whole pulse.
Diagnostic dried(const Life& life) {
    Diagnostic error = EventFlow::dry_error();
    error.message += formatted("; in layer %u after %.1f s; all lines are released", life.layer(),
                               life.time_s());
    return error;
}

// A line that cannot be written, an edge that came too late, or motors that were stopped at once.
Diagnostic with_position(Diagnostic error, bool is_known) {
    // Some say it themselves.
    if (!is_known && error.message.find(" is lost") == std::string::npos)
        error.message += "; the printer has stopped, and its position is lost";
    return error;
}

// The heaters' thread, from construction to the end of the print.
class Tending {
public:
    Tending(Heating* heating, Shared& shared) {
        if (!heating) return;
        attendant_.emplace(shared.orders, shared.marks, heating->control.get(), &shared.desk);
        worker_.start([this, heating, &shared] {
            tend(*heating->control, *attendant_, shared.finished, shared.heat_ticks,
                 [&](const thermal::Trip& trip) { shared.tripped(trip); });
            (void)heating->stage->release();
        });
    }
    void join(const StopSignals& signals) { worker_.join(signals); }

private:
    std::optional<HeatAttendant> attendant_;
    Worker worker_;
};

struct Outcome {
    Status planned = Done{};
    Result<bool> executed = true;
};

Status status_of(Shared& shared, const Life& life, const Status& planned,
                 const Result<bool>& executed, bool is_known) {
    if (const auto trip = shared.trip()) return with_position(diagnostic_of(*trip), is_known);
    if (!executed) return with_position(executed.error(), false);
    if (shared.flow->ran_dry()) return dried(life);
    if (!planned) return with_position(planned.error(), is_known);
    if (!*executed) return stopped(shared, life);
    return Done{};
}

// All that a print has beside its job, until its threads have ended.
struct Running {
    Running(const PrintJob& job, const Prepared& prepared, gpio::GpioChip& chip, gpio::Clock& clock,
            Heating* heating)
        : printer(job.resumption ? lifted(job.printer, *job.resumption) : job.printer),
          shared(job.control ? *job.control : own_control, {heating != nullptr, can_resume(job)}),
          traced(clock),
          executor(chip, traced, executor_timing(printer), shared.stop_requests, &shared.marks,
                   &shared.course.wanted_pace),
          life(printer, shared.control, shared.course, shared.layers, shared.desk,
               {job.file, prepared.inspection.totals.layers,
                prepared.inspection.header.summary.estimated_time_s, prepared.journal.why_none}) {
        if (heating) life.cut = [heating] { (void)heating->stage->all_off(); };
        if (job.resumption) life.begin_with(*job.resumption, job.is_lifted);
    }

    config::Printer printer;
    PrintControl own_control;
    Shared shared;
    gpio::TracingClock traced;
    Executor executor;
    Life life;
    Outcome outcome;
    std::int64_t delayed_ns = 0;  // of the path, whose last event waits for the head to be parked
};

// The real-time thread.
void drive(Running& running, gpio::GpioChip& chip) {
    Shared& shared = running.shared;
    Diagnostics told_before;
    take_precedence(running.printer.timing.cpu, told_before);
    Result<bool>& executed = running.outcome.executed;
    executed = shared.flow->drain([&](std::span<const LineEvent> events) {
        return follow(events, running.executor, shared.course, running.traced,
                      shared.stop_requests);
    });
    running.delayed_ns = running.executor.delayed_ns();
    if (executed && *executed && shared.last)
        executed = finish(*shared.last, running.executor, shared.course, running.traced,
                          shared.stop_requests);
    const Status released = chip.release();
    if (!released && executed) executed = released.error();
    shared.finished.store(true);
}

// What the print came to, once its motion has ended: told to all.
Status conclude(Running& running, const Worker& planner, std::optional<JournalWriter>& journal) {
    Life& life = running.life;
    const Result<bool>& executed = running.outcome.executed;
    const bool is_known = executed.ok() && running.shared.stop_requests < 2;
    const Status planned = planner.ends_soon() ? running.outcome.planned : Done{};
    Status status = status_of(running.shared, life, planned, executed, is_known);
    if (journal && (status || life.is_cancelled()))
        journal->remove();
    else if (is_known)
        life.note_rest();
    if (journal) journal->finish();
    life.end(status, is_known);
    return status;
}

void report_on(const Running& running, PrintReport& report) {
    const Executor& executor = running.executor;
    report.cpu = running.printer.timing.cpu;
    report.planned_s = static_cast<double>(executor.time_ns()) / ns_per_s;
    report.stretched_s = static_cast<double>(executor.stretched_ns()) / ns_per_s;
    report.worst_late_ns = executor.worst_late_ns();
    report.writes = executor.writes();
    report.waited_s = static_cast<double>(executor.waited_ns()) / ns_per_s;
    report.lateness = running.traced.histogram();
    report.paused_s = running.life.paused_s();
    if (!running.life.has_set_speed()) return;
    const double delayed_s = static_cast<double>(running.delayed_ns) / ns_per_s;
    report.slowed_s =
        std::max(0.0, delayed_s - report.stretched_s - report.waited_s - report.paused_s);
}

// Before the threads of a print are waited for, on whatever way that comes: nobody would watch them any more.
struct Ending {
    Shared& shared;
    ~Ending() {
        if (!shared.finished.load()) shared.come_to_rest();
        shared.finished.store(true);
    }
};

// What a print may have beside its lines.
struct Around {
    Heating* heating = nullptr;
    Buttons* buttons = nullptr;
    std::optional<Watchdog> watchdog{};
};

Result<PrintReport> run(const PrintJob& job, Prepared& prepared, gpio::GpioChip& chip,
                        gpio::Clock& clock, Around around) {
    Heating* const heating = around.heating;
    Buttons* const buttons = around.buttons;
    const Inspection& inspection = prepared.inspection;
    Running running(job, prepared, chip, clock, heating);
    Shared& shared = running.shared;
    Life& life = running.life;
    Result<format::Reader> reader =
        prepared.file.reader(job.resumption ? job.resumption->first_layer : 0);
    if (!reader) return reader.error();
    Result<EventStream> stream = EventStream::open(std::move(*reader), job.file, running.printer,
                                                   inspection.filament_diameter_mm, &shared.orders);
    if (!stream) return stream.error();
    stream->heed_speed(shared.course.plan_factor);
    if (job.resumption) stream->begin_drawn_back(job.resumption->drawn_back_mm);
    const StopSignals signals;
    PrintReport report;
    report.warnings = prepared.notes;
    report.told = report.warnings.size();
    if (job.begun) job.begun();
    // At once: the keeper of the heaters' lines expects to hear of them.
    Tending tending(heating, shared);
    Worker planner, edges;
    const Ending ending{shared};
    Supervision supervision(std::move(around.watchdog));
    const Watched watched{signals, shared, life, heating, buttons, supervision};
    if (const Before opened = open(watched, job, prepared, chip, clock); !opened.status) {
        shared.finished.store(true);
        const Diagnostic why = left_unbegun(job, prepared.journal, opened, chip, life);
        tending.join(signals);
        return why;
    }
    if (buttons)
        life.lacks_filament = [buttons] { return buttons->is_active(config::input_filament); };
    std::optional<JournalWriter> journal;
    if (prepared.journal.journal) journal.emplace(std::move(*prepared.journal.journal));
    life.keep_journal(journal ? &*journal : nullptr, prepared.journal.file);
    shared.flow.emplace(shared.stop_requests, shared.finished);
    if (job.resumption) life.heat_for(*job.resumption);
    planner.start([&] { running.outcome.planned = fill(prepared.file, *stream, shared); });
    edges.start([&] { drive(running, chip); });
    watch(watched, job, inspection, running.traced);
    edges.join(signals);
    if (heating) (void)heating->stage->all_off();
    const Status status = conclude(running, planner, journal);
    // All is off and told: whoever hangs at a sensor or the file is waited for.
    planner.join(signals);
    tending.join(signals);
    if (!status) return status.error();
    if (life.journal_error()) report.warnings.push_back(*life.journal_error());
    report_on(running, report);
    return report;
}

}  // namespace

Result<PrintReport> print(const PrintJob& job, gpio::GpioChip& chip, gpio::Clock& clock,
                          Heating* heating, Buttons* buttons) {
    keep_stacks_small();
    Result<Prepared> prepared = prepare(job);
    if (!prepared) return prepared.error();
    if (!heating && !job.no_heat && !prepared->inspection.demands.hottest.empty())
        return Diagnostic{Severity::error, ExitStatus::internal, "no heaters were opened", {}};
    if (job.checked) job.checked(prepared->notes);
    return run(job, *prepared, chip, clock, {heating, buttons});
}

Result<PrintReport> print(const PrintJob& job) {
    keep_stacks_small();
    Result<Prepared> prepared = prepare(job);
    if (!prepared) return prepared.error();
    const Result<std::vector<gpio::LineRequest>> requests = line_requests(job.printer);
    if (!requests) return requests.error();
    if (job.checked) job.checked(prepared->notes);
    // From here on lines are held: one that comes between homing and printing must not be lost, nor end the program.
    const StopSignals signals;
    const Result<std::unique_ptr<gpio::GpioChip>> chip = gpio::open_gpiod_chip(*requests);
    if (!chip) return chip.error();
    gpio::MonotonicClock clock;
    std::optional<Heating> heating;
    const Demands& demands = prepared->inspection.demands;
    if (!job.no_heat && !demands.hottest.empty()) {
        Result<Heating> opened = open_heating(job.printer);
        if (!opened) return opened.error();
        heating.emplace(std::move(*opened));
    }
    Result<std::optional<Buttons>> buttons = open_buttons(job.printer);
    if (!buttons) return buttons.error();
    Around around{heating ? &*heating : nullptr, *buttons ? &**buttons : nullptr};
    // Last of all: from here on it wants to be fed.
    if (!job.printer.watchdog.device.empty()) {
        Result<Watchdog> watchdog = Watchdog::open(job.printer.watchdog);
        if (!watchdog) return watchdog.error();
        around.watchdog.emplace(std::move(*watchdog));
    }
    return run(job, *prepared, **chip, clock, std::move(around));
}

}  // namespace lyr::run
