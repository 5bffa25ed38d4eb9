// How far the work is, in the last line of a terminal; nothing where nobody can see it.

#pragma once

#include <chrono>
#include <string>

namespace lyr::command_line {

class ProgressLine {
public:
    // Redrawn at most every tenth of a second.
    void show(const std::string& text);
    void clear();

private:
    bool drawn_ = false;
    std::chrono::steady_clock::time_point shown_{};
};

// What takes the line away and leaves the cursor where it began; empty where there is no terminal.
const char* line_eraser();

}  // namespace lyr::command_line
