// What the thread and its owner share belongs to both, for a kernel's driver that hangs cannot be waited for.

#include "target/thermal/slow_sensor.h"

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include "base/text.h"
#include "target/thermal/pid.h"

namespace lyr::thermal {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

Diagnostic failed(std::string what) {
    return {Severity::error, ExitStatus::machine, std::move(what), {}};
}

struct Latest {
    Latest(std::unique_ptr<TemperatureSensor> its_sensor, Result<double> first)
        : sensor(std::move(its_sensor)), reading(std::move(first)) {}

    const std::unique_ptr<TemperatureSensor> sensor;
    std::atomic<bool> is_over{false};
    std::mutex mutex;
    Result<double> reading;
    Clock::time_point ended;
};

void keep_reading(const std::shared_ptr<Latest>& latest) {
    while (!latest->is_over) {
        Result<double> reading = latest->sensor->read();
        {
            const std::lock_guard lock(latest->mutex);
            latest->reading = std::move(reading);
            latest->ended = Clock::now();
        }
        // One that fails at once is not asked more often than others.
        std::this_thread::sleep_for(Seconds(tick_s));
    }
}

class SlowSensor final : public TemperatureSensor {
public:
    SlowSensor(std::unique_ptr<TemperatureSensor> sensor, Result<double> first)
        : latest_(std::make_shared<Latest>(std::move(sensor), std::move(first))) {}
    ~SlowSensor() override { latest_->is_over = true; }
    SlowSensor(const SlowSensor&) = delete;
    SlowSensor& operator=(const SlowSensor&) = delete;

    Result<double> read() override {
        if (!begun_) begin();
        const std::lock_guard lock(latest_->mutex);
        const double age_s = Seconds(Clock::now() - latest_->ended).count();
        if (age_s > oldest_s)
            return failed(formatted("the sensor has not answered for %.1f s", age_s));
        return latest_->reading;
    }

private:
    void begin() {
        begun_ = true;
        latest_->ended = Clock::now();
        std::thread([latest = latest_] { keep_reading(latest); }).detach();
    }

    std::shared_ptr<Latest> latest_;
    bool begun_ = false;
};

}  // namespace

Result<std::unique_ptr<TemperatureSensor>> unhurried(std::unique_ptr<TemperatureSensor> sensor) {
    const Clock::time_point from = Clock::now();
    Result<double> first = sensor->read();
    const double took_s = Seconds(Clock::now() - from).count();
    if (!first) return first.error();
    if (took_s > slowest_s)
        return failed(
            formatted("its sensor takes %.1f s to read, and %g s are the most with which "
                      "a heater can be guarded",
                      took_s, slowest_s));
    if (took_s <= quick_s) return sensor;
    std::unique_ptr<TemperatureSensor> slow =
        std::make_unique<SlowSensor>(std::move(sensor), std::move(first));
    return slow;
}

}  // namespace lyr::thermal
