// One pass of FilePath with a box around each curve.

#include "target/run/inspect.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "target/moves/move_maker.h"
#include "target/run/reach.h"

namespace lyr::run {
namespace {

using config::axis_names;
using config::axis_x;
using config::axis_y;
using config::axis_z;

// Ends that are exactly on the limit must not fail by the rounding of a centre: far below a step.
constexpr double rounding_mm = 1e-6;

struct Box {
    AxisValues low_mm, high_mm;

    void include(const AxisValues& point_mm) {
        for (std::size_t i = 0; i < point_mm.size(); ++i) {
            low_mm[i] = std::min(low_mm[i], point_mm[i]);
            high_mm[i] = std::max(high_mm[i], point_mm[i]);
        }
    }
};

Box box_of(const PathCurve& curve) {
    Box box{curve.from_mm, curve.from_mm};
    box.include(curve.to_mm);
    if (!curve.is_arc) return box;
    // Turning points are at whole quarter turns.
    constexpr double quarter_rad = std::numbers::pi / 2;
    const double from = curve.start_angle_rad, to = from + curve.sweep_rad;
    const double last = std::max(from, to) / quarter_rad;
    for (double quarter = std::ceil(std::min(from, to) / quarter_rad); quarter <= last; ++quarter)
        box.include(curve.at((quarter * quarter_rad - from) / curve.sweep_rad));
    return box;
}

Status check_range(const Box& box, const PathCurve& curve, const std::string& path,
                   const config::Printer& printer) {
    for (const std::size_t i : {axis_x, axis_y, axis_z}) {
        const config::Axis& axis = printer.axes[i];
        const bool below = box.low_mm[i] < axis.min_mm - rounding_mm;
        if (!below && !(box.high_mm[i] > axis.max_mm + rounding_mm)) continue;
        const std::string name(axis_names[i]);
        char text[200];
        std::snprintf(text, sizeof text,
                      "the path goes to %.3f mm on axis %s, and axis.%s.range_mm is %g to %g",
                      below ? box.low_mm[i] : box.high_mm[i], name.c_str(), name.c_str(),
                      axis.min_mm, axis.max_mm);
        Diagnostic error = machine_error(text);
        error.where.file = path;
        error.where.layer = static_cast<int>(curve.layer) + 1;
        return error;
    }
    return Done{};
}

}  // namespace

Result<format::Reader> open_file(const std::string& path, std::uint32_t first_layer) {
    const Result<PrintFile> file = PrintFile::open(path);
    if (!file) return file.error();
    return file->reader(first_layer);
}

Result<Inspection> inspect(const std::string& path, const config::Printer& printer) {
    const Result<PrintFile> file = PrintFile::open(path);
    if (!file) return file.error();
    return inspect(*file, printer);
}

Result<Inspection> inspect(const PrintFile& print, const config::Printer& printer) {
    Result<format::Reader> reader = print.reader();
    if (!reader) return reader.error();
    const std::string& path = print.path();
    Inspection inspection;
    inspection.header = reader->header();
    inspection.filament_diameter_mm =
        moves::filament_diameter_mm(printer, inspection.header.metadata.filament_diameter_mm);
    if (!(inspection.filament_diameter_mm > 0))
        return Diagnostic{
            Severity::error,
            ExitStatus::input,
            "the file states no filament diameter; set filament_diameter_mm of the printer",
            {.file = path}};
    FilePath file(std::move(*reader), printer.start_mm, inspection.filament_diameter_mm);
    PathCurve curve;
    Box all{};
    for (std::size_t i = 0; i < printer.start_mm.size(); ++i)
        all.low_mm[i] = all.high_mm[i] = printer.start_mm[i];
    for (;;) {
        const Result<bool> more = file.next(curve);
        if (!more) return more.error();
        if (!*more) break;
        const Box box = box_of(curve);
        if (const Status in_range = check_range(box, curve, path, printer); !in_range)
            return in_range.error();
        if (const Status reached = check_reach(curve, path, printer); !reached)
            return reached.error();
        all.include(box.low_mm);
        all.include(box.high_mm);
    }
    inspection.totals = file.totals();
    inspection.demands = file.demands();
    if (inspection.demands.highest_tool > 0)
        return Diagnostic{Severity::error,
                          ExitStatus::unsupported,
                          "the file uses tool " + std::to_string(inspection.demands.highest_tool) +
                              "; this printer has tool 0 only",
                          {.file = path}};
    if (const auto layer = inspection.demands.still_layer) {
        Diagnostic still{Severity::error,
                         ExitStatus::input,
                         "a path has a speed of 0 mm/s: a .lyr file states speeds in steps of 0.01 "
                         "mm/s, and what it was made from asks for less",
                         {.file = path}};
        still.where.layer = static_cast<int>(*layer);
        return still;
    }
    inspection.low_mm = all.low_mm;
    inspection.high_mm = all.high_mm;
    // Written to meanwhile, it has been seen in part.
    if (const Status same = print.check(); !same) return same.error();
    return inspection;
}

}  // namespace lyr::run
