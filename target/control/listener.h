// The Unix socket that clients connect to: one server for each, and nobody but its user and group may.
//
// Contract
//  1. open() makes the socket with mode 0660; at no time may others connect to it. Its folder must be there.
//  2. A socket that a server left behind when it was killed is replaced. One that is served, by whatever program, and
//     whatever is no socket, stays as it is, and the error (status machine) says so. Of two that start at once, one wins.
//  3. The socket is removed at the end.

#pragma once

#include <string>

#include "base/diagnostic.h"

namespace lyr::control {

class Listener {
public:
    static Result<Listener> open(const std::string& path);

    Listener(Listener&& other) noexcept;
    Listener& operator=(Listener&&) = delete;
    ~Listener();

    const std::string& path() const { return path_; }
    // A connection that waits, not blocking; below 0: there is none.
    int accept() const;
    int descriptor() const { return socket_; }

private:
    Listener(std::string path, int lock) : path_(std::move(path)), lock_(lock) {}
    Status listen();

    std::string path_;
    int lock_;  // of PATH.lock; whoever has it may replace the socket
    int socket_ = -1;
};

}  // namespace lyr::control
