// One bulk request a kernel chip. The request's lines are all set by every ioctl on it, so that the
// levels of lines that do not change are repeated from memory.

#include "target/gpio/gpiod_chip.h"

#include <gpiod.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

namespace lyr::gpio {
namespace {

constexpr const char* consumer = "lyrrun";

Diagnostic machine_error(std::string message) {
    return {Severity::error, ExitStatus::machine, std::move(message), {}};
}

std::string line_text(const LineRequest& request) {
    const auto* number = std::get_if<std::uint32_t>(&request.line);
    const std::string line =
        number ? std::to_string(*number) : '"' + std::get<std::string>(request.line) + '"';
    return request.purpose + ": line " + line + " of " + request.chip;
}

struct CloseChip {
    // Closing a chip releases all lines held through it.
    void operator()(gpiod_chip* chip) const { ::gpiod_chip_close(chip); }
};

// The lines held on one kernel chip.
struct Bank {
    std::unique_ptr<gpiod_chip, CloseChip> chip;
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

Diagnostic cannot_open(const LineRequest& request, int error) {
    std::string message =
        request.purpose + ": cannot open GPIO chip " + request.chip + ": " + std::strerror(error);
    if (error == EACCES || error == EPERM)
        message += "; add the user to the group of /dev/gpiochip* (often: gpio)";
    else
        message += "; `gpiodetect` lists the chips of this machine";
    return machine_error(std::move(message));
}

// The bank of the request's kernel chip, opened if it is the first line there. Two ways to write
// the same chip ("0", "gpiochip0") are the same bank.
Result<std::size_t> bank_for(std::vector<Bank>& banks, const LineRequest& request) {
    // The library would take an empty name for chip number 0.
    if (request.chip.empty()) return cannot_open(request, ENODEV);
    errno = 0;
    std::unique_ptr<gpiod_chip, CloseChip> chip(::gpiod_chip_open_lookup(request.chip.c_str()));
    if (!chip) return cannot_open(request, errno ? errno : ENODEV);
    const std::string name = ::gpiod_chip_name(chip.get());
    const auto known = std::find_if(banks.begin(), banks.end(),
                                    [&](const Bank& bank) { return bank.name == name; });
    if (known != banks.end()) return static_cast<std::size_t>(known - banks.begin());
    banks.emplace_back();
    banks.back().chip = std::move(chip);
    banks.back().name = name;
    return banks.size() - 1;
}

Result<gpiod_line*> find_line(gpiod_chip* chip, const LineRequest& request) {
    gpiod_line* line = nullptr;
    if (const auto* number = std::get_if<std::uint32_t>(&request.line)) {
        const unsigned int count = ::gpiod_chip_num_lines(chip);
        if (*number >= count)
            return machine_error(line_text(request) + " does not exist: the chip has lines 0 to " +
                                 std::to_string(count - 1));
        line = ::gpiod_chip_get_line(chip, *number);
    } else {
        line = ::gpiod_chip_find_line(chip, std::get<std::string>(request.line).c_str());
    }
    if (!line)
        return machine_error(line_text(request) + " was not found; `gpioinfo " + request.chip +
                             "` lists the lines");
    if (::gpiod_line_is_used(line)) {
        const char* user = ::gpiod_line_consumer(line);
        return machine_error(line_text(request) + " is already held by " +
                             (user ? user : "the kernel") +
                             "; choose another line or end its user");
    }
    return line;
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
    if (::gpiod_line_request_bulk_output(&bank.bulk, consumer, values.data()) == 0) return Done{};
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
