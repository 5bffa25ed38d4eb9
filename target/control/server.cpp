// One loop over poll(2). Who is readable and who has room again is looked at anew in each round, for at most
// most_clients and a few more descriptors.

#include "target/control/server.h"

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <utility>
#include <vector>

#include "target/control/client.h"

namespace lyr::control {
namespace {

using Clock = Subscription::Clock;

// How long the loop sleeps where nothing happens; clients that are stuck are seen no later.
constexpr std::chrono::milliseconds longest_sleep{1'000};

// Signals blocked, for a thread that inherits it.
class BlockedSignals {
public:
    BlockedSignals() {
        sigset_t all;
        sigfillset(&all);
        pthread_sigmask(SIG_BLOCK, &all, &before_);
    }
    ~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    BlockedSignals(const BlockedSignals&) = delete;
    BlockedSignals& operator=(const BlockedSignals&) = delete;

private:
    sigset_t before_;
};

}  // namespace

class Server::Work {
public:
    Work(Listener listener, Dispatcher& dispatcher)
        : listener_(std::move(listener)),
          dispatcher_(dispatcher),
          wake_(::eventfd(0, EFD_CLOEXEC)) {}
    ~Work() { ::close(wake_); }
    Work(const Work&) = delete;
    Work& operator=(const Work&) = delete;

    void run();
    void stop() {
        const std::uint64_t once = 1;
        (void)!::write(wake_, &once, sizeof once);
    }

private:
    std::vector<pollfd> awaited() const;
    int sleep_ms(Clock::time_point now) const;
    void accept_waiting(Clock::time_point now);
    void make_room(Clock::time_point now);
    void dismiss(Clock::time_point now) {
        std::erase_if(clients_,
                      [&](const auto& client) { return client->is_over(now, stuck_time); });
    }

    Listener listener_;
    Dispatcher& dispatcher_;
    int wake_;
    std::vector<std::unique_ptr<Client>> clients_;
    // Connections are not accepted before: the process had no descriptor left.
    Clock::time_point accept_from_{};
};

// The wake-up first, then the listener, then the clients. Descriptor -1 is passed over.
std::vector<pollfd> Server::Work::awaited() const {
    std::vector<pollfd> all{{wake_, POLLIN, 0}};
    const bool accepts = accept_from_ <= Clock::now();
    all.push_back({accepts ? listener_.descriptor() : -1, POLLIN, 0});
    for (const auto& client : clients_) {
        const int events =
            (client->wants_more() ? POLLIN : 0) | (client->has_unsent() ? POLLOUT : 0);
        all.push_back({client->socket(), static_cast<short>(events), 0});
    }
    return all;
}

int Server::Work::sleep_ms(Clock::time_point now) const {
    Clock::time_point until = now + longest_sleep;
    for (const auto& client : clients_)
        if (client->subscription().interval && !client->has_unsent())
            until = std::min(until, client->subscription().next_due);
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - now).count();
    return static_cast<int>(std::max<std::int64_t>(0, left));
}

void Server::Work::make_room(Clock::time_point now) {
    const auto rank = [](const std::unique_ptr<Client>& client) {
        return std::pair(client->subscription().interval.has_value(), client->heard());
    };
    const auto silent =
        std::min_element(clients_.begin(), clients_.end(),
                         [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    (*silent)->answer(
        refusal_line({"null", ErrorCode::too_many_clients,
                      "all places are taken, and this client was silent for longest"}));
    (*silent)->serve(dispatcher_, now);
    clients_.erase(silent);
}

void Server::Work::accept_waiting(Clock::time_point now) {
    for (;;) {
        const int socket = listener_.accept();
        if (socket < 0) {
            if (errno != EAGAIN && errno != EINTR) accept_from_ = now + longest_sleep;
            return;
        }
        auto client = std::make_unique<Client>(socket, now);
        // Some may have gone without having been looked at since.
        if (clients_.size() >= most_clients) {
            for (const auto& other : clients_) other->serve(dispatcher_, now);
            dismiss(now);
        }
        if (clients_.size() >= most_clients) make_room(now);
        client->answer(dispatcher_.greeting());
        client->serve(dispatcher_, now);
        clients_.push_back(std::move(client));
    }
}

void Server::Work::run() {
    for (;;) {
        std::vector<pollfd> all = awaited();
        ::poll(all.data(), all.size(), sleep_ms(Clock::now()));
        if (all[0].revents) break;
        const Clock::time_point now = Clock::now();
        for (std::size_t i = 0; i < clients_.size(); ++i) {
            if (all[i + 2].revents) clients_[i]->serve(dispatcher_, now);
            clients_[i]->tell_status(dispatcher_, now);
        }
        dismiss(now);
        if (all[1].revents) accept_waiting(now);
    }
    for (const auto& client : clients_) client->tell_status(dispatcher_, Clock::now(), true);
}

Server::Server(Listener listener, Dispatcher& dispatcher)
    : work_(std::make_unique<Work>(std::move(listener), dispatcher)) {
    const BlockedSignals blocked;
    thread_ = std::thread([this] { work_->run(); });
}

Server::~Server() {
    work_->stop();
    thread_.join();
}

}  // namespace lyr::control
