// Times are counted in buckets as fine as the figures that are told: an hour has forty million of them.

#include "target/board/latency.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdio>
#include <thread>

#include "base/constants.h"
#include "base/text.h"
#include "target/gpio/gpiod_chip.h"
#include "target/run/line_layout.h"
#include "target/run/real_time.h"

namespace lyr::board {
namespace {

// Longer than MonotonicClock stays awake for: the thread sleeps.
constexpr std::int64_t sparse_ns = 1'000'000;
static_assert(sparse_ns > gpio::MonotonicClock::awake_ns);
// 20,000 edges a second.
constexpr std::int64_t dense_ns = 50'000;
static_assert(dense_ns < gpio::MonotonicClock::awake_ns);
// Dense waits come in runs of this length, longer than the second in which Linux counts how long
// a real-time thread has run.
constexpr std::int64_t run_ns = 2'000'000'000;

// What a print's other threads and a board's other programs do: more than the caches hold.
void work(const std::atomic<bool>& finished) {
    std::vector<std::uint64_t> memory(std::size_t{1} << 18);
    for (std::size_t i = 0; !finished.load(std::memory_order_relaxed); ++i)
        memory[(i * 7919) % memory.size()] += i;
}

// The ordinary work, from construction to destruction.
class Load {
public:
    Load() {
        for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
            threads_.emplace_back([this] { work(finished_); });
    }
    ~Load() {
        finished_.store(true);
        for (std::thread& thread : threads_) thread.join();
    }

private:
    std::atomic<bool> finished_{false};
    std::vector<std::thread> threads_;
};

struct Samples {
    Times asleep, awake, write;
};

class Measurement {
public:
    Measurement(gpio::Clock& clock, gpio::GpioChip* chip) : clock_(clock), chip_(chip) {}

    Result<Samples> run(double seconds) {
        const std::int64_t half_ns = std::llround(seconds * ns_per_s / 2);
        const std::int64_t end_ns = clock_.now_ns() + 2 * half_ns;
        // Each kind has its half, however short the whole is.
        const std::int64_t turn_ns = std::min(run_ns, half_ns);
        // There is time for one more wait of either kind.
        const auto time_left = [&] { return clock_.now_ns() + sparse_ns < end_ns; };
        for (bool dense = false; time_left(); dense = !dense) {
            const std::int64_t until_ns = std::min(end_ns, clock_.now_ns() + turn_ns);
            if (Status done = dense ? wait(dense_ns, until_ns, samples_.awake)
                                    : wait(sparse_ns, until_ns, samples_.asleep);
                !done)
                return done.error();
        }
        return std::move(samples_);
    }

private:
    Status wait(std::int64_t gap_ns, std::int64_t until_ns, Times& late) {
        for (std::int64_t due_ns = clock_.now_ns() + gap_ns; due_ns <= until_ns;) {
            const std::int64_t now_ns = clock_.wait_until_ns(due_ns);
            late.add(now_ns - due_ns);
            if (chip_) {
                if (Status written = chip_->write(gpio::all_lines(chip_->line_count()), 0);
                    !written)
                    return written;
                samples_.write.add(clock_.now_ns() - now_ns);
            }
            // As in a print, a late one makes the next ones no sooner.
            due_ns = now_ns + gap_ns;
        }
        return Done{};
    }

    gpio::Clock& clock_;
    gpio::GpioChip* chip_;
    Samples samples_;
};

std::string row(const char* what, const Spread& spread) {
    return formatted("# %-28s %9zu  %10.1f %10.1f %10.1f\n", what, spread.count,
                     static_cast<double>(spread.median_ns) / ns_per_us,
                     static_cast<double>(spread.rare_ns) / ns_per_us,
                     static_cast<double>(spread.worst_ns) / ns_per_us);
}

std::optional<Diagnostic> warning_of(std::int64_t worst_ns, std::int64_t limit_ns) {
    if (worst_ns <= limit_ns) return std::nullopt;
    return Diagnostic{
        Severity::warning,
        ExitStatus::machine,
        formatted("a wait ended %.3f ms late, and pulse.late_limit_ms is %.3f: a print would have "
                  "stopped there; docs/bring-up.md says what makes a board punctual",
                  static_cast<double>(worst_ns) / 1e6, static_cast<double>(limit_ns) / 1e6),
        {}};
}

Diagnostic has_timing_note() {
    return {
        Severity::note,
        ExitStatus::ok,
        "the printer's file has a [timing] already, and TOML allows no second one: the measured "
        "keys are printed as comments; put them into that section by hand",
        {}};
}

}  // namespace

std::size_t Times::bucket_of(std::uint64_t time_ns) {
    const int shift = std::max(0, static_cast<int>(std::bit_width(time_ns)) - exact_bits);
    return static_cast<std::size_t>(shift) * half + static_cast<std::size_t>(time_ns >> shift);
}

std::int64_t Times::end_ns(std::size_t bucket) {
    const std::size_t shift = bucket < half ? 0 : bucket / half - 1;
    return (static_cast<std::int64_t>(bucket - shift * half + 1) << shift) - 1;
}

void Times::add(std::int64_t time_ns) {
    const auto longest_ns = std::int64_t{1} << most_bits;
    ++counts_[bucket_of(
        static_cast<std::uint64_t>(std::clamp<std::int64_t>(time_ns, 0, longest_ns - 1)))];
    ++count_;
    worst_ns_ = std::max(worst_ns_, time_ns);
}

std::int64_t Times::place_from_above(std::uint64_t number) const {
    std::size_t bucket = counts_.size();
    for (std::uint64_t above = 0; bucket > 0 && above < number;) above += counts_[--bucket];
    return std::min(end_ns(bucket), worst_ns_);
}

Spread Times::spread() const {
    constexpr std::size_t rare = 10'000;
    return {count_, place_from_above(count_ - count_ / 2), place_from_above(count_ / rare + 1),
            worst_ns_};
}

void Times::add_to(std::vector<std::uint64_t>& histogram) const {
    for (std::size_t i = 0; i < counts_.size(); ++i) {
        if (counts_[i] == 0) continue;
        // A power of two of microseconds is where a bucket begins.
        const auto us = static_cast<std::uint64_t>(end_ns(i) / 1'000);
        const auto wide = static_cast<std::size_t>(std::bit_width(us));
        if (wide >= histogram.size()) histogram.resize(wide + 1);
        histogram[wide] += counts_[i];
    }
}

Result<LatencyReport> measure_latency(const LatencyJob& job, gpio::Clock& clock,
                                      gpio::GpioChip* chip) {
    Result<Samples> samples = Measurement(clock, chip).run(job.seconds);
    if (!samples) return samples.error();
    LatencyReport report;
    report.printer = job.printer.name;
    for (const Times* times : {&samples->asleep, &samples->awake}) times->add_to(report.histogram);
    report.asleep = samples->asleep.spread();
    report.awake = samples->awake.spread();
    if (chip) report.write = samples->write.spread();
    config::Printer measured = job.printer;
    measured.timing.late_ns = std::max(report.asleep.rare_ns, report.awake.rare_ns);
    if (report.write) measured.timing.write_ns = report.write->rare_ns;
    report.steps_per_s = config::held_steps_per_s(measured);
    report.has_timing = job.printer.timing.is_given;
    if (report.has_timing) report.warnings.push_back(has_timing_note());
    if (const auto warning = warning_of(std::max(report.asleep.worst_ns, report.awake.worst_ns),
                                        job.printer.pulse.late_limit_ns))
        report.warnings.push_back(*warning);
    return report;
}

Result<LatencyReport> measure_latency(const LatencyJob& job) {
    if (const Status has = run::check_cpu(job.printer.timing.cpu); !has) return has.error();
    std::unique_ptr<gpio::GpioChip> chip;
    if (job.lines) {
        const Result<std::vector<gpio::LineRequest>> requests = run::line_requests(job.printer);
        if (!requests) return requests.error();
        Result<std::unique_ptr<gpio::GpioChip>> opened = gpio::open_gpiod_chip(*requests);
        if (!opened) return opened.error();
        chip = std::move(*opened);
    }
    gpio::MonotonicClock clock;
    Result<LatencyReport> report = LatencyReport{};
    Diagnostics warnings;
    const Load load;
    std::thread([&] {
        run::lock_memory(warnings);
        run::take_precedence(job.printer.timing.cpu, warnings);
        report = measure_latency(job, clock, chip.get());
    }).join();
    if (report) report->warnings.insert(report->warnings.begin(), warnings.begin(), warnings.end());
    return report;
}

std::string text_of(const LatencyReport& report) {
    std::string text = "# Timing of the board of \"" + escaped(report.printer) + "\".\n" +
                       formatted("# %-28s %9s  %10s %10s %10s\n", "microseconds", "count", "median",
                                 "1 in 10^4", "worst");
    text += row("a wait ended late, asleep", report.asleep);
    text += row("a wait ended late, awake", report.awake);
    if (report.write)
        text += row("a write to all lines took", *report.write);
    else
        text += "# No line was written (--lines writes those of the motors, inactive).\n";
    for (std::size_t i = 0; i < report.histogram.size(); ++i)
        if (report.histogram[i])
            text += formatted("# waits less than %9llu us late: %llu\n", 1ULL << i,
                              static_cast<unsigned long long>(report.histogram[i]));
    text +=
        formatted("# All motors can step at %.0f steps a second each. For ", report.steps_per_s);
    text += report.has_timing ? "the [timing] that printer.toml has, in place of its own:\n"
                              : "printer.toml:\n[timing]\n";
    const char* key = report.has_timing ? "# " : "";
    const std::int64_t late_ns = std::max(report.asleep.rare_ns, report.awake.rare_ns);
    text += formatted("%slate_us = %.1f\n", key, static_cast<double>(late_ns) / ns_per_us);
    if (report.write)
        text += formatted("%swrite_us = %.1f\n", key,
                          static_cast<double>(report.write->rare_ns) / ns_per_us);
    return text;
}

}  // namespace lyr::board
