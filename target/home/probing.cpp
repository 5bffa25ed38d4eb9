#include "target/home/probing.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace lyr::home {
namespace {

using config::axis_x, config::axis_y, config::axis_z;

Diagnostic at(const Spot& spot, const Diagnostic& error) {
    Diagnostic placed = error;
    placed.message = formatted("at x %g, y %g: ", spot.x_mm, spot.y_mm) + error.message;
    return placed;
}

Result<ByAxes::Positions> touch_here(ByAxes& machine, const config::Printer& printer) {
    const config::Probe& probe = *printer.probe;
    const Target target{axis_z,
                        config::contact_probe,
                        -1,
                        0,
                        probe.offset_mm[2],
                        probe.fast_mm_s,
                        probe.slow_mm_s,
                        probe.lift_mm,
                        probe.tolerance_mm};
    const double reach_mm = machine.at_mm()[axis_z] - probe.offset_mm[2] + probe.reach_mm;
    const std::array targets{target};
    if (Status open = machine.check_open(targets); !open) return open.error();
    Result<ByAxes::Positions> found = machine.touch(targets, probe.fast_mm_s, reach_mm);
    ByAxes::Positions sum{};
    double low_mm = 0, high_mm = 0;
    for (int sample = 0; sample < probe.samples && found; ++sample) {
        found = machine.touch_slowly(targets, *found);
        if (!found) break;
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += (*found)[i] / probe.samples;
        const double z_mm = (*found)[axis_z];
        low_mm = sample == 0 ? z_mm : std::min(low_mm, z_mm);
        high_mm = sample == 0 ? z_mm : std::max(high_mm, z_mm);
    }
    if (!found) return found;
    const Result<Moved> lifted = machine.move(
        {0, 0, sum[axis_z] + probe.lift_mm - machine.at_mm()[axis_z]}, probe.fast_mm_s);
    if (!lifted) return lifted.error();
    if (high_mm - low_mm <= probe.tolerance_mm) return sum;
    return machine_error(
        formatted("approaches of the probe differ by %.3f mm, and probe.tolerance_mm "
                  "is %g: clean the nozzle, or look for what is loose",
                  high_mm - low_mm, probe.tolerance_mm));
}

}  // namespace

Spot probe_spot(const config::Printer& printer) {
    const auto place = printer.probe->home_mm.value_or(
        std::array{middle_mm(printer.axes[axis_x]), middle_mm(printer.axes[axis_y])});
    return {place[0], place[1]};
}

Result<ByAxes::Positions> touch_bed(ByAxes& machine, const config::Printer& printer,
                                    const Spot& spot) {
    if (!config::probe_reaches(printer, spot.x_mm, spot.y_mm))
        return at(spot, machine_error("the probe cannot get there"));
    const ByAxes::Positions& from = machine.at_mm();
    const Result<Moved> there = machine.move(
        {spot.x_mm - printer.probe->offset_mm[0] - from[axis_x],
         spot.y_mm - printer.probe->offset_mm[1] - from[axis_y], 0},
        std::hypot(printer.axes[axis_x].max_speed_mm_s, printer.axes[axis_y].max_speed_mm_s));
    if (!there) return there.error();
    Result<ByAxes::Positions> touched = touch_here(machine, printer);
    if (!touched) return at(spot, touched.error());
    return touched;
}

}  // namespace lyr::home
