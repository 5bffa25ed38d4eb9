// Sensors with few figures, or that seldom say anything new: guard 7 of target/thermal/guard.h in a loop with a heater.

#include <cmath>

#include "target/gpio/mock_chip.h"
#include "target/thermal/faults_scene.h"

using namespace lyr;
using namespace lyr::thermal;
using namespace lyr::tests;

namespace {

struct Converter {
    const char* name;
    config::SensorKind kind;
    double full_scale;   // of a converter
    double step;         // of its figure, in units
    double interval_s;   // between two of them
    double noise_steps;  // how much of a step it flickers by
};

using enum config::SensorKind;
constexpr std::array<Converter, 8> converters{{
    {"10 bits", ntc_100k_3950, 1'023, 1, tick_s, 0.01},
    {"10 bits with some noise", epcos_100k, 1'023, 1, tick_s, 0.3},
    {"12 bits without noise", semitec_104gt2, 4'095, 1, tick_s, 0.001},
    {"platinum in 12 bits, 2 °C a count", pt1000, 4'095, 1, tick_s, 0.01},
    {"16 bits with noise", ntc_100k_3950, 65'535, 1, tick_s, 2},
    {"1-wire, 1/16 °C each 0.75 s", celsius, 1, 62.5, 0.75, 0.01},
    {"MAX6675, 1/4 °C each 0.25 s", celsius, 1, 250, 0.25, 0.1},
    {"hwmon, 1 °C each 2 s", celsius, 1, 1'000, 2, 0.01},
}};

// One heater with such a sensor.
class Rig {
public:
    Rig(std::size_t number, const Converter& converter)
        : converter_(converter),
          settings_(config::default_heater(number)),
          body_([&] {
              settings_.sensor.kind = converter.kind;
              settings_.sensor.full_scale = converter.full_scale;
              config::Heater fine = settings_;
              fine.sensor.full_scale /= unit();
              fine.sensor.celsius_per_unit *= unit();
              return fine;
          }()),
          stage_(outputs(), &chip_),
          control_(port(number), false, stage_) {}

    void advance(double time_s, double fan_share = 0) {
        for (const double until_s = time_s_ + time_s; time_s_ < until_s;) {
            time_s_ = tick_s * ++ticks_;
            body_.advance(tick_s, chip_.levels() != 0, fan_share);
            control_.tick(time_s_);
            clock_.advance_ns(100'000'000);
            highest_c_ = std::max(highest_c_, body_.body_c());
            lowest_c_ = std::min(lowest_c_, body_.body_c());
        }
    }
    void forget_extremes() { highest_c_ = lowest_c_ = body_.body_c(); }
    void freeze() { is_frozen_ = true; }

    HeatControl& control() { return control_; }
    double time_s() const { return time_s_; }
    double highest_c() const { return highest_c_; }
    double lowest_c() const { return lowest_c_; }
    // Of one step, where the body is.
    double step_c() const {
        const SensorScale scale(settings_.sensor);
        const double raw = raw_of(scale, body_.body_c());
        return std::abs(measure(scale, raw + converter_.step).temperature_c -
                        measure(scale, raw).temperature_c);
    }

private:
    // The model's noise is one of its own units.
    double unit() const { return converter_.step * converter_.noise_steps; }
    double figure() {
        if (is_frozen_ || time_s_ < next_s_) return figure_;
        next_s_ += converter_.interval_s;
        figure_ = converter_.step * std::floor(*body_.raw() * unit() / converter_.step + 0.5);
        return figure_;
    }
    std::vector<Output> outputs() const {
        std::vector<Output> made;
        made.push_back({LineOutput{0, SlowPwm(settings_.cycle_s)}, true});
        return made;
    }
    std::vector<HeaterPort> port(std::size_t number) {
        std::vector<HeaterPort> ports;
        ports.push_back({number, settings_, std::make_unique<MockSensor>([this] {
                             return Result<double>(figure());
                         })});
        return ports;
    }

    Converter converter_;
    config::Heater settings_;
    HeatedBody body_;
    gpio::VirtualClock clock_;
    gpio::MockChip chip_{1, clock_, {}};
    PowerStage stage_;
    HeatControl control_;
    int ticks_ = 0;
    double time_s_ = 0, next_s_ = 0, figure_ = 0, highest_c_ = 0, lowest_c_ = 0;
    bool is_frozen_ = false;
};

struct Case {
    std::size_t heater;
    double target_c;
};
constexpr std::array<Case, 8> cases{{{config::heater_tool, 50},
                                     {config::heater_tool, 180},
                                     {config::heater_tool, 210},
                                     {config::heater_tool, 250},
                                     {config::heater_bed, 25},
                                     {config::heater_bed, 60},
                                     {config::heater_bed, 110},
                                     {config::heater_chamber, 40}}};

template <class Check>
void for_each_case(Check check) {
    for (const Case& heated : cases)
        for (const Converter& converter : converters) {
            CAPTURE(converter.name);
            CAPTURE(config::heater_names[heated.heater]);
            CAPTURE(heated.target_c);
            Rig rig(heated.heater, converter);
            rig.control().set_target(heated.heater, heated.target_c);
            rig.advance(1'200);
            REQUIRE_MESSAGE(!rig.control().trip(), rig.control().trip()->message);
            rig.forget_extremes();
            check(rig, heated);
        }
}

}  // namespace

TEST_CASE("guard 7: a converter of 10 bits at a steady temperature was taken for a frozen one" *
          doctest::test_suite("long")) {
    for_each_case([](Rig& rig, const Case& heated) {
        for (const double fan_share : {0.0, 1.0, 0.3}) rig.advance(900, fan_share);
        REQUIRE_MESSAGE(!rig.control().trip(), rig.control().trip()->message);
        const double off_c =
            std::max(rig.highest_c() - heated.target_c, heated.target_c - rig.lowest_c());
        CHECK(off_c < 3 + 2 * rig.step_c());
    });
}

TEST_CASE("guard 7: whatever the sensor, one that freezes is found in time, and before it is hot" *
          doctest::test_suite("long")) {
    for_each_case([](Rig& rig, const Case& heated) {
        const double frozen_time_s = config::default_heater(heated.heater).guard.frozen_time_s;
        rig.freeze();
        rig.advance(frozen_time_s + 0.5);
        REQUIRE(rig.control().trip());
        CHECK(rig.control().trip()->kind == GuardKind::frozen);
        CHECK(rig.highest_c() < heated.target_c + 10);
    });
}
