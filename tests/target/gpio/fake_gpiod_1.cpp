// The functions of libgpiod 1.6 that target/gpio calls, on a FakeBoard.

#include <gpiod.h>

#include <memory>

#include "target/gpio/fake_board.h"

using lyr::tests::board;
using lyr::tests::Call;
using lyr::tests::FakeBoard;
using lyr::tests::FakeChip;
using lyr::tests::FakeEdge;
using lyr::tests::FakeLine;

struct gpiod_line {
    gpiod_chip* chip;
    unsigned number;
    bool held = false;
    FakeLine& fake() const;
};

struct gpiod_chip {
    FakeChip* fake;
    std::vector<std::unique_ptr<gpiod_line>> lines;
};

FakeLine& gpiod_line::fake() const {
    return chip->fake->lines.at(number);
}

namespace {

void let_go(gpiod_line& line) {
    if (line.held) FakeBoard::free(line.fake());
    line.held = false;
}

lyr::gpio::Pull pull_of(int flags) {
    if (flags & GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP) return lyr::gpio::Pull::up;
    if (flags & GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN) return lyr::gpio::Pull::down;
    if (flags & GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE) return lyr::gpio::Pull::none;
    return lyr::gpio::Pull::as_is;
}

}  // namespace

gpiod_chip* gpiod_chip_open(const char* path) {
    FakeChip* fake = board().chip_at(path);
    if (!fake) return nullptr;
    auto* chip = new gpiod_chip{fake, {}};
    for (unsigned i = 0; i < fake->lines.size(); ++i)
        chip->lines.push_back(std::make_unique<gpiod_line>(gpiod_line{chip, i}));
    return chip;
}

void gpiod_chip_close(gpiod_chip* chip) {
    for (const auto& line : chip->lines) let_go(*line);
    --board().opened;
    delete chip;
}

const char* gpiod_chip_name(gpiod_chip* chip) {
    return chip->fake->name.c_str();
}
const char* gpiod_chip_label(gpiod_chip* chip) {
    return chip->fake->label.c_str();
}
unsigned int gpiod_chip_num_lines(gpiod_chip* chip) {
    return static_cast<unsigned>(chip->lines.size());
}
gpiod_line* gpiod_chip_get_line(gpiod_chip* chip, unsigned int number) {
    return number < chip->lines.size() ? chip->lines[number].get() : nullptr;
}
gpiod_line* gpiod_chip_find_line(gpiod_chip* chip, const char* name) {
    for (const auto& line : chip->lines)
        if (line->fake().name == name) return line.get();
    return nullptr;
}

unsigned int gpiod_line_offset(gpiod_line* line) {
    return line->number;
}
const char* gpiod_line_name(gpiod_line* line) {
    return line->fake().name.empty() ? nullptr : line->fake().name.c_str();
}
const char* gpiod_line_consumer(gpiod_line* line) {
    return line->fake().user.empty() ? nullptr : line->fake().user.c_str();
}
bool gpiod_line_is_used(gpiod_line* line) {
    return !line->fake().user.empty();
}

int gpiod_line_request_bulk(gpiod_line_bulk* bulk, const gpiod_line_request_config* config,
                            const int* levels) {
    std::vector<unsigned> numbers;
    for (unsigned i = 0; i < bulk->num_lines; ++i) numbers.push_back(bulk->lines[i]->number);
    if (!board().take(*bulk->lines[0]->chip->fake, numbers, config->consumer)) return -1;
    for (unsigned i = 0; i < bulk->num_lines; ++i) {
        FakeLine& line = bulk->lines[i]->fake();
        bulk->lines[i]->held = true;
        line.output = config->request_type == GPIOD_LINE_REQUEST_DIRECTION_OUTPUT;
        line.drive = config->flags & GPIOD_LINE_REQUEST_FLAG_OPEN_DRAIN
                         ? lyr::gpio::Drive::open_drain
                         : lyr::gpio::Drive::push_pull;
        line.level = levels[i] != 0;
    }
    return 0;
}

int gpiod_line_set_value_bulk(gpiod_line_bulk* bulk, const int* levels) {
    ++board().sets;
    if (board().must_fail(Call::set)) return -1;
    for (unsigned i = 0; i < bulk->num_lines; ++i) {
        ++board().lines_set;
        FakeBoard::drive(bulk->lines[i]->fake(), levels[i] != 0);
    }
    return 0;
}

void gpiod_line_release_bulk(gpiod_line_bulk* bulk) {
    --board().requests;
    for (unsigned i = 0; i < bulk->num_lines; ++i) let_go(*bulk->lines[i]);
}

int gpiod_line_request_both_edges_events_flags(gpiod_line* line, const char* user, int flags) {
    if (!board().take(*line->chip->fake, {line->number}, user)) return -1;
    line->held = true;
    line->fake().pull = pull_of(flags);
    FakeBoard::watch(line->fake());
    return 0;
}

void gpiod_line_release(gpiod_line* line) {
    --board().requests;
    let_go(*line);
}

int gpiod_line_event_get_fd(gpiod_line* line) {
    return line->fake().pipe[0];
}

int gpiod_line_get_value(gpiod_line* line) {
    return board().must_fail(Call::read) ? -1 : FakeBoard::is_high(line->fake());
}

int gpiod_line_event_read_multiple(gpiod_line* line, gpiod_line_event* events, unsigned int room) {
    if (board().must_fail(Call::read)) return -1;
    unsigned count = 0;
    for (FakeEdge edge{}; count < room && FakeBoard::pop(line->fake(), edge); ++count) {
        events[count].ts = {static_cast<time_t>(edge.time_ns / 1'000'000'000),
                            static_cast<long>(edge.time_ns % 1'000'000'000)};
        events[count].event_type =
            edge.rising ? GPIOD_LINE_EVENT_RISING_EDGE : GPIOD_LINE_EVENT_FALLING_EDGE;
    }
    return static_cast<int>(count);
}
