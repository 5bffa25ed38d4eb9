// Threads that work beside this one on what it has: they end before that is gone, whatever is thrown.
//
// Contract
//  1. join() waits for both.
//  2. Destroyed before that, by an exception, it asks for a stop, tells the maker that nobody takes edges any more, and
//     waits.

#pragma once

#include <atomic>
#include <thread>

#include "target/run/executor.h"

namespace lyr::home {

struct Beside {
    run::StopRequests& stop;
    std::atomic<bool>& finished;
    std::thread maker{}, edges{};  // makes edges, where they are not there yet; writes them

    void join() {
        for (std::thread* thread : {&edges, &maker})
            if (thread->joinable()) thread->join();
    }
    ~Beside() {
        if (!maker.joinable() && !edges.joinable()) return;
        ++stop;
        finished.store(true);
        join();
    }
};

}  // namespace lyr::home
