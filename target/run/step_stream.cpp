// A batch ends when its buffer is full or the file is; moves of few steps share a batch.

#include "target/run/step_stream.h"

#include <algorithm>

#include "base/constants.h"
#include "target/run/inspect.h"

namespace lyr::run {
namespace {

constexpr std::size_t batch_events = 2048;
// Orders that stand between the moves of a full planner are fewer, but for a file that means harm.
constexpr std::size_t most_waiting = 4 * motion::Planner::default_capacity;
// Three years, far from where nanoseconds no longer fit.
constexpr std::int64_t longest_ns = static_cast<std::int64_t>(1e8 * ns_per_s);
constexpr const char* too_long = "the print would take longer than three years";

}  // namespace

Result<StepStream> StepStream::open(const std::string& path, const config::Printer& printer,
                                    double filament_diameter_mm, OrderQueue* orders,
                                    std::uint32_t first_layer) {
    Result<format::Reader> reader = open_file(path, first_layer);
    if (!reader) return reader.error();
    return open(std::move(*reader), path, printer, filament_diameter_mm, orders);
}

Result<StepStream> StepStream::open(format::Reader reader, const std::string& path,
                                    const config::Printer& printer, double filament_diameter_mm,
                                    OrderQueue* orders) {
    Result<motion::Planner> planner = motion::Planner::create(motion_limits(printer));
    if (!planner) return planner.error();
    return StepStream(path, Interpreter(std::move(reader), printer, filament_diameter_mm),
                      std::move(*planner), MotorSteps(printer), orders);
}

StepStream::StepStream(std::string path, Interpreter interpreter, motion::Planner planner,
                       MotorSteps generator, OrderQueue* orders)
    : path_(std::move(path)),
      interpreter_(std::move(interpreter)),
      planner_(std::move(planner)),
      generator_(std::move(generator)),
      orders_(orders),
      events_(batch_events) {}

Result<bool> StepStream::next(std::vector<Step>& steps) {
    moves_.clear();
    begun_.clear();
    std::size_t room = batch_events;
    while (room > 0) {
        room -= take(room, steps);
        if (room == 0) break;
        motion::PlannedMove& move = moves_.emplace_back();
        const std::int64_t ended_ns = planner_.time_ns();
        while (!planner_.pop(move)) {
            if (read_all_) {
                moves_.pop_back();
                return finish(steps);
            }
            if (const Status planned = plan(); !planned) return planned.error();
        }
        if (planner_.time_ns() > longest_ns) return refused(too_long);
        note_begin(move);
        if (!waiting_.empty() && waiting_.front().before_move <= popped_) {
            // What lags behind the plan comes first.
            generator_.rest_until(move.start_ns);
            while (take(events_.size(), steps) == events_.size()) continue;
            give_orders(ended_ns, steps);
        }
        ++popped_;
        generator_.start(move);
    }
    return true;
}

// The steps that come after the last move; false when there are no more.
bool StepStream::finish(std::vector<Step>& steps) {
    generator_.finish();
    if (take(events_.size(), steps) == events_.size()) return true;
    end_rest_ns_ = rested_ns_;
    give_orders(planner_.time_ns(), steps);
    return false;
}

std::size_t StepStream::take(std::size_t most, std::vector<Step>& steps) {
    const std::size_t count = generator_.next(std::span(events_).first(most));
    append_steps(std::span(events_).first(count), steps);
    if (count > 0) last_ns_ = events_[count - 1].time_ns;
    return count;
}

// Feeds the planner until it is full or the file ends.
Status StepStream::plan() {
    while (!planner_.full()) {
        if (!held_) {
            Result<std::optional<Instruction>> instruction = interpreter_.next();
            if (!instruction) return instruction.error();
            held_ = *instruction;
        }
        if (!held_) {
            read_all_ = true;
            planner_.flush();
            return Done{};
        }
        if (const auto* dwell = std::get_if<Rest>(&*held_))
            if (Status rested = rest(dwell->time_s); !rested) return rested;
        if (const auto* order = std::get_if<HeatOrder>(&*held_))
            if (Status planned = plan(*order); !planned) return planned;
        if (const auto* move = std::get_if<motion::Move>(&*held_))
            if (Status pushed = plan(*move); !pushed) return pushed;
        held_.reset();
    }
    return Done{};
}

void StepStream::note_begin(const motion::PlannedMove& move) {
    bool is_new = move.tag != layer_;
    for (; !manners_.empty() && manners_.front().before_move <= popped_; manners_.pop_front()) {
        manner_ = manners_.front();
        is_new = true;
    }
    layer_ = move.tag;
    if (is_new) begun_.push_back({move.start_ns, layer_, manner_.factor, manner_.drawn_back_mm});
}

Status StepStream::plan(motion::Move move) {
    const float factor = speed_factor_ ? speed_factor_->load(std::memory_order_relaxed) : 1;
    const auto drawn_back_mm = static_cast<float>(interpreter_.drawn_back_mm());
    if (factor != planned_.factor || drawn_back_mm != planned_.drawn_back_mm)
        manners_.push_back(planned_ = {pushed_, factor, drawn_back_mm});
    move.speed_mm_s *= static_cast<double>(factor);
    if (const Status pushed = planner_.push(move); !pushed) {
        Diagnostic error = pushed.error();
        error.where.file = path_;
        error.where.layer = static_cast<int>(move.tag);
        return error;
    }
    // What is shorter, the planner leaves out.
    if (motion::length_of(move.path) < motion::Planner::shortest_mm) return Done{};
    ++pushed_;
    rested_ns_ = 0;
    return Done{};
}

Status StepStream::rest(double time_s) {
    planner_.dwell(time_s);
    rested_ns_ +=
        static_cast<std::int64_t>(std::min(time_s, motion::Planner::longest_s) * ns_per_s);
    if (rested_ns_ > longest_ns) return refused(too_long);
    return Done{};
}

Diagnostic StepStream::refused(const char* why) const {
    return {Severity::error, ExitStatus::input, why, {.file = path_}};
}

Status StepStream::plan(const HeatOrder& asked) {
    const std::optional<HeatOrder> heeded = orders_ ? orders_->heed(asked) : std::nullopt;
    if (!heeded) return Done{};
    const HeatOrder& order = *heeded;
    const bool same_place = !waiting_.empty() && waiting_.back().before_move == pushed_ &&
                            waiting_.back().rested_ns == rested_ns_;
    // All motors rest when the head does, and what lags behind it has come.
    if (order.is_gate())
        if (Status rested = rest(static_cast<double>(generator_.tail_ns()) / ns_per_s); !rested)
            return rested;
    if (same_place && join(waiting_.back().order, order)) {
        waiting_.back().rested_ns = rested_ns_;
        return Done{};
    }
    if (waiting_.size() == most_waiting)
        return refused("the file waits for temperatures thousands of times between two moves");
    waiting_.push_back({pushed_, order, rested_ns_});
    return Done{};
}

void StepStream::give_orders(std::int64_t ended_ns, std::vector<Step>& steps) {
    // Without a rest, steps of the next move that run ahead of it follow closely.
    const bool lags = generator_.tail_ns() > 0;
    for (; !waiting_.empty() && waiting_.front().before_move <= popped_; waiting_.pop_front()) {
        const auto& [before_move, order, rested_ns] = waiting_.front();
        orders_->push(order);
        const bool follows = lags && rested_ns == 0;
        if (!follows) last_ns_ = std::max(last_ns_, ended_ns + rested_ns);
        steps.push_back({last_ns_, mark_axis, order.is_gate()});
    }
}

}  // namespace lyr::run
