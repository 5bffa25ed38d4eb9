// Steinhart-Hart's inverse is the one real root of a cubic; platinum's is Newton's, since its curve is almost
// a straight line.

#include "target/config/thermistor.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lyr::config {
namespace {

constexpr double kelvin_at_0_c = 273.15;
// IEC 60751, for platinum of 3851 ppm/K.
constexpr double platinum_a = 3.9083e-3, platinum_b = -5.775e-7, platinum_c = -4.183e-12;
// From a straight line as the first guess, Newton's method is at rounding after four.
constexpr int platinum_rounds = 6;

double inverse_k(double temperature_c) {
    return 1 / (temperature_c + kelvin_at_0_c);
}

double celsius(double inverse_k) {
    return 1 / inverse_k - kelvin_at_0_c;
}

// The Beta curve through two points.
Beta between(const ResistancePoint& a, const ResistancePoint& b) {
    const double beta_k = std::log(a.resistance_ohm / b.resistance_ohm) /
                          (inverse_k(a.temperature_c) - inverse_k(b.temperature_c));
    return {a.temperature_c, a.resistance_ohm, beta_k};
}

double temperature(const Beta& curve, double resistance_ohm) {
    return celsius(inverse_k(curve.reference_c) +
                   std::log(resistance_ohm / curve.reference_ohm) / curve.beta_k);
}

double resistance(const Beta& curve, double temperature_c) {
    return curve.reference_ohm *
           std::exp(curve.beta_k * (inverse_k(temperature_c) - inverse_k(curve.reference_c)));
}

double temperature(const SteinhartHart& curve, double resistance_ohm) {
    const double log = std::log(resistance_ohm);
    return celsius(curve.a + curve.b * log + curve.c * log * log * log);
}

// x^3 + p x + q = 0 with p > 0 has one real root.
double resistance(const SteinhartHart& curve, double temperature_c) {
    const double constant = curve.a - inverse_k(temperature_c);
    if (curve.c == 0) return std::exp(-constant / curve.b);
    const double p = curve.b / curve.c, q = constant / curve.c;
    const double root = std::sqrt(q * q / 4 + p * p * p / 27);
    return std::exp(std::cbrt(-q / 2 + root) + std::cbrt(-q / 2 - root));
}

// The piece of a table whose range holds the value, or the outermost one.
template <class IsBeyond>
Beta piece(const ResistanceTable& table, IsBeyond is_beyond) {
    std::size_t i = 1;
    while (i + 1 < table.points.size() && is_beyond(table.points[i])) ++i;
    return between(table.points[i - 1], table.points[i]);
}

double temperature(const ResistanceTable& table, double resistance_ohm) {
    return temperature(
        piece(table,
              [&](const ResistancePoint& point) { return resistance_ohm < point.resistance_ohm; }),
        resistance_ohm);
}

double resistance(const ResistanceTable& table, double temperature_c) {
    return resistance(
        piece(table,
              [&](const ResistancePoint& point) { return temperature_c > point.temperature_c; }),
        temperature_c);
}

double resistance(const Platinum& platinum, double t) {
    const double cold = t < 0 ? platinum_c * (t - 100) * t * t * t : 0;
    return platinum.zero_ohm * (1 + platinum_a * t + platinum_b * t * t + cold);
}

double temperature(const Platinum& platinum, double resistance_ohm) {
    double t = (resistance_ohm / platinum.zero_ohm - 1) / platinum_a;
    for (int i = 0; i < platinum_rounds; ++i) {
        const double slope = platinum_a + 2 * platinum_b * t +
                             (t < 0 ? platinum_c * (4 * t * t * t - 300 * t * t) : 0);
        t -= (resistance(platinum, t) - resistance_ohm) / (platinum.zero_ohm * slope);
    }
    return t;
}

// Data sheets' resistances at three temperatures.
constexpr std::array<ResistancePoint, 3> epcos_100k{{{25, 100'000}, {150, 1'641.9}, {250, 226.15}}};
constexpr std::array<ResistancePoint, 3> semitec_104gt2{
    {{20, 126'800}, {150, 1'360}, {300, 80.65}}};
constexpr Beta honeywell_100k{25, 100'000, 3'974};
constexpr Beta ntc_100k_3950{25, 100'000, 3'950};

}  // namespace

double temperature_c(const Resistor& resistor, double resistance_ohm) {
    return std::visit([&](const auto& curve) { return temperature(curve, resistance_ohm); },
                      resistor);
}

double resistance_ohm(const Resistor& resistor, double temperature_c) {
    return std::visit([&](const auto& curve) { return resistance(curve, temperature_c); },
                      resistor);
}

SteinhartHart through(std::span<const ResistancePoint, 3> points) {
    std::array<double, 3> log{}, y{};
    for (std::size_t i = 0; i < 3; ++i) {
        log[i] = std::log(points[i].resistance_ohm);
        y[i] = inverse_k(points[i].temperature_c);
    }
    const double slope_01 = (y[1] - y[0]) / (log[1] - log[0]);
    const double slope_02 = (y[2] - y[0]) / (log[2] - log[0]);
    SteinhartHart curve;
    curve.c = (slope_02 - slope_01) / (log[2] - log[1]) / (log[0] + log[1] + log[2]);
    curve.b = slope_01 - curve.c * (log[0] * log[0] + log[0] * log[1] + log[1] * log[1]);
    curve.a = y[0] - (curve.b + curve.c * log[0] * log[0]) * log[0];
    return curve;
}

Resistor resistor_of(const Sensor& sensor) {
    switch (sensor.kind) {
        case SensorKind::epcos_100k:
            return through(epcos_100k);
        case SensorKind::semitec_104gt2:
            return through(semitec_104gt2);
        case SensorKind::honeywell_100k:
            return honeywell_100k;
        case SensorKind::pt1000:
            return Platinum{};
        case SensorKind::beta:
            return Beta{25, sensor.r25_ohm, sensor.beta_k};
        case SensorKind::steinhart_hart:
            return through(std::span(sensor.points).first<3>());
        case SensorKind::table:
            return ResistanceTable{sensor.points};
        case SensorKind::ntc_100k_3950:
        case SensorKind::celsius:
            break;
    }
    return ntc_100k_3950;
}

double share_of(double resistance_ohm, double pullup_ohm) {
    return resistance_ohm / (resistance_ohm + pullup_ohm);
}

double resistance_of(double share, double pullup_ohm) {
    return pullup_ohm * share / (1 - share);
}

}  // namespace lyr::config
