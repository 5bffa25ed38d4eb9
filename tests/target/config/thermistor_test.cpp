// Contract of target/config/thermistor.h, by number.

#include "target/config/thermistor.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace lyr;
using namespace lyr::config;

namespace {

std::vector<Resistor> resistors() {
    std::vector<Resistor> all{Beta{}, Platinum{}, Platinum{100}};
    for (std::size_t kind = 0; kind < config::sensor_kinds.size(); ++kind) {
        config::Sensor sensor;
        sensor.kind = static_cast<config::SensorKind>(kind);
        sensor.points = {{0, 330'000}, {100, 6'700}, {200, 600}, {300, 90}};
        all.push_back(resistor_of(sensor));
    }
    return all;
}

}  // namespace

TEST_CASE("thermistor 1: temperature and resistance are inverse and monotone") {
    for (const Resistor& resistor : resistors()) {
        double before = resistance_ohm(resistor, -41);
        const double sense = resistance_ohm(resistor, 100) > before ? 1 : -1;
        for (double t = -40; t <= 400; t += 0.7) {
            const double ohm = resistance_ohm(resistor, t);
            REQUIRE(std::abs(temperature_c(resistor, ohm) - t) < 1e-6);
            REQUIRE((ohm - before) * sense > 0);
            before = ohm;
        }
    }
}

TEST_CASE("thermistor 2: curves pass through what they are made of") {
    const std::vector<config::ResistancePoint> points{{25, 1e5}, {150, 1641.9}, {250, 226.15}};
    const SteinhartHart curve = through(std::span(points).first<3>());
    const Resistor table = ResistanceTable{{{0, 3.3e5}, {25, 1e5}, {150, 1641.9}, {250, 226.15}}};
    for (const auto& [t, ohm] : points) {
        CHECK(temperature_c(curve, ohm) == doctest::Approx(t).epsilon(1e-9));
        CHECK(temperature_c(table, ohm) == doctest::Approx(t).epsilon(1e-9));
    }
    // Two of its points make the Beta curve.
    const Resistor beta = Beta{};
    const Resistor two = ResistanceTable{{{25, 1e5}, {200, resistance_ohm(beta, 200)}}};
    for (double t = -20; t < 300; t += 10)
        CHECK(resistance_ohm(two, t) == doctest::Approx(resistance_ohm(beta, t)));
}

TEST_CASE("thermistor: resistances of data sheets") {
    const auto ohm = [](config::SensorKind kind, double t) {
        config::Sensor sensor;
        sensor.kind = kind;
        return resistance_ohm(resistor_of(sensor), t);
    };
    using enum config::SensorKind;
    // B57560G104F, R/T characteristic 8404.
    CHECK(ohm(epcos_100k, 25) == doctest::Approx(100'000).epsilon(0.001));
    CHECK(ohm(epcos_100k, 100) == doctest::Approx(6'240).epsilon(0.03));
    CHECK(ohm(epcos_100k, 200) == doctest::Approx(555).epsilon(0.03));
    CHECK(ohm(semitec_104gt2, 25) == doctest::Approx(100'000).epsilon(0.02));
    CHECK(ohm(ntc_100k_3950, 25) == doctest::Approx(100'000));
    // IEC 60751.
    CHECK(ohm(pt1000, 0) == doctest::Approx(1'000));
    CHECK(ohm(pt1000, 100) == doctest::Approx(1'385.06).epsilon(1e-5));
    CHECK(ohm(pt1000, -40) == doctest::Approx(842.71).epsilon(1e-5));
    CHECK(ohm(pt1000, 400) == doctest::Approx(2'470.92).epsilon(1e-5));
}

TEST_CASE("thermistor 3: the divider and its inverse") {
    for (const double pullup_ohm : {1'000.0, 4'700.0})
        for (double ohm = 10; ohm < 1e6; ohm *= 3)
            CHECK(resistance_of(share_of(ohm, pullup_ohm), pullup_ohm) == doctest::Approx(ohm));
    CHECK(share_of(4'700, 4'700) == 0.5);
}
