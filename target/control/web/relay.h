// The print that the page shows, through its control socket. Prints come and go; the page stays.
//
// Contract
//  1. serve() connects where there is no connection, and takes the statuses that have come; it waits for nothing: a
//     server that has not greeted yet, as while lyrrun checks a large file, is no print until it has.
//  2. answer() hands a request on and waits for its answer, for Link::patience at the most. A request is one line:
//     line ends in it are spaces.
//  3. print() counts the prints that were connected to; what is told of is that print, also after its end.

#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "target/control/link.h"
#include "target/control/web/history.h"

namespace lyr::control {

class Relay {
public:
    // Empty: that of the first print that is found.
    explicit Relay(std::string socket) : socket_(std::move(socket)) {}

    void serve();
    std::string answer(std::string_view request);

    // Of what comes next; below 0: there is no print.
    int descriptor() const {
        if (link_) return link_->descriptor();
        return silent_.empty() ? -1 : silent_.begin()->second.descriptor();
    }
    bool is_connected() const { return link_.has_value(); }
    std::uint64_t print() const { return print_; }
    const std::optional<Told>& told() const { return told_; }
    // Its path; empty: there was none yet.
    const std::string& file() const { return file_; }
    const History& history() const { return history_; }

private:
    // Reaches every place from which no greeting is awaited yet.
    void look();
    void connect();
    void take(const Answer& answer);

    std::string socket_;
    std::optional<Link> link_;
    std::map<std::string, Link> silent_;  // have not greeted yet
    std::optional<Told> told_;
    std::string file_;
    History history_;
    std::uint64_t print_ = 0;
    std::chrono::steady_clock::time_point connect_from_{};
};

}  // namespace lyr::control
