#include "target/control/web/loopback.h"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace lyr::control {
namespace {

constexpr int waiting_connections = 16;

int made(int family) {
    const int socket = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const int on = 1;
    if (socket < 0) return socket;
    // A page that was closed a moment ago would keep the port for a minute.
    (void)::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (family == AF_INET6) (void)::setsockopt(socket, IPPROTO_IPV6, IPV6_V6ONLY, &on, sizeof on);
    return socket;
}

template <class Address>
bool listens(int socket, const Address& address) {
    return socket >= 0 &&
           ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
           ::listen(socket, waiting_connections) == 0;
}

Diagnostic refused(std::uint16_t port, int error) {
    return machine_error("the page cannot be served on port " + std::to_string(port) + ": " +
                         std::strerror(error));
}

}  // namespace

Result<std::pair<int, int>> listen_on_loopback(std::uint16_t& port) {
    sockaddr_in four{};
    four.sin_family = AF_INET;
    four.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    four.sin_port = htons(port);
    const int first = made(AF_INET);
    if (!listens(first, four)) {
        const int error = errno;
        if (first >= 0) ::close(first);
        return refused(port, error);
    }
    socklen_t size = sizeof four;
    (void)::getsockname(first, reinterpret_cast<sockaddr*>(&four), &size);
    port = ntohs(four.sin_port);
    sockaddr_in6 six{};
    six.sin6_family = AF_INET6;
    six.sin6_addr = in6addr_loopback;
    six.sin6_port = four.sin_port;
    const int second = made(AF_INET6);
    if (listens(second, six)) return std::pair(first, second);
    const int error = errno;
    if (second >= 0) ::close(second);
    if (error != EADDRINUSE) return std::pair(first, -1);
    // A browser that tries ::1 first would find somebody else there.
    ::close(first);
    return refused(port, error);
}

}  // namespace lyr::control
