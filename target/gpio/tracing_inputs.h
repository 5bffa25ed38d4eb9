// Input lines around others that shows each edge to an observer as it is collected.
//
// Contract
//  1. All calls are passed on; the observer sees every edge that collect() gave, once, in order.

#pragma once

#include <functional>

#include "target/gpio/input_lines.h"

namespace lyr::gpio {

class TracingInputs final : public InputLines {
public:
    using Observer = std::function<void(const InputEdge&)>;

    TracingInputs(InputLines& inner, Observer observer)
        : inner_(inner), observer_(std::move(observer)) {}

    std::size_t line_count() const override { return inner_.line_count(); }
    Result<LineMask> read() override { return inner_.read(); }
    Result<std::size_t> collect(std::span<InputEdge> edges) override {
        Result<std::size_t> count = inner_.collect(edges);
        if (count)
            for (const InputEdge& edge : edges.first(*count)) observer_(edge);
        return count;
    }
    Result<bool> wait_ns(std::int64_t time_ns) override { return inner_.wait_ns(time_ns); }

private:
    InputLines& inner_;
    Observer observer_;
};

}  // namespace lyr::gpio
