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

// Which writes fail, and how.
class LineFaults {
public:
    using Fault = std::function<std::optional<Diagnostic>(std::uint64_t number)>;

    explicit LineFaults(Fault fault) : fault_(std::move(fault)) {}
    bool may_fail() const { return released_ || fault_; }
    // Of the next write, which may.
    Status next();
    // From now on all writes fail; the last one makes every line inactive.
    Status release(GpioChip& lines);
    bool released() const { return released_; }

private:
    Fault fault_;
    std::uint64_t writes_ = 0;
    bool released_ = false;
};

// `Observer` is called with each LineWrite, and false where there is none. With types of their own no write needs a call:
// simulations write hundreds of millions of times.
template <class Observer, class Timer = Clock>
class MockLines final : public GpioChip {
public:
    using Fault = LineFaults::Fault;

    MockLines(std::size_t line_count, const Timer& clock, Observer observer, Fault fault = {})
        : line_count_(line_count),
          lines_(all_lines(line_count)),
          clock_(clock),
          observer_(std::move(observer)),
          faults_(std::move(fault)) {}
    ~MockLines() override { (void)MockLines::release(); }

    std::size_t line_count() const override { return line_count_; }
    [[gnu::always_inline]] Status write(LineMask changed, LineMask levels) override {
        Status written = faults_.may_fail() ? faults_.next() : Status(Done{});
        if (!written) return written;
        changed &= lines_;
        levels_ = (levels_ & ~changed) | (levels & changed);
        if (observer_) observer_(LineWrite{clock_.now_ns(), changed, levels_});
        return written;
    }
    Status release() override { return faults_.release(*this); }
    LineMask levels() const { return levels_; }
    bool released() const { return faults_.released(); }

private:
    std::size_t line_count_;
    LineMask lines_;
    const Timer& clock_;
    Observer observer_;
    LineFaults faults_;
    LineMask levels_ = 0;
};

using LineObserver = std::function<void(const LineWrite&)>;
using MockChip = MockLines<LineObserver>;

// An observer that appends to `writes`, which must outlive it.
LineObserver recorder(std::vector<LineWrite>& writes);

}  // namespace lyr::gpio
