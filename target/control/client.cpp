#include "target/control/client.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace lyr::control {
namespace {

std::string too_long_line() {
    return refusal_line({"null", ErrorCode::line_too_long,
                         "a line has " + std::to_string(most_line_bytes) + " bytes at most"});
}

}  // namespace

Client::~Client() {
    ::close(socket_);
}

void Client::receive(Clock::time_point now) {
    std::array<char, most_line_bytes> bytes;
    const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
    if (count > 0) heard_ = now;
    if (count > 0) return session_.receive({bytes.data(), static_cast<std::size_t>(count)});
    if (count == 0)
        ended_ = true;
    else if (errno != EAGAIN && errno != EINTR)
        gone_ = true;
}

void Client::send(Clock::time_point now) {
    while (has_unsent()) {
        const std::string_view bytes = session_.unsent();
        const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0 && errno != EAGAIN) gone_ = true;
        if (count <= 0) return;
        session_.sent(static_cast<std::size_t>(count));
        moved_ = now;
    }
    moved_ = now;
}

void Client::serve(Dispatcher& dispatcher, Clock::time_point now) {
    if (!has_unsent()) moved_ = now;
    if (wants_more()) receive(now);
    // Lines that had to wait for room go on as soon as there is some: nothing else may come that would call this.
    for (bool goes_on = true; goes_on;) {
        goes_on = false;
        while (const auto line = session_.take()) {
            session_.answer(line->too_long ? too_long_line()
                                           : dispatcher.answer(line->text, &subscription_));
            goes_on = true;
        }
        send(now);
        goes_on = goes_on && !has_unsent() && !gone_;
    }
}

void Client::tell_status(Dispatcher& dispatcher, Clock::time_point now, bool last) {
    if (!subscription_.interval || (now < subscription_.next_due && !last)) return;
    if (!has_unsent()) {
        moved_ = now;
        session_.answer(dispatcher.status_event());
    }
    subscription_.next_due = now + *subscription_.interval;
    send(now);
}

bool Client::is_over(Clock::time_point now, Clock::duration stuck_time) const {
    return gone_ || (has_unsent() ? now - moved_ > stuck_time : ended_);
}

}  // namespace lyr::control
