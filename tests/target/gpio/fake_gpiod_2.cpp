// The functions of libgpiod 2.x that target/gpio calls, on a FakeBoard.

#include <gpiod.h>

#include <cstring>
#include <map>

#include "target/gpio/fake_board.h"

using lyr::tests::board;
using lyr::tests::Call;
using lyr::tests::FakeBoard;
using lyr::tests::FakeChip;
using lyr::tests::FakeEdge;
using lyr::tests::FakeLine;

struct gpiod_chip {
    FakeChip* fake;
};
struct gpiod_chip_info {
    FakeChip* fake;
};
struct gpiod_line_info {
    FakeLine* fake;
};
struct gpiod_line_settings {
    gpiod_line_direction direction = GPIOD_LINE_DIRECTION_AS_IS;
    gpiod_line_edge edges = GPIOD_LINE_EDGE_NONE;
    gpiod_line_bias bias = GPIOD_LINE_BIAS_AS_IS;
    gpiod_line_drive drive = GPIOD_LINE_DRIVE_PUSH_PULL;
    gpiod_line_value value = GPIOD_LINE_VALUE_INACTIVE;
};
struct gpiod_line_config {
    std::map<unsigned, gpiod_line_settings> lines;
};
struct gpiod_request_config {
    std::string user;
    std::size_t kept = 0;
};
struct gpiod_line_request {
    FakeChip* fake;
    std::vector<unsigned> numbers;
};
struct gpiod_edge_event {
    FakeEdge fake;
};
struct gpiod_edge_event_buffer {
    std::vector<gpiod_edge_event> events;
};

namespace {

lyr::gpio::Pull pull_of(gpiod_line_bias bias) {
    if (bias == GPIOD_LINE_BIAS_PULL_UP) return lyr::gpio::Pull::up;
    if (bias == GPIOD_LINE_BIAS_PULL_DOWN) return lyr::gpio::Pull::down;
    if (bias == GPIOD_LINE_BIAS_DISABLED) return lyr::gpio::Pull::none;
    return lyr::gpio::Pull::as_is;
}

void begin(FakeLine& line, const gpiod_line_settings& settings) {
    line.output = settings.direction == GPIOD_LINE_DIRECTION_OUTPUT;
    line.drive = settings.drive == GPIOD_LINE_DRIVE_OPEN_DRAIN ? lyr::gpio::Drive::open_drain
                                                               : lyr::gpio::Drive::push_pull;
    line.pull = pull_of(settings.bias);
    if (line.output) line.level = settings.value == GPIOD_LINE_VALUE_ACTIVE;
    if (settings.edges == GPIOD_LINE_EDGE_BOTH) FakeBoard::watch(line);
}

}  // namespace

gpiod_chip* gpiod_chip_open(const char* path) {
    FakeChip* fake = board().chip_at(path);
    return fake ? new gpiod_chip{fake} : nullptr;
}
void gpiod_chip_close(gpiod_chip* chip) {
    --board().opened;
    delete chip;
}

gpiod_chip_info* gpiod_chip_get_info(gpiod_chip* chip) {
    return new gpiod_chip_info{chip->fake};
}
void gpiod_chip_info_free(gpiod_chip_info* info) {
    delete info;
}
const char* gpiod_chip_info_get_name(gpiod_chip_info* info) {
    return info->fake->name.c_str();
}
const char* gpiod_chip_info_get_label(gpiod_chip_info* info) {
    return info->fake->label.c_str();
}
size_t gpiod_chip_info_get_num_lines(gpiod_chip_info* info) {
    return info->fake->lines.size();
}

int gpiod_chip_get_line_offset_from_name(gpiod_chip* chip, const char* name) {
    for (std::size_t i = 0; i < chip->fake->lines.size(); ++i)
        if (chip->fake->lines[i].name == name) return static_cast<int>(i);
    return -1;
}
gpiod_line_info* gpiod_chip_get_line_info(gpiod_chip* chip, unsigned int number) {
    return number < chip->fake->lines.size() ? new gpiod_line_info{&chip->fake->lines[number]}
                                             : nullptr;
}
void gpiod_line_info_free(gpiod_line_info* info) {
    delete info;
}
const char* gpiod_line_info_get_name(gpiod_line_info* info) {
    return info->fake->name.empty() ? nullptr : info->fake->name.c_str();
}
bool gpiod_line_info_is_used(gpiod_line_info* info) {
    return !info->fake->user.empty();
}
const char* gpiod_line_info_get_consumer(gpiod_line_info* info) {
    return info->fake->user.empty() ? nullptr : info->fake->user.c_str();
}

gpiod_line_settings* gpiod_line_settings_new() {
    return new gpiod_line_settings;
}
void gpiod_line_settings_free(gpiod_line_settings* settings) {
    delete settings;
}
void gpiod_line_settings_reset(gpiod_line_settings* settings) {
    *settings = {};
}
int gpiod_line_settings_set_direction(gpiod_line_settings* settings, gpiod_line_direction value) {
    settings->direction = value;
    return 0;
}
int gpiod_line_settings_set_edge_detection(gpiod_line_settings* settings, gpiod_line_edge value) {
    settings->edges = value;
    return 0;
}
int gpiod_line_settings_set_bias(gpiod_line_settings* settings, gpiod_line_bias value) {
    settings->bias = value;
    return 0;
}
int gpiod_line_settings_set_drive(gpiod_line_settings* settings, gpiod_line_drive value) {
    settings->drive = value;
    return 0;
}
int gpiod_line_settings_set_output_value(gpiod_line_settings* settings, gpiod_line_value value) {
    settings->value = value;
    return 0;
}

gpiod_line_config* gpiod_line_config_new() {
    return new gpiod_line_config;
}
void gpiod_line_config_free(gpiod_line_config* config) {
    delete config;
}
int gpiod_line_config_add_line_settings(gpiod_line_config* config, const unsigned int* numbers,
                                        size_t count, gpiod_line_settings* settings) {
    for (std::size_t i = 0; i < count; ++i) config->lines[numbers[i]] = *settings;
    return 0;
}

gpiod_request_config* gpiod_request_config_new() {
    return new gpiod_request_config;
}
void gpiod_request_config_free(gpiod_request_config* config) {
    delete config;
}
void gpiod_request_config_set_consumer(gpiod_request_config* config, const char* user) {
    config->user = user;
}
void gpiod_request_config_set_event_buffer_size(gpiod_request_config* config, size_t size) {
    config->kept = size;
}

gpiod_line_request* gpiod_chip_request_lines(gpiod_chip* chip, gpiod_request_config* request,
                                             gpiod_line_config* config) {
    std::vector<unsigned> numbers;
    for (const auto& [number, settings] : config->lines) numbers.push_back(number);
    if (!board().take(*chip->fake, numbers, request->user.c_str())) return nullptr;
    for (const auto& [number, settings] : config->lines) begin(chip->fake->lines[number], settings);
    return new gpiod_line_request{chip->fake, numbers};
}
void gpiod_line_request_release(gpiod_line_request* request) {
    --board().requests;
    for (const unsigned number : request->numbers) FakeBoard::free(request->fake->lines[number]);
    delete request;
}
int gpiod_line_request_set_values_subset(gpiod_line_request* request, size_t count,
                                         const unsigned int* numbers,
                                         const gpiod_line_value* values) {
    ++board().sets;
    if (board().must_fail(Call::set)) return -1;
    for (std::size_t i = 0; i < count; ++i) {
        ++board().lines_set;
        FakeBoard::drive(request->fake->lines.at(numbers[i]), values[i] == GPIOD_LINE_VALUE_ACTIVE);
    }
    return 0;
}
gpiod_line_value gpiod_line_request_get_value(gpiod_line_request* request, unsigned int number) {
    if (board().must_fail(Call::read)) return GPIOD_LINE_VALUE_ERROR;
    return FakeBoard::is_high(request->fake->lines.at(number)) ? GPIOD_LINE_VALUE_ACTIVE
                                                               : GPIOD_LINE_VALUE_INACTIVE;
}
int gpiod_line_request_get_fd(gpiod_line_request* request) {
    return request->fake->lines.at(request->numbers.front()).pipe[0];
}

gpiod_edge_event_buffer* gpiod_edge_event_buffer_new(size_t size) {
    auto* buffer = new gpiod_edge_event_buffer;
    buffer->events.resize(size);
    return buffer;
}
void gpiod_edge_event_buffer_free(gpiod_edge_event_buffer* buffer) {
    delete buffer;
}
gpiod_edge_event* gpiod_edge_event_buffer_get_event(gpiod_edge_event_buffer* buffer,
                                                    unsigned long index) {
    return &buffer->events.at(index);
}
int gpiod_line_request_read_edge_events(gpiod_line_request* request,
                                        gpiod_edge_event_buffer* buffer, size_t room) {
    if (board().must_fail(Call::read)) return -1;
    FakeLine& line = request->fake->lines.at(request->numbers.front());
    std::size_t count = 0;
    while (count < room && FakeBoard::pop(line, buffer->events.at(count).fake)) ++count;
    return static_cast<int>(count);
}
uint64_t gpiod_edge_event_get_timestamp_ns(gpiod_edge_event* event) {
    return static_cast<std::uint64_t>(event->fake.time_ns);
}
gpiod_edge_event_type gpiod_edge_event_get_event_type(gpiod_edge_event* event) {
    return event->fake.rising ? GPIOD_EDGE_EVENT_RISING_EDGE : GPIOD_EDGE_EVENT_FALLING_EDGE;
}
