// One bulk request a kernel chip. The request's lines are all set by every ioctl on it, so that the
// levels of lines that do not change are repeated from memory.

#include "target/gpio/gpiod_chip.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "target/gpio/gpiod_lines.h"

namespace lyr::gpio {
namespace {

// The lines held on one kernel chip.
struct Bank {
    ChipHandle chip;
    std::string name;
    gpiod_line_bulk bulk{};
    std::vector<std::size_t> lines;  // of the GpioChip, in the order of the bulk
    LineMask mask = 0;
    LineMask levels = 0;  // physical, as last set
    bool stale = false;   // the last write failed: the kernel's levels are not known
};

Status set_levels(Bank& bank, LineMask levels) {
    std::array<int, GPIOD_LINE_BULK_MAX_LINES> values{};
    for (std::size_t i = 0; i < bank.lines.size(); ++i)
        values[i] = (levels & line_bit(bank.lines[i])) != 0;
    bank.stale = ::gpiod_line_set_value_bulk(&bank.bulk, values.data()) != 0;
    if (bank.stale)
        return machine_error("writing the lines of " + bank.name + " failed: " +
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
            Status set = set_levels(bank, (bank.levels & ~ours) | (physical & ours));
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

// The bank of the request's kernel chip, opened if it is the first line there. Two ways to write
// the same chip ("0", "gpiochip0") are the same bank.
Result<std::size_t> bank_for(std::vector<Bank>& banks, const LineRequest& request) {
    Result<ChipHandle> chip = open_chip(request);
    if (!chip) return chip.error();
    const std::string name = ::gpiod_chip_name(chip->get());
    const auto known = std::find_if(banks.begin(), banks.end(),
                                    [&](const Bank& bank) { return bank.name == name; });
    if (known != banks.end()) return static_cast<std::size_t>(known - banks.begin());
    banks.emplace_back();
    banks.back().chip = std::move(*chip);
    banks.back().name = name;
    return banks.size() - 1;
}

Status add_line(std::vector<Bank>& banks, std::span<const LineRequest> requests,
                std::size_t index) {
    const LineRequest& request = requests[index];
    const Result<std::size_t> found = bank_for(banks, request);
    if (!found) return found.error();
    Bank& bank = banks[*found];
    const Result<gpiod_line*> line = find_line(bank.chip.get(), request);
    if (!line) return line.error();
    for (std::size_t i = 0; i < bank.lines.size(); ++i)
        if (bank.bulk.lines[i] == *line)
            return machine_error(line_text(request) + " is already used for " +
                                 requests[bank.lines[i]].purpose);
    ::gpiod_line_bulk_add(&bank.bulk, *line);
    bank.lines.push_back(index);
    bank.mask |= line_bit(index);
    if (request.active_low) bank.levels |= line_bit(index);
    return Done{};
}

// Requests the bank's lines as outputs, inactive from the first moment.
Status hold(Bank& bank, std::span<const LineRequest> requests) {
    std::array<int, GPIOD_LINE_BULK_MAX_LINES> values{};
    for (std::size_t i = 0; i < bank.lines.size(); ++i)
        values[i] = requests[bank.lines[i]].active_low;
    if (::gpiod_line_request_bulk_output(&bank.bulk, line_consumer, values.data()) == 0)
        return Done{};
    return machine_error("cannot request the lines of " + bank.name + " as outputs (" +
                         requests[bank.lines.front()].purpose +
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
