#include "slicer/printer_range.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/text.h"

namespace lyr::slicer {
namespace {

Diagnostic warning(const std::string& message, std::size_t layer) {
    return {Severity::warning,
            ExitStatus::machine,
            message + "; plate.at moves the part",
            {.layer = static_cast<int>(layer) + 1}};
}

}  // namespace

void RangeReport::Farthest::take(double other_beyond_mm, double other_at_mm,
                                 std::size_t other_layer) {
    if (!(other_beyond_mm > beyond_mm)) return;
    *this = {other_beyond_mm, other_at_mm, other_layer};
}

void RangeReport::add(const format::EncodedLayer& layer, std::size_t index,
                      const config::Printer& printer) {
    const format::Bounds& box = layer.totals.motion;
    const std::array<std::int64_t, 3> low{box.low.x, box.low.y, box.low.z},
        high{box.high.x, box.high.y, box.high.z};
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        const config::Axis& axis = printer.axes[i];
        const double low_mm = layer.quantum.mm(low[i]), high_mm = layer.quantum.mm(high[i]);
        axes_[i].take(axis.min_mm - low_mm, low_mm, index);
        axes_[i].take(high_mm - axis.max_mm, high_mm, index);
        if (printer.kinematics != config::Kinematics::delta || i == config::axis_z) continue;
        const double off_mm = std::max(std::abs(low_mm), std::abs(high_mm));
        from_middle_.take(off_mm - printer.delta.reach_mm, off_mm, index);
    }
}

void RangeReport::finish(const config::Printer& printer, Diagnostics& diagnostics) const {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        const Farthest& farthest = axes_[i];
        if (!(farthest.beyond_mm > 0)) continue;
        const char* name = config::axis_names[i].data();
        diagnostics.push_back(warning(
            formatted("the print goes to %.6g mm on axis %s, and axis.%s.range_mm of the "
                      "printer is %g to %g",
                      farthest.at_mm, name, name, printer.axes[i].min_mm, printer.axes[i].max_mm),
            farthest.layer));
    }
    if (from_middle_.beyond_mm > 0)
        diagnostics.push_back(
            warning(formatted("the print goes %.6g mm from the middle of the bed, and the arms of "
                              "the printer reach %g mm (delta.reach_mm)",
                              from_middle_.at_mm, printer.delta.reach_mm),
                    from_middle_.layer));
}

}  // namespace lyr::slicer
