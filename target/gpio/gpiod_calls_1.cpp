// libgpiod 1.6: lines are objects of their chip, a request is a bulk of them, and setting it sets them all.

#include <gpiod.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "target/gpio/clock.h"
#include "target/gpio/gpiod_calls.h"

namespace lyr::gpio::calls {
namespace {

int flags_of(Drive drive) {
    return drive == Drive::open_drain ? GPIOD_LINE_REQUEST_FLAG_OPEN_DRAIN : 0;
}

int flags_of(Pull pull) {
    switch (pull) {
        case Pull::as_is:
            break;
        case Pull::up:
            return GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
        case Pull::down:
            return GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
        case Pull::none:
            return GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
    }
    return 0;
}

}  // namespace

struct Chip {
    gpiod_chip* open;
};

struct Held {
    gpiod_line_bulk bulk{};
    std::span<const OutputLine> lines;
};

struct Watched {
    gpiod_line* line;
};

void CloseChip::operator()(Chip* chip) const {
    ::gpiod_chip_close(chip->open);
    delete chip;
}

ChipHandle open(const std::string& path) {
    errno = 0;
    gpiod_chip* chip = ::gpiod_chip_open(path.c_str());
    // The library does not say why where the file is none of a chip.
    if (!chip && errno == 0) errno = ENODEV;
    return ChipHandle(chip ? new Chip{chip} : nullptr);
}

std::optional<ChipFacts> facts(Chip& chip) {
    return ChipFacts{::gpiod_chip_name(chip.open), ::gpiod_chip_label(chip.open),
                     ::gpiod_chip_num_lines(chip.open)};
}

std::optional<std::uint32_t> find(Chip& chip, const std::string& name) {
    gpiod_line* line = ::gpiod_chip_find_line(chip.open, name.c_str());
    if (!line) return std::nullopt;
    return ::gpiod_line_offset(line);
}

std::optional<LineFacts> facts(Chip& chip, std::uint32_t number) {
    gpiod_line* line = ::gpiod_chip_get_line(chip.open, number);
    if (!line) return std::nullopt;
    LineFacts facts;
    if (const char* name = ::gpiod_line_name(line)) facts.name = name;
    if (!::gpiod_line_is_used(line)) return facts;
    const char* user = ::gpiod_line_consumer(line);
    facts.user = user ? user : "the kernel";
    return facts;
}

bool holds_unlike_lines() {
    return false;
}

void Release::operator()(Held* held) const {
    ::gpiod_line_release_bulk(&held->bulk);
    delete held;
}

HeldHandle hold(Chip& chip, std::span<const OutputLine> lines, const char* user) {
    // Not a HeldHandle yet: only what is held may be released.
    auto held = std::make_unique<Held>();
    held->lines = lines;
    std::array<int, GPIOD_LINE_BULK_MAX_LINES> levels{};
    for (const OutputLine& wanted : lines) {
        gpiod_line* line = ::gpiod_chip_get_line(chip.open, wanted.number);
        if (!line) return nullptr;
        levels[held->bulk.num_lines] = wanted.level;
        ::gpiod_line_bulk_add(&held->bulk, line);
    }
    const gpiod_line_request_config config{user, GPIOD_LINE_REQUEST_DIRECTION_OUTPUT,
                                           flags_of(lines.front().drive)};
    if (::gpiod_line_request_bulk(&held->bulk, &config, levels.data()) != 0) return nullptr;
    return HeldHandle(held.release());
}

bool set(Held& held, LineMask, LineMask levels) {
    std::array<int, GPIOD_LINE_BULK_MAX_LINES> values{};
    std::size_t next = 0;
    for (const OutputLine& line : held.lines) values[next++] = (levels & line_bit(line.bit)) != 0;
    return ::gpiod_line_set_value_bulk(&held.bulk, values.data()) == 0;
}

void Unwatch::operator()(Watched* watched) const {
    ::gpiod_line_release(watched->line);
    delete watched;
}

WatchedHandle watch(Chip& chip, std::uint32_t number, Pull pull, const char* user) {
    gpiod_line* line = ::gpiod_chip_get_line(chip.open, number);
    if (!line || ::gpiod_line_request_both_edges_events_flags(line, user, flags_of(pull)) != 0)
        return nullptr;
    return WatchedHandle(new Watched{line});
}

int descriptor(const Watched& watched) {
    return ::gpiod_line_event_get_fd(watched.line);
}

std::optional<bool> level(Watched& watched) {
    const int value = ::gpiod_line_get_value(watched.line);
    if (value < 0) return std::nullopt;
    return value != 0;
}

int take(Watched& watched, std::span<KernelEdge> edges) {
    std::array<gpiod_line_event, kept_edges> events{};
    const auto room = static_cast<unsigned>(std::min(edges.size(), events.size()));
    const int count = ::gpiod_line_event_read_multiple(watched.line, events.data(), room);
    for (std::size_t i = 0; i < static_cast<std::size_t>(std::max(count, 0)); ++i)
        edges[i] = {ns_of(events[i].ts), events[i].event_type == GPIOD_LINE_EVENT_RISING_EDGE};
    return count;
}

}  // namespace lyr::gpio::calls
