#include "target/run/event_flow.h"

#include <thread>

namespace lyr::run {
namespace {

// How long a full ring is left alone; far below what it holds.
constexpr std::chrono::microseconds full_nap{2'000};
// Of the real-time thread, which has nothing to write.
constexpr std::chrono::microseconds empty_nap{50};

}  // namespace

void EventFlow::put(std::span<const LineEvent> events) {
    while (!finished_.load()) {
        events = events.subspan(ring_.push(events));
        if (events.empty()) return;
        filled_.store(true);
        std::this_thread::sleep_for(full_nap);
    }
}

void EventFlow::close() {
    ring_.close();
    filled_.store(true);
}

void EventFlow::nap() {
    naps_.fetch_add(1, std::memory_order_relaxed);
    std::this_thread::sleep_for(empty_nap);
}

Diagnostic EventFlow::dry_error() {
    return {Severity::error,
            ExitStatus::machine,
            "no steps have come for seconds: reading the file or planning hangs",
            {}};
}

}  // namespace lyr::run
