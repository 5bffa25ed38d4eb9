// Ends the program at SIGINT, SIGTERM or SIGHUP, whatever it is doing: in one line and with status stopped, and with
// nothing left of files that are not whole.
//
// Contract
//  1. The signals are blocked in the calling thread and all that it starts, from here to the end of the program; a
//     thread waits for them until destruction.
//  2. Signals that were ignored when the program began stay so: nohup(1) means what it says.

#pragma once

#include <csignal>
#include <thread>

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

}  // namespace lyr::command_line
