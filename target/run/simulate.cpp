// The chain is that of a print; at its end the mock's observer decodes the lines and hands each step to
// the two checks.

#include "target/run/simulate.h"

#include <algorithm>

#include "target/gpio/tracing_chip.h"
#include "target/run/event_stream.h"
#include "target/run/executor.h"
#include "target/run/print.h"
#include "target/run/step_checks.h"

namespace lyr::run {
namespace {

constexpr double ns_per_s = 1e9;

// Progress and stop are asked for after so many batches of events.
constexpr std::uint64_t batches_between_questions = 64;

Diagnostic stopped() {
    return {Severity::error, ExitStatus::stopped, "the simulation was stopped on request", {}};
}

// Everything that a simulation is made of, in the order in which the steps pass through it.
class Simulation {
public:
    Simulation(const SimulationJob& job, const Inspection& inspection, EventStream stream,
               FilePath file)
        : job_(job),
          inspection_(inspection),
          stream_(std::move(stream)),
          file_(std::move(file)),
          checks_(job.printer, [this](PathCurve& curve) { return file_.next(curve); }),
          decoder_([this](const DecodedStep& step) { checks_.step(step); }),
          layout_(line_layout(job.printer)),
          mock_(layout_.names.size(), clock_,
                [this](const gpio::LineWrite& write) { decoder_.write(write); }) {}

    // `trace` is none, or the file to write the wave to.
    Status run(ReplaceFile* trace);
    SimulationReport report() const;

private:
    Status pump(Executor& executor, ReplaceFile* trace);
    bool asked_to_stop(const Executor& executor) const;

    const SimulationJob& job_;
    const Inspection& inspection_;
    EventStream stream_;
    FilePath file_;
    StepChecks checks_;
    PulseDecoder decoder_;
    LineLayout layout_;
    gpio::VirtualClock clock_;
    gpio::MockChip mock_;
    double print_time_s_ = 0;
};

Status Simulation::run(ReplaceFile* trace) {
    std::optional<gpio::TracingChip> tracing;
    if (trace) tracing.emplace(mock_, clock_, layout_.names, *trace);
    gpio::GpioChip& chip = tracing ? static_cast<gpio::GpioChip&>(*tracing) : mock_;
    const StopRequests none{0};
    Executor executor(chip, clock_, executor_timing(job_.printer), none);
    Status pumped = pump(executor, trace);
    print_time_s_ = static_cast<double>(executor.time_ns()) / ns_per_s;
    if (!pumped) return pumped;
    if (Status followed = checks_.finish(decoder_.positions()); !followed) return followed;
    Status released = chip.release();
    if (tracing) tracing->finish();
    return released;
}

Status Simulation::pump(Executor& executor, ReplaceFile* trace) {
    std::vector<LineEvent> events;
    for (std::uint64_t batch = 0;; ++batch) {
        events.clear();
        const Result<bool> more = stream_.next(events);
        if (!more) return more.error();
        checks_.expect(stream_.steps().moves(), stream_.schedule().take_shifts());
        const Result<bool> executed = executor.execute(events);
        if (!executed) return executed.error();
        if (!*more) return Done{};
        if (batch % batches_between_questions != 0) continue;
        if (trace && trace->failed()) return trace->flush();
        if (asked_to_stop(executor)) return stopped();
    }
}

bool Simulation::asked_to_stop(const Executor& executor) const {
    if (job_.progress)
        job_.progress({stream_.steps().layer(), inspection_.totals.layers,
                       static_cast<double>(executor.time_ns()) / ns_per_s,
                       inspection_.header.summary.estimated_time_s});
    return job_.stop && job_.stop();
}

SimulationReport Simulation::report() const {
    SimulationReport report;
    report.file = job_.file;
    report.printer = job_.printer;
    report.inspection = inspection_;
    report.print_time_s = print_time_s_;
    report.delayed_ns = stream_.schedule().shift_ns() - EventStream::driver_wake_ns;
    for (std::size_t i = 0; i < report.pulses.size(); ++i) report.pulses[i] = decoder_.figures(i);
    report.positions = decoder_.positions();
    report.writes = decoder_.writes();
    report.path = checks_.off_file();
    report.planned_steps = checks_.off_plan();
    return report;
}

// What a print would refuse is worth knowing, but no reason not to simulate.
Diagnostics notes_of(const Inspection& inspection) {
    Diagnostics notes;
    if (const Status possible = check_demands(inspection, true, notes); !possible) {
        notes.push_back(possible.error());
        notes.back().severity = Severity::warning;
    }
    return notes;
}

}  // namespace

Result<SimulationReport> simulate(const SimulationJob& job) {
    std::optional<ReplaceFile> trace;
    if (job.trace) {
        Result<ReplaceFile> opened = ReplaceFile::open(*job.trace);
        if (!opened) return opened.error();
        trace.emplace(std::move(*opened));
    }
    const Result<Inspection> inspection = inspect(job.file, job.printer);
    if (!inspection) return inspection.error();
    const double diameter_mm = inspection->filament_diameter_mm;
    Result<EventStream> stream = EventStream::open(job.file, job.printer, diameter_mm);
    if (!stream) return stream.error();
    Result<format::Reader> reader = open_file(job.file);
    if (!reader) return reader.error();
    Simulation simulation(job, *inspection, std::move(*stream),
                          FilePath(std::move(*reader), job.printer.start_mm, diameter_mm));
    if (const Status run = simulation.run(trace ? &*trace : nullptr); !run) return run.error();
    if (trace)
        if (const Status written = trace->commit(); !written) return written.error();
    SimulationReport report = simulation.report();
    report.notes = notes_of(*inspection);
    return report;
}

}  // namespace lyr::run
