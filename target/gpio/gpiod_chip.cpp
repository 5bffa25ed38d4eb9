// One request a kernel chip. What is held is set from the levels in memory, so that a request whose lines are
// all set by every ioctl on it (libgpiod 1.6) and one where only some are (2.x) are the same here.

#include "target/gpio/gpiod_chip.h"

#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "target/gpio/gpiod_lines.h"

namespace lyr::gpio {
namespace {

// The lines held by one request.
struct Bank {
    OpenChip chip;
    std::vector<calls::OutputLine> lines;
    calls::HeldHandle held;  // goes before the lines and the chip
    LineMask mask = 0;
    LineMask levels = 0;  // physical, as last set
    bool stale = false;   // the last write failed: the kernel's levels are not known
};

Status set_levels(Bank& bank, LineMask changed, LineMask levels) {
    bank.stale = !calls::set(*bank.held, bank.stale ? bank.mask : changed, levels);
    if (bank.stale)
        return machine_error("writing the lines of " + bank.chip.facts.name + " failed: " +
                             std::strerror(errno) + "; the printer must be homed again");
    bank.levels = levels;
    return Done{};
}

class GpiodChip final : public GpioChip {
public:
    GpiodChip(std::vector<Bank> banks, std::size_t line_count, LineMask inverted)
        : banks_(std::move(banks)), line_count_(line_count), inverted_(inverted) {}
    ~GpiodChip() override { (void)GpiodChip::release(); }

    std::size_t line_count() const override { return line_count_; }

    Status write(LineMask changed, LineMask levels) override {
        if (banks_.empty())
            return machine_error("a line was written after the lines were released");
        Status result = Done{};
        const LineMask physical = levels ^ inverted_;
        for (Bank& bank : banks_) {
            const LineMask ours = changed & bank.mask;
            if (!ours && !(bank.stale && changed)) continue;
            Status set = set_levels(bank, ours, (bank.levels & ~ours) | (physical & ours));
            if (!set && result) result = std::move(set);
        }
        return result;
    }

    Status release() override {
        if (banks_.empty()) return Done{};
        Status low = write(all_lines(line_count_), 0);
        banks_.clear();
        return low;
    }

private:
    std::vector<Bank> banks_;
    std::size_t line_count_;
    LineMask inverted_;
};

bool fit_one_request(const LineRequest& a, const LineRequest& b) {
    return calls::holds_unlike_lines() || a.drive == b.drive;
}

// All lines are found before any is held, so that nothing is if one cannot be.
Status add_line(std::vector<Bank>& banks, std::span<const LineRequest> requests,
                std::size_t index) {
    const LineRequest& request = requests[index];
    Result<OpenChip> chip = open_chip(request);
    if (!chip) return chip.error();
    const Result<std::uint32_t> number = free_line(*chip, request);
    if (!number) return number.error();
    Bank* bank = nullptr;
    for (Bank& known : banks) {
        // Two ways to write the same chip ("0", "gpiochip0") have the same name.
        if (known.chip.facts.name != chip->facts.name) continue;
        for (const calls::OutputLine& line : known.lines)
            if (line.number == *number)
                return machine_error(line_text(request) + " is already used for " +
                                     requests[line.bit].purpose);
        if (fit_one_request(requests[known.lines.front().bit], request)) bank = &known;
    }
    if (!bank) {
        bank = &banks.emplace_back();
        bank->chip = std::move(*chip);
    }
    bank->lines.push_back({index, *number, request.active_low, request.drive});
    bank->mask |= line_bit(index);
    if (request.active_low) bank->levels |= line_bit(index);
    return Done{};
}

Status hold(Bank& bank, std::span<const LineRequest> requests) {
    bank.held = calls::hold(*bank.chip.handle, bank.lines, line_consumer);
    if (bank.held) return Done{};
    return machine_error("cannot request the lines of " + bank.chip.facts.name + " as outputs (" +
                         requests[bank.lines.front().bit].purpose +
                         " and others): " + std::strerror(errno));
}

}  // namespace

Result<std::unique_ptr<GpioChip>> open_gpiod_chip(std::span<const LineRequest> requests) {
    if (requests.empty() || requests.size() > max_lines)
        return machine_error("from 1 to " + std::to_string(max_lines) +
                             " lines can be held together, not " + std::to_string(requests.size()));
    std::vector<Bank> banks;
    LineMask inverted = 0;
    for (std::size_t i = 0; i < requests.size(); ++i) {
        if (const Status added = add_line(banks, requests, i); !added) return added.error();
        if (requests[i].active_low) inverted |= line_bit(i);
    }
    for (Bank& bank : banks)
        if (const Status held = hold(bank, requests); !held) return held.error();
    return std::unique_ptr<GpioChip>(
        std::make_unique<GpiodChip>(std::move(banks), requests.size(), inverted));
}

}  // namespace lyr::gpio
