// Where a running print and whoever controls it meet: commands one way, what the print is at the other way. One a
// print; the print serves it, any number of ordinary threads may use it. The real-time thread looks at nothing of it
// but the number of requests to stop.
//
// Contract
//  1. Commands come out in the order in which they were posted, each once. post() never waits for the print; false:
//     more than `most_waiting` would wait then, and none of those posted together is taken.
//  2. An emergency stop is always taken, and stops the motors before post() returns to its caller or a step later; the
//     print serves it before all other commands.
//  3. status() is what was published last, as a whole.

#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "target/config/printer.h"
#include "target/run/command.h"
#include "target/run/executor.h"
#include "target/run/heat_desk.h"

namespace lyr::run {

enum class PrintState : std::uint8_t {
    heating,   // waits for temperatures
    printing,  // on its path
    pausing,   // comes to rest and parks
    paused,
    resuming,  // heats, primes and goes back
    stopping,  // on request or after a fault
    done,      // from here on it is over
    failed,
    stopped,  // for good, on request
};
inline constexpr std::array<std::string_view, 9> print_state_names{
    "heating",  "printing", "pausing", "paused", "resuming",
    "stopping", "done",     "failed",  "stopped"};

constexpr bool is_over(PrintState state) {
    return state >= PrintState::done;
}

struct PrintStatus {
    PrintState state = PrintState::heating;
    std::string message;     // why it is in this state, where that is not plain; one line
    bool draws_out = false;  // filament, or is about to: it cannot go on before that is done
    std::string file;
    std::uint32_t layer = 0, layers = 0;  // from 1; 0: before the first
    // Of the head, as its motors have stepped; is_position_known: not after an emergency stop.
    std::array<double, 3> position_mm{};
    bool is_position_known = true;
    double time_s = 0;       // of the plan, waits and pauses not counted
    double elapsed_s = 0;    // since the begin
    double estimated_s = 0;  // of the whole plan, as the file states it; 0: it does not
    HeatersNow heaters{};
    double fan = 0;  // 0..1
    double speed_factor = 1;
    double filament_mm = 0;  // pushed on the path so far, less what is drawn back
};

class PrintControl {
public:
    static constexpr std::size_t most_waiting = 64;

    bool post(const Command& command) { return post(std::span(&command, 1)); }
    bool post(std::span<const Command> commands);
    PrintStatus status() const;

    // For the print.
    // A cancel or an emergency stop waits.
    bool ends() const;
    std::optional<Command> take();
    void publish(PrintStatus status);
    StopRequests& stop_requests() { return stop_requests_; }

private:
    mutable std::mutex mutex_;
    std::deque<Command> waiting_;
    PrintStatus status_;
    StopRequests stop_requests_{0};
};

}  // namespace lyr::run
