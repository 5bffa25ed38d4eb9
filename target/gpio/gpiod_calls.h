// The calls that libgpiod 1.6 and 2.x spell differently, and nothing more: what a request means, which lines
// go together and what is said when one fails is gpiod_chip.cpp's. One of gpiod_calls_1.cpp and
// gpiod_calls_2.cpp is built. Private to this room.
//
// Contract
//  1. What fails leaves errno at the reason.
//  2. Levels are physical here: 1 is high, whatever the line is used for.
//  3. hold() asks for all lines in one request: either every one of them is an output at its level, or none is
//     held. `lines` outlives what is held.
//  4. set() is one system call. It gives the lines in `which` their bit of `levels`; those of the other lines
//     must be what they have, since they may be set too.
//  5. watch() asks for an input whose edges are kept, kept_edges of them. take() gives the oldest, as many as there
//     are and there is room for, or -1.
//  6. set(), level() and take() allocate nothing.

#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "target/gpio/input_lines.h"

namespace lyr::gpio::calls {

struct Chip;
struct CloseChip {
    void operator()(Chip* chip) const;
};
using ChipHandle = std::unique_ptr<Chip, CloseChip>;

ChipHandle open(const std::string& path);

struct ChipFacts {
    std::string name, label;
    std::uint32_t line_count = 0;
};
std::optional<ChipFacts> facts(Chip& chip);

// The number of the first line of this name.
std::optional<std::uint32_t> find(Chip& chip, const std::string& name);

struct LineFacts {
    std::string name;
    std::optional<std::string> user;  // who holds it
};
std::optional<LineFacts> facts(Chip& chip, std::uint32_t number);

struct OutputLine {
    std::size_t bit = 0;       // in the masks of set()
    std::uint32_t number = 0;  // on its chip
    bool level = false;        // from the first moment
    Drive drive = Drive::push_pull;
};

// Whether one request may hold lines that differ in drive: the kernel's first interface, which 1.6 uses, has
// one for all of a request.
bool holds_unlike_lines();

struct Held;
struct Release {
    void operator()(Held* held) const;
};
using HeldHandle = std::unique_ptr<Held, Release>;

HeldHandle hold(Chip& chip, std::span<const OutputLine> lines, const char* user);
bool set(Held& held, LineMask which, LineMask levels);

inline constexpr std::size_t kept_edges = 16;

struct Watched;
struct Unwatch {
    void operator()(Watched* watched) const;
};
using WatchedHandle = std::unique_ptr<Watched, Unwatch>;

struct KernelEdge {
    std::int64_t time_ns = 0;
    bool level = false;  // afterwards
};

WatchedHandle watch(Chip& chip, std::uint32_t number, Pull pull, const char* user);
// Readable while there are edges.
int descriptor(const Watched& watched);
std::optional<bool> level(Watched& watched);
int take(Watched& watched, std::span<KernelEdge> edges);

}  // namespace lyr::gpio::calls
