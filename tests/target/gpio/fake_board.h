// A board without a kernel: what fake_gpiod_1.cpp and fake_gpiod_2.cpp, which stand in for libgpiod, do to it, and
// what a test lets it do. So one test source holds both versions' use of the library to the same contract.

#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "target/gpio/input_lines.h"

namespace lyr::tests {

struct FakeEdge {
    std::int64_t time_ns;
    bool rising;
};

struct FakeLine {
    std::string name, user;
    bool output = false, watched = false;
    bool level = false;  // of the wire
    int rises = 0;       // as an output
    gpio::Drive drive = gpio::Drive::push_pull;
    gpio::Pull pull = gpio::Pull::as_is;
    std::deque<FakeEdge> edges;
    std::array<int, 2> pipe{-1, -1};  // one byte an edge, so that it can be polled
};

struct FakeChip {
    std::string name, label;
    std::vector<FakeLine> lines;
};

enum class Call { open, request, set, read };

struct FakeBoard {
    std::deque<FakeChip> chips;
    int opened = 0;    // handles of chips
    int requests = 0;  // held
    int sets = 0;      // calls that set levels
    int lines_set = 0;
    bool fails = false;  // the next call of `failing`
    Call failing = Call::set;

    // errno is set as the kernel would.
    bool must_fail(Call call);
    FakeChip* chip_at(const std::string& path);
    // A request's: false, and nothing is taken, if any of them is held.
    bool take(FakeChip& chip, const std::vector<unsigned>& numbers, const char* user);
    // These may be called from several threads: a wire may turn while the program runs.
    static void watch(FakeLine& line);
    static void free(FakeLine& line);
    static void drive(FakeLine& line, bool level);
    static bool is_high(const FakeLine& line);
    static int rises_of(const FakeLine& line);
    // What happens at the wire.
    static void turn(FakeLine& line, bool level, std::int64_t time_ns);
    static bool pop(FakeLine& line, FakeEdge& edge);
};

FakeBoard& board();

}  // namespace lyr::tests
