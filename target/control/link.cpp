#include "target/control/link.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/text.h"
#include "target/control/dispatcher.h"
#include "target/control/socket_address.h"

namespace lyr::control {
namespace {

// What a server says fits many times; one that never ends a line is none of ours.
constexpr std::size_t most_held_bytes = std::size_t{1} << 18;
// Its socket is there before the file is read, and served from the print's begin on.
constexpr const char* no_greeting =
    "lyrrun does not answer yet: it may still be checking a large file; ask again later, or end "
    "lyrrun with Ctrl-C or SIGTERM";

}  // namespace

Diagnostic Link::problem(const std::string& what) const {
    return {Severity::error, ExitStatus::machine, what, {.file = path_}};
}

Result<Link> Link::open(const std::string& path) {
    Result<Link> link = reach(path);
    if (!link) return link;
    const Result<bool> greeted = link->take_greeting(patience);
    if (!greeted) return greeted.error();
    if (!*greeted) return link->problem(no_greeting);
    return link;
}

Result<Link> Link::reach(const std::string& path) {
    Link link(path, ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (Status connected = link.connect(); !connected) return connected.error();
    return link;
}

Result<bool> Link::take_greeting(std::chrono::milliseconds wait) {
    const Result<std::optional<Answer>> first = next_within(wait);
    if (!first) return first.error();
    if (!*first) return false;
    if (const auto* refused = std::get_if<Refused>(&**first)) return problem(refused->message);
    const auto* greeting = std::get_if<Greeting>(&**first);
    if (!greeting) return problem("this is no control socket of lyrrun");
    if (greeting->protocol != protocol_version)
        return problem(formatted("lyrrun speaks version %d of the protocol, this is for %d",
                                 greeting->protocol, protocol_version));
    greeting_ = *greeting;
    return true;
}

Link::Link(Link&& other) noexcept
    : path_(std::move(other.path_)),
      socket_(std::exchange(other.socket_, -1)),
      greeting_(std::move(other.greeting_)),
      held_(std::move(other.held_)),
      line_(std::move(other.line_)) {}

Link::~Link() {
    if (socket_ >= 0) ::close(socket_);
}

Status Link::connect() {
    const auto address = SocketAddress::of(path_);
    if (!address) return problem("the socket's name is too long");
    // Without waiting: many may be asking already.
    if (::connect(socket_, address->get(), SocketAddress::size) == 0) {
        (void)::fcntl(socket_, F_SETFL, 0);
        return Done{};
    }
    if (errno == EAGAIN) return problem(no_greeting);
    if (errno == ENOENT || errno == ECONNREFUSED)
        return problem("no printer is at work here: lyrrun makes this socket when it prints");
    if (errno == EACCES)
        return problem("you may not control this printer: join the group that the socket has");
    return problem(std::string("cannot be connected to: ") + std::strerror(errno));
}

Status Link::send(const std::string& line) {
    const std::string bytes = line + '\n';
    for (std::size_t at = 0; at < bytes.size();) {
        const ssize_t count = ::send(socket_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return problem("the print has ended");
        at += static_cast<std::size_t>(count);
    }
    return Done{};
}

Result<Answer> Link::next() {
    Result<std::optional<Answer>> answer = next_within(patience);
    if (!answer) return answer.error();
    if (!*answer) return problem("lyrrun does not answer");
    return std::move(**answer);
}

Result<std::optional<Answer>> Link::next_within(std::chrono::milliseconds wait) {
    std::size_t end;
    while ((end = held_.find('\n')) == std::string::npos) {
        pollfd waiting{socket_, POLLIN, 0};
        const int ready = ::poll(&waiting, 1, static_cast<int>(wait.count()));
        if (ready < 0 && errno == EINTR) continue;
        if (ready <= 0) return std::optional<Answer>();
        std::array<char, 4096> bytes;
        const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
        if (count <= 0) return problem("the print has ended");
        held_.append(bytes.data(), static_cast<std::size_t>(count));
        if (held_.size() > most_held_bytes) return problem("this is no control socket of lyrrun");
    }
    line_ = held_.substr(0, end);
    held_.erase(0, end + 1);
    std::optional<Answer> answer = read_answer(line_);
    if (!answer) return problem("this is no control socket of lyrrun: it says " + in_quotes(line_));
    return answer;
}

}  // namespace lyr::control
