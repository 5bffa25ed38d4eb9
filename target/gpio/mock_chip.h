// Lines that lead nowhere: every write goes to an observer, and any of them can be made to fail.
// The simulator's observer decodes the pulses; a test's may record them.
//
// Contract
//  1. The observer sees each write that succeeded once, in order, with the clock's time and with
//  the
//     state of all lines afterwards.
//  2. A write for which `fault` returns a diagnostic returns it, changes no line and is not
//  observed.
//     The fault is asked once a write, with the number of the write from 0.

#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "target/gpio/clock.h"
#include "target/gpio/gpio_chip.h"

namespace lyr::gpio {

// What one write did.
struct LineWrite {
    std::int64_t time_ns = 0;
    LineMask changed = 0;  // lines written, whether or not they had that level before
    LineMask levels = 0;   // of all lines, after the write
};

class MockChip final : public GpioChip {
public:
    using Observer = std::function<void(const LineWrite&)>;
    using Fault = std::function<std::optional<Diagnostic>(std::uint64_t number)>;

    MockChip(std::size_t line_count, const Clock& clock, Observer observer, Fault fault = {});
    ~MockChip() override;

    std::size_t line_count() const override { return line_count_; }
    // Here, so that whoever knows the type makes no call for it: simulations write hundreds of millions of times.
    Status write(LineMask changed, LineMask levels) override {
        if (released_) return write_after_release();
        if (fault_)
            if (auto error = fault_(writes_++)) return std::move(*error);
        changed &= all_lines(line_count_);
        levels_ = (levels_ & ~changed) | (levels & changed);
        if (observer_) observer_({clock_.now_ns(), changed, levels_});
        return Done{};
    }
    Status release() override;
    LineMask levels() const { return levels_; }
    bool released() const { return released_; }

private:
    static Diagnostic write_after_release();

    std::size_t line_count_;
    const Clock& clock_;
    Observer observer_;
    Fault fault_;
    LineMask levels_ = 0;
    std::uint64_t writes_ = 0;
    bool released_ = false;
};

// An observer that appends to `writes`, which must outlive it.
MockChip::Observer recorder(std::vector<LineWrite>& writes);

}  // namespace lyr::gpio
