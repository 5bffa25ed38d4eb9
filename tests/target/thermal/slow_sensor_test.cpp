// Contract of target/thermal/slow_sensor.h, by number, on the real clock.

#include "target/thermal/slow_sensor.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "target/gpio/mock_chip.h"
#include "target/thermal/control.h"

using namespace lyr;
using namespace lyr::thermal;

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point from) {
    return std::chrono::duration<double>(Clock::now() - from).count();
}

void sleep(double time_s) {
    std::this_thread::sleep_for(std::chrono::duration<double>(time_s));
}

// Threads that have not ended may still ask it.
struct Bus {
    std::atomic<double> takes_s{0.15};
    std::atomic<double> raw{60'000};
    std::atomic<bool> is_gone{false};
    std::atomic<int> readings{0};
};

std::unique_ptr<TemperatureSensor> sensor_on(const std::shared_ptr<Bus>& bus) {
    return std::make_unique<MockSensor>([bus]() -> Result<double> {
        ++bus->readings;
        if (bus->is_gone)
            return Diagnostic{Severity::error, ExitStatus::machine, "no such device", {}};
        sleep(bus->takes_s);
        return bus->raw.load();
    });
}

}  // namespace

TEST_CASE("slow sensor 1: quick ones are left alone, and the slowest are refused") {
    const auto bus = std::make_shared<Bus>();
    bus->takes_s = 0;
    std::unique_ptr<TemperatureSensor> sensor = sensor_on(bus);
    TemperatureSensor* const same = sensor.get();
    const auto quick = unhurried(std::move(sensor));
    REQUIRE(quick.ok());
    CHECK(quick->get() == same);
    bus->takes_s = slowest_s + 0.05;
    const auto slowest = unhurried(sensor_on(bus));
    REQUIRE_FALSE(slowest.ok());
    CHECK(slowest.error().status == ExitStatus::machine);
    bus->is_gone = true;
    CHECK(unhurried(sensor_on(bus)).error().message == "no such device");
}

TEST_CASE("slow sensor 2, 3, 4: what was read last, and nothing once it is too old" *
          doctest::test_suite("long")) {
    const auto bus = std::make_shared<Bus>();
    auto sensor = unhurried(sensor_on(bus));
    REQUIRE(sensor.ok());
    CHECK(bus->readings == 1);
    bus->raw = 61'000;
    Clock::time_point from = Clock::now();
    CHECK(*(*sensor)->read() == 60'000);
    CHECK(seconds_since(from) < 0.1);
    sleep(0.45);
    CHECK(*(*sensor)->read() == 61'000);
    bus->is_gone = true;
    sleep(0.45);
    CHECK((*sensor)->read().error().message == "no such device");
    bus->is_gone = false;
    sleep(0.45);
    CHECK((*sensor)->read().ok());
    bus->takes_s = oldest_s + 1.5;
    from = Clock::now();
    while ((*sensor)->read() && seconds_since(from) < 5) sleep(0.02);
    CHECK((*sensor)->read().error().message.find("has not answered for 2.") != std::string::npos);
    CHECK(seconds_since(from) < oldest_s + 0.5);
    from = Clock::now();
    sensor->reset();
    CHECK(seconds_since(from) < 0.1);
}

TEST_CASE("slow sensor: one that took 0.75 s to read made each tick of all heaters as long") {
    const auto bus = std::make_shared<Bus>();
    bus->takes_s = 0.3;
    config::Heater bed = config::default_heater(config::heater_bed);
    bed.sensor.kind = config::SensorKind::celsius;
    auto slow = unhurried(sensor_on(bus));
    REQUIRE(slow.ok());
    gpio::VirtualClock clock;
    gpio::MockChip chip(1, clock, {});
    std::vector<Output> outputs;
    outputs.push_back({LineOutput{0, SlowPwm(bed.cycle_s)}, true});
    PowerStage stage(std::move(outputs), &chip);
    std::vector<HeaterPort> ports;
    ports.push_back({config::heater_bed, bed, std::move(*slow)});
    HeatControl control(std::move(ports), false, stage);
    control.set_target(config::heater_bed, 60);
    const Clock::time_point from = Clock::now();
    double worst_s = 0;
    const auto tick = [&] {
        const double before_s = seconds_since(from);
        control.tick(before_s);
        worst_s = std::max(worst_s, seconds_since(from) - before_s);
        sleep(tick_s);
    };
    while (seconds_since(from) < 0.6) tick();
    CHECK_FALSE(control.trip());
    CHECK(control.status(config::heater_bed)->temperature_c == 60);
    // Unplugged: found by the first reading that fails, and the four ticks of any bad sample.
    bus->is_gone = true;
    const double gone_s = seconds_since(from);
    while (!control.trip() && seconds_since(from) < gone_s + 5) tick();
    REQUIRE(control.trip());
    CHECK(control.trip()->kind == GuardKind::unreadable);
    CHECK(seconds_since(from) - gone_s < 0.3 + tick_s + (bad_samples + 2) * tick_s);
    CHECK(worst_s < 0.1);
}
