// A pair of sockets that keep messages apart; the end of the program shows as the end of the stream.

#include "target/run/line_keeper.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <utility>

#include "base/text.h"

namespace lyr::run {
namespace {

using Clock = std::chrono::steady_clock;

struct Request {
    gpio::LineMask changed = 0, levels = 0;
    bool release = false;
};

struct Reply {
    bool ok = true;
    std::array<char, 400> message{};  // of the diagnostic
};

Diagnostic lost(const std::string& why) {
    return machine_error("the keeper of the heater lines " + why);
}

Reply reply_of(const Status& status) {
    Reply reply;
    reply.ok = status.ok();
    if (reply.ok) return reply;
    const std::string text = status.error().message.substr(0, reply.message.size() - 1);
    std::copy(text.begin(), text.end(), reply.message.begin());
    return reply;
}

template <class Message>
bool send_whole(int socket, const Message& message) {
    ssize_t sent;
    do sent = ::send(socket, &message, sizeof message, MSG_NOSIGNAL);
    while (sent < 0 && errno == EINTR);
    return sent == static_cast<ssize_t>(sizeof message);
}

template <class Message>
bool receive_whole(int socket, Message& message) {
    ssize_t received;
    do received = ::recv(socket, &message, sizeof message, 0);
    while (received < 0 && errno == EINTR);
    return received == static_cast<ssize_t>(sizeof message);
}

// The keeper's life.
void serve(int socket, gpio::GpioChip& chip, int silent_ms) {
    for (;;) {
        pollfd waiting{socket, POLLIN, 0};
        const int ready = ::poll(&waiting, 1, silent_ms);
        if (ready < 0 && errno == EINTR) continue;
        Request request;
        if (ready <= 0 || !receive_whole(socket, request)) return;
        const Status done =
            request.release ? chip.release() : chip.write(request.changed, request.levels);
        if (!send_whole(socket, reply_of(done)) || request.release) return;
    }
}

[[noreturn]] void live(int socket, const OpenChip& open, int silent_ms,
                       const std::function<void()>& drop) {
    // Ctrl-Z stops a whole foreground group, and a stopped keeper would leave heaters on: it is of no group that a
    // terminal knows, and heeds no signal by which it could be ended or stopped in passing.
    (void)::setsid();
    sigset_t all;
    sigfillset(&all);
    ::sigprocmask(SIG_SETMASK, &all, nullptr);
    Result<std::unique_ptr<gpio::GpioChip>> chip = open();
    const Status opened = chip ? Status(Done{}) : Status(chip.error());
    if (send_whole(socket, reply_of(opened)) && chip) serve(socket, **chip, silent_ms);
    if (chip) (void)(*chip)->release();
    if (drop) drop();
    // Nothing of the program that this is a copy of may be wound up here.
    ::_exit(0);
}

// A write takes microseconds. A keeper that has not answered by then never may: it was stopped, or hangs.
constexpr timeval longest_answer{1, 0};

// A process that was killed ends at once, or a little later on a busy board, and lets go of its lines; one that hangs in the
// kernel may never, and nobody may wait for it for long.
constexpr int patient_tries = 10, most_tries = 40, try_us = 10'000;

class KeptChip final : public gpio::GpioChip {
public:
    KeptChip(std::size_t line_count, int socket, pid_t keeper, OpenChip open, int silent_ms)
        : line_count_(line_count),
          socket_(socket),
          keeper_(keeper),
          open_(std::move(open)),
          silent_(silent_ms) {
        for (const int way : {SO_RCVTIMEO, SO_SNDTIMEO})
            (void)::setsockopt(socket_, SOL_SOCKET, way, &longest_answer, sizeof longest_answer);
    }
    ~KeptChip() override {
        (void)KeptChip::release();
        ::close(socket_);
        if (keeper_ > 0) ::waitpid(keeper_, nullptr, 0);
    }
    KeptChip(const KeptChip&) = delete;
    KeptChip& operator=(const KeptChip&) = delete;

    std::size_t line_count() const override { return line_count_; }
    Status write(gpio::LineMask changed, gpio::LineMask levels) override {
        if (released_) return lost("has released them");
        return ask({changed, levels, false});
    }
    Status release() override {
        if (released_) return Done{};
        released_ = true;
        return ask({0, 0, true});
    }

private:
    Status ask(const Request& request) {
        Reply reply;
        if (keeper_ < 0) return lost(take_lines() ? "is gone" : still_on);
        const bool was_silent = Clock::now() - asked_ > silent_;
        asked_ = Clock::now();
        if (!send_whole(socket_, request) || !receive_whole(socket_, reply))
            return take_over(was_silent);
        if (reply.ok) return Done{};
        return machine_error(reply.message.data());
    }

    // A keeper that was killed has left its lines as they were, one that hangs holds them so.
    Diagnostic take_over(bool was_silent) {
        ::kill(keeper_, SIGKILL);
        bool has_ended = false;
        for (int i = 0; i < most_tries; ++i) {
            has_ended = has_ended || ::waitpid(keeper_, nullptr, WNOHANG) != 0;
            if ((has_ended || i >= patient_tries) && take_lines()) break;
            ::usleep(try_us);
        }
        keeper_ = -1;
        if (!own_) return lost(still_on);
        // Whoever stopped the program, by Ctrl-Z or SIGSTOP, must not look for a fault in the keeper.
        if (was_silent)
            return lost(formatted(
                "has switched them off, because this program was silent for more than %lld s: "
                "it was stopped, or the board is overloaded",
                static_cast<long long>(silent_.count() / 1'000)));
        return lost("is gone or hangs; they were taken from it and switched off");
    }

    // All inactive from then on; whoever asks again tries again.
    bool take_lines() {
        if (own_) return true;
        Result<std::unique_ptr<gpio::GpioChip>> chip = open_();
        if (!chip || !(*chip)->write(gpio::all_lines(line_count_), 0)) return false;
        own_ = std::move(*chip);
        return true;
    }

    static constexpr const char* still_on =
        "is gone or hangs, and they may still be on: cut the power now";

    std::size_t line_count_;
    int socket_;
    pid_t keeper_;  // below 0: none any more
    OpenChip open_;
    std::unique_ptr<gpio::GpioChip> own_;  // of lines that were taken over; all are inactive
    std::chrono::milliseconds silent_;
    Clock::time_point asked_ = Clock::now();
    bool released_ = false;
};

}  // namespace

Result<std::unique_ptr<gpio::GpioChip>> keep_lines(std::size_t line_count, const OpenChip& open,
                                                   int silent_ms,
                                                   const std::function<void()>& drop) {
    std::array<int, 2> sockets{};
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, sockets.data()) != 0)
        return lost(std::string("cannot be reached: ") + std::strerror(errno));
    const pid_t keeper = ::fork();
    if (keeper == 0) {
        ::close(sockets[0]);
        live(sockets[1], open, silent_ms, drop);
    }
    ::close(sockets[1]);
    if (keeper < 0) {
        ::close(sockets[0]);
        return lost(std::string("cannot be started: ") + std::strerror(errno));
    }
    Reply opened;
    const bool answered = receive_whole(sockets[0], opened);
    if (answered && opened.ok)
        return std::unique_ptr<gpio::GpioChip>(
            std::make_unique<KeptChip>(line_count, sockets[0], keeper, open, silent_ms));
    ::close(sockets[0]);
    ::waitpid(keeper, nullptr, 0);
    if (!answered) return lost("ended at its start");
    return machine_error(opened.message.data());
}

}  // namespace lyr::run
