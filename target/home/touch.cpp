#include "target/home/touch.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/text.h"
#include "target/motion/kinematics.h"
#include "target/moves/machine.h"

namespace lyr::home {
namespace {

std::string name_of(const Target& target) {
    if (target.contact == config::contact_probe) return "the probe";
    return "endstop " + std::string(config::contact_names[target.contact]);
}

Diagnostic failed(const Target& target, const std::string& what) {
    return machine_error(name_of(target) + what);
}

Diagnostic never(const Target& target, double reach_mm) {
    return failed(target, formatted(" has not triggered within %.1f mm: is it connected, and does "
                                    "the axis move towards it?",
                                    reach_mm));
}

Diagnostic stuck(const Target& target) {
    return failed(target, formatted(" is still triggered after backing off by %g mm: it is stuck, "
                                    "not connected, or active_low is the wrong way round",
                                    target.back_off_mm));
}

Diagnostic differ(const Target& target, double off_mm) {
    return failed(target,
                  formatted(": two approaches differ by %.3f mm, and homing.tolerance_mm is %g: "
                            "the contact is loose, or the motor loses steps",
                            off_mm, target.tolerance_mm));
}

// Where several go together none is faster than its own endstop lets it.
double least(std::span<const Target> targets, double Target::*speed_mm_s) {
    return std::ranges::min(targets, {}, speed_mm_s).*speed_mm_s;
}

}  // namespace

ByAxes::Positions ByAxes::after(const Positions& from_mm, const motion::StepCounts& counts) const {
    const motion::Kinematics kinematics = moves::kinematics_of(machine_);
    std::array<double, 3> motors_mm =
        motion::motors_at(kinematics, {from_mm[0], from_mm[1], from_mm[2]});
    for (std::size_t i = 0; i < motors_mm.size(); ++i)
        motors_mm[i] += static_cast<double>(counts[i]) / machine_.axes[i].steps_per_mm;
    const motion::Point at = motion::head_at(kinematics, motors_mm);
    return {at.x, at.y, at.z};
}

Result<Moved> ByAxes::move(const Positions& way_mm, double speed_mm_s, Contacts watched) {
    const auto& [x, y, z] = at_mm_;
    machine_.start_mm = at_mm_;
    const motion::Line line{{x, y, z}, {x + way_mm[0], y + way_mm[1], z + way_mm[2]}};
    if (motion::length_of(line) <= motion::Planner::shortest_mm) return Moved();
    Result<Moved> moved = mover_.run(machine_, std::array{motion::Move{line, speed_mm_s}}, watched);
    if (!moved) return moved;
    at_mm_ = after(at_mm_, moved->counts);
    return moved;
}

Result<ByAxes::Positions> ByAxes::touch(std::span<const Target> targets, double speed_mm_s,
                                        double reach_mm) {
    Positions touched_mm{}, left_mm{};
    std::vector<Target> left(targets.begin(), targets.end());
    for (const Target& target : left) left_mm[target.axis] = reach_mm;
    while (!left.empty()) {
        Positions way_mm{};
        Contacts watched;
        for (const Target& target : left) {
            way_mm[target.axis] = target.direction * left_mm[target.axis];
            watched[target.contact] = true;
        }
        const Positions from_mm = at_mm_;
        const double together = std::sqrt(static_cast<double>(left.size()));
        const Result<Moved> moved = move(way_mm, speed_mm_s * together, watched);
        if (!moved) return moved.error();
        if (moved->contacts().none()) return never(left.front(), reach_mm);
        for (const Target& target : left) {
            left_mm[target.axis] -= std::abs(at_mm_[target.axis] - from_mm[target.axis]);
            const auto& counts = moved->at_contact[target.contact];
            if (!counts) continue;
            const Positions there_mm = after(from_mm, *counts);
            if (targets.size() == 1) touched_mm = there_mm;
            touched_mm[target.axis] = there_mm[target.axis];
        }
        std::erase_if(left, [&](const Target& target) {
            return moved->at_contact[target.contact].has_value();
        });
    }
    return touched_mm;
}

Status ByAxes::check_open(std::span<const Target> targets) {
    const Result<Contacts> touched = mover_.touched();
    if (!touched) return touched.error();
    for (const Target& target : targets)
        if ((*touched)[target.contact]) return stuck(target);
    return Done{};
}

Result<ByAxes::Positions> ByAxes::touch_slowly(std::span<const Target> targets,
                                               const Positions& leave_mm) {
    Positions way_mm{};
    double reach_mm = 0;
    for (const Target& target : targets) {
        way_mm[target.axis] =
            leave_mm[target.axis] - target.direction * target.back_off_mm - at_mm_[target.axis];
        reach_mm = std::max(reach_mm, 2 * target.back_off_mm);
    }
    const Result<Moved> moved = move(way_mm, least(targets, &Target::fast_mm_s));
    if (!moved) return moved.error();
    if (Status open = check_open(targets); !open) return open.error();
    return touch(targets, least(targets, &Target::slow_mm_s), reach_mm);
}

Result<double> ByAxes::home(std::span<const Target> targets) {
    const Result<Contacts> touched = mover_.touched();
    if (!touched) return touched.error();
    std::vector<Target> open;
    for (const Target& target : targets)
        if (!(*touched)[target.contact]) open.push_back(target);
    Positions first_mm = at_mm_;
    if (!open.empty()) {
        double reach_mm = 0;
        for (const Target& target : open) reach_mm = std::max(reach_mm, target.reach_mm);
        const Result<Positions> fast = touch(open, least(open, &Target::fast_mm_s), reach_mm);
        if (!fast) return fast.error();
        for (const Target& target : open) first_mm[target.axis] = (*fast)[target.axis];
    }
    Result<Positions> found_mm = touch_slowly(targets, first_mm);
    if (found_mm && open.size() < targets.size()) {
        first_mm = *found_mm;
        found_mm = touch_slowly(targets, first_mm);
    }
    if (!found_mm) return found_mm.error();
    double repeat_mm = 0;
    Positions away_mm{};
    for (const Target& target : targets) {
        const std::size_t axis = target.axis;
        const double off_mm = std::abs((*found_mm)[axis] - first_mm[axis]);
        if (off_mm > target.tolerance_mm) return differ(target, off_mm);
        repeat_mm = std::max(repeat_mm, off_mm);
        at_mm_[axis] += target.at_mm - (*found_mm)[axis];
        away_mm[axis] = target.at_mm - target.direction * target.back_off_mm - at_mm_[axis];
    }
    const Result<Moved> moved = move(away_mm, least(targets, &Target::fast_mm_s));
    if (!moved) return moved.error();
    return repeat_mm;
}

}  // namespace lyr::home
