// The line events of a simulation. Their steps are made on a thread of their own while those before them are written: they
// are half of the work.
//
// Contract
//  1. next() gives what EventStream::next() would: the same events, in portions of the same length.
//  2. What is made ahead is bounded: at most `ahead` groups, each of some batches of steps, of which the last one begins
//     no later than longest_group_ns after the first. A speed holds from the group on that is asked for next; so results
//     do not depend on which thread is quicker.
//  3. After the last portion, or one with an error, next() must not be called any more. The destructor leaves undone what
//     nobody took.

#pragma once

#include <array>
#include <thread>

#include "target/run/event_stream.h"
#include "target/run/handover.h"

namespace lyr::run {

// A batch of events, and what it brings with it.
struct Portion {
    std::vector<LineEvent> events;
    std::vector<motion::PlannedMove> moves;  // that it begins
    std::vector<LayerBegin> begun;
    std::vector<Shift> shifts;
    std::int64_t shift_ns = 0;  // after it
    std::uint32_t layer = 0;
    Result<bool> more = true;  // false: this is the last one
};

class StreamBeside {
public:
    static constexpr std::size_t batches_in_group = 2, ahead = 2;

    // `speed_factor` is read by next() alone.
    StreamBeside(EventStream stream, const std::atomic<float>& speed_factor,
                 std::int64_t longest_group_ns);
    ~StreamBeside();
    StreamBeside(const StreamBeside&) = delete;
    StreamBeside& operator=(const StreamBeside&) = delete;

    // Valid until the next call.
    const Portion& next();

private:
    struct Batch {
        std::vector<Step> steps;
        std::vector<motion::PlannedMove> moves;
        std::vector<LayerBegin> begun;
        std::uint32_t layer = 0;
        Result<bool> more = true;
        std::int64_t end_ns = 0;  // if there are no more
    };
    struct Group {
        float speed_factor = 1;  // that it is made with
        std::size_t count = 0;   // of its batches
        std::array<Batch, batches_in_group> batches;
    };

    void ask(Group group);
    void work();
    void make(Group& group);
    void make(Batch& batch);

    EventStream stream_;  // the thread makes steps, next() events of them
    const std::atomic<float>& wanted_factor_;
    const std::int64_t longest_group_ns_;
    std::atomic<float> factor_{1};  // of the thread
    Group group_;                   // that is given out
    std::size_t given_ = 0;
    Portion portion_;
    Handover<Group> asked_{ahead + 1}, made_{ahead + 1};
    std::thread thread_;
};

}  // namespace lyr::run
