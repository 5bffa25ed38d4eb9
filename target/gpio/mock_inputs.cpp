#include "target/gpio/mock_inputs.h"

#include <algorithm>

namespace lyr::gpio {

MockInputs::MockInputs(std::size_t line_count, const Clock& clock, Fault fault)
    : line_count_(line_count), clock_(clock), fault_(std::move(fault)) {
    edges_.reserve(most_edges);
}

void MockInputs::set(std::size_t line, bool active, std::int64_t time_ns) {
    if (line >= line_count_ || ((levels_ & line_bit(line)) != 0) == active) return;
    levels_ ^= line_bit(line);
    dropped_ = dropped_ || edges_.size() == most_edges;
    if (!dropped_) edges_.push_back({time_ns, static_cast<std::uint8_t>(line), active});
}

Result<LineMask> MockInputs::read() {
    if (fault_)
        if (auto error = fault_()) return std::move(*error);
    return levels_;
}

Result<std::size_t> MockInputs::collect(std::span<InputEdge> edges) {
    if (fault_)
        if (auto error = fault_()) return std::move(*error);
    if (dropped_) return machine_error("edges of inputs were dropped");
    const std::size_t count = std::min(edges.size(), edges_.size());
    const auto end = edges_.begin() + static_cast<std::ptrdiff_t>(count);
    std::copy(edges_.begin(), end, edges.begin());
    edges_.erase(edges_.begin(), end);
    return count;
}

Result<bool> MockInputs::wait_ns(std::int64_t) {
    if (fault_)
        if (auto error = fault_()) return std::move(*error);
    return !edges_.empty() || dropped_;
}

}  // namespace lyr::gpio
