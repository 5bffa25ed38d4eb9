#include "target/gpio/debounce.h"

namespace lyr::gpio {

void Debounce::edge(const InputEdge& edge) {
    if (edge.active == level_) return;
    // The old level had lasted: what came before was a pulse by itself.
    if (level_ == told_ && edge.time_ns - changed_ns_ >= settle_ns_) away_ = false;
    level_ = edge.active;
    line_ = edge.line;
    changed_ns_ = edge.time_ns;
    if (!away_) first_ns_ = edge.time_ns;
    away_ = true;
}

std::optional<InputEdge> Debounce::settled(std::int64_t now_ns) {
    if (level_ == told_ || now_ns - changed_ns_ < settle_ns_) return std::nullopt;
    told_ = level_;
    away_ = false;
    return InputEdge{first_ns_, line_, told_};
}

}  // namespace lyr::gpio
