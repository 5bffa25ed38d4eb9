// A thread of a print, which is joined on whatever way the print ends.
//
// Contract
//  1. The destructor joins: what makes the thread end has been told to it before.
//  2. ends_soon() waits for it, for patience_s at most.
//  3. join() waits on where it hangs, as at a sensor's file or that of the print, and lets signals end the program then.
//  4. A Heartbeat is missed when its number has not changed for as long as that.

#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

#include "target/run/stop_signals.h"

namespace lyr::run {

// As long as heaters may be silent.
inline constexpr int patience_s = 3;

class Worker {
public:
    Worker() = default;
    ~Worker();
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    void start(std::function<void()> work);
    bool ends_soon() const;
    void join(const StopSignals& signals);

private:
    std::atomic<bool> has_ended_{false};
    std::thread thread_;
};

// Of a thread that says by a number that it goes on.
class Heartbeat {
public:
    bool is_missed(std::uint32_t beats, double now_s);

private:
    bool has_begun_ = false;
    std::uint32_t beats_ = 0;
    double since_s_ = 0;
};

}  // namespace lyr::run
