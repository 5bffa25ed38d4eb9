// A file of sysfs is read anew from its begin each time: that is what makes the driver convert.

#include "target/thermal/sensor.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

namespace lyr::thermal {

using config::open_share, config::shorted_share;

namespace {

Diagnostic unreadable(const std::string& path, const std::string& why) {
    return {Severity::error,
            ExitStatus::machine,
            "cannot read the temperature: " + why,
            {.file = path}};
}

class FileSensor final : public TemperatureSensor {
public:
    FileSensor(std::string path, int descriptor)
        : path_(std::move(path)), descriptor_(descriptor) {}
    ~FileSensor() override { ::close(descriptor_); }
    FileSensor(const FileSensor&) = delete;
    FileSensor& operator=(const FileSensor&) = delete;

    Result<double> read() override {
        std::array<char, 64> text{};
        const ssize_t length = ::pread(descriptor_, text.data(), text.size(), 0);
        if (length < 0) return unreadable(path_, std::strerror(errno));
        double value = 0;
        const char* end = text.data() + length;
        const auto [rest, error] = std::from_chars(text.data(), end, value);
        // Some drivers end it with blanks.
        const std::string_view tail(rest, static_cast<std::size_t>(end - rest));
        const std::size_t at = std::min(tail.find_first_not_of(" \t\r"), tail.size());
        const bool whole = at == tail.size() || tail[at] == '\n';
        if (error != std::errc() || !whole || !std::isfinite(value))
            return unreadable(path_, "it holds no number");
        return value;
    }

private:
    std::string path_;
    int descriptor_;
};

}  // namespace

Result<std::unique_ptr<TemperatureSensor>> open_file_sensor(const std::string& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return unreadable(path, std::strerror(errno));
    std::unique_ptr<TemperatureSensor> sensor = std::make_unique<FileSensor>(path, descriptor);
    if (const Result<double> first = sensor->read(); !first) return first.error();
    return sensor;
}

Measured measure(const SensorScale& scale, double raw) {
    const config::Sensor& settings = scale.settings;
    if (settings.kind == config::SensorKind::celsius) return {raw * settings.celsius_per_unit};
    const double share = raw / settings.full_scale;
    Measured measured;
    if (!(share < open_share)) measured.wiring = Wiring::open;
    if (share <= shorted_share) measured.wiring = Wiring::shorted;
    const double seen = share < open_share ? std::max(share, shorted_share) : open_share;
    measured.temperature_c =
        temperature_c(scale.resistor, config::resistance_of(seen, settings.pullup_ohm));
    return measured;
}

double raw_of(const SensorScale& scale, double temperature_c) {
    const config::Sensor& settings = scale.settings;
    if (settings.kind == config::SensorKind::celsius)
        return temperature_c / settings.celsius_per_unit;
    return settings.full_scale *
           config::share_of(resistance_ohm(scale.resistor, temperature_c), settings.pullup_ohm);
}

}  // namespace lyr::thermal
