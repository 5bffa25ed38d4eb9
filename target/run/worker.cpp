#include "target/run/worker.h"

#include <chrono>
#include <utility>

namespace lyr::run {

Worker::~Worker() {
    if (thread_.joinable()) thread_.join();
}

void Worker::start(std::function<void()> work) {
    thread_ = std::thread([this, work = std::move(work)] {
        work();
        has_ended_.store(true, std::memory_order_release);
    });
}

bool Worker::ends_soon() const {
    constexpr std::chrono::milliseconds nap{1};
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(patience_s);
    while (thread_.joinable() && !has_ended_.load(std::memory_order_acquire)) {
        if (std::chrono::steady_clock::now() > until) return false;
        std::this_thread::sleep_for(nap);
    }
    return true;
}

void Worker::join(const StopSignals& signals) {
    if (!ends_soon()) signals.let_strike();
    if (thread_.joinable()) thread_.join();
}

bool Heartbeat::is_missed(std::uint32_t beats, double now_s) {
    if (!std::exchange(has_begun_, true) || beats != beats_) since_s_ = now_s;
    beats_ = beats;
    return now_s - since_s_ > patience_s;
}

}  // namespace lyr::run
