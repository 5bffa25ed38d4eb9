// What heating.h (4) says of a board that a killed print has left as it was.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "scratch.h"
#include "target/gpio/mock_chip.h"
#include "target/run/heating.h"

using namespace lyr;
using namespace lyr::run;

namespace {

std::string left_on(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    for (const char* name : {"period", "duty_cycle", "enable"})
        std::ofstream(folder / name) << "20000\n";
    return folder.string();
}

int duty_ns(const std::filesystem::path& folder) {
    int found_ns = -1;
    std::ifstream(folder / "duty_cycle") >> found_ns;
    return found_ns;
}

config::Printer wired_printer(const std::filesystem::path& pwm) {
    config::Printer printer = config::generic_printer();
    for (std::uint32_t i = 0; i < config::axis_count; ++i) {
        printer.axes[i].step = config::Pin{"gpiochip0", 2 * i, false};
        printer.axes[i].direction = config::Pin{"gpiochip0", 2 * i + 1, false};
    }
    printer.heaters[config::heater_tool]->output = config::Pin{"gpiochip0", 20U, false};
    printer.heaters[config::heater_bed]->output.reset();
    printer.heaters[config::heater_bed]->pwm = left_on(pwm);
    return printer;
}

}  // namespace

TEST_CASE("heating 4: heaters that a killed print left on are switched off, by line and channel") {
    const auto pwm = lyr::tests::scratch("switch_off");
    const config::Printer printer = wired_printer(pwm);
    gpio::VirtualClock clock;
    std::vector<std::string> asked;
    const Status off = switch_off(printer, [&](std::span<const gpio::LineRequest> requests) {
        for (const gpio::LineRequest& request : requests) asked.push_back(request.purpose);
        return Result<std::unique_ptr<gpio::GpioChip>>(
            std::make_unique<gpio::MockChip>(requests.size(), clock, gpio::LineObserver()));
    });
    CHECK(off.ok());
    CHECK(asked.size() == 2 * config::axis_count + 1);
    CHECK(asked.back() == "heater.tool.output");
    CHECK(duty_ns(pwm) == 0);
    std::filesystem::remove_all(pwm);
}

TEST_CASE("heating 4: of a print that is at work nothing is touched") {
    const auto pwm = lyr::tests::scratch("switch_off_busy");
    const config::Printer printer = wired_printer(pwm);
    const Diagnostic busy{Severity::error, ExitStatus::machine, "held by lyrrun", {}};
    const Status off = switch_off(printer, [&](std::span<const gpio::LineRequest>) {
        return Result<std::unique_ptr<gpio::GpioChip>>(busy);
    });
    REQUIRE_FALSE(off.ok());
    CHECK(off.error().message == "held by lyrrun");
    CHECK(duty_ns(pwm) == 20'000);
    std::filesystem::remove_all(pwm);
}

TEST_CASE(
    "heating 1, 4: a channel that is held is not heated by another, and is switched off all the "
    "same") {
    const std::filesystem::path folder = lyr::tests::scratch_folder("switch_off_held");
    config::Printer printer = wired_printer(folder);
    std::ofstream(folder / "sensor") << 25 << '\n';
    config::Heater& bed = *printer.heaters[config::heater_bed];
    bed.sensor.kind = config::SensorKind::celsius;
    bed.sensor.celsius_per_unit = 1;
    bed.sensor.file = folder / "sensor";
    printer.heaters[config::heater_tool].reset();
    {
        const Result<Heating> first = open_heating(printer);
        REQUIRE(first.ok());
        std::ofstream(folder / "duty_cycle") << 5'000 << '\n';
        const Result<Heating> second = open_heating(printer);
        REQUIRE_FALSE(second.ok());
        CHECK(second.error().where.file == folder / "duty_cycle");
        CHECK(duty_ns(folder) == 5'000);
        gpio::VirtualClock clock;
        CHECK(switch_off(printer, [&](std::span<const gpio::LineRequest> requests) {
                  return Result<std::unique_ptr<gpio::GpioChip>>(std::make_unique<gpio::MockChip>(
                      requests.size(), clock, gpio::LineObserver()));
              }).ok());
        CHECK(duty_ns(folder) == 0);
    }
    // Its keeper has ended, too.
    CHECK(open_heating(printer).ok());
    std::filesystem::remove_all(folder);
}
