#include "target/home/mover.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "target/home/beside.h"
#include "target/home/move_stream.h"
#include "target/run/event_flow.h"
#include "target/run/real_time.h"

namespace lyr::home {
namespace {

// How long an edge of a contact may wait until it is looked at: the machine runs on meanwhile.
constexpr std::int64_t look_ns = 1'000'000;
// For how many times of settling a contact that goes on bouncing is waited for.
constexpr std::int64_t most_settlings = 20;

// After every wait something is looked at.
class PolledClock final : public gpio::Clock {
public:
    PolledClock(gpio::Clock& inner, ContactWatch* watch) : inner_(inner), watch_(watch) {}
    std::int64_t now_ns() const override { return inner_.now_ns(); }
    std::int64_t wait_until_ns(std::int64_t time_ns) override {
        const std::int64_t now = inner_.wait_until_ns(time_ns);
        if (watch_) watch_->poll(now);
        return now;
    }

private:
    gpio::Clock& inner_;
    ContactWatch* watch_;
};

// The edges of all the moves, or until nobody takes them any more.
void make(MoveStream& stream, run::EventFlow& flow, const std::atomic<bool>& finished) {
    std::vector<run::LineEvent> events;
    for (bool more = true; more && !finished.load();) {
        events.clear();
        more = stream.next(events);
        flow.put(events);
    }
    flow.close();
}

// From the fastest of the moves to rest.
std::int64_t braking_ns(const config::Printer& machine, std::span<const motion::Move> moves) {
    double fastest_mm_s = 0;
    for (const motion::Move& move : moves) fastest_mm_s = std::max(fastest_mm_s, move.speed_mm_s);
    std::int64_t longest_ns = 0;
    for (std::size_t i = 0; i < config::axis_e; ++i)
        longest_ns = std::max(longest_ns, run::braking_ns(machine.axes[i], fastest_mm_s));
    return longest_ns;
}

Diagnostic stopped() {
    return {Severity::error, ExitStatus::stopped, "stopped on request", {}};
}

motion::StepCounts difference(motion::StepCounts counts, const motion::StepCounts& before) {
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] -= before[i];
    return counts;
}

}  // namespace

Mover::Mover(const config::Printer& printer, gpio::GpioChip& chip, gpio::Clock& clock,
             gpio::InputLines* inputs, run::StopSource stop)
    : chip_(chip),
      clock_(clock),
      tally_(chip, clock),
      stop_(std::move(stop)),
      cpu_(printer.timing.cpu) {
    if (inputs) watch_.emplace(*inputs, printer);
}

Result<Contacts> Mover::touched() {
    return watch_ ? watch_->touched() : Contacts();
}

Result<Moved> Mover::run(const config::Printer& machine, std::span<const motion::Move> moves,
                         Contacts watched) {
    Result<MoveStream> stream = MoveStream::create(machine, moves);
    if (!stream) return stream.error();
    run::StopRequests stop{0};
    if (stop_ && asked() > 0) return stopped();
    if (watch_)
        if (Status begun = watch_->begin(watched, stop, clock_.now_ns()); !begun)
            return begun.error();
    const motion::StepCounts before = tally_.counts();
    run::ExecutorTiming timing = run::executor_timing(machine);
    timing.braking_ns = braking_ns(machine, moves);
    PolledClock polled(clock_, watch_ && !stop_ ? &*watch_ : nullptr);
    run::Executor executor(tally_, polled, timing, stop);
    const Result<bool> executed =
        stop_ ? execute_beside(executor, *stream, stop) : execute(executor, *stream);
    if (!executed) return executed.error();
    // Whoever writes next takes all lines but enable for inactive.
    const gpio::LineMask enable = run::line_layout(machine).enable;
    if (Status rests = tally_.write(gpio::all_lines(tally_.line_count()), enable); !rests)
        return rests.error();
    return outcome(before);
}

unsigned Mover::asked() {
    const unsigned count = stop_();
    asked_to_stop_ = asked_to_stop_ || count > 0;
    return count;
}

Result<bool> Mover::execute(run::Executor& executor, MoveStream& stream) {
    std::vector<run::LineEvent> events;
    Result<bool> executed = true;
    for (bool more = true; more && executed && *executed;) {
        events.clear();
        more = stream.next(events);
        executed = executor.execute(events);
    }
    const std::int64_t since_ns = clock_.now_ns();
    if (!executed || !watch_) return executed;
    do watch_->poll(clock_.wait_until_ns(clock_.now_ns() + watch_->settle_ns()));
    while (may_settle(since_ns));
    return executed;
}

bool Mover::may_settle(std::int64_t since_ns) const {
    if (!watch_) return false;
    const std::int64_t now_ns = clock_.now_ns(), settle_ns = watch_->settle_ns();
    if (now_ns - since_ns < settle_ns) return true;
    return !watch_->is_quiet(now_ns) && now_ns - since_ns < most_settlings * settle_ns;
}

// One thread makes edges, the real-time thread writes them; this one watches, and is asked to stop.
Result<bool> Mover::execute_beside(run::Executor& executor, MoveStream& stream,
                                   run::StopRequests& stop) {
    Result<bool> executed = true;
    std::atomic<bool> finished{false};
    run::EventFlow flow(stop, finished);
    Beside threads{stop, finished};
    threads.maker = std::thread([&] { make(stream, flow, finished); });
    threads.edges = std::thread([&] {
        Diagnostics told_before;
        run::take_precedence(cpu_, told_before);
        executed = flow.drain(
            [&](std::span<const run::LineEvent> events) { return executor.execute(events); });
        finished.store(true);
    });
    const auto look = [&] {
        if (watch_) {
            (void)watch_->inputs().wait_ns(look_ns);
            watch_->poll(clock_.now_ns());
        } else {
            std::this_thread::sleep_for(std::chrono::nanoseconds(look_ns));
        }
        stop += asked();
    };
    while (!finished.load()) look();
    threads.join();
    if (flow.ran_dry()) return run::EventFlow::dry_error();
    const std::int64_t since_ns = clock_.now_ns();
    do look();
    while (may_settle(since_ns));
    return executed;
}

Result<Moved> Mover::outcome(const motion::StepCounts& before) const {
    if (asked_to_stop_) return stopped();
    if (watch_ && !watch_->status()) return watch_->status().error();
    Moved moved;
    moved.counts = difference(tally_.counts(), before);
    for (std::size_t i = 0; watch_ && i < moved.at_contact.size(); ++i) {
        if (!watch_->triggers()[i]) continue;
        const auto counts = tally_.counts_at(*watch_->triggers()[i]);
        if (!counts)
            return machine_error("contact " + std::string(config::contact_names[i]) +
                                 " closed too long before the machine came to rest");
        moved.at_contact[i] = difference(*counts, before);
    }
    return moved;
}

}  // namespace lyr::home
