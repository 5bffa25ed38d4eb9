// A connection of the control socket, from the server's side.
//
// Contract
//  1. serve() receives, answers and sends as much as can be had without waiting.
//  2. is_over() when there is nothing left to do for this client: it has gone, or has ended and has all its answers, or
//     has been stuck for too long.

#pragma once

#include "target/control/dispatcher.h"
#include "target/control/session.h"

namespace lyr::control {

class Client {
public:
    using Clock = Subscription::Clock;

    // The socket is its own from here on.
    Client(int socket, Clock::time_point now) : socket_(socket), moved_(now), heard_(now) {}
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;
    ~Client();

    int socket() const { return socket_; }
    bool wants_more() const { return !ended_ && session_.wants_more(); }
    bool has_unsent() const { return !session_.unsent().empty(); }
    const Subscription& subscription() const { return subscription_; }
    // When it last sent something.
    Clock::time_point heard() const { return heard_; }

    void answer(std::string_view line) { session_.answer(line); }
    void serve(Dispatcher& dispatcher, Clock::time_point now);
    // If it is due; `last`: in any case.
    void tell_status(Dispatcher& dispatcher, Clock::time_point now, bool last = false);
    bool is_over(Clock::time_point now, Clock::duration stuck_time) const;

private:
    void receive(Clock::time_point now);
    void send(Clock::time_point now);

    int socket_;
    Session session_;
    Subscription subscription_;
    bool ended_ = false, gone_ = false;
    Clock::time_point moved_, heard_;  // moved: when it last took something, or had nothing to take
};

}  // namespace lyr::control
