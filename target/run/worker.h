// A thread of a print, which is joined on whatever way the print ends.
//
// Contract
//  1. The destructor joins: what makes the thread end has been told to it before.
//  2. ends_soon() waits for it, for patience_s at most.
//  3. join() waits on where it hangs, as at a sensor's file or that of the print, and lets signals end the program then.

#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "target/run/stop_signals.h"

namespace lyr::run {

class Worker {
public:
    // As long as heaters may be silent.
    static constexpr int patience_s = 3;

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

}  // namespace lyr::run
