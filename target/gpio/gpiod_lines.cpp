// libgpiod 2.x opens chips by path only, so that names are looked up here for both versions.

#include "target/gpio/gpiod_lines.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

namespace lyr::gpio {
namespace {

constexpr const char* device_prefix = "gpiochip";

Diagnostic cannot_open(const LineRequest& request, int error) {
    std::string message =
        request.purpose + ": cannot open GPIO chip " + request.chip + ": " + std::strerror(error);
    if (error == EACCES || error == EPERM)
        message += "; add the user to the group of /dev/gpiochip* (often: gpio)";
    else
        message += "; `gpiodetect` lists the chips of this machine";
    return machine_error(std::move(message));
}

// Without handle: errno says why.
OpenChip open_path(const std::string& path) {
    OpenChip chip{calls::open(path), {}};
    if (!chip.handle) return chip;
    if (auto facts = calls::facts(*chip.handle))
        chip.facts = std::move(*facts);
    else
        chip.handle.reset();
    return chip;
}

OpenChip open_label(const std::string& label, const std::string& devices) {
    std::vector<std::string> paths;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(devices, none))
        if (entry.path().filename().string().starts_with(device_prefix))
            paths.push_back(entry.path().string());
    std::sort(paths.begin(), paths.end());
    int error = ENODEV;
    for (const std::string& path : paths) {
        OpenChip chip = open_path(path);
        if (chip.handle && chip.facts.label == label) return chip;
        // It may be the one.
        if (!chip.handle && errno == EACCES) error = EACCES;
    }
    errno = error;
    return {};
}

OpenChip open_named(const std::string& name, const std::string& devices) {
    if (name.front() == '/') return open_path(name);
    const bool is_number = name.find_first_not_of("0123456789") == std::string::npos;
    const std::string device = is_number ? device_prefix + name : name;
    if (device.starts_with(device_prefix)) return open_path(devices + '/' + device);
    return open_label(name, devices);
}

}  // namespace

std::string line_text(const LineRequest& request) {
    const auto* number = std::get_if<std::uint32_t>(&request.line);
    const std::string line =
        number ? std::to_string(*number) : '"' + std::get<std::string>(request.line) + '"';
    return request.purpose + ": line " + line + " of " + request.chip;
}

Result<OpenChip> open_chip(const LineRequest& request, const std::string& devices) {
    if (request.chip.empty()) return cannot_open(request, ENODEV);
    OpenChip chip = open_named(request.chip, devices);
    if (!chip.handle) return cannot_open(request, errno);
    return chip;
}

Result<FoundLine> find_line(const OpenChip& chip, const LineRequest& request) {
    std::optional<std::uint32_t> number;
    if (const auto* stated = std::get_if<std::uint32_t>(&request.line)) {
        if (*stated >= chip.facts.line_count)
            return machine_error(line_text(request) + " does not exist: the chip has lines 0 to " +
                                 std::to_string(chip.facts.line_count - 1));
        number = *stated;
    } else {
        number = calls::find(*chip.handle, std::get<std::string>(request.line));
    }
    auto facts = number ? calls::facts(*chip.handle, *number) : std::nullopt;
    if (!facts)
        return machine_error(line_text(request) + " was not found; `gpioinfo " + request.chip +
                             "` lists the lines");
    return FoundLine{chip.facts.name, *number, std::move(facts->name), std::move(facts->user)};
}

Result<std::uint32_t> free_line(const OpenChip& chip, const LineRequest& request) {
    const Result<FoundLine> found = find_line(chip, request);
    if (!found) return found.error();
    if (found->user)
        return machine_error(line_text(request) + " is already held by " + *found->user +
                             "; choose another line or end its user");
    return found->number;
}

Result<FoundLine> look_up_line(const LineRequest& request) {
    const Result<OpenChip> chip = open_chip(request);
    if (!chip) return chip.error();
    return find_line(*chip, request);
}

}  // namespace lyr::gpio
