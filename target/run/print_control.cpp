#include "target/run/print_control.h"

#include <algorithm>
#include <utility>

namespace lyr::run {

bool PrintControl::post(std::span<const Command> commands) {
    // As after a second Ctrl-C: the pulse that is out ends, and nothing follows.
    constexpr int at_once = 2;
    const auto emergency = std::ranges::find_if(commands, [](const Command& command) {
        return std::holds_alternative<EmergencyStop>(command);
    });
    const bool is_emergency = emergency != commands.end();
    if (is_emergency) stop_requests_ += at_once;
    const std::lock_guard lock(mutex_);
    if (is_emergency) {
        // One is enough, however often it is asked for.
        if (waiting_.empty() || !std::holds_alternative<EmergencyStop>(waiting_.front()))
            waiting_.push_front(*emergency);
        return true;
    }
    if (waiting_.size() + commands.size() > most_waiting) return false;
    for (const Command& command : commands) waiting_.push_back(command);
    return true;
}

PrintStatus PrintControl::status() const {
    const std::lock_guard lock(mutex_);
    return status_;
}

bool PrintControl::ends() const {
    const std::lock_guard lock(mutex_);
    return std::any_of(waiting_.begin(), waiting_.end(), [](const Command& command) {
        return std::holds_alternative<Cancel>(command) ||
               std::holds_alternative<EmergencyStop>(command);
    });
}

std::optional<Command> PrintControl::take() {
    const std::lock_guard lock(mutex_);
    if (waiting_.empty()) return std::nullopt;
    const Command command = waiting_.front();
    waiting_.pop_front();
    return command;
}

void PrintControl::publish(PrintStatus status) {
    const std::lock_guard lock(mutex_);
    status_ = std::move(status);
}

}  // namespace lyr::run
