#include "target/run/watchdog.h"

#include <fcntl.h>
#include <linux/watchdog.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace lyr::run {

Result<Watchdog> Watchdog::open(const config::WatchdogSettings& settings) {
    const int descriptor = ::open(settings.device.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0)
        return machine_error("cannot open the watchdog " + settings.device + ": " +
                             std::strerror(errno) +
                             "; look at watchdog.device, and who else uses it");
    int timeout_s = static_cast<int>(std::lround(settings.timeout_s));
    // Some drivers have one timeout only.
    (void)::ioctl(descriptor, WDIOC_SETTIMEOUT, &timeout_s);
    Watchdog watchdog(descriptor);
    watchdog.feed();
    return watchdog;
}

Watchdog::Watchdog(Watchdog&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

Watchdog::~Watchdog() {
    if (descriptor_ < 0) return;
    // Without this letter the driver takes the end for a crash.
    (void)!::write(descriptor_, "V", 1);
    ::close(descriptor_);
}

void Watchdog::feed() {
    (void)!::write(descriptor_, "\n", 1);
}

void notify(const std::string& state) {
    const char* place = std::getenv("NOTIFY_SOCKET");
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::size_t length = place ? std::strlen(place) : 0;
    if (length < 2 || length > sizeof address.sun_path) return;
    std::memcpy(address.sun_path, place, length);
    // A name that belongs to no file.
    if (place[0] == '@') address.sun_path[0] = '\0';
    const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket < 0) return;
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + length);
    (void)!::sendto(socket, state.data(), state.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
                    reinterpret_cast<const sockaddr*>(&address), size);
    ::close(socket);
}

void Supervision::feed(double now_s, std::optional<std::uint32_t> ticks, const std::string& text) {
    if (now_s < next_s_) return;
    next_s_ = now_s + 1;
    if (ticks && *ticks == seen_ticks_) return;
    seen_ticks_ = ticks.value_or(0);
    if (watchdog_) watchdog_->feed();
    notify("WATCHDOG=1\nSTATUS=" + text);
}

}  // namespace lyr::run
