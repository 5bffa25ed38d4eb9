// The control thread: serves the clients of the socket.
//
// Contract
//  1. Nothing that clients do holds the print up: they are served by one thread of ordinary priority, which never waits
//     for any of them.
//  2. What it holds is bounded: most_clients, each with what session.h says. One more takes the place of
//     the one that has sent nothing for the longest, of those without a subscription if there are any: the one that comes
//     may want to stop the print.
//  3. A client that takes nothing of what waits for it for stuck_s is closed. One that has only stopped sending gets
//     all its answers first.
//  4. A client that has subscribed is told the status in its interval, once more at the end, and never a second one
//     while it has not taken the first.
//  5. Signals go to other threads.

#pragma once

#include <memory>
#include <thread>

#include "target/control/dispatcher.h"
#include "target/control/listener.h"

namespace lyr::control {

class Server {
public:
    static constexpr std::size_t most_clients = 16;
    static constexpr std::chrono::seconds stuck_time{10};

    // The dispatcher must outlive it.
    Server(Listener listener, Dispatcher& dispatcher);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

private:
    class Work;

    std::unique_ptr<Work> work_;
    std::thread thread_;
};

}  // namespace lyr::control
