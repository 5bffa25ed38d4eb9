// One client of the control socket, as far as it is bytes: requests are cut out of what comes, answers wait until the
// client takes them. Knows nothing of descriptors, so that tests can feed it byte by byte.
//
// Contract
//  1. take() gives each line once, without its end ("\n" or "\r\n"), in order, however the bytes were split.
//  2. A line of more than most_line_bytes is told once, as too long, and skipped to its end; then lines come as before.
//  3. What is held is bounded: while full_bytes of answers wait, take() gives nothing, and while wants_more() is false
//     nothing may be received.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace lyr::control {

inline constexpr std::size_t most_line_bytes = 4096;

class Session {
public:
    static constexpr std::size_t full_bytes = std::size_t{1} << 14;

    struct Line {
        std::string text;
        bool too_long = false;
    };

    // At most most_line_bytes at once.
    void receive(std::string_view bytes) { in_ += bytes; }
    bool wants_more() const;
    // The next line; none: it is not whole yet, or answers have to leave first.
    std::optional<Line> take();

    void answer(std::string_view line);

    std::string_view unsent() const { return std::string_view(out_).substr(sent_); }
    void sent(std::size_t bytes);
    // Of answers, sent or not.
    std::size_t held_bytes() const { return out_.size(); }

private:
    std::string in_, out_;
    std::size_t sent_ = 0;
    bool skipping_ = false;
};

}  // namespace lyr::control
