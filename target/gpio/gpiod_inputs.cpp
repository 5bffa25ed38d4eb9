// One request a line, since each line's pull is its own and the kernel keeps each line's edges in a queue of its own
// anyway. The queues are merged by time.

#include "target/gpio/gpiod_inputs.h"

#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include "target/gpio/clock.h"
#include "target/gpio/gpiod_lines.h"

namespace lyr::gpio {
namespace {

struct Input {
    OpenChip chip;
    calls::WatchedHandle line;
    std::string text;  // for messages
    bool active_low = false;
    bool may_chatter = false;
};

Diagnostic lost(const Input& input) {
    return machine_error("reading " + input.text + " failed: " + std::strerror(errno));
}

class GpiodInputs final : public InputLines {
public:
    explicit GpiodInputs(std::vector<Input> inputs) : inputs_(std::move(inputs)) {
        for (std::size_t i = 0; i < inputs_.size(); ++i)
            polled_[i] = {calls::descriptor(*inputs_[i].line), POLLIN | POLLPRI, 0};
    }

    std::size_t line_count() const override { return inputs_.size(); }

    Result<LineMask> read() override {
        LineMask levels = 0;
        for (std::size_t i = 0; i < inputs_.size(); ++i) {
            const std::optional<bool> level = calls::level(*inputs_[i].line);
            if (!level) return lost(inputs_[i]);
            if (*level != inputs_[i].active_low) levels |= line_bit(i);
        }
        return levels;
    }

    Result<std::size_t> collect(std::span<InputEdge> edges) override {
        Result<bool> ready = wait_ns(0);
        if (!ready) return std::move(ready).error();
        std::size_t count = 0;
        for (std::size_t i = 0; *ready && i < inputs_.size() && count < edges.size(); ++i) {
            if (polled_[i].revents == 0) continue;
            Result<std::size_t> taken = take(i, edges.subspan(count));
            if (!taken) return taken;
            count += *taken;
        }
        std::sort(edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(count),
                  [](const InputEdge& a, const InputEdge& b) { return a.time_ns < b.time_ns; });
        return count;
    }

    Result<bool> wait_ns(std::int64_t time_ns) override {
        const timespec limit = timespec_of(time_ns);
        const int ready = ::ppoll(polled_.data(), inputs_.size(), &limit, nullptr);
        if (ready < 0 && errno != EINTR)
            return machine_error(std::string("waiting for inputs failed: ") + std::strerror(errno));
        return ready > 0;
    }

private:
    Result<std::size_t> take(std::size_t index, std::span<InputEdge> edges) {
        const Input& input = inputs_[index];
        std::array<calls::KernelEdge, calls::kept_edges> kept;
        const int count =
            calls::take(*input.line, std::span(kept).first(std::min(edges.size(), kept.size())));
        if (count < 0) return lost(input);
        // The kernel drops what comes after these.
        const bool overflows = count == static_cast<int>(kept.size());
        if (overflows && !input.may_chatter)
            return machine_error(input.text +
                                 ": edges come faster than they can be taken; is the "
                                 "line connected, and has it a pull resistor?");
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
            edges[i] = {kept[i].time_ns, static_cast<std::uint8_t>(index),
                        kept[i].level != input.active_low};
        if (overflows) {
            const std::optional<bool> level = calls::level(*input.line);
            if (!level) return lost(input);
            edges[kept.size() - 1].active = *level != input.active_low;
        }
        return static_cast<std::size_t>(count);
    }

    std::vector<Input> inputs_;
    std::array<pollfd, max_lines> polled_{};
};

Result<Input> open_input(const InputRequest& request) {
    Result<OpenChip> chip = open_chip(request.line);
    if (!chip) return chip.error();
    const Result<std::uint32_t> number = free_line(*chip, request.line);
    if (!number) return number.error();
    const std::string text = line_text(request.line);
    calls::WatchedHandle line = calls::watch(*chip->handle, *number, request.pull, line_consumer);
    if (!line)
        return machine_error("cannot watch " + text + ": " + std::strerror(errno) +
                             (request.pull == Pull::as_is ? "" : "; can the chip set its pull?"));
    return Input{std::move(*chip), std::move(line), text, request.line.active_low,
                 request.may_chatter};
}

}  // namespace

Result<std::unique_ptr<InputLines>> open_gpiod_inputs(std::span<const InputRequest> requests) {
    if (requests.empty() || requests.size() > max_lines)
        return machine_error("from 1 to " + std::to_string(max_lines) +
                             " inputs can be watched together, not " +
                             std::to_string(requests.size()));
    std::vector<Input> inputs;
    for (const InputRequest& request : requests) {
        Result<Input> input = open_input(request);
        if (!input) return std::move(input).error();
        inputs.push_back(std::move(*input));
    }
    return std::unique_ptr<InputLines>(std::make_unique<GpiodInputs>(std::move(inputs)));
}

}  // namespace lyr::gpio
