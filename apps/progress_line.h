// How far the work is, in the last line of a terminal; nothing where nobody can see it.
//
// Contract
//  1. show() and clear() never wait: a terminal that takes nothing now (stopped by Ctrl-S, at the end of a connection
//     that is gone) is passed by. Whoever tells how far a print is also hears what shall become of it.

#pragma once

#include <chrono>
#include <string>

namespace lyr::command_line {

class ProgressLine {
public:
    ProgressLine();
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    // Redrawn at most every tenth of a second.
    void show(const std::string& text);
    void clear();

private:
    int terminal_;  // below 0: none
    bool drawn_ = false;
    std::chrono::steady_clock::time_point shown_{};
};

// What takes the line away and leaves the cursor where it began; empty where there is no terminal.
const char* line_eraser();

}  // namespace lyr::command_line
