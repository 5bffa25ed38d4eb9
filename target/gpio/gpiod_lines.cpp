#include "target/gpio/gpiod_lines.h"

#include <cerrno>
#include <cstring>
#include <utility>

namespace lyr::gpio {
namespace {

Diagnostic cannot_open(const LineRequest& request, int error) {
    std::string message =
        request.purpose + ": cannot open GPIO chip " + request.chip + ": " + std::strerror(error);
    if (error == EACCES || error == EPERM)
        message += "; add the user to the group of /dev/gpiochip* (often: gpio)";
    else
        message += "; `gpiodetect` lists the chips of this machine";
    return machine_error(std::move(message));
}

}  // namespace

Diagnostic machine_error(std::string message) {
    return {Severity::error, ExitStatus::machine, std::move(message), {}};
}

std::string line_text(const LineRequest& request) {
    const auto* number = std::get_if<std::uint32_t>(&request.line);
    const std::string line =
        number ? std::to_string(*number) : '"' + std::get<std::string>(request.line) + '"';
    return request.purpose + ": line " + line + " of " + request.chip;
}

Result<ChipHandle> open_chip(const LineRequest& request) {
    // The library would take an empty name for chip number 0.
    if (request.chip.empty()) return cannot_open(request, ENODEV);
    errno = 0;
    ChipHandle chip(::gpiod_chip_open_lookup(request.chip.c_str()));
    if (!chip) return cannot_open(request, errno ? errno : ENODEV);
    return chip;
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

}  // namespace lyr::gpio
