// Sockets for tests, and a client that is made of nothing but system calls.

#pragma once

#include <doctest/doctest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <string>

#include "scratch.h"
#include "target/control/socket_address.h"

namespace lyr::tests {

inline std::string socket_path(const std::string& name) {
    return scratch(name + ".sock");
}

class Connection {
public:
    explicit Connection(const std::string& path)
        : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        const auto address = control::SocketAddress::of(path);
        open_ = address && ::connect(socket_, address->get(), control::SocketAddress::size) == 0;
    }
    ~Connection() { ::close(socket_); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    bool is_open() const { return open_; }
    int socket() const { return socket_; }

    void send(const std::string& bytes) const {
        for (std::size_t at = 0; at < bytes.size();) {
            const ssize_t count =
                ::send(socket_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
            if (count <= 0) return;
            at += static_cast<std::size_t>(count);
        }
    }
    void end_sending() const { ::shutdown(socket_, SHUT_WR); }

    // "(end)" where the server has closed, "(nothing)" after so long without a whole line.
    std::string line(std::chrono::milliseconds patience = std::chrono::seconds(10)) {
        for (;;) {
            const std::size_t end = held_.find('\n');
            if (end != std::string::npos) {
                std::string line = held_.substr(0, end);
                held_.erase(0, end + 1);
                return line;
            }
            pollfd waiting{socket_, POLLIN, 0};
            if (::poll(&waiting, 1, static_cast<int>(patience.count())) <= 0) return "(nothing)";
            char bytes[4096];
            const ssize_t count = ::recv(socket_, bytes, sizeof bytes, 0);
            if (count <= 0) return "(end)";
            held_.append(bytes, static_cast<std::size_t>(count));
        }
    }

private:
    int socket_;
    bool open_ = false;
    std::string held_;
};

}  // namespace lyr::tests
