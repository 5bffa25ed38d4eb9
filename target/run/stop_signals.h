// SIGINT, SIGTERM and SIGHUP as something to ask for instead of something that strikes: a print is
// ended by its own loop, with its lines released, and never in the middle of a write.
//
// Contract
//  1. From construction to destruction the three signals are blocked in the calling thread and in all
//     threads that it starts; those that are ignored, as under nohup(1), stay ignored.
//  2. wait_ms(t) returns true as soon as one of them arrives, and false after t milliseconds without;
//     each arrival is told once.
//  3. They may be nested: what the inner one was not asked for is left to the outer one.
//  4. After let_strike() they end the program, if the calling thread waits for something.

#pragma once

#include <csignal>
#include <functional>

namespace lyr::run {

class StopSignals {
public:
    StopSignals();
    ~StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;

    bool wait_ms(int time_ms) const;
    void let_strike() const;

private:
    sigset_t signals_;
    sigset_t before_;
};

// How often a stop was asked for since the last call; whoever watches a motion calls it every millisecond or so.
using StopSource = std::function<unsigned()>;

}  // namespace lyr::run
