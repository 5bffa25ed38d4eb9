// The lock is on a file beside the socket, so that there is no moment between looking whether a socket is served and
// replacing it in which another server can come.

#include "target/control/listener.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "target/control/socket_address.h"

namespace lyr::control {
namespace {

constexpr mode_t socket_mode = 0660;
// Connections that wait for the server to look; more are refused by the kernel.
constexpr int waiting_connections = 8;

Diagnostic problem(const std::string& path, const std::string& what) {
    return {Severity::error, ExitStatus::machine, what, {.file = path}};
}

Diagnostic refused(const std::string& path, const std::string& what, int error) {
    return problem(path, what + ": " + std::strerror(error));
}

std::string lock_path(const std::string& path) {
    return path + ".lock";
}

bool is_file_of(int descriptor, const std::string& path) {
    struct stat held {
    }, named{};
    return ::fstat(descriptor, &held) == 0 && ::stat(path.c_str(), &named) == 0 &&
           held.st_dev == named.st_dev && held.st_ino == named.st_ino;
}

Result<int> take_lock(const std::string& path) {
    const std::string name = lock_path(path);
    for (;;) {
        const int lock = ::open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
        if (lock < 0) return refused(path, "the control socket cannot be made here", errno);
        if (::flock(lock, LOCK_EX | LOCK_NB) != 0) {
            ::close(lock);
            return problem(path, "this socket is served already: the printer is at work");
        }
        // A server that ended in between has removed the file.
        if (is_file_of(lock, name)) return lock;
        ::close(lock);
    }
}

bool is_served(const SocketAddress& address) {
    const int probe = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const bool refused = probe >= 0 && ::connect(probe, address.get(), SocketAddress::size) != 0 &&
                         errno == ECONNREFUSED;
    if (probe >= 0) ::close(probe);
    return !refused;
}

// Makes the name free.
Status clear(const std::string& path, const SocketAddress& address) {
    struct stat found {};
    if (::lstat(path.c_str(), &found) != 0) return Done{};
    if (!S_ISSOCK(found.st_mode))
        return problem(path, "the control socket cannot be made: there is a file of that name");
    if (is_served(address)) return problem(path, "another program serves this socket");
    if (::unlink(path.c_str()) != 0)
        return refused(path, "the socket of a server that is gone cannot be removed", errno);
    return Done{};
}

}  // namespace

Result<Listener> Listener::open(const std::string& path) {
    const Result<int> lock = take_lock(path);
    if (!lock) return lock.error();
    Listener listener(path, *lock);
    if (Status listening = listener.listen(); !listening) return listening.error();
    return listener;
}

Status Listener::listen() {
    const std::optional<SocketAddress> address = SocketAddress::of(path_);
    if (!address) return problem(path_, "the control socket's name is too long");
    if (Status cleared = clear(path_, *address); !cleared) return cleared;
    const int made = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    // The mode before it has a name, lest somebody connects in between; once more after it, since the process's umask
    // may have taken the group's part away.
    const bool listening = made >= 0 && ::fchmod(made, socket_mode) == 0 &&
                           ::bind(made, address->get(), SocketAddress::size) == 0 &&
                           ::chmod(path_.c_str(), socket_mode) == 0 &&
                           ::listen(made, waiting_connections) == 0;
    if (!listening) {
        const int error = errno;
        if (made >= 0) ::close(made);
        return refused(path_, "the control socket cannot be made here", error);
    }
    socket_ = made;
    return Done{};
}

Listener::Listener(Listener&& other) noexcept
    : path_(std::move(other.path_)),
      lock_(std::exchange(other.lock_, -1)),
      socket_(std::exchange(other.socket_, -1)) {}

Listener::~Listener() {
    if (socket_ >= 0) {
        ::unlink(path_.c_str());
        ::close(socket_);
    }
    if (lock_ < 0) return;
    ::unlink(lock_path(path_).c_str());
    ::close(lock_);
}

int Listener::accept() const {
    return ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
}

}  // namespace lyr::control
