// Groups go round: what has been given out comes back to be filled anew, so that nothing is allocated again.

#include "target/run/stream_beside.h"

namespace lyr::run {
namespace {

// Of a batch; a vector that grows would take twice as much.
constexpr std::size_t usual_steps = 2'304;
// Two edges a step, and some of direction.
constexpr std::size_t usual_events = 5'120;

}  // namespace

StreamBeside::StreamBeside(EventStream stream, const std::atomic<float>& speed_factor,
                           std::int64_t longest_group_ns)
    : stream_(std::move(stream)),
      wanted_factor_(speed_factor),
      longest_group_ns_(longest_group_ns) {
    stream_.heed_speed(factor_);
    portion_.events.reserve(usual_events);
    for (std::size_t i = 0; i < ahead; ++i) ask({});
    thread_ = std::thread([this] { work(); });
}

StreamBeside::~StreamBeside() {
    asked_.shut();
    thread_.join();
}

const Portion& StreamBeside::next() {
    if (given_ == group_.count) {
        ask(std::move(group_));
        group_ = *made_.pop();
        given_ = 0;
    }
    Batch& batch = group_.batches[given_++];
    portion_.events.clear();
    portion_.more = batch.more;
    const bool is_last = batch.more && !*batch.more;
    if (batch.more)
        stream_.append(batch.steps, is_last ? std::optional(batch.end_ns) : std::nullopt,
                       portion_.events);
    portion_.moves.swap(batch.moves);
    portion_.begun.swap(batch.begun);
    portion_.shifts = stream_.schedule().take_shifts();
    portion_.shift_ns = stream_.schedule().shift_ns();
    portion_.layer = batch.layer;
    return portion_;
}

void StreamBeside::ask(Group group) {
    group.speed_factor = wanted_factor_.load(std::memory_order_relaxed);
    asked_.push(std::move(group));
}

// Both queues have room for all groups that there are: only what is not there yet is waited for.
void StreamBeside::work() {
    while (std::optional<Group> group = asked_.pop()) {
        make(*group);
        const Result<bool>& more = group->batches[group->count - 1].more;
        const bool is_last = !more || !*more;
        made_.push(std::move(*group));
        if (is_last) return;
    }
}

void StreamBeside::make(Group& group) {
    factor_ = group.speed_factor;
    const std::int64_t begin_ns = stream_.steps().time_ns();
    group.count = 0;
    do {
        Batch& batch = group.batches[group.count++];
        make(batch);
        if (!batch.more || !*batch.more) return;
    } while (group.count < batches_in_group &&
             stream_.steps().time_ns() - begin_ns < longest_group_ns_);
}

void StreamBeside::make(Batch& batch) {
    batch.steps.clear();
    batch.steps.reserve(usual_steps);
    batch.more = stream_.next(batch.steps);
    batch.moves = stream_.steps().moves();
    batch.begun = stream_.steps().begun();
    batch.layer = stream_.steps().layer();
    batch.end_ns = stream_.steps().time_ns();
}

}  // namespace lyr::run
