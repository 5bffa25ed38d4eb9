// A thread in sigwait(3) may do what a signal handler must not: take a lock, print.

#include "apps/signal_watch.h"

#include <pthread.h>

#include <chrono>
#include <cstdio>

#include "apps/progress_line.h"
#include "base/replace_file.h"

namespace lyr::command_line {
namespace {

// Tells the thread to look whether it is still needed. Nobody else sends it.
int wake_signal() {
    return SIGRTMIN;
}

void watch(const std::stop_token& needed_no_more, const sigset_t& signals, const char* program) {
    int signal = wake_signal();
    while (signal == wake_signal()) {
        if (needed_no_more.stop_requested() || sigwait(&signals, &signal) != 0) return;
    }
    const Diagnostic stopped{Severity::error, ExitStatus::stopped, "stopped on request", {}};
    end_soon(stopped.status);
    std::fprintf(stderr, "%s%s: %s\n", line_eraser(), program, to_string(stopped).c_str());
    end_process(stopped.status);
}

}  // namespace

SignalWatch::SignalWatch(const char* program) {
    sigemptyset(&signals_);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        sigaction(signal, nullptr, &action);
        if (action.sa_handler != SIG_IGN) sigaddset(&signals_, signal);
    }
    sigaddset(&signals_, wake_signal());
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
    thread_ = std::jthread([this, program](const std::stop_token& needed_no_more) {
        watch(needed_no_more, signals_, program);
    });
}

SignalWatch::~SignalWatch() {
    thread_.request_stop();
    pthread_kill(thread_.native_handle(), wake_signal());
}

void end_soon(ExitStatus status) {
    static constexpr std::chrono::milliseconds patience{500};
    std::thread([status] {
        std::this_thread::sleep_for(patience);
        end_process(status);
    }).detach();
}

}  // namespace lyr::command_line
