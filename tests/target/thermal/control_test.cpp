// Contracts of target/thermal/control.h and simulated_heat.h: machines without a fault.

#include "target/thermal/control.h"

#include <cmath>

#include "target/gpio/mock_chip.h"
#include "target/thermal/faults_scene.h"

using namespace lyr;
using namespace lyr::thermal;
using namespace lyr::tests;

namespace {

constexpr double hour_s = 3'600;

// Time to reach the target, and the highest and lowest reading from then on.
struct Course {
    double reached_s = 0, highest_c = 0, lowest_c = 1e9;
};

Course course(SimulatedHeat& heat, std::size_t heater, double until_s) {
    Course course;
    heat.observe([&](double time_s) {
        const HeaterStatus& status = *heat.control().status(heater);
        if (!course.reached_s && heat.control().reached(heater)) course.reached_s = time_s;
        course.highest_c = std::max(course.highest_c, status.temperature_c);
        if (course.reached_s) course.lowest_c = std::min(course.lowest_c, status.temperature_c);
    });
    heat.advance_to(until_s);
    heat.observe({});
    return course;
}

}  // namespace

TEST_CASE("control: heaters reach their targets, overshoot little and hold them" *
          doctest::test_suite("long")) {
    const config::Printer printer = heated_printer();
    for (const Targets& targets :
         {Targets{210, 60, 0}, Targets{250, 110, 50}, Targets{180, 40, 30}}) {
        for (const std::size_t heater : {config::heater_tool, config::heater_bed}) {
            SimulatedHeat heat(printer, {});
            set_targets(heat, targets);
            const Course run = course(heat, heater, hour_s);
            const double target_c = heater == config::heater_tool ? targets.tool_c : targets.bed_c;
            CAPTURE(target_c);
            REQUIRE_FALSE(heat.control().trip());
            CHECK(run.reached_s > 20);
            CHECK(run.reached_s < 800);
            CHECK(run.highest_c < target_c + 4);
            CHECK(run.lowest_c > target_c - 3);
            CHECK(std::abs(heat.body_c(heater) - target_c) < 1.5);
        }
    }
}

TEST_CASE("control: a heater is off while its sensor gives bad figures, before any guard fires") {
    for (const char* fault : {"open", "short", "unreadable"}) {
        CAPTURE(fault);
        const std::string script = "20 " + std::string(fault) + " tool\n20.25 mend tool\n";
        config::Printer printer = heated_printer();
        SimulatedHeat heat(printer, faults_of(script, printer));
        heat.control().set_target(config::heater_tool, 210);
        heat.advance_to(19.9);
        REQUIRE(heat.any_heater_on());
        int off = 0;
        heat.observe([&](double) { off += !heat.any_heater_on(); });
        heat.advance_to(20.2);
        CHECK(off == 3);
        heat.advance_to(25);
        CHECK(off == 3);
        CHECK_FALSE(heat.control().trip());
    }
}

TEST_CASE("control: ticks that come late mean as much power and time as those in time") {
    for (const double passed_s : {tick_s, 8 * tick_s}) {
        CAPTURE(passed_s);
        gpio::VirtualClock clock;
        gpio::MockChip chip(1, clock, {});
        std::vector<Output> outputs;
        outputs.push_back({LineOutput{0, SlowPwm(1)}, true});
        PowerStage stage(std::move(outputs), &chip);
        config::Heater tool = config::default_heater(config::heater_tool);
        tool.pid = {0, 0.01, 0};
        tool.guard.frozen_time_s = 1'000;
        std::vector<HeaterPort> ports;
        ports.push_back(
            {config::heater_tool, tool, std::make_unique<MockSensor>([&]() -> Result<double> {
                 return raw_of(SensorScale(tool.sensor), 199);
             })});
        HeatControl control(std::move(ports), false, stage);
        control.set_target(config::heater_tool, 200);
        for (int i = 0; i * passed_s < 40; ++i) {
            control.tick(i * passed_s);
            const double near_s = i * passed_s;
            if (near_s < reached_s - 2 * tick_s) CHECK_FALSE(control.reached(config::heater_tool));
            if (near_s > reached_s) CHECK(control.reached(config::heater_tool));
        }
        const HeaterStatus& status = *control.status(config::heater_tool);
        CHECK(status.power == doctest::Approx(0.4).epsilon(0.03));
        CHECK(status.on_s == doctest::Approx(0.01 * 40 * 40 / 2).epsilon(0.03));
    }
}

TEST_CASE("control 1: without a target nothing is ever switched on") {
    SimulatedHeat heat(heated_printer(), {});
    bool on = false;
    heat.observe([&](double) { on = on || heat.any_heater_on(); });
    heat.advance_to(hour_s);
    CHECK_FALSE(on);
    CHECK_FALSE(heat.control().trip());
    CHECK(heat.control().reached(config::heater_tool));
}

TEST_CASE("control: no false alarm over ten hours of prints in PLA and ABS, with fans and changes" *
          doctest::test_suite("long")) {
    for (const Targets& targets : {Targets{215, 60, 0}, Targets{240, 100, 45}}) {
        CAPTURE(targets.tool_c);
        SimulatedHeat heat(heated_printer(), {});
        set_targets(heat, targets);
        heat.advance_to(0.2 * hour_s);
        REQUIRE_FALSE(heat.control().trip());
        // A layer's fan goes on and off, temperatures step down and up, and at last all cools down.
        for (int layer = 0; layer < 300; ++layer) {
            heat.control().set_fan(layer % 3 == 0 ? 0 : layer % 3 == 1 ? 0.5 : 1);
            const double step_c = layer % 7 == 0 ? -10 : layer % 11 == 0 ? 15 : 0;
            heat.control().set_target(config::heater_tool, targets.tool_c + step_c);
            if (layer == 5) heat.control().set_target(config::heater_bed, targets.bed_c - 5);
            heat.advance_to(0.2 * hour_s + layer * 115.0);
            REQUIRE_MESSAGE(!heat.control().trip(), heat.control().trip()->message);
        }
        set_targets(heat, {0, 0, 0});
        heat.advance_to(heat.time_s() + 100);
        // Heating again while it still cools, and once more from almost cold.
        for (const double pause_s : {1.0, 30.0, 500.0, 5'000.0}) {
            set_targets(heat, {0, 0, 0});
            heat.advance_to(heat.time_s() + pause_s);
            set_targets(heat, targets);
            heat.advance_to(heat.time_s() + 900);
            REQUIRE_MESSAGE(!heat.control().trip(), heat.control().trip()->message);
        }
    }
}

TEST_CASE("control: no false alarm with sensors of every kind" * doctest::test_suite("long")) {
    for (std::size_t kind = 0; kind < config::sensor_kinds.size(); ++kind) {
        CAPTURE(config::sensor_kinds[kind]);
        config::Printer printer = heated_printer();
        for (auto& heater : printer.heaters) {
            heater->sensor.kind = static_cast<config::SensorKind>(kind);
            heater->sensor.points = {{0, 330'000}, {100, 6'700}, {300, 90}};
            if (kind % 2) heater->sensor.full_scale = 26'400;
            // A platinum resistor under 4.7 kOhm has a count for 2 °C in 12 bits.
            if (heater->sensor.kind == config::SensorKind::pt1000)
                heater->sensor.full_scale = 65'535, heater->sensor.pullup_ohm = 2'200;
        }
        SimulatedHeat heat(printer, {});
        set_targets(heat, {230, 90, 40});
        heat.advance_to(2 * hour_s);
        REQUIRE_MESSAGE(!heat.control().trip(), heat.control().trip()->message);
        CHECK(heat.control().reached(config::heater_tool));
        CHECK(heat.control().reached(config::heater_bed));
    }
}

TEST_CASE("control 2: fans go on after a guard has fired, at the speed that they had") {
    SimulatedHeat heat(heated_printer(), faults_of("300 open bed"));
    set_targets(heat, {});
    heat.control().set_fan(0.5);
    heat.advance_to(310);
    REQUIRE(heat.control().trip());
    int on = 0, ticks = 0;
    heat.observe([&](double) { ++ticks, on += heat.is_fan_on(); });
    heat.advance_to(410);
    CHECK_FALSE(heat.any_heater_on());
    CHECK(std::abs(on - ticks / 2) <= 5);
}

TEST_CASE("control 4: reached() waits for a target from above, too") {
    SimulatedHeat heat(heated_printer(), {});
    set_targets(heat, {});
    heat.advance_to(600);
    REQUIRE(heat.control().reached(config::heater_tool));
    heat.control().set_target(config::heater_tool, 170);
    CHECK_FALSE(heat.control().reached(config::heater_tool));
    heat.advance_to(605);
    CHECK_FALSE(heat.control().reached(config::heater_tool));
    heat.advance_to(900);
    CHECK(heat.control().reached(config::heater_tool));
    CHECK(heat.body_c(config::heater_tool) < 173);
}

TEST_CASE("control 5: the same run gives the same temperatures") {
    const auto run = [] {
        SimulatedHeat heat(heated_printer(), {});
        set_targets(heat, {});
        heat.advance_to(700);
        return std::pair(heat.body_c(config::heater_tool), heat.body_c(config::heater_bed));
    };
    CHECK(run() == run());
}
