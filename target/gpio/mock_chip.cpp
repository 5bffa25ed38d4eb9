// The mock keeps the levels itself; everything else is up to its observer.

#include "target/gpio/mock_chip.h"

namespace lyr::gpio {

MockChip::MockChip(std::size_t line_count, const Clock& clock, Observer observer, Fault fault)
    : line_count_(line_count),
      clock_(clock),
      observer_(std::move(observer)),
      fault_(std::move(fault)) {}

MockChip::~MockChip() {
    (void)MockChip::release();
}

Diagnostic MockChip::write_after_release() {
    return {Severity::error,
            ExitStatus::internal,
            "a line was written after the lines were released",
            {}};
}

Status MockChip::release() {
    if (released_) return Done{};
    Status low = write(all_lines(line_count_), 0);
    released_ = true;
    return low;
}

MockChip::Observer recorder(std::vector<LineWrite>& writes) {
    return [&writes](const LineWrite& write) { writes.push_back(write); };
}

}  // namespace lyr::gpio
