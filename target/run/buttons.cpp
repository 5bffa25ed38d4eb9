#include "target/run/buttons.h"

#include <algorithm>
#include <array>

#include "target/gpio/gpiod_inputs.h"
#include "target/run/line_layout.h"

namespace lyr::run {

std::vector<gpio::InputRequest> input_requests(const config::Printer& printer) {
    std::vector<gpio::InputRequest> requests;
    for (std::size_t i = 0; i < printer.inputs.size(); ++i) {
        const std::optional<config::Pin>& pin = printer.inputs[i];
        if (!pin) continue;
        requests.push_back(input_request("input." + std::string(config::input_names[i]), *pin));
        // A worn button is no reason to end a print; an emergency line that cannot be read is.
        requests.back().may_chatter = i != config::input_emergency;
    }
    return requests;
}

Result<Buttons> Buttons::start(const config::Printer& printer,
                               std::unique_ptr<gpio::InputLines> lines) {
    const Result<gpio::LineMask> levels = lines->read();
    if (!levels) return levels.error();
    Buttons buttons(std::move(lines));
    for (std::size_t i = 0; i < printer.inputs.size(); ++i) {
        if (!printer.inputs[i]) continue;
        const std::size_t line = buttons.inputs_.size();
        const bool is_active = (*levels & gpio::line_bit(line)) != 0;
        const bool is_state = i == config::input_emergency || i == config::input_filament;
        gpio::Debounce debounce(settle_ns, is_active && !is_state);
        if (is_active && is_state) debounce.edge({0, static_cast<std::uint8_t>(line), true});
        buttons.inputs_.push_back({i, debounce});
    }
    return buttons;
}

Result<std::vector<std::size_t>> Buttons::pressed(std::int64_t now_ns) {
    std::array<gpio::InputEdge, 64> edges;
    for (std::size_t count = edges.size(); count == edges.size();) {
        const Result<std::size_t> collected = lines_->collect(edges);
        if (!collected) return collected.error();
        count = *collected;
        for (std::size_t i = 0; i < count; ++i)
            if (edges[i].line < inputs_.size()) inputs_[edges[i].line].debounce.edge(edges[i]);
    }
    std::vector<std::size_t> pressed;
    for (Input& input : inputs_)
        if (const auto change = input.debounce.settled(now_ns); change && change->active)
            pressed.push_back(input.number);
    return pressed;
}

bool Buttons::is_active(std::size_t number) const {
    return std::any_of(inputs_.begin(), inputs_.end(), [number](const Input& input) {
        return input.number == number && input.debounce.active();
    });
}

Result<std::optional<Buttons>> open_buttons(const config::Printer& printer) {
    const std::vector<gpio::InputRequest> requests = input_requests(printer);
    if (requests.empty()) return std::optional<Buttons>();
    auto lines = gpio::open_gpiod_inputs(requests);
    if (!lines) return lines.error();
    Result<Buttons> buttons = Buttons::start(printer, std::move(*lines));
    if (!buttons) return buttons.error();
    return std::optional<Buttons>(std::move(*buttons));
}

std::optional<Diagnostic> emergency(Buttons& buttons, std::int64_t now_ns) {
    const Result<std::vector<std::size_t>> pressed = buttons.pressed(now_ns);
    if (!pressed) return pressed.error();
    if (std::find(pressed->begin(), pressed->end(), config::input_emergency) == pressed->end())
        return std::nullopt;
    return Diagnostic{Severity::error,
                      ExitStatus::stopped,
                      "stopped on request of input.emergency, which is active",
                      {}};
}

}  // namespace lyr::run
