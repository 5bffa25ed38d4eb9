// Contract of target/thermal/tune.h: on the simulator, and what the gains it finds are worth.

#include "target/thermal/tune.h"

#include <cmath>

#include "target/thermal/faults_scene.h"

using namespace lyr;
using namespace lyr::thermal;
using namespace lyr::tests;

namespace {

TuneResult tuned(const config::Printer& printer, std::size_t heater, double target_c) {
    SimulatedHeat heat(printer, {});
    heat.control().set_target(heater, target_c);
    heat.control().tune(heater, RelayTune(target_c, printer.heaters[heater]->max_power));
    while (!heat.control().relay()->finished() && heat.time_s() < 7'200)
        heat.advance_to(heat.time_s() + 10);
    REQUIRE_FALSE(heat.control().trip());
    const auto result = heat.control().relay()->result();
    REQUIRE(result);
    // Off once it is done.
    heat.advance_to(heat.time_s() + 1);
    CHECK_FALSE(heat.any_heater_on());
    return *result;
}

}  // namespace

TEST_CASE("tune: the gains that it finds reach the target and hold it, for heaters of all sizes") {
    for (const std::size_t heater : {config::heater_tool, config::heater_bed})
        for (const double size : {0.5, 1.0, 2.0}) {
            CAPTURE(heater);
            CAPTURE(size);
            config::Printer printer = heated_printer();
            config::Heater& settings = *printer.heaters[heater];
            settings.model.capacity_j_k *= size;
            settings.model.lag_s *= 1.5;
            settings.cycle_s = 0.5;
            const double target_c = heater == config::heater_tool ? 210 : 70;
            const TuneResult result = tuned(printer, heater, target_c);
            CHECK(result.ultimate_period_s > 1);
            for (const config::Pid& gains : {result.tyreus_luyben, result.ziegler_nichols}) {
                CHECK(gains.kp > 0);
                CHECK(gains.ki > 0);
                CHECK(gains.kd > 0);
            }
            CHECK(result.tyreus_luyben.kp < result.ziegler_nichols.kp);
            settings.pid = result.tyreus_luyben;
            SimulatedHeat heat(printer, {});
            heat.control().set_target(heater, target_c);
            double highest_c = 0, off_c = 0;
            heat.observe([&](double time_s) {
                highest_c = std::max(highest_c, heat.body_c(heater));
                if (time_s > 900) off_c = std::max(off_c, std::abs(heat.body_c(heater) - target_c));
            });
            heat.advance_to(1'200);
            REQUIRE_FALSE(heat.control().trip());
            CHECK(highest_c < target_c + 8);
            CHECK(off_c < 1.5);
        }
}

TEST_CASE("tune: strong beds with slow sensors were taken for stuck on") {
    struct Bed {
        double power_w, lag_s, capacity_j_k;
    };
    for (const Bed& bed :
         {Bed{220, 30, 700}, Bed{400, 30, 700}, Bed{300, 45, 1'500}, Bed{600, 25, 1'500}}) {
        CAPTURE(bed.power_w);
        config::Printer printer = heated_printer();
        config::HeatModel& model = printer.heaters[config::heater_bed]->model;
        model.power_w = bed.power_w;
        model.lag_s = bed.lag_s;
        model.capacity_j_k = bed.capacity_j_k;
        CHECK(tuned(printer, config::heater_bed, 60).ultimate_period_s > bed.lag_s);
        // And a target that is lowered while it heats.
        SimulatedHeat heat(printer, {});
        heat.control().set_target(config::heater_bed, 100);
        while (heat.control().status(config::heater_bed)->temperature_c < 60)
            heat.advance_to(heat.time_s() + 1);
        heat.control().set_target(config::heater_bed, 60);
        heat.advance_to(heat.time_s() + 300);
        CHECK_FALSE(heat.control().trip());
    }
}

TEST_CASE("tune 1: the power is within its bounds, and off at the end") {
    RelayTune tune(100, 0.6);
    double temperature_c = 20;
    for (int i = 0; i < 100'000 && !tune.finished(); ++i) {
        const double power = tune.update(i * 0.1, temperature_c);
        CHECK(power >= 0);
        CHECK(power <= 0.6);
        temperature_c += 0.1 * (20 * power - 0.05 * (temperature_c - 20));
    }
    REQUIRE(tune.finished());
    CHECK(tune.update(1e6, 20) == 0);
}

TEST_CASE("tune: the lines it gives are lines of printer.toml") {
    const TuneResult result = tuned(heated_printer(), config::heater_tool, 200);
    const std::string text = text_of(result, "tool");
    CHECK(text.find("[heater.tool]\nkp = ") != std::string::npos);
    CHECK(text.find("\nki = ") != std::string::npos);
    CHECK(text.find("\nkd = ") != std::string::npos);
}
