// libgpiod 2.x: a request is an object made from settings a line, and setting any of its lines leaves the
// others alone.

#include <gpiod.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "target/gpio/gpiod_calls.h"

namespace lyr::gpio::calls {
namespace {

// What the library hands out belongs to the caller, and each kind has a function of its own to free it.
template <class T>
using Owned = std::unique_ptr<T, void (*)(T*)>;
template <class T>
Owned<T> owned(T* thing, void (*free)(T*)) {
    return {thing, free};
}

gpiod_line_bias bias_of(Pull pull) {
    switch (pull) {
        case Pull::as_is:
            break;
        case Pull::up:
            return GPIOD_LINE_BIAS_PULL_UP;
        case Pull::down:
            return GPIOD_LINE_BIAS_PULL_DOWN;
        case Pull::none:
            return GPIOD_LINE_BIAS_DISABLED;
    }
    return GPIOD_LINE_BIAS_AS_IS;
}

gpiod_line_value value_of(bool level) {
    return level ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
}

// A request while it is put together.
struct Draft {
    explicit Draft(const char* user) {
        if (whole()) ::gpiod_request_config_set_consumer(request.get(), user);
    }
    bool whole() const { return request && lines && settings; }
    // With the settings as they are.
    bool add(std::uint32_t number) {
        return ::gpiod_line_config_add_line_settings(lines.get(), &number, 1, settings.get()) == 0;
    }
    gpiod_line_request* of(Chip& chip);

    Owned<gpiod_request_config> request =
        owned(::gpiod_request_config_new(), ::gpiod_request_config_free);
    Owned<gpiod_line_config> lines = owned(::gpiod_line_config_new(), ::gpiod_line_config_free);
    Owned<gpiod_line_settings> settings =
        owned(::gpiod_line_settings_new(), ::gpiod_line_settings_free);
};

bool make_output(gpiod_line_settings* settings, const OutputLine& line) {
    const gpiod_line_drive drive =
        line.drive == Drive::open_drain ? GPIOD_LINE_DRIVE_OPEN_DRAIN : GPIOD_LINE_DRIVE_PUSH_PULL;
    return ::gpiod_line_settings_set_direction(settings, GPIOD_LINE_DIRECTION_OUTPUT) == 0 &&
           ::gpiod_line_settings_set_drive(settings, drive) == 0 &&
           ::gpiod_line_settings_set_output_value(settings, value_of(line.level)) == 0;
}

bool make_watched(gpiod_line_settings* settings, Pull pull) {
    return ::gpiod_line_settings_set_direction(settings, GPIOD_LINE_DIRECTION_INPUT) == 0 &&
           ::gpiod_line_settings_set_edge_detection(settings, GPIOD_LINE_EDGE_BOTH) == 0 &&
           ::gpiod_line_settings_set_bias(settings, bias_of(pull)) == 0;
}

}  // namespace

struct Chip {
    gpiod_chip* open;
};

struct Held {
    gpiod_line_request* request = nullptr;
    std::span<const OutputLine> lines;
};

struct Watched {
    gpiod_line_request* request;
    std::uint32_t number;
    gpiod_edge_event_buffer* buffer;
};

gpiod_line_request* Draft::of(Chip& chip) {
    return ::gpiod_chip_request_lines(chip.open, request.get(), lines.get());
}

void CloseChip::operator()(Chip* chip) const {
    ::gpiod_chip_close(chip->open);
    delete chip;
}

ChipHandle open(const std::string& path) {
    gpiod_chip* chip = ::gpiod_chip_open(path.c_str());
    return ChipHandle(chip ? new Chip{chip} : nullptr);
}

std::optional<ChipFacts> facts(Chip& chip) {
    const auto info = owned(::gpiod_chip_get_info(chip.open), ::gpiod_chip_info_free);
    if (!info) return std::nullopt;
    return ChipFacts{::gpiod_chip_info_get_name(info.get()),
                     ::gpiod_chip_info_get_label(info.get()),
                     static_cast<std::uint32_t>(::gpiod_chip_info_get_num_lines(info.get()))};
}

std::optional<std::uint32_t> find(Chip& chip, const std::string& name) {
    const int number = ::gpiod_chip_get_line_offset_from_name(chip.open, name.c_str());
    if (number < 0) return std::nullopt;
    return static_cast<std::uint32_t>(number);
}

std::optional<LineFacts> facts(Chip& chip, std::uint32_t number) {
    const auto info = owned(::gpiod_chip_get_line_info(chip.open, number), ::gpiod_line_info_free);
    if (!info) return std::nullopt;
    LineFacts facts;
    if (const char* name = ::gpiod_line_info_get_name(info.get())) facts.name = name;
    if (!::gpiod_line_info_is_used(info.get())) return facts;
    const char* user = ::gpiod_line_info_get_consumer(info.get());
    facts.user = user ? user : "the kernel";
    return facts;
}

bool holds_unlike_lines() {
    return true;
}

void Release::operator()(Held* held) const {
    ::gpiod_line_request_release(held->request);
    delete held;
}

HeldHandle hold(Chip& chip, std::span<const OutputLine> lines, const char* user) {
    Draft draft(user);
    if (!draft.whole()) return nullptr;
    for (const OutputLine& line : lines)
        if (!make_output(draft.settings.get(), line) || !draft.add(line.number)) return nullptr;
    gpiod_line_request* request = draft.of(chip);
    return HeldHandle(request ? new Held{request, lines} : nullptr);
}

bool set(Held& held, LineMask which, LineMask levels) {
    std::array<unsigned int, max_lines> numbers{};
    std::array<gpiod_line_value, max_lines> values{};
    std::size_t count = 0;
    for (const OutputLine& line : held.lines) {
        if (!(which & line_bit(line.bit))) continue;
        numbers[count] = line.number;
        values[count++] = value_of((levels & line_bit(line.bit)) != 0);
    }
    return ::gpiod_line_request_set_values_subset(held.request, count, numbers.data(),
                                                  values.data()) == 0;
}

void Unwatch::operator()(Watched* watched) const {
    ::gpiod_edge_event_buffer_free(watched->buffer);
    ::gpiod_line_request_release(watched->request);
    delete watched;
}

WatchedHandle watch(Chip& chip, std::uint32_t number, Pull pull, const char* user) {
    Draft draft(user);
    auto buffer = owned(::gpiod_edge_event_buffer_new(kept_edges), ::gpiod_edge_event_buffer_free);
    if (!draft.whole() || !buffer || !make_watched(draft.settings.get(), pull) ||
        !draft.add(number))
        return nullptr;
    ::gpiod_request_config_set_event_buffer_size(draft.request.get(), kept_edges);
    gpiod_line_request* request = draft.of(chip);
    return WatchedHandle(request ? new Watched{request, number, buffer.release()} : nullptr);
}

int descriptor(const Watched& watched) {
    return ::gpiod_line_request_get_fd(watched.request);
}

std::optional<bool> level(Watched& watched) {
    const gpiod_line_value value = ::gpiod_line_request_get_value(watched.request, watched.number);
    if (value == GPIOD_LINE_VALUE_ERROR) return std::nullopt;
    return value == GPIOD_LINE_VALUE_ACTIVE;
}

int take(Watched& watched, std::span<KernelEdge> edges) {
    const int count = ::gpiod_line_request_read_edge_events(watched.request, watched.buffer,
                                                            std::min(edges.size(), kept_edges));
    for (std::size_t i = 0; i < static_cast<std::size_t>(std::max(count, 0)); ++i) {
        gpiod_edge_event* event = ::gpiod_edge_event_buffer_get_event(watched.buffer, i);
        edges[i] = {static_cast<std::int64_t>(::gpiod_edge_event_get_timestamp_ns(event)),
                    ::gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE};
    }
    return count;
}

}  // namespace lyr::gpio::calls
