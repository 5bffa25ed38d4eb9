#include "apps/progress_line.h"

#include <unistd.h>

#include <cstdio>

namespace lyr::command_line {

void ProgressLine::show(const std::string& text) {
    constexpr std::chrono::milliseconds shortest_interval{100};
    if (*line_eraser() == '\0') return;
    const auto now = std::chrono::steady_clock::now();
    if (now - shown_ < shortest_interval) return;
    shown_ = now;
    drawn_ = true;
    std::fprintf(stderr, "%s%s", line_eraser(), text.c_str());
}

void ProgressLine::clear() {
    if (drawn_) std::fputs(line_eraser(), stderr);
    drawn_ = false;
}

const char* line_eraser() {
    static const bool terminal = ::isatty(STDERR_FILENO) == 1;
    return terminal ? "\r\033[K" : "";
}

}  // namespace lyr::command_line
