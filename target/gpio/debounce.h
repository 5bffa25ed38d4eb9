// Which edges of an input line count: contacts bounce for a millisecond or so, and long cables catch pulses of motors.
//
// Method. A new level counts once it has lasted; it then counts from the edge on that began it, or, where the contact
// bounced, from the first edge since the old level last lasted. So what a contact's bounce costs is time until one
// knows, and nothing of where the machine was.
//
// Contract
//  1. A level that lasts for `settle_ns` is told once, with the time of the first edge away from the level told before.
//  2. A pulse that is shorter, alone, is told never; with settle_ns = 0 every edge is told at once.
//  3. Edges come in order of time; settled(now) knows of all that came before `now`.

#pragma once

#include <cstdint>
#include <optional>

#include "target/gpio/input_lines.h"

namespace lyr::gpio {

class Debounce {
public:
    Debounce(std::int64_t settle_ns, bool active)
        : settle_ns_(settle_ns), told_(active), level_(active) {}

    void edge(const InputEdge& edge);
    // The level that has settled since the last call, if it is another than that told before.
    std::optional<InputEdge> settled(std::int64_t now_ns);
    // As told last.
    bool active() const { return told_; }
    // The last edge is that long ago.
    bool is_quiet(std::int64_t now_ns) const { return now_ns - changed_ns_ >= settle_ns_; }

private:
    std::int64_t settle_ns_;
    bool told_, level_;
    std::uint8_t line_ = 0;
    std::int64_t first_ns_ = 0;    // the first edge away from what was told
    std::int64_t changed_ns_ = 0;  // the last edge
    bool away_ = false;            // first_ns_ is one
};

}  // namespace lyr::gpio
