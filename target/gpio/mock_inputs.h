// Input lines that the program itself sets: the simulator's endstops and a test's buttons.
//
// Contract (beside that of InputLines)
//  1. set() changes a line at the clock's time, or at the time given, which must not be before that of the last change.
//     A line that has the level already has no edge.
//  2. `fault` is asked before each read, collect and wait; a diagnostic that it returns is the answer.
//  3. wait_ns() takes no time: it says whether there are edges.
//  4. More than `most_edges` that nobody collects are dropped, which the next collect() says.

#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "target/gpio/clock.h"
#include "target/gpio/input_lines.h"

namespace lyr::gpio {

class MockInputs final : public InputLines {
public:
    using Fault = std::function<std::optional<Diagnostic>()>;
    static constexpr std::size_t most_edges = 1024;

    MockInputs(std::size_t line_count, const Clock& clock, Fault fault = {});

    void set(std::size_t line, bool active) { set(line, active, clock_.now_ns()); }
    void set(std::size_t line, bool active, std::int64_t time_ns);
    LineMask levels() const { return levels_; }

    std::size_t line_count() const override { return line_count_; }
    Result<LineMask> read() override;
    Result<std::size_t> collect(std::span<InputEdge> edges) override;
    Result<bool> wait_ns(std::int64_t time_ns) override;

private:
    std::size_t line_count_;
    const Clock& clock_;
    Fault fault_;
    LineMask levels_ = 0;
    std::vector<InputEdge> edges_;
    bool dropped_ = false;
};

}  // namespace lyr::gpio
