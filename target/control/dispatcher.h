// What is done about a request: the one place where the control socket and the web page meet the print.
//
// Contract
//  1. Every line gets exactly one answer, and none is waited for: a command that is accepted is on its way, and the
//     status tells when it is done.
//  2. What the print cannot do in its state, or the printer never, is refused before anything of the request is done.
//  3. All members may be called from one thread at a time.

#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "target/control/request.h"
#include "target/run/print_control.h"

namespace lyr::control {

inline constexpr int protocol_version = 1;

// How often a client is told the status, and when next.
struct Subscription {
    using Clock = std::chrono::steady_clock;

    std::optional<Clock::duration> interval;
    Clock::time_point next_due{};
};

class Dispatcher {
public:
    Dispatcher(run::PrintControl& print, const config::Printer& printer)
        : print_(print), printer_(printer) {}

    // Lines without their end.
    std::string greeting() const;
    // Without a subscription, subscribe is refused.
    std::string answer(std::string_view line, Subscription* subscription);
    std::string status_event() const;

    run::PrintStatus status() const { return print_.status(); }

private:
    std::optional<Refusal> objection(const Commands& commands) const;
    std::optional<Refusal> objection(const run::Command& command,
                                     const run::PrintStatus& status) const;
    std::string carry_out(const std::string& id, const Commands& commands);

    run::PrintControl& print_;
    const config::Printer& printer_;
};

// One JSON object.
std::string json_of(const run::PrintStatus& status, const config::Printer& printer);

}  // namespace lyr::control
