// Groups go round: what has been given out comes back to be filled anew, so that nothing is allocated again.

#include "target/run/stream_beside.h"

namespace lyr::run {
namespace {

// Of a portion: two edges a step and some of direction; a vector that grows would take twice as much.
constexpr std::size_t usual_events = 5'120;

}  // namespace

StreamBeside::StreamBeside(EventStream stream, const std::atomic<float>& speed_factor,
                           std::int64_t longest_group_ns)
    : stream_(std::move(stream)),
      wanted_factor_(speed_factor),
      longest_group_ns_(longest_group_ns) {
    stream_.heed_speed(factor_);
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
    return group_.portions[given_++];
}

void StreamBeside::ask(Group group) {
    group.speed_factor = wanted_factor_.load(std::memory_order_relaxed);
    asked_.push(std::move(group));
}

// Both queues have room for all groups that there are: only what is not there yet is waited for.
void StreamBeside::work() {
    while (std::optional<Group> group = asked_.pop()) {
        make(*group);
        const Result<bool>& more = group->portions[group->count - 1].more;
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
        Portion& portion = group.portions[group.count++];
        make(portion);
        if (!portion.more || !*portion.more) return;
    } while (group.count < portions_in_group &&
             stream_.steps().time_ns() - begin_ns < longest_group_ns_);
}

void StreamBeside::make(Portion& portion) {
    portion.events.clear();
    portion.events.reserve(usual_events);
    portion.more = stream_.next(portion.events);
    portion.moves = stream_.steps().moves();
    portion.begun = stream_.steps().begun();
    portion.shifts = stream_.schedule().take_shifts();
    portion.shift_ns = stream_.schedule().shift_ns();
    portion.layer = stream_.steps().layer();
}

}  // namespace lyr::run
