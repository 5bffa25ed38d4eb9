// The chain is that of a print; its begin has a thread of its own. At its end the lines hand each step to the checks, which
// have one, too.

#include "target/run/simulate.h"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "base/constants.h"
#include "base/text.h"
#include "target/gpio/tracing_chip.h"
#include "target/run/demands.h"
#include "target/run/executor.h"
#include "target/run/heating.h"
#include "target/run/inspect.h"
#include "target/run/life.h"
#include "target/run/simulated_lines.h"
#include "target/run/stream_beside.h"

namespace lyr::run {
namespace {

// Progress and stop are asked for after so many batches of events.
constexpr std::uint64_t batches_between_questions = 64;

// Where anybody may ask for more speed, so much is made at once: less than in a print, whose ring holds seconds.
constexpr std::int64_t heeded_within_ns = 500'000'000;

Diagnostic stopped() {
    return {Severity::error, ExitStatus::stopped, "the simulation was stopped on request", {}};
}

Diagnostic ended(double time_s, std::uint32_t layer, const std::string& why) {
    return {Severity::error,
            ExitStatus::stopped,
            formatted("after %.1f s, in layer %u: ", time_s, layer) + why,
            {}};
}

Diagnostic tripped(const thermal::SimulatedHeat& heat, std::uint32_t layer) {
    char text[64];
    std::snprintf(text, sizeof text, "after %.1f s, in layer %u: ", *heat.tripped_s(), layer);
    Diagnostic error = diagnostic_of(*heat.control().trip());
    error.message = text + error.message;
    return error;
}

Diagnostic script_warning(std::int64_t time_ns, const std::string& what) {
    return {Severity::warning,
            ExitStatus::ok,
            formatted("after %.1f s: ", static_cast<double>(time_ns) / ns_per_s) + what,
            {}};
}

// Whether anybody asks anything of the print.
bool lives(const SimulationJob& job) {
    return !job.script.empty() || job.control || job.resumption ||
           !job.line_faults.signals_s.empty();
}

// Everything that a simulation is made of, in the order in which the steps pass through it.
class Simulation {
public:
    // `orders` is none, or where the stream puts what is to be heated.
    Simulation(const SimulationJob& job, const Inspection& inspection, EventStream stream,
               FilePath file, OrderQueue* orders, bool heats)
        : job_(job),
          inspection_(inspection),
          heats_(heats),
          control_(job.control ? *job.control : own_control_),
          marked_(orders != nullptr),
          heat_(job.printer, heats_ ? job.faults : std::vector<thermal::Fault>(),
                job.line_faults.heaters),
          attendant_(orders ? *orders : no_orders_, marks_, heats ? &heat_.control() : nullptr,
                     &desk_),
          clock_(heat_, attendant_, control_.stop_requests()),
          life_(job.printer, control_, course_, layers_, desk_,
                {job.file, inspection.totals.layers, inspection.header.summary.estimated_time_s}),
          stream_(std::move(stream), course_.plan_factor,
                  is_lived() ? heeded_within_ns : std::numeric_limits<std::int64_t>::max()),
          file_(std::move(file)),
          checks_(job.printer, [this](PathCurve& curve) { return file_.next(curve); }),
          layout_(line_layout(job.printer)),
          lines_(layout_.names.size(), clock_, checks_, job.line_faults.motors) {
        // Without its switch a heater is cold at once.
        life_.cut = [this] { heat_.release(); };
        life_.hear_of_refusal = [this](const std::string& why) {
            notes_.push_back(script_warning(clock_.now_ns(), why));
        };
        if (job.heat_watch)
            heat_.observe(
                [this](double time_s) { job_.heat_watch(time_s, heat_.any_heater_on()); });
        if (job.resumption) {
            life_.begin_with(*job.resumption, false);
            life_.heat_for(*job.resumption);
        }
        if (is_lived()) clock_.on_tick = [this](double time_s) { live(time_s); };
    }

    // `trace` is none, or the file to write the wave to.
    Status run(ReplaceFile* trace);
    SimulationReport report() const;
    const Diagnostics& notes() const { return notes_; }

private:
    Status carry_out(Executor& executor, gpio::GpioChip& chip, ReplaceFile* trace);
    Status pump(Executor& executor, ReplaceFile* trace);
    Result<bool> follow(const Portion& portion, Executor& executor);
    bool is_lived() const { return lives(job_); }
    void live(double time_s);
    Diagnostic why_ended() const;
    bool asked_to_stop(const Executor& executor) const;

    const SimulationJob& job_;
    const Inspection& inspection_;
    bool heats_;
    PrintControl own_control_;
    PrintControl& control_;
    bool marked_;
    OrderQueue no_orders_;
    Marks marks_;
    HeatDesk desk_;
    thermal::SimulatedHeat heat_;
    HeatAttendant attendant_;
    SimulatedClock clock_;
    Course course_;
    LayerLog layers_;
    Life life_;
    std::size_t posted_ = 0, signalled_ = 0;  // of the script and of the signals
    StepPositions trip_steps_{};
    bool is_derailed_ = false;  // a write failed
    StreamBeside stream_;
    std::uint32_t layer_ = 0;
    std::int64_t shift_ns_ = 0, followed_ns_ = 0;  // when the path was done
    FilePath file_;
    ChecksBeside checks_;
    LineLayout layout_;
    SimulatedLines lines_;
    double print_time_s_ = 0, waited_s_ = 0;
    Diagnostics notes_;  // of the script
};

Status Simulation::run(ReplaceFile* trace) {
    std::optional<gpio::TracingChip> tracing;
    if (trace) tracing.emplace(lines_.chip(), clock_, layout_.names, *trace);
    gpio::GpioChip& chip = tracing ? static_cast<gpio::GpioChip&>(*tracing) : lines_.chip();
    Executor executor(chip, clock_, executor_timing(job_.printer), control_.stop_requests(),
                      marked_ ? &marks_ : nullptr, &course_.wanted_pace);
    lines_.belong_to(&executor);
    if (!tracing) lines_.bind(executor);
    Status done = carry_out(executor, chip, trace);
    lines_.belong_to(nullptr);
    if (done && tracing) tracing->finish();
    return done;
}

Status Simulation::carry_out(Executor& executor, gpio::GpioChip& chip, ReplaceFile* trace) {
    Status pumped = pump(executor, trace);
    heat_.release();
    if (job_.heat_watch)
        job_.heat_watch(static_cast<double>(clock_.now_ns()) / ns_per_s, heat_.any_heater_on());
    life_.end(pumped, !is_derailed_ && control_.stop_requests() < 2);
    trip_steps_ = executor.trip_steps();
    print_time_s_ = static_cast<double>(executor.time_ns()) / ns_per_s;
    waited_s_ = static_cast<double>(executor.waited_ns()) / ns_per_s;
    if (!pumped) return pumped;
    if (Status followed = checks_.finish(lines_.decoder().positions()); !followed) return followed;
    return chip.release();
}

Status Simulation::pump(Executor& executor, ReplaceFile* trace) {
    for (std::uint64_t batch = 0;; ++batch) {
        const Portion& portion = stream_.next();
        if (!portion.more) return portion.more.error();
        layer_ = portion.layer;
        shift_ns_ = portion.shift_ns;
        checks_.expect(portion.moves, portion.shifts);
        // Who lives looks there, and takes away what has been.
        if (is_lived()) layers_.begin(portion.begun, portion.shift_ns);
        const Result<bool> executed = follow(portion, executor);
        is_derailed_ = !executed.ok();
        if (!executed) return executed.error();
        if (!*executed) return why_ended();
        if (!*portion.more) return Done{};
        if (batch % batches_between_questions != 0) continue;
        if (trace && trace->failed()) return trace->flush();
        if (asked_to_stop(executor)) return stopped();
    }
}

Result<bool> Simulation::follow(const Portion& portion, Executor& executor) {
    std::span<const LineEvent> events(portion.events);
    const bool is_last = !*portion.more;
    if (is_last) events = events.first(events.size() - 1);
    Result<bool> executed =
        run::follow(events, executor, course_, clock_, control_.stop_requests());
    if (!is_last || !executed || !*executed) return executed;
    followed_ns_ = clock_.now_ns();
    // Whoever asks nothing of a print has its head parked, too.
    clock_.on_tick = [this](double time_s) { live(time_s); };
    return finish(portion.events.back(), executor, course_, clock_, control_.stop_requests());
}

void Simulation::live(double time_s) {
    for (; posted_ < job_.script.size() && job_.script[posted_].time_s <= time_s; ++posted_)
        if (!control_.post(job_.script[posted_].command))
            notes_.push_back(script_warning(clock_.now_ns(), "too many commands at once"));
    const std::vector<double>& signals_s = job_.line_faults.signals_s;
    for (; signalled_ < signals_s.size() && signals_s[signalled_] <= time_s; ++signalled_)
        ++control_.stop_requests();
    life_.tick(time_s);
    if (life_.rests() && signals_s.empty() && posted_ == job_.script.size() && !job_.control)
        ++control_.stop_requests();
}

Diagnostic Simulation::why_ended() const {
    if (heat_.control().trip()) return tripped(heat_, layer_);
    return ended(static_cast<double>(clock_.now_ns()) / ns_per_s, life_.layer(),
                 life_.ended_by().value_or(signalled_ ? "stopped on request"
                                                      : "the script ends, and the print rests"));
}

bool Simulation::asked_to_stop(const Executor& executor) const {
    if (job_.progress)
        job_.progress({layer_, inspection_.totals.layers,
                       static_cast<double>(executor.time_ns()) / ns_per_s,
                       inspection_.header.summary.estimated_time_s});
    return job_.stop && job_.stop();
}

SimulationReport Simulation::report() const {
    SimulationReport report;
    report.file = job_.file;
    report.printer = job_.printer;
    report.totals = inspection_.totals;
    report.filament_diameter_mm = inspection_.filament_diameter_mm;
    report.print_time_s = print_time_s_;
    report.delayed_ns = shift_ns_ - EventStream::driver_wake_ns;
    for (std::size_t i = 0; i < report.pulses.size(); ++i)
        report.pulses[i] = lines_.decoder().figures(i);
    report.positions = lines_.decoder().positions();
    report.writes = lines_.decoder().writes();
    report.path = checks_.checks().off_file();
    report.planned_steps = checks_.checks().off_plan();
    report.waited_s = waited_s_;
    report.paused_s = life_.paused_s();
    report.trip_steps = trip_steps_;
    const auto is_speed = [](const TimedCommand& timed) {
        return std::holds_alternative<SetSpeedFactor>(timed.command);
    };
    const double took_s = static_cast<double>(followed_ns_) / ns_per_s;
    if (std::any_of(job_.script.begin(), job_.script.end(), is_speed))
        report.slowed_s = std::max(0.0, took_s - print_time_s_ - waited_s_ - report.paused_s);
    report.notes = notes_;
    if (posted_ < job_.script.size())
        report.notes.push_back(
            script_warning(clock_.now_ns(), "the print ended, and " +
                                                counted(job_.script.size() - posted_, "command") +
                                                " of the script came after"));
    for (std::size_t i = 0; i < config::heater_count; ++i) {
        const thermal::HeaterStatus* status = heat_.control().status(i);
        if (heats_ && status && status->on_s > 0)
            report.heat.push_back({i, status->highest_c, status->on_s});
    }
    return report;
}

struct Heed {
    bool heats = false;
    Diagnostics notes;
};

// A simulation has nobody who would tell it to go on, and passes over pauses; whatever else a print refuses it refuses too.
Result<Heed> heed(const Inspection& inspection, const SimulationJob& job) {
    Heed result;
    const Status possible =
        check_demands(inspection, job.printer, job.no_heat, result.notes, lives(job));
    if (!possible) {
        if (possible.error().status != ExitStatus::unsupported) return possible.error();
        result.notes.push_back(possible.error());
        result.notes.back().severity = Severity::warning;
    }
    result.heats = !job.no_heat && !inspection.demands.hottest.empty();
    return result;
}

}  // namespace

Result<SimulationReport> simulate(const SimulationJob& asked) {
    SimulationJob job = asked;
    std::uint32_t first_layer = 0;
    if (job.resumption) {
        job.printer = lifted(job.printer, *job.resumption);
        first_layer = job.resumption->first_layer;
    }
    std::optional<ReplaceFile> trace;
    if (job.trace) {
        Result<ReplaceFile> opened = ReplaceFile::open(*job.trace);
        if (!opened) return opened.error();
        trace.emplace(std::move(*opened));
    }
    const Result<Inspection> inspection = inspect(job.file, job.printer);
    if (!inspection) return inspection.error();
    const double diameter_mm = inspection->filament_diameter_mm;
    Result<Heed> heeded = heed(*inspection, job);
    if (!heeded) return heeded.error();
    OrderQueue orders({heeded->heats, lives(job)});
    OrderQueue* wanted = heeded->heats || lives(job) ? &orders : nullptr;
    Result<EventStream> stream =
        EventStream::open(job.file, job.printer, diameter_mm, wanted, first_layer);
    if (!stream) return stream.error();
    Result<format::Reader> reader = open_file(job.file, first_layer);
    if (!reader) return reader.error();
    FilePath file(std::move(*reader), job.printer.start_mm, diameter_mm);
    if (job.resumption) {
        stream->begin_drawn_back(job.resumption->drawn_back_mm);
        file.begin_drawn_back(job.resumption->drawn_back_mm);
    }
    Simulation simulation(job, *inspection, std::move(*stream), std::move(file), wanted,
                          heeded->heats);
    if (const Status run = simulation.run(trace ? &*trace : nullptr); !run) {
        if (job.ended) job.ended(simulation.notes());
        return run.error();
    }
    if (trace)
        if (const Status written = trace->commit(); !written) return written.error();
    SimulationReport report = simulation.report();
    report.notes.insert(report.notes.begin(), heeded->notes.begin(), heeded->notes.end());
    return report;
}

}  // namespace lyr::run
