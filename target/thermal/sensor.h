// Temperature sensors: where a raw figure comes from, and what it says.
//
// An abstract class for the source, as GpioChip is one: the real one reads a file of the kernel, the mock
// one is the simulator's model. What the figure means is the same pure function for both.
//
// Contract
//  1. read() gives the figure as the kernel states it (converter counts, or units of temperature), or a
//     diagnostic (status machine) with file and reason.
//  2. FileSensor serves everything that the kernel shows as one number in a file: IIO converters, 1-wire,
//     MAX31855 and MAX6675, hwmon. It holds the file open and allocates nothing.
//  3. measure() never fails: what no whole sensor gives is `open` (a broken wire reads full scale) or
//     `shorted` (it reads nothing), and then the temperature is that at the end of the scale.
//  4. raw_of() is the inverse of measure() within the converter's resolution.

#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/diagnostic.h"
#include "target/config/thermistor.h"

namespace lyr::thermal {

class TemperatureSensor {
public:
    virtual ~TemperatureSensor() = default;
    virtual Result<double> read() = 0;
};

Result<std::unique_ptr<TemperatureSensor>> open_file_sensor(const std::string& path);

class MockSensor final : public TemperatureSensor {
public:
    explicit MockSensor(std::function<Result<double>()> source) : source_(std::move(source)) {}
    Result<double> read() override { return source_(); }

private:
    std::function<Result<double>()> source_;
};

enum class Wiring : std::uint8_t { whole, open, shorted };

struct Measured {
    double temperature_c = 0;
    Wiring wiring = Wiring::whole;
};

// A sensor's settings with its curve worked out.
struct SensorScale {
    explicit SensorScale(const config::Sensor& sensor)
        : settings(sensor), resistor(config::resistor_of(sensor)) {}

    config::Sensor settings;
    config::Resistor resistor;
};

Measured measure(const SensorScale& scale, double raw);
double raw_of(const SensorScale& scale, double temperature_c);

}  // namespace lyr::thermal
