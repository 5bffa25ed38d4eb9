// The mock keeps the levels itself; everything else is up to its observer.

#include "target/gpio/mock_chip.h"

namespace lyr::gpio {

Status LineFaults::next() {
    if (released_)
        return Diagnostic{Severity::error,
                          ExitStatus::internal,
                          "a line was written after the lines were released",
                          {}};
    if (auto error = fault_(writes_++)) return std::move(*error);
    return Done{};
}

Status LineFaults::release(GpioChip& lines) {
    if (released_) return Done{};
    Status low = lines.write(all_lines(lines.line_count()), 0);
    released_ = true;
    return low;
}

LineObserver recorder(std::vector<LineWrite>& writes) {
    return [&writes](const LineWrite& write) { writes.push_back(write); };
}

}  // namespace lyr::gpio
