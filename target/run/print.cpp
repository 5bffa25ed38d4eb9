// Four threads: this one, the planning one that fills the ring, the real-time one that empties it, and the one that
// tends the heaters. They share the ring, the marks of orders, the number of requests to stop and a few numbers for the
// progress.

#include "target/run/print.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <optional>
#include <thread>

#include "target/gpio/gpiod_chip.h"
#include "target/run/demands.h"
#include "target/run/event_ring.h"
#include "target/run/event_stream.h"
#include "target/run/executor.h"
#include "target/run/real_time.h"
#include "target/run/stop_signals.h"

namespace lyr::run {
namespace {

// 2 MiB, and two edges a step: almost a second of four axes at 20,000 steps/s each.
constexpr std::size_t ring_events = std::size_t{1} << 17;
// How long a thread that waits for the ring sleeps; far below what the ring holds.
constexpr std::chrono::microseconds planner_nap{2'000};
constexpr std::chrono::microseconds executor_nap{50};
constexpr int signal_wait_ms = 100;
constexpr double ns_per_s = 1e9;
constexpr double ns_per_us = 1e3;

// What the threads share.
struct Shared {
    EventRing ring{ring_events};
    StopRequests stop_requests{0};
    std::atomic<bool> filled{false};    // the ring is full, or all of the print is in it
    std::atomic<bool> finished{false};  // the real-time thread has ended
    std::atomic<std::uint32_t> layer{0};
    std::atomic<std::int64_t> time_ns{0};
    OrderQueue orders;
    Marks marks;

    // The first that fires brings the head to rest.
    void tripped(const thermal::Trip& trip) {
        const std::lock_guard lock(trip_mutex_);
        if (!trip_) ++stop_requests;
        if (!trip_) trip_ = trip;
    }
    std::optional<thermal::Trip> trip() {
        const std::lock_guard lock(trip_mutex_);
        return trip_;
    }

private:
    std::mutex trip_mutex_;
    std::optional<thermal::Trip> trip_;
};

// The planning thread.
Status fill(EventStream& stream, Shared& shared) {
    std::vector<LineEvent> events;
    Status status = Done{};
    for (bool more = true; more && !shared.finished.load();) {
        events.clear();
        const Result<bool> next = stream.next(events);
        if (!next) {
            status = next.error();
            // What the ring still holds is enough to brake on.
            ++shared.stop_requests;
        }
        more = next.ok() && *next;
        shared.layer.store(stream.steps().layer());
        std::span<const LineEvent> left(events);
        while (!left.empty() && !shared.finished.load()) {
            left = left.subspan(shared.ring.push(left));
            if (left.empty()) break;
            shared.filled.store(true);
            std::this_thread::sleep_for(planner_nap);
        }
    }
    shared.ring.close();
    shared.filled.store(true);
    return status;
}

// The real-time thread. Events are taken a few at a time, so that the ring has room again early.
Result<bool> drain(Executor& executor, Shared& shared) {
    constexpr std::size_t batch = 64;
    while (!shared.ring.ended()) {
        std::span<const LineEvent> events = shared.ring.view();
        if (events.empty()) {
            if (shared.stop_requests.load() != 0) return false;
            std::this_thread::sleep_for(executor_nap);
            continue;
        }
        events = events.first(std::min(batch, events.size()));
        Result<bool> executed = executor.execute(events);
        if (!executed || !*executed) return executed;
        shared.time_ns.store(executor.time_ns(), std::memory_order_relaxed);
        shared.ring.drop(events.size());
    }
    return true;
}

// Until the real-time thread has ended.
void watch(const StopSignals& signals, Shared& shared, const PrintJob& job,
           const Inspection& inspection, Heating* heating) {
    while (!shared.finished.load()) {
        if (signals.wait_ms(signal_wait_ms)) ++shared.stop_requests;
        if (heating)
            if (const auto silent = heating->stage->expire(heat_time_s())) shared.tripped(*silent);
        if (job.progress)
            job.progress({shared.layer.load(), inspection.totals.layers,
                          static_cast<double>(shared.time_ns.load()) / ns_per_s,
                          inspection.header.summary.estimated_time_s});
    }
}

Diagnostic stopped(const Shared& shared) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "stopped on request in layer %u after %.1f s; all lines are released",
                  shared.layer.load(), static_cast<double>(shared.time_ns.load()) / ns_per_s);
    return {Severity::error, ExitStatus::stopped, text, {}};
}

// What is known and decided before a line is touched.
struct Prepared {
    Inspection inspection;
    Diagnostics notes;
};

Result<Prepared> prepare(const PrintJob& job) {
    Result<Inspection> inspection = inspect(job.file, job.printer);
    if (!inspection) return inspection.error();
    Prepared prepared{std::move(*inspection), {}};
    const Status possible =
        check_demands(prepared.inspection, job.printer, job.no_heat, prepared.notes);
    if (!possible) return possible.error();
    return prepared;
}

// The heaters' thread, from construction to the end of the print.
class Tending {
public:
    Tending(Heating* heating, Shared& shared) {
        if (!heating) return;
        attendant_.emplace(shared.orders, shared.marks, *heating->control);
        thread_ = std::thread([this, heating, &shared] {
            tend(*heating->control, *attendant_, shared.finished,
                 [&](const thermal::Trip& trip) { shared.tripped(trip); });
            (void)heating->stage->release();
        });
    }
    void join() {
        if (thread_.joinable()) thread_.join();
    }

private:
    std::optional<HeatAttendant> attendant_;
    std::thread thread_;
};

Result<PrintReport> run(const PrintJob& job, const Prepared& prepared, gpio::GpioChip& chip,
                        gpio::Clock& clock, Heating* heating) {
    Shared shared;
    Result<EventStream> stream =
        EventStream::open(job.file, job.printer, prepared.inspection.filament_diameter_mm,
                          heating ? &shared.orders : nullptr);
    if (!stream) return stream.error();
    const StopSignals signals;
    PrintReport report;
    report.warnings = prepared.notes;
    lock_memory(report.warnings);
    gpio::TracingClock traced(clock);
    Executor executor(chip, traced, executor_timing(job.printer), shared.stop_requests,
                      heating ? &shared.marks : nullptr);
    Status planned = Done{};
    Result<bool> executed = true;
    Tending tending(heating, shared);
    std::thread planner([&] { planned = fill(*stream, shared); });
    std::thread edges([&] {
        take_precedence(report.warnings);
        while (!shared.filled.load() && !shared.stop_requests.load())
            std::this_thread::sleep_for(executor_nap);
        executed = drain(executor, shared);
        const Status released = chip.release();
        if (!released && executed) executed = released.error();
        shared.finished.store(true);
    });
    watch(signals, shared, job, prepared.inspection, heating);
    edges.join();
    planner.join();
    tending.join();
    if (const auto trip = shared.trip()) return diagnostic_of(*trip);
    if (!executed) return executed.error();
    if (!planned) return planned.error();
    if (!*executed) return stopped(shared);
    report.planned_s = static_cast<double>(executor.time_ns()) / ns_per_s;
    report.stretched_s = static_cast<double>(executor.stretched_ns()) / ns_per_s;
    report.worst_late_ns = executor.worst_late_ns();
    report.writes = executor.writes();
    report.waited_s = static_cast<double>(executor.waited_ns()) / ns_per_s;
    report.lateness = traced.histogram();
    return report;
}

}  // namespace

Result<PrintReport> print(const PrintJob& job, gpio::GpioChip& chip, gpio::Clock& clock,
                          Heating* heating) {
    const Result<Prepared> prepared = prepare(job);
    if (!prepared) return prepared.error();
    if (!heating && !job.no_heat && !prepared->inspection.demands.hottest.empty())
        return Diagnostic{Severity::error, ExitStatus::internal, "no heaters were opened", {}};
    return run(job, *prepared, chip, clock, heating);
}

Result<PrintReport> print(const PrintJob& job) {
    const Result<Prepared> prepared = prepare(job);
    if (!prepared) return prepared.error();
    const Result<std::vector<gpio::LineRequest>> requests = line_requests(job.printer);
    if (!requests) return requests.error();
    const Result<std::unique_ptr<gpio::GpioChip>> chip = gpio::open_gpiod_chip(*requests);
    if (!chip) return chip.error();
    gpio::MonotonicClock clock;
    // Before the heaters: their keeper is a process of its own, which expects to hear of them.
    if (job.before)
        if (Status ready = job.before(**chip, clock); !ready) return ready.error();
    std::optional<Heating> heating;
    const Demands& demands = prepared->inspection.demands;
    if (!job.no_heat && !demands.hottest.empty()) {
        Result<Heating> opened = open_heating(job.printer);
        if (!opened) return opened.error();
        heating.emplace(std::move(*opened));
    }
    return run(job, *prepared, **chip, clock, heating ? &*heating : nullptr);
}

std::string text_of(const PrintReport& report) {
    char line[200];
    std::snprintf(
        line, sizeof line,
        "  printed in %.3f s, %.3f s longer than planned\n  %llu writes, the latest %.3f us "
        "late\n",
        report.planned_s + report.stretched_s, report.stretched_s,
        static_cast<unsigned long long>(report.writes),
        static_cast<double>(report.worst_late_ns) / ns_per_us);
    std::string text = line;
    if (report.waited_s > 0) {
        std::snprintf(line, sizeof line, "  waited %.1f s for temperatures\n", report.waited_s);
        text += line;
    }
    for (std::size_t i = 0; i < report.lateness.size(); ++i) {
        if (!report.lateness[i]) continue;
        std::snprintf(line, sizeof line, "  waits less than %9llu us late: %llu\n", 1ULL << i,
                      static_cast<unsigned long long>(report.lateness[i]));
        text += line;
    }
    return text;
}

}  // namespace lyr::run
