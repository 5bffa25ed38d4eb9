#include "target/run/tended_heat.h"

#include <chrono>

#include "target/gpio/clock.h"

namespace lyr::run {
namespace {

Diagnostic over(const char* message, ExitStatus status) {
    return {Severity::error, status, message, {}};
}

}  // namespace

Result<std::unique_ptr<TendedHeat>> TendedHeat::open(const config::Printer& printer) {
    std::unique_ptr<TendedHeat> heat(new TendedHeat);
    Result<Heating> heating = open_heating(printer);
    if (!heating) return heating.error();
    heat->heating_ = std::move(*heating);
    Result<std::optional<Buttons>> buttons = open_buttons(printer);
    if (!buttons) return buttons.error();
    heat->buttons_ = std::move(*buttons);
    thermal::PowerStage& stage = *heat->heating_.stage;
    heat->watch_ = std::jthread([&stage](const std::stop_token& ended) {
        while (!ended.stop_requested()) {
            (void)stage.expire(heat_time_s());
            std::this_thread::sleep_for(std::chrono::milliseconds(tick_ms));
        }
    });
    return heat;
}

std::optional<Diagnostic> TendedHeat::tick() {
    heating_.control->tick(heat_time_s());
    if (heating_.control->trip()) return diagnostic_of(*heating_.control->trip());
    std::optional<Diagnostic> why;
    if (heating_.stage->latched())
        why = over("reading the sensors took more than 3 s", ExitStatus::machine);
    else if (buttons_)
        why = emergency(*buttons_, gpio::MonotonicClock().now_ns());
    if (!why && signals_.wait_ms(tick_ms)) why = over("stopped on request", ExitStatus::stopped);
    if (!why) return std::nullopt;
    why->message += "; all heaters are off";
    (void)heating_.stage->all_off();
    return why;
}

}  // namespace lyr::run
