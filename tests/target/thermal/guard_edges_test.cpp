// What target/thermal/guard.h, control.h and faults.h say of times that are late, of heating that was broken off, and of
// what comes after a guard has fired.

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "target/gpio/mock_chip.h"
#include "target/thermal/control.h"
#include "target/thermal/faults.h"
#include "target/thermal/faults_scene.h"
#include "target/thermal/pid.h"

using namespace lyr;
using namespace lyr::thermal;
using namespace lyr::tests;

namespace {

// The first guard that fires, of samples a tick apart.
std::optional<Trip> watched(const config::GuardLimits& limits, double until_s, double apart_s,
                            const std::function<double(double)>& temperature_c,
                            const std::function<double(double)>& target_c, double power = 1) {
    GuardState state;
    for (int tick = 0; tick * apart_s < until_s; ++tick) {
        const double time_s = tick * apart_s;
        const Sample sample{
            time_s, 2'000.0 + tick % 2, {temperature_c(time_s)}, target_c(time_s), power};
        if (auto trip = watch("tool", limits, state, sample)) return trip;
    }
    return std::nullopt;
}
const config::GuardLimits tool_limits = config::default_heater(config::heater_tool).guard;

}  // namespace

TEST_CASE("guard 2: ticks that come late make no jump of a heater that is fast") {
    CHECK_FALSE(watched(
        tool_limits, 60, 1, [](double s) { return std::min(198.0, 20 + 8 * s); },
        [](double) { return 200.0; }));
}

TEST_CASE("guard 3: heating that was broken off long ago leaves no time that is nearly over") {
    CHECK_FALSE(watched(
        tool_limits, 3'660, tick_s,
        [](double s) { return s < 3'610 ? 25.0 : 25 + 2 * (s - 3'610); },
        [](double s) { return s < 19 || s >= 3'600 ? 210.0 : 0.0; }));
}

TEST_CASE(
    "guard 3: what a heater that was switched off for a moment had to gain counts from where it "
    "has cooled to") {
    CHECK_FALSE(watched(
        tool_limits, 130, tick_s,
        [](double s) {
            return s < 80 ? 25 + 2 * s : s < 90 ? 185 - (s - 80) : 175 + 0.4 * (s - 90);
        },
        [](double s) { return s < 80 || s >= 90 ? 210.0 : 0.0; }));
}

TEST_CASE("guard 6: the mark follows no faster than stray_c in stray_time_s") {
    config::GuardLimits limits = tool_limits;
    limits.stray_c = 1;
    limits.stray_time_s = 100;
    const auto trip = watched(
        limits, 200, tick_s, [](double s) { return 25 + 0.03 * s; }, [](double) { return 0.0; }, 0);
    REQUIRE(trip);
    CHECK(trip->kind == GuardKind::stuck_on);
}

TEST_CASE("control 2: after a guard has fired all is off for good, and the first reason stays") {
    gpio::VirtualClock clock;
    bool is_broken = false;
    gpio::MockChip chip(2, clock, {}, [&](std::uint64_t) -> std::optional<Diagnostic> {
        if (is_broken) return Diagnostic{Severity::error, ExitStatus::machine, "no lines", {}};
        return std::nullopt;
    });
    std::vector<Output> outputs;
    for (std::size_t line : {0, 1}) outputs.push_back({LineOutput{line, SlowPwm(1)}, true});
    PowerStage stage(std::move(outputs), &chip);
    double tool_c = 25;
    std::vector<HeaterPort> ports;
    for (const std::size_t heater : {config::heater_tool, config::heater_bed}) {
        const config::Heater settings = config::default_heater(heater);
        ports.push_back({heater, settings,
                         std::make_unique<MockSensor>([&tool_c, settings]() -> Result<double> {
                             return raw_of(SensorScale(settings.sensor), tool_c);
                         })});
    }
    HeatControl control(std::move(ports), false, stage);
    control.set_target(config::heater_tool, 210);
    control.set_target(config::heater_bed, 60);
    double time_s = 0;
    for (; !control.trip() && time_s < 100; time_s += tick_s) control.tick(time_s);
    REQUIRE(control.trip());
    CHECK(control.trip()->kind == GuardKind::too_slow);
    is_broken = true;
    control.set_target(config::heater_tool, 210);
    control.tick(time_s);
    CHECK(control.trip()->kind == GuardKind::too_slow);
    for (const std::size_t heater : {config::heater_tool, config::heater_bed}) {
        CHECK(control.status(heater)->target_c == 0);
        CHECK(control.status(heater)->power == 0);
    }
}

TEST_CASE("faults 1: only motors of x, y and z lose steps") {
    config::Printer printer = heated_printer();
    printer.probe.emplace();
    printer.probe->input = config::Pin{"c", 9u, false};
    CHECK_FALSE(parse_faults("1 lose probe 5", "f", printer).ok());
    CHECK(parse_faults("1 lose x 5", "f", printer).ok());
}
