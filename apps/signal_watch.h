// Ends the program at SIGINT, SIGTERM or SIGHUP, whatever it is doing: in one line and with status stopped, and with
// nothing left of files that are not whole.
//
// Contract
//  1. The signals are blocked in the calling thread and all that it starts, from here to the end of the program; a
//     thread waits for them until destruction. What it says is said within half a second or not at all.
//  2. Signals that were ignored when the program began stay so: nohup(1) means what it says.

#pragma once

#include <csignal>
#include <thread>

#include "base/diagnostic.h"

namespace lyr::command_line {

class SignalWatch {
public:
    explicit SignalWatch(const char* program);
    ~SignalWatch();
    SignalWatch(const SignalWatch&) = delete;
    SignalWatch& operator=(const SignalWatch&) = delete;

private:
    sigset_t signals_;
    std::jthread thread_;
};

// Ends the program with this status in half a second, if nothing else has ended it by then: a terminal that was
// stopped, or a pipe that nobody reads, would keep the last message of one that was asked to stop for as long as it
// likes.
void end_soon(ExitStatus status);

}  // namespace lyr::command_line
