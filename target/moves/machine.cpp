#include "target/moves/machine.h"

#include <cmath>
#include <numbers>

#include "target/motion/shaper.h"

namespace lyr::moves {
namespace {

motion::Delta delta_of(const config::DeltaFrame& frame,
                       const std::array<double, motion::axis_count>& steps_per_mm) {
    motion::Delta delta{steps_per_mm, {}};
    for (std::size_t i = 0; i < motion::Delta::tower_count; ++i) {
        const double angle_rad = frame.tower_angle_deg[i] * std::numbers::pi / 180;
        delta.towers[i] = {frame.radius_mm[i] * std::cos(angle_rad),
                           frame.radius_mm[i] * std::sin(angle_rad), frame.arm_mm[i]};
    }
    return delta;
}

motion::ShaperKind kind_of(config::ShaperKind kind) {
    switch (kind) {
        case config::ShaperKind::none:
            return motion::ShaperKind::none;
        case config::ShaperKind::zv:
            return motion::ShaperKind::zv;
        case config::ShaperKind::mzv:
            return motion::ShaperKind::mzv;
        case config::ShaperKind::ei:
            return motion::ShaperKind::ei;
    }
    return motion::ShaperKind::none;
}

}  // namespace

motion::Kinematics kinematics_of(const config::Printer& printer) {
    std::array<double, motion::axis_count> steps_per_mm{};
    for (std::size_t i = 0; i < steps_per_mm.size(); ++i)
        steps_per_mm[i] = printer.axes[i].steps_per_mm;
    switch (printer.kinematics) {
        case config::Kinematics::cartesian:
            break;
        case config::Kinematics::corexy:
            return motion::CoreXy{steps_per_mm};
        case config::Kinematics::delta:
            return delta_of(printer.delta, steps_per_mm);
    }
    return motion::Cartesian{steps_per_mm};
}

std::shared_ptr<const motion::BedMesh> bed_of(const config::Printer& printer) {
    const config::BedMesh& mesh = printer.mesh;
    if (mesh.heights_mm.empty()) return nullptr;
    std::vector<double> heights_mm;
    for (const std::vector<double>& row : mesh.heights_mm)
        heights_mm.insert(heights_mm.end(), row.begin(), row.end());
    const auto& [x0, y0, x1, y1] = mesh.area_mm;
    return std::make_shared<const motion::BedMesh>(motion::Point{x0, y0}, motion::Point{x1, y1},
                                                   mesh.heights_mm.front().size(),
                                                   std::move(heights_mm), mesh.fade_mm);
}

motion::Shaping shaping_of(const config::Printer& printer) {
    motion::Shaping shaping;
    for (std::size_t axis = 0; axis < printer.shapers.size(); ++axis) {
        const config::InputShaper& shaper = printer.shapers[axis];
        shaping.axes[axis] = motion::taps_of(
            motion::Shaper{kind_of(shaper.kind), shaper.frequency_hz, shaper.damping}, axis);
    }
    for (std::size_t axis = 0; axis < printer.backlash_mm.size(); ++axis)
        shaping.play_steps[axis] = printer.backlash_mm[axis] * printer.axes[axis].steps_per_mm;
    shaping.extruder = motion::taps_of(
        motion::PressureAdvance{printer.pressure_advance_s, printer.pressure_smooth_s});
    shaping.bed = bed_of(printer);
    return shaping;
}

bool is_shaped(const config::Printer& printer) {
    for (const config::InputShaper& shaper : printer.shapers)
        if (shaper.kind != config::ShaperKind::none) return true;
    return printer.pressure_advance_s > 0;
}

bool is_timed(const config::Printer& printer) {
    for (const double backlash_mm : printer.backlash_mm)
        if (backlash_mm > 0) return true;
    return is_shaped(printer) || printer.kinematics == config::Kinematics::delta ||
           printer.max_jerk_mm_s3 > 0 || !printer.mesh.heights_mm.empty();
}

}  // namespace lyr::moves
