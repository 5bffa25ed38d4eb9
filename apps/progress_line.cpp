// The terminal of standard error is opened once more: whether to wait belongs to what was opened, and standard error is
// shared with the shell.

#include "apps/progress_line.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstring>

namespace lyr::command_line {
namespace {

constexpr const char* eraser = "\r\033[K";

int open_terminal() {
    if (::isatty(STDERR_FILENO) != 1) return -1;
    return ::open("/proc/self/fd/2", O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
}

}  // namespace

ProgressLine::ProgressLine() : terminal_(open_terminal()) {}

ProgressLine::~ProgressLine() {
    if (terminal_ >= 0) ::close(terminal_);
}

void ProgressLine::show(const std::string& text) {
    constexpr std::chrono::milliseconds shortest_interval{100};
    if (terminal_ < 0) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - shown_ < shortest_interval) return;
    shown_ = now;
    const std::string line = eraser + text;
    if (::write(terminal_, line.data(), line.size()) > 0) drawn_ = true;
}

void ProgressLine::clear() {
    if (!drawn_) return;
    drawn_ = false;
    // Where it does not take it, what comes next stands behind the line.
    [[maybe_unused]] const ssize_t taken = ::write(terminal_, eraser, std::strlen(eraser));
}

const char* line_eraser() {
    static const bool terminal = ::isatty(STDERR_FILENO) == 1;
    return terminal ? eraser : "";
}

}  // namespace lyr::command_line
