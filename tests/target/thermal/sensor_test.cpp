// Contract of target/thermal/sensor.h, by number.

#include "target/thermal/sensor.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "scratch.h"

using namespace lyr;
using namespace lyr::thermal;

namespace {

struct TestFile {
    std::string path = lyr::tests::scratch("sensor");
    ~TestFile() { std::filesystem::remove(path); }
    void hold(const std::string& text) const { std::ofstream(path) << text; }
};

}  // namespace

TEST_CASE(
    "sensor 1, 2: a file is read anew each time; what is no number is an error that names it") {
    const TestFile file;
    file.hold("2047\n");
    auto sensor = open_file_sensor(file.path);
    REQUIRE(sensor.ok());
    CHECK(*(*sensor)->read() == 2047);
    file.hold("-1250");
    CHECK(*(*sensor)->read() == -1250);
    // Drivers that end it with blanks were taken for broken.
    for (const char* text : {"2047 \n", "2047\r\n", "2047\t ", "2047 "}) {
        file.hold(text);
        const Result<double> read = (*sensor)->read();
        REQUIRE(read.ok());
        CHECK(*read == 2047);
    }
    for (const char* text : {"", "\n", "YES", "12 34", "12 \r34\n", "nan", "inf", "0x10"}) {
        CAPTURE(text);
        file.hold(text);
        const Result<double> read = (*sensor)->read();
        REQUIRE_FALSE(read.ok());
        CHECK(read.error().status == ExitStatus::machine);
        CHECK(read.error().where.file == file.path);
        CHECK_FALSE(open_file_sensor(file.path).ok());
    }
    CHECK_FALSE(open_file_sensor("/nonexistent/in_voltage0_raw").ok());
    CHECK_FALSE(open_file_sensor("/tmp").ok());
}

TEST_CASE("sensor 3: broken and shorted wires are told from temperatures") {
    const SensorScale scale{config::Sensor{}};
    CHECK(measure(scale, 4'095).wiring == Wiring::open);
    CHECK(measure(scale, 70'000).wiring == Wiring::open);
    CHECK(measure(scale, 0).wiring == Wiring::shorted);
    CHECK(measure(scale, -5).wiring == Wiring::shorted);
    for (const double raw : {-1e9, 0.0, 4'095.0, 1e9, std::nan("")})
        CHECK(std::isfinite(measure(scale, raw).temperature_c));
    for (double t = -20; t <= 350; t += 10)
        CHECK(measure(scale, raw_of(scale, t)).wiring == Wiring::whole);
}

TEST_CASE("sensor 4: measuring is the inverse of the scale, for every kind") {
    for (std::size_t kind = 0; kind < config::sensor_kinds.size(); ++kind) {
        config::Sensor sensor;
        sensor.kind = static_cast<config::SensorKind>(kind);
        sensor.points = {{0, 330'000}, {100, 6'700}, {200, 600}, {300, 90}};
        const SensorScale scale{sensor};
        for (double t = 0; t <= 300; t += 1.7)
            CHECK(std::abs(measure(scale, raw_of(scale, t)).temperature_c - t) < 1e-6);
    }
}
