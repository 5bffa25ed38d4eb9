// A line that is too long is known by what is held without an end, so that it need not be held whole.

#include "target/control/session.h"

namespace lyr::control {

bool Session::wants_more() const {
    return in_.size() <= most_line_bytes && unsent().size() < full_bytes;
}

std::optional<Session::Line> Session::take() {
    while (unsent().size() < full_bytes) {
        const std::size_t end = in_.find('\n');
        const bool whole = end != std::string::npos;
        const bool too_long = (whole ? end : in_.size()) > most_line_bytes;
        if (!whole && !too_long && !skipping_) return std::nullopt;
        const bool told = skipping_;
        skipping_ = !whole;
        std::string text = whole ? in_.substr(0, end) : std::string();
        in_.erase(0, whole ? end + 1 : std::string::npos);
        if (!told) {
            if (too_long) return Line{{}, true};
            if (text.ends_with('\r')) text.pop_back();
            return Line{std::move(text)};
        }
        if (!whole) return std::nullopt;
    }
    return std::nullopt;
}

void Session::answer(std::string_view line) {
    out_ += line;
    out_ += '\n';
}

void Session::sent(std::size_t bytes) {
    sent_ += bytes;
    // A client that always leaves a little must not make it grow.
    if (sent_ < out_.size() && sent_ < full_bytes) return;
    out_.erase(0, sent_);
    sent_ = 0;
}

}  // namespace lyr::control
