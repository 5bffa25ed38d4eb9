// Resistance and temperature: how a thermistor or a platinum resistor answers, and the divider through which
// a converter sees it. Pure values; where the numbers come from is target/thermal/sensor.h's.
//
// Contract
//  1. temperature_c() and resistance_ohm() are inverse to each other within 1e-6 °C from -40 to 400 °C, and
//     strictly monotone.
//  2. A Steinhart-Hart curve passes through its three points; a table passes through all of its own, runs as
//     a Beta curve between them, and goes on as its outermost pieces beyond them.
//  3. share_of() is the share of full scale that a converter reads at a resistance under its pull-up, and
//     resistance_of() the inverse.

#pragma once

#include <span>
#include <variant>
#include <vector>

#include "base/diagnostic.h"
#include "target/config/heater.h"

namespace lyr::config {

// ln R falls evenly with 1/T.
struct Beta {
    double reference_c = 25, reference_ohm = 100'000, beta_k = 3'950;
};

// 1/T = a + b ln R + c (ln R)^3, in kelvin.
struct SteinhartHart {
    double a = 0, b = 0, c = 0;
};

// In order of temperature; resistance falls.
struct ResistanceTable {
    std::vector<ResistancePoint> points;
};

// Callendar-Van Dusen, with the coefficients of IEC 60751.
struct Platinum {
    double zero_ohm = 1'000;
};

using Resistor = std::variant<Beta, SteinhartHart, ResistanceTable, Platinum>;

double temperature_c(const Resistor& resistor, double resistance_ohm);
double resistance_ohm(const Resistor& resistor, double temperature_c);

// Through three points in order of temperature.
SteinhartHart through(std::span<const ResistancePoint, 3> points);

// The curve of a sensor that is a resistor; a sensor of kind celsius has none and gives the default.
Resistor resistor_of(const Sensor& sensor);

// Of full scale, how near to its ends a reading is no sensor any more: a 100 kOhm thermistor under 4.7 kOhm
// is at 0.998 below -40 °C, and at 0.002 it would have 10 Ohm.
inline constexpr double open_share = 0.998, shorted_share = 0.002;

double share_of(double resistance_ohm, double pullup_ohm);
double resistance_of(double share, double pullup_ohm);

}  // namespace lyr::config
