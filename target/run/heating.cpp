// Outputs keep their order whichever way they go out: the heaters', then the part fan's.

#include "target/run/heating.h"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "base/text.h"
#include "target/gpio/gpiod_chip.h"
#include "target/run/line_keeper.h"
#include "target/run/line_layout.h"
#include "target/thermal/slow_sensor.h"

namespace lyr::run {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::duration<double> tick{thermal::tick_s};
constexpr int silent_ms = static_cast<int>(thermal::silent_s * 1'000);

Diagnostic missing(const config::Printer& printer, const std::string& key) {
    return machine_error("printer \"" + printer.name + "\" has no " + key +
                         ": it is needed to heat (not to --simulate, and not with --no-heat)");
}

// What is collected on the way to a stage.
struct Outputs {
    std::vector<thermal::Output> outputs;
    std::vector<gpio::LineRequest> requests;
};

Status append(Outputs& all, const std::string& section, const std::optional<config::Pin>& line,
              const std::string& pwm, double cycle_s, bool heats) {
    if (line) {
        all.outputs.push_back(
            {thermal::LineOutput{all.requests.size(), thermal::SlowPwm(cycle_s)}, heats});
        all.requests.push_back(line_request(section + ".output", *line));
        return Done{};
    }
    Result<thermal::KernelPwm> channel = thermal::KernelPwm::open(pwm);
    if (!channel) return channel.error();
    all.outputs.push_back({std::move(*channel), heats});
    return Done{};
}

std::string section_of(std::size_t heater) {
    return "heater." + std::string(config::heater_names[heater]);
}

// Kernel PWM channels belong to nobody: what is left on one stays. All are tried; the first error.
Status drop_channels(const config::Printer& printer) {
    Status dropped = Done{};
    for (const std::optional<config::Heater>& heater : printer.heaters) {
        if (!heater || heater->pwm.empty()) continue;
        const auto channel =
            thermal::KernelPwm::open(heater->pwm, thermal::KernelPwm::Use::switch_off);
        if (!channel && dropped) dropped = channel.error();
    }
    return dropped;
}

// All outputs are kernel PWM channels: their keeper has no line, and is written to all the same.
class NoLines final : public gpio::GpioChip {
public:
    std::size_t line_count() const override { return 0; }
    Status write(gpio::LineMask, gpio::LineMask) override { return Done{}; }
    Status release() override { return Done{}; }
};

OpenChip opener_of(std::vector<gpio::LineRequest> requests) {
    using Opened = Result<std::unique_ptr<gpio::GpioChip>>;
    if (requests.empty()) return [] { return Opened(std::make_unique<NoLines>()); };
    return [requests = std::move(requests)] { return gpio::open_gpiod_chip(requests); };
}

Result<thermal::HeaterPort> open_port(const config::Printer& printer, std::size_t number) {
    const config::Heater& heater = *printer.heaters[number];
    const std::string section = section_of(number);
    if (heater.sensor.file.empty()) return missing(printer, section + ".sensor.file");
    if (!heater.output && heater.pwm.empty()) return missing(printer, section + ".output or .pwm");
    auto sensor = thermal::open_file_sensor(heater.sensor.file);
    if (sensor) sensor = thermal::unhurried(std::move(*sensor));
    if (!sensor) {
        Diagnostic error = sensor.error();
        error.message = section + ": " + error.message;
        return error;
    }
    return thermal::HeaterPort{number, heater, std::move(*sensor)};
}

}  // namespace

std::vector<KeyProblem> shared_files(const config::Printer& printer, const std::string& root) {
    const std::vector<std::pair<std::string, std::string>> files = config::used_files(printer);
    // A channel is its folder.
    const auto look = [&root](const std::string& path, struct stat& file) {
        return ::stat((root + path).c_str(), &file) == 0;
    };
    std::vector<KeyProblem> problems;
    for (std::size_t i = 0; i < files.size(); ++i) {
        struct stat file {};
        if (!look(files[i].second, file)) continue;
        for (std::size_t j = 0; j < i; ++j) {
            struct stat other {};
            if (look(files[j].second, other) && other.st_ino == file.st_ino &&
                other.st_dev == file.st_dev)
                problems.emplace_back(
                    files[i].first,
                    formatted("%s is %s too, by another path: give one of them another",
                              files[i].second.c_str(), files[j].first.c_str()));
        }
    }
    return problems;
}

Result<Heating> open_heating(const config::Printer& printer) {
    if (const auto shared = shared_files(printer, ""); !shared.empty())
        return machine_error(shared[0].first + ": " + shared[0].second);
    std::vector<thermal::HeaterPort> ports;
    Outputs all;
    for (std::size_t i = 0; i < config::heater_count; ++i) {
        if (!printer.heaters[i]) continue;
        Result<thermal::HeaterPort> port = open_port(printer, i);
        if (!port) return port.error();
        const config::Heater& heater = *printer.heaters[i];
        const std::string section = section_of(i);
        if (Status added = append(all, section, heater.output, heater.pwm, heater.cycle_s, true);
            !added)
            return added.error();
        ports.push_back(std::move(*port));
    }
    const auto& fan = printer.part_fan;
    const bool has_fan = fan && (fan->output || !fan->pwm.empty());
    if (has_fan)
        if (Status added = append(all, "fan.part", fan->output, fan->pwm, fan->cycle_s, false);
            !added)
            return added.error();
    Heating heating;
    if (!all.outputs.empty()) {
        const auto drop = [&] { (void)drop_channels(printer); };
        auto chip = keep_lines(all.requests.size(), opener_of(all.requests), silent_ms, drop);
        if (!chip) return chip.error();
        heating.chip = std::move(*chip);
    }
    heating.stage =
        std::make_unique<thermal::PowerStage>(std::move(all.outputs), heating.chip.get());
    heating.control =
        std::make_unique<thermal::HeatControl>(std::move(ports), has_fan, *heating.stage);
    return heating;
}

Status switch_off(const config::Printer& printer, const OpenLines& open) {
    Result<std::vector<gpio::LineRequest>> requests = line_requests(printer);
    if (!requests) return requests.error();
    for (std::size_t i = 0; i < config::heater_count; ++i)
        if (const auto& heater = printer.heaters[i]; heater && heater->output)
            requests->push_back(line_request(section_of(i) + ".output", *heater->output));
    const Result<std::unique_ptr<gpio::GpioChip>> chip = open(*requests);
    if (!chip) return chip.error();
    const Status dropped = drop_channels(printer);
    const Status released = (*chip)->release();
    return dropped ? released : dropped;
}

double heat_time_s() {
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

void tend(thermal::HeatControl& control, HeatAttendant& attendant,
          const std::atomic<bool>& finished, std::atomic<std::uint32_t>& ticks,
          const std::function<void(const thermal::Trip&)>& tripped) {
    bool told = false;
    Clock::time_point next = Clock::now();
    while (!finished.load()) {
        control.tick(heat_time_s());
        attendant.tick();
        ++ticks;
        if (control.trip() && !told) tripped(*control.trip());
        told = control.trip().has_value();
        next = std::max(next + std::chrono::duration_cast<Clock::duration>(tick), Clock::now());
        std::this_thread::sleep_until(next);
    }
}

Diagnostic diagnostic_of(const thermal::Trip& trip) {
    return machine_error(trip.message);
}

}  // namespace lyr::run
