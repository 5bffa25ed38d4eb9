// Blocked signals wait in the kernel; sigtimedwait(2) fetches them.

#include "target/run/stop_signals.h"

#include <pthread.h>

#include <cerrno>
#include <ctime>
#include <initializer_list>

namespace lyr::run {

StopSignals::StopSignals() {
    sigemptyset(&signals_);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        sigaction(signal, nullptr, &action);
        if (action.sa_handler != SIG_IGN) sigaddset(&signals_, signal);
    }
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
}

StopSignals::~StopSignals() {
    // Who blocked them before hears of what arrived since.
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (sigismember(&before_, signal) == 1) sigdelset(&signals_, signal);
    // To nobody else it is of use: there is nothing left to stop.
    while (wait_ms(0)) continue;
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void StopSignals::let_strike() const {
    pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
}

bool StopSignals::wait_ms(int time_ms) const {
    constexpr int ms_per_s = 1'000;
    constexpr long ns_per_ms = 1'000'000;
    const timespec limit{time_ms / ms_per_s, (time_ms % ms_per_s) * ns_per_ms};
    // Another signal, such as a stop and continue from the terminal, may cut the wait short.
    return sigtimedwait(&signals_, nullptr, &limit) > 0;
}

}  // namespace lyr::run
