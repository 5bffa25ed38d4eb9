#include "target/run/checks_beside.h"

namespace lyr::run {

ChecksBeside::ChecksBeside(const config::Printer& printer, CurveSource source)
    : checks_(printer, std::move(source)), thread_([this] {
          while (const std::optional<Batch> batch = waiting_.pop()) check(*batch);
      }) {}

ChecksBeside::~ChecksBeside() {
    if (!thread_.joinable()) return;
    waiting_.shut();
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
    waiting_.close();
    thread_.join();
    return checks_.finish(positions);
}

void ChecksBeside::hand_over() {
    waiting_.push(std::move(batch_));
    batch_ = {};
    batch_.steps.reserve(2 * steps_in_batch);
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
