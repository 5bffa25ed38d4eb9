// A Unix socket's path as the kernel takes it.

#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <optional>
#include <string>

namespace lyr::control {

class SocketAddress {
public:
    static constexpr socklen_t size = sizeof(sockaddr_un);

    // None: longer than the kernel allows (107 bytes).
    static std::optional<SocketAddress> of(const std::string& path) {
        SocketAddress address;
        if (path.empty() || path.size() >= sizeof address.address_.sun_path) return std::nullopt;
        std::copy(path.begin(), path.end(), address.address_.sun_path);
        return address;
    }

    const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&address_); }

private:
    SocketAddress() { address_.sun_family = AF_UNIX; }

    sockaddr_un address_{};
};

}  // namespace lyr::control
