// A model is warmed, when its sensor is read, for as long as has passed since, by what its line is then: lines change
// only after all sensors were read.

#include "target/run/dry_run.h"

#include <limits>

#include "target/gpio/mock_chip.h"
#include "target/run/line_layout.h"
#include "target/thermal/model.h"

namespace lyr::run {
namespace {

struct WarmedBody {
    explicit WarmedBody(const config::Heater& heater) : body(heater) {}

    Result<double> raw(bool on, bool fan_on) {
        const double now_s = heat_time_s();
        body.advance(now_s - warmed_s, on, fan_on ? 1 : 0);
        warmed_s = now_s;
        return body.raw();
    }

    thermal::HeatedBody body;
    double warmed_s = heat_time_s();
};

// The heaters in their order, then the part fan, as open_heating() has them.
Heating model_heating(const config::Printer& printer, const gpio::Clock& clock) {
    std::vector<thermal::Output> outputs;
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < config::heater_count; ++i) {
        if (!printer.heaters[i]) continue;
        numbers.push_back(i);
        outputs.push_back(
            {thermal::LineOutput{outputs.size(), thermal::SlowPwm(printer.heaters[i]->cycle_s)},
             true});
    }
    const bool has_fan = printer.part_fan.has_value();
    if (has_fan)
        outputs.push_back(
            {thermal::LineOutput{outputs.size(), thermal::SlowPwm(printer.part_fan->cycle_s)},
             false});
    auto chip = std::make_unique<gpio::MockChip>(outputs.size(), clock, gpio::LineObserver());
    const gpio::LineMask fan_bit = has_fan ? gpio::line_bit(numbers.size()) : 0;
    std::vector<thermal::HeaterPort> ports;
    for (std::size_t line = 0; line < numbers.size(); ++line) {
        const config::Heater& heater = *printer.heaters[numbers[line]];
        const auto source = [body = std::make_shared<WarmedBody>(heater), lines = chip.get(), line,
                             fan_bit] {
            const gpio::LineMask levels = lines->levels();
            return body->raw((levels & gpio::line_bit(line)) != 0, (levels & fan_bit) != 0);
        };
        ports.push_back({numbers[line], heater, std::make_unique<thermal::MockSensor>(source)});
    }
    Heating heating;
    heating.stage = std::make_unique<thermal::PowerStage>(std::move(outputs), chip.get());
    heating.chip = std::move(chip);
    heating.control =
        std::make_unique<thermal::HeatControl>(std::move(ports), has_fan, *heating.stage);
    return heating;
}

}  // namespace

Result<PrintReport> dry_run(PrintJob job) {
    job.before = {};  // no endstop would close
    job.printer.pulse.late_limit_ns = std::numeric_limits<std::int64_t>::max();
    gpio::MonotonicClock clock;
    gpio::MockChip chip(line_layout(job.printer).names.size(), clock, {});
    if (job.no_heat) return print(job, chip, clock);
    Heating heating = model_heating(job.printer, clock);
    return print(job, chip, clock, &heating);
}

}  // namespace lyr::run
