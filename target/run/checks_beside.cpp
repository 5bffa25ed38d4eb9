#include "target/run/checks_beside.h"

namespace lyr::run {

ChecksBeside::ChecksBeside(const config::Printer& printer, CurveSource source)
    : checks_(printer, std::move(source)), thread_([this] { work(); }) {}

ChecksBeside::~ChecksBeside() {
    if (!thread_.joinable()) return;
    {
        const std::lock_guard lock(mutex_);
        gives_up_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void ChecksBeside::expect(std::span<const motion::PlannedMove> moves,
                          std::span<const Shift> shifts) {
    if (batch_.steps.size() >= steps_in_batch) hand_over();
    batch_.entries.push_back({moves.size(), shifts.size(), batch_.steps.size()});
    batch_.moves.insert(batch_.moves.end(), moves.begin(), moves.end());
    batch_.shifts.insert(batch_.shifts.end(), shifts.begin(), shifts.end());
}

Status ChecksBeside::finish(const StepPositions& positions) {
    hand_over();
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    changed_.notify_all();
    thread_.join();
    return checks_.finish(positions);
}

void ChecksBeside::hand_over() {
    {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return waiting_.size() < most_waiting; });
        waiting_.push_back(std::move(batch_));
    }
    changed_.notify_all();
    batch_ = {};
}

void ChecksBeside::work() {
    for (;;) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return !waiting_.empty() || ends_ || gives_up_; });
        if (gives_up_ || waiting_.empty()) return;
        const Batch batch = std::move(waiting_.front());
        waiting_.pop_front();
        lock.unlock();
        changed_.notify_all();
        check(batch);
    }
}

void ChecksBeside::check(const Batch& batch) {
    const std::span<const Step> steps(batch.steps);
    std::size_t moves = 0, shifts = 0, checked = 0;
    for (const Batch::Entry& entry : batch.entries) {
        check(steps.subspan(checked, entry.steps_before - checked));
        checked = entry.steps_before;
        checks_.expect(std::span(batch.moves).subspan(moves, entry.moves),
                       std::span(batch.shifts).subspan(shifts, entry.shifts));
        moves += entry.moves;
        shifts += entry.shifts;
    }
    check(steps.subspan(checked));
}

void ChecksBeside::check(std::span<const Step> steps) {
    for (const Step& step : steps) {
        checks_.step({step.time_ns, step.axis, positions_, step.positive});
        positions_[step.axis] += step.positive ? 1 : -1;
    }
}

}  // namespace lyr::run
