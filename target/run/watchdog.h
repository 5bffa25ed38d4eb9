// The board's watchdog, which restarts the board when nobody feeds it, and so switches all lines off whatever became of
// the program and the kernel; and the init system that started the program, which may do the same with the program.
//
// Contract
//  1. Watchdog::open() starts the device with the timeout that is asked for, or the driver's own where it cannot be set.
//     Errors (status machine): it cannot be opened.
//  2. One that was fed and is destroyed in order is stopped ("V"); one whose program crashed or hangs is not.
//  3. notify() tells the init system (sd_notify(3)) what goes on, if it asked for that by $NOTIFY_SOCKET; it never waits.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "base/diagnostic.h"
#include "target/config/life.h"

namespace lyr::run {

class Watchdog {
public:
    static Result<Watchdog> open(const config::WatchdogSettings& settings);
    Watchdog(Watchdog&& other) noexcept;
    Watchdog& operator=(Watchdog&&) = delete;
    ~Watchdog();

    void feed();

private:
    explicit Watchdog(int descriptor) : descriptor_(descriptor) {}

    int descriptor_;
};

// "READY=1", "WATCHDOG=1", "STATUS=..."; several with line breaks between them.
void notify(const std::string& state);

// Feeds the board's watchdog and the init system's once a second, while what they watch over goes on.
class Supervision {
public:
    explicit Supervision(std::optional<Watchdog> watchdog) : watchdog_(std::move(watchdog)) {
        notify("READY=1");
    }
    // `ticks` is how often that has gone round; none: nothing does.
    void feed(double now_s, std::optional<std::uint32_t> ticks, const std::string& text);

private:
    std::optional<Watchdog> watchdog_;
    double next_s_ = 0;
    std::uint32_t seen_ticks_ = 0;
};

}  // namespace lyr::run
