#include "target/home/calibration.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/text.h"
#include "target/home/delta_fit.h"
#include "target/home/probing.h"
#include "target/moves/machine.h"

namespace lyr::home {
namespace {

using config::axis_x, config::axis_y, config::axis_z;

constexpr double deg_per_turn = 360;

Status check_possible(const config::Printer& printer, Calibration what) {
    const bool is_delta = printer.kinematics == config::Kinematics::delta;
    if (!printer.probe || !printer.probe->input)
        return machine_error("printer \"" + printer.name +
                             "\" has no probe.input to calibrate with");
    if (homable(printer).none())
        return machine_error("printer \"" + printer.name +
                             "\" has no endstops; it must be homed first");
    if (what == Calibration::delta && !is_delta)
        return machine_error("--calibrate delta is for kinematics = \"delta\"");
    if (what == Calibration::probe && !printer.endstops[axis_z].input)
        return machine_error(
            "the probe homes z itself, so that its height cannot be found by it: print "
            "a first layer, and correct probe.offset_mm");
    return Done{};
}

// The middle, and two rings of six: beside the towers and between them.
std::vector<Spot> delta_spots(const config::Printer& printer) {
    const auto& offset = printer.probe->offset_mm;
    const double reach_mm = printer.delta.reach_mm - std::hypot(offset[0], offset[1]);
    std::vector<Spot> spots{{0, 0}};
    for (const double share : {0.55, 1.0})
        for (int i = 0; i < 6; ++i) {
            const double angle_rad = (i * deg_per_turn / 6 + 30) * std::numbers::pi / 180;
            // Just within, so that rounding does not leave it.
            const double off_mm = 0.99 * share * reach_mm;
            spots.push_back({off_mm * std::cos(angle_rad), off_mm * std::sin(angle_rad)});
        }
    return spots;
}

// What the probe reaches, or on a delta a square within it.
std::array<double, 4> mesh_area(const config::Printer& printer) {
    if (printer.mesh.has_area) return printer.mesh.area_mm;
    const auto& offset = printer.probe->offset_mm;
    if (printer.kinematics == config::Kinematics::delta) {
        const double half_mm =
            (printer.delta.reach_mm - std::hypot(offset[0], offset[1])) / std::numbers::sqrt2;
        return {-half_mm, -half_mm, half_mm, half_mm};
    }
    std::array<double, 4> area{};
    for (const std::size_t axis : {axis_x, axis_y}) {
        const config::Axis& limits = printer.axes[axis];
        area[axis] = std::max(limits.min_mm, limits.min_mm + offset[axis]);
        area[axis + 2] = std::min(limits.max_mm, limits.max_mm + offset[axis]);
    }
    return area;
}

// Row by row, each the other way round than the one before, so that ways are short.
std::vector<Spot> mesh_spots(const config::BedMesh& mesh) {
    const auto& [x0, y0, x1, y1] = mesh.area_mm;
    std::vector<Spot> spots;
    for (int row = 0; row < mesh.points[1]; ++row)
        for (int i = 0; i < mesh.points[0]; ++i) {
            const int column = row % 2 == 0 ? i : mesh.points[0] - 1 - i;
            spots.push_back({x0 + (x1 - x0) * column / (mesh.points[0] - 1),
                             y0 + (y1 - y0) * row / (mesh.points[1] - 1)});
        }
    return spots;
}

std::vector<Spot> spots_of(const config::Printer& printer, Calibration what) {
    switch (what) {
        case Calibration::probe:
            return {probe_spot(printer)};
        case Calibration::delta:
            return delta_spots(printer);
        case Calibration::mesh:
            return mesh_spots(printer.mesh);
    }
    return {};
}

Status check_reached(const config::Printer& printer, const std::vector<Spot>& spots) {
    for (const Spot& spot : spots)
        if (!config::probe_reaches(printer, spot.x_mm, spot.y_mm))
            return machine_error(
                formatted("the probe cannot get to x %g, y %g: see mesh.area_mm and "
                          "probe.offset_mm",
                          spot.x_mm, spot.y_mm));
    return Done{};
}

// Over where the probe, whose offset may not be known yet, surely is not in the bed.
double safe_height_mm(const config::Printer& printer) {
    const config::Probe& probe = *printer.probe;
    return printer.axes[axis_z].min_mm + std::max(0.0, probe.offset_mm[2]) + probe.lift_mm +
           probe.reach_mm;
}

void note_calibrated(config::Printer& printer, std::initializer_list<const char*> keys) {
    for (const char* key : keys)
        if (std::find(printer.calibrated.begin(), printer.calibrated.end(), key) ==
            printer.calibrated.end())
            printer.calibrated.emplace_back(key);
}

Result<std::string> calibrate_probe(config::Printer& printer,
                                    const std::vector<ByAxes::Positions>& touched) {
    printer.probe->offset_mm[2] = touched.front()[axis_z];
    note_calibrated(printer, {"probe.offset_mm"});
    return formatted("  the probe triggers with the nozzle %.3f mm over the bed\n",
                     touched.front()[axis_z]);
}

double worst_of(const std::vector<double>& heights_mm) {
    double worst_mm = 0;
    for (const double height_mm : heights_mm) worst_mm = std::max(worst_mm, std::abs(height_mm));
    return worst_mm;
}

Result<std::string> calibrate_delta(config::Printer& printer,
                                    const std::vector<ByAxes::Positions>& touched) {
    const motion::Kinematics kinematics = moves::kinematics_of(printer);
    std::vector<Touch> touches;
    for (const ByAxes::Positions& at : touched) {
        const auto carriages_mm = motion::motors_at(kinematics, {at[0], at[1], at[2]});
        Touch& touch = touches.emplace_back();
        touch.nozzle_mm = printer.probe->offset_mm[2];
        for (std::size_t tower = 0; tower < 3; ++tower)
            touch.below_endstop_mm[tower] =
                carriage_endstop_mm(printer, tower) - carriages_mm[tower];
    }
    std::optional<config::Printer> found = fit_delta(printer, touches);
    if (!found)
        return machine_error("no frame of a delta fits what was probed: check delta.arm_mm");
    const double before_mm = worst_of(heights_of(printer, touches));
    const double after_mm = worst_of(heights_of(*found, touches));
    printer = std::move(*found);
    std::erase_if(printer.calibrated,
                  [](const std::string& key) { return key.starts_with("mesh."); });
    printer.mesh.heights_mm.clear();
    note_calibrated(printer, {"delta.radius_mm", "delta.tower_angle_deg", "axis.x.endstop_mm",
                              "axis.y.endstop_mm", "axis.z.endstop_mm"});
    return formatted("  the bed was found up to %.3f mm off; with this frame it is %.3f mm\n",
                     before_mm, after_mm);
}

Result<std::string> calibrate_mesh(config::Printer& printer,
                                   const std::vector<ByAxes::Positions>& touched) {
    config::BedMesh& mesh = printer.mesh;
    const auto columns = static_cast<std::size_t>(mesh.points[0]);
    mesh.heights_mm.assign(static_cast<std::size_t>(mesh.points[1]), std::vector<double>(columns));
    double low_mm = 0, high_mm = 0;
    for (std::size_t i = 0; i < touched.size(); ++i) {
        const std::size_t row = i / columns, in_row = i % columns;
        const double height_mm = touched[i][axis_z] - printer.probe->offset_mm[2];
        mesh.heights_mm[row][row % 2 == 0 ? in_row : columns - 1 - in_row] = height_mm;
        low_mm = i == 0 ? height_mm : std::min(low_mm, height_mm);
        high_mm = i == 0 ? height_mm : std::max(high_mm, height_mm);
    }
    note_calibrated(printer, {"mesh.area_mm", "mesh.points", "mesh.heights_mm"});
    return formatted("  the bed is from %.3f to %.3f mm high\n", low_mm, high_mm);
}

template <class List>
std::string list_of(const List& values, const char* format) {
    std::string text = "[";
    for (std::size_t i = 0; i < values.size(); ++i)
        text += (i == 0 ? "" : ", ") + formatted(format, static_cast<double>(values[i]));
    return text + ']';
}

Result<std::vector<ByAxes::Positions>> touch_all(Mover& mover, const config::Printer& printer,
                                                 const std::vector<Spot>& spots,
                                                 const ProbeProgress& progress) {
    const Result<Homed> homed = home(mover, printer, homable(printer));
    if (!homed) return homed.error();
    motion::Point above = homed->head;
    above.z = safe_height_mm(printer);
    if (Status there = travel(mover, printer, homed->head, above); !there) return there.error();
    config::Printer machine = bare_machine(printer);
    machine.start_mm = {above.x, above.y, above.z};
    ByAxes axes(mover, machine);
    std::vector<ByAxes::Positions> touched;
    for (const Spot& spot : spots) {
        if (progress) progress(touched.size(), spots.size());
        const Result<ByAxes::Positions> touch = touch_bed(axes, printer, spot);
        if (!touch) return touch.error();
        touched.push_back(*touch);
    }
    return touched;
}

}  // namespace

Result<Calibrated> calibrate(const Job& job, Calibration what, const ProbeProgress& progress) {
    if (Status possible = check_possible(job.printer, what); !possible) return possible.error();
    Calibrated result{job.printer, {}, {}};
    config::Printer& printer = result.printer;
    if (!printer.uncalibrated)
        printer.uncalibrated = std::make_shared<const config::Printer>(job.printer);
    if (what == Calibration::mesh) {
        printer.mesh.area_mm = mesh_area(printer);
        printer.mesh.has_area = true;
    }
    const std::vector<Spot> spots = spots_of(printer, what);
    if (Status all = check_reached(printer, spots); !all) return all.error();
    std::vector<ByAxes::Positions> touched;
    const Status done = with_machine(job, result.warnings, [&](Mover& mover) -> Status {
        Result<std::vector<ByAxes::Positions>> all = touch_all(mover, printer, spots, progress);
        if (!all) return all.error();
        touched = std::move(*all);
        return Done{};
    });
    if (!done) return done.error();
    Result<std::string> text = what == Calibration::probe  ? calibrate_probe(printer, touched)
                               : what == Calibration::mesh ? calibrate_mesh(printer, touched)
                                                           : calibrate_delta(printer, touched);
    if (!text) return text.error();
    result.text = std::move(*text);
    return result;
}

std::string calibration_toml(const config::Printer& printer) {
    const auto has = [&](std::string_view key) {
        return std::find(printer.calibrated.begin(), printer.calibrated.end(), key) !=
               printer.calibrated.end();
    };
    std::string text = "# Written by lyrrun --calibrate.\n";
    if (has("delta.radius_mm") || has("delta.tower_angle_deg"))
        text += "\n[delta]\nradius_mm = " + list_of(printer.delta.radius_mm, "%.4f") +
                "\ntower_angle_deg = " + list_of(printer.delta.tower_angle_deg, "%.5f") + '\n';
    for (std::size_t i = 0; i < printer.endstops.size(); ++i) {
        const std::string axis = "axis." + std::string(config::axis_names[i]);
        if (has(axis + ".endstop_mm"))
            text +=
                formatted("\n[%s]\nendstop_mm = %.4f\n", axis.c_str(), *printer.endstops[i].at_mm);
    }
    if (has("probe.offset_mm"))
        text += "\n[probe]\noffset_mm = " + list_of(printer.probe->offset_mm, "%.4f") + '\n';
    if (!has("mesh.heights_mm")) return text;
    text += "\n[mesh]\narea_mm = " + list_of(printer.mesh.area_mm, "%.4f") +
            "\npoints = " + list_of(printer.mesh.points, "%.0f");
    if (has("mesh.fade_mm")) text += formatted("\nfade_mm = %g", printer.mesh.fade_mm);
    text += "\nheights_mm = [\n";
    for (const std::vector<double>& row : printer.mesh.heights_mm)
        text += "    " + list_of(row, "%.4f") + ",\n";
    return text + "]\n";
}

}  // namespace lyr::home
