// An inverted axis is a direction line that is active at the other level.

#include "target/run/line_layout.h"

namespace lyr::run {
namespace {

using config::axis_count;
using config::axis_names;

std::string name_of(std::size_t axis, const char* line) {
    return std::string(axis_names[axis]) + '.' + line;
}

// As an owner would write it.
std::string key_of(std::size_t axis, const char* line) {
    return "axis." + name_of(axis, line);
}

gpio::Pull pull_of(config::Pull pull) {
    switch (pull) {
        case config::Pull::as_is:
            return gpio::Pull::as_is;
        case config::Pull::up:
            return gpio::Pull::up;
        case config::Pull::down:
            return gpio::Pull::down;
        case config::Pull::none:
            return gpio::Pull::none;
    }
    return gpio::Pull::as_is;
}

}  // namespace

gpio::LineRequest line_request(std::string purpose, const config::Pin& pin, bool inverted) {
    return {std::move(purpose), pin.chip, pin.line, pin.active_low != inverted,
            pin.open_drain ? gpio::Drive::open_drain : gpio::Drive::push_pull};
}

gpio::InputRequest input_request(std::string purpose, const config::Pin& pin) {
    return {{std::move(purpose), pin.chip, pin.line, pin.active_low}, pull_of(pin.pull)};
}

LineLayout line_layout(const config::Printer& printer) {
    LineLayout layout;
    for (std::size_t i = 0; i < axis_count; ++i) {
        layout.names.push_back(name_of(i, "step"));
        layout.names.push_back(name_of(i, "direction"));
    }
    for (std::size_t i = 0; i < axis_count; ++i) {
        if (!printer.axes[i].enable) continue;
        layout.enable |= gpio::line_bit(layout.names.size());
        layout.names.push_back(name_of(i, "enable"));
    }
    return layout;
}

Result<std::vector<gpio::LineRequest>> line_requests(const config::Printer& printer) {
    std::vector<gpio::LineRequest> requests;
    for (std::size_t i = 0; i < axis_count; ++i) {
        const config::Axis& axis = printer.axes[i];
        if (!axis.step || !axis.direction)
            return machine_error("printer \"" + printer.name + "\" has no " +
                                 key_of(i, axis.step ? "direction" : "step") +
                                 ": a line is needed to print (not to --simulate)");
        requests.push_back(line_request(key_of(i, "step"), *axis.step));
        requests.push_back(line_request(key_of(i, "direction"), *axis.direction, axis.invert));
    }
    for (std::size_t i = 0; i < axis_count; ++i)
        if (const auto& enable = printer.axes[i].enable)
            requests.push_back(line_request(key_of(i, "enable"), *enable));
    return requests;
}

}  // namespace lyr::run
