#include "target/home/delta_fit.h"

#include <cmath>

#include "target/home/least_squares.h"
#include "target/motion/kinematics.h"
#include "target/moves/machine.h"

namespace lyr::home {
namespace {

// Endstops, radius, two angles.
constexpr std::size_t unknowns = 6;
constexpr double endstops_mm = 1, radius_mm = 1, angle_deg = 0.5;

double endstop_height_mm(const config::Printer& printer, std::size_t tower) {
    return printer.endstops[tower].at_mm.value_or(printer.axes[config::axis_z].max_mm);
}

double arm_height_mm(const config::DeltaFrame& frame, std::size_t tower) {
    return std::sqrt((frame.arm_mm[tower] - frame.radius_mm[tower]) *
                     (frame.arm_mm[tower] + frame.radius_mm[tower]));
}

config::Printer changed(config::Printer printer, const Numbers& by) {
    for (std::size_t tower = 0; tower < 3; ++tower) {
        printer.endstops[tower].at_mm = endstop_height_mm(printer, tower) + by[tower];
        printer.delta.radius_mm[tower] += by[3];
    }
    printer.delta.tower_angle_deg[0] += by[4];
    printer.delta.tower_angle_deg[1] += by[5];
    return printer;
}

}  // namespace

double carriage_endstop_mm(const config::Printer& printer, std::size_t tower) {
    return endstop_height_mm(printer, tower) + arm_height_mm(printer.delta, tower);
}

std::vector<double> heights_of(const config::Printer& printer, const std::vector<Touch>& touches) {
    const motion::Kinematics kinematics = moves::kinematics_of(printer);
    std::array<double, 3> endstop_mm{};
    for (std::size_t tower = 0; tower < 3; ++tower)
        endstop_mm[tower] = carriage_endstop_mm(printer, tower);
    std::vector<double> heights_mm;
    for (const Touch& touch : touches) {
        std::array<double, 3> carriage_mm = endstop_mm;
        for (std::size_t tower = 0; tower < 3; ++tower)
            carriage_mm[tower] -= touch.below_endstop_mm[tower];
        heights_mm.push_back(motion::head_at(kinematics, carriage_mm).z - touch.nozzle_mm);
    }
    return heights_mm;
}

std::optional<config::Printer> fit_delta(const config::Printer& printer,
                                         const std::vector<Touch>& touches) {
    if (touches.size() <= unknowns) return std::nullopt;
    const auto residuals = [&](const Numbers& by) {
        return heights_of(changed(printer, by), touches);
    };
    const auto by =
        least_squares(residuals, Numbers(unknowns),
                      {endstops_mm, endstops_mm, endstops_mm, radius_mm, angle_deg, angle_deg});
    if (!by) return std::nullopt;
    return changed(printer, *by);
}

}  // namespace lyr::home
