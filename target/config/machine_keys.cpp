#include "target/config/machine_keys.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/constants.h"
#include "base/text.h"
#include "target/config/key_rules.h"

namespace lyr::config {
namespace {

constexpr std::array<std::string_view, 3> kinematics_names{"cartesian", "corexy", "delta"};
constexpr std::array<std::string_view, 4> shaper_names{"none", "zv", "mzv", "ei"};

// One number for all three towers, or a list of three.
Key towers_key(std::string path, Range range, std::array<double, 3> DeltaFrame::*field) {
    return {std::move(path), false, false,
            [range, field](const toml::node& node, Draft& draft) -> Complaint {
                std::array<double, 3> values{};
                const auto* list = node.as_array();
                if (list && list->size() != values.size())
                    return "expected a number or a list of three";
                for (std::size_t i = 0; i < values.size(); ++i) {
                    const auto value = number_in(list ? *list->get(i) : node, range);
                    if (!value) return expected(text_of(range) + ", or a list of three", node);
                    values[i] = *value;
                }
                draft.printer.delta.*field = values;
                return std::nullopt;
            }};
}

void append_shaper(std::vector<Key>& keys, std::size_t axis) {
    const std::string path = "shaper." + std::string(axis_names[axis]) + '.';
    keys.push_back(choice(path + "kind", shaper_names, [axis](Draft& d, std::size_t kind) {
        d.printer.shapers[axis].kind = static_cast<ShaperKind>(kind);
    }));
    // Below, the copies of a motion are a second apart; above, no frame of a printer vibrates.
    keys.push_back(number(path + "frequency_hz", {2, 500}, [axis](Draft& d, double value) {
        d.printer.shapers[axis].frequency_hz = value;
    }));
    keys.push_back(number(path + "damping", {0, 0.9}, [axis](Draft& d, double value) {
        d.printer.shapers[axis].damping = value;
    }));
}

constexpr double full_turn_deg = 360;
// Far below the 120 of any delta that was ever built.
constexpr double least_apart_deg = 30;

void append_start_problems(const Printer& printer, const Given& given, Problems& problems) {
    for (std::size_t i = axis_x; i <= axis_z; ++i) {
        const auto where = outside(printer, i, printer.start_mm[i]);
        if (!where) continue;
        if (given("start_mm"))
            problems.emplace_back("start_mm", ": " + *where);
        else
            problems.emplace_back(
                "axis." + std::string(axis_names[i]) + ".range_mm",
                ": start_mm is [0, 0, 0] where it is not given, and " + *where + "; give start_mm");
    }
}

void append_shaper_problems(const Printer& printer, const Given& given, Problems& problems) {
    for (std::size_t axis = axis_x; axis <= axis_z; ++axis) {
        const std::string path = "shaper." + std::string(axis_names[axis]);
        if (printer.shapers[axis].kind != ShaperKind::none && !given(path + ".frequency_hz"))
            problems.emplace_back(path + ".kind", ": needs " + path + ".frequency_hz beside it");
    }
}

void append_delta_problems(const Printer& printer, const Given& given, Problems& problems) {
    if (!given("delta")) {
        problems.emplace_back("kinematics",
                              ": \"delta\" needs a section [delta] with arm_mm, radius_mm and "
                              "reach_mm");
        return;
    }
    bool whole = true;
    for (const char* key : {"delta.arm_mm", "delta.radius_mm", "delta.reach_mm"}) {
        if (given(key)) continue;
        problems.emplace_back(key, " is missing: kinematics = \"delta\" needs it");
        whole = false;
    }
    if (!whole) return;
    const DeltaFrame& frame = printer.delta;
    for (std::size_t i = 0; i < frame.arm_mm.size(); ++i)
        if (frame.radius_mm[i] + frame.reach_mm > flattest_arm_share * frame.arm_mm[i]) {
            problems.emplace_back(
                "delta.reach_mm",
                formatted(
                    ": an arm of %g mm reaches %g mm from the middle at the most", frame.arm_mm[i],
                    std::max(0.0, flattest_arm_share * frame.arm_mm[i] - frame.radius_mm[i])));
            break;
        }
    for (std::size_t i = 0; i < frame.tower_angle_deg.size(); ++i) {
        const double apart_deg = std::abs(std::remainder(
            frame.tower_angle_deg[i] - frame.tower_angle_deg[(i + 1) % 3], full_turn_deg));
        if (apart_deg >= least_apart_deg) continue;
        problems.emplace_back(
            "delta.tower_angle_deg",
            formatted(": two towers are %g degrees apart, and must be at least %g: with them in "
                      "one place nothing tells x from y",
                      apart_deg, least_apart_deg));
        break;
    }
    if (std::hypot(printer.start_mm[0], printer.start_mm[1]) > frame.reach_mm)
        problems.emplace_back("start_mm", ": farther from the middle than delta.reach_mm");
}

// Whoever calibrates x and y one by one, as on other machines, bends the corner between them.
void append_belt_problems(const Printer& printer, Problems& problems) {
    if (printer.kinematics != Kinematics::corexy) return;
    const double x = printer.axes[axis_x].steps_per_mm, y = printer.axes[axis_y].steps_per_mm;
    // Drivers may be set to different microsteps, which are powers of two.
    const double doublings = std::log2(y / x);
    constexpr double rounding = 1e-9;
    if (std::abs(doublings - std::round(doublings)) < rounding) return;
    problems.emplace_back(
        "axis.y.steps_per_mm",
        formatted(
            ": %g is not axis.x.steps_per_mm = %g, nor that doubled or halved for other "
            "microsteps: both belts of a CoreXY move x as well as y, so that neither axis has "
            "steps of its own",
            y, x));
}

}  // namespace

void append_machine_keys(std::vector<Key>& keys) {
    keys.push_back(choice("kinematics", kinematics_names, [](Draft& d, std::size_t kind) {
        d.printer.kinematics = static_cast<Kinematics>(kind);
    }));
    keys.push_back(number("max_jerk_mm_s3", {0, 1e9},
                          [](Draft& d, double v) { d.printer.max_jerk_mm_s3 = v; }));
    // Beyond, a short line is hardly begun before it ends.
    keys.push_back(number("minimum_cruise_ratio", {0, 0.95},
                          [](Draft& d, double v) { d.printer.minimum_cruise_ratio = v; }));
    keys.push_back(towers_key("delta.arm_mm", {1, 10'000}, &DeltaFrame::arm_mm));
    keys.push_back(towers_key("delta.radius_mm", {1, 10'000}, &DeltaFrame::radius_mm));
    keys.push_back(towers_key("delta.tower_angle_deg", {-360, 360}, &DeltaFrame::tower_angle_deg));
    keys.push_back(number("delta.reach_mm", {1, 10'000},
                          [](Draft& d, double v) { d.printer.delta.reach_mm = v; }));
    for (std::size_t axis = axis_x; axis <= axis_z; ++axis) {
        append_shaper(keys, axis);
        keys.push_back(number("axis." + std::string(axis_names[axis]) + ".backlash_mm", {0, 2},
                              [axis](Draft& d, double v) { d.printer.backlash_mm[axis] = v; }));
    }
    keys.push_back(number("pressure_advance.advance_s", {0, 2},
                          [](Draft& d, double v) { d.printer.pressure_advance_s = v; }));
    keys.push_back(number("pressure_advance.smooth_s", {0.001, 0.2},
                          [](Draft& d, double v) { d.printer.pressure_smooth_s = v; }));
}

Problems machine_problems(const Printer& printer, const Given& given) {
    Problems problems;
    if (printer.kinematics == Kinematics::delta) {
        append_delta_problems(printer, given, problems);
    } else if (given("delta")) {
        problems.emplace_back("delta", ": only for kinematics = \"delta\"");
    }
    if (printer.max_jerk_mm_s3 > 0 && printer.max_jerk_mm_s3 < 1)
        problems.emplace_back("max_jerk_mm_s3", ": expected 0 for no limit, or a number from 1 on");
    const double slowest_mm_s2 = std::min(printer.axes[axis_x].max_acceleration_mm_s2,
                                          printer.axes[axis_y].max_acceleration_mm_s2);
    // Where firmwares speak of jerk they mean a jump in speed, some 10 mm/s.
    if (printer.max_jerk_mm_s3 >= 1 && printer.max_jerk_mm_s3 < slowest_mm_s2)
        problems.emplace_back(
            "max_jerk_mm_s3",
            formatted(": with %g no axis gets to its max_acceleration_mm_s2 within a second, and "
                      "every move would crawl; it is a change of acceleration, not the jump in "
                      "speed that some firmwares call jerk: 100000 is a start, 0 no limit",
                      printer.max_jerk_mm_s3));
    append_belt_problems(printer, problems);
    append_start_problems(printer, given, problems);
    append_shaper_problems(printer, given, problems);
    const auto& late_ns = printer.timing.late_ns;
    if (late_ns && *late_ns >= printer.pulse.late_limit_ns)
        problems.emplace_back(
            "timing.late_us",
            formatted(": one edge in 10,000 is later than pulse.late_limit_ms = %g, which ends a "
                      "print",
                      static_cast<double>(printer.pulse.late_limit_ns) / ns_per_ms));
    return problems;
}

std::optional<std::string> outside(const Printer& printer, std::size_t axis, double at_mm) {
    const Axis& limits = printer.axes[axis];
    if (at_mm >= limits.min_mm && at_mm <= limits.max_mm) return std::nullopt;
    const std::string name(axis_names[axis]);
    return formatted("%s = %g is outside of axis.%s.range_mm = [%g, %g]", name.c_str(), at_mm,
                     name.c_str(), limits.min_mm, limits.max_mm);
}

double fastest_motor_mm_s(const Printer& printer, std::size_t motor) {
    const double x = printer.axes[axis_x].max_speed_mm_s, y = printer.axes[axis_y].max_speed_mm_s;
    if (motor == axis_e || printer.kinematics == Kinematics::cartesian)
        return printer.axes[motor].max_speed_mm_s;
    if (printer.kinematics == Kinematics::corexy)
        return motor == axis_z ? printer.axes[axis_z].max_speed_mm_s : x + y;
    const double off_mm = printer.delta.radius_mm[motor] + printer.delta.reach_mm;
    const double arm_mm = printer.delta.arm_mm[motor];
    const double height_mm = std::sqrt(std::max(0.0, (arm_mm - off_mm) * (arm_mm + off_mm)));
    // Without a frame there is nothing to say yet; that is another error.
    const double steepest = height_mm > 0 ? off_mm / height_mm : 0;
    return printer.axes[axis_z].max_speed_mm_s + std::hypot(x, y) * steepest;
}

double held_steps_per_s(const Printer& printer) {
    if (!printer.timing.late_ns) return std::numeric_limits<double>::infinity();
    const PulseTiming& pulse = printer.pulse;
    const std::int64_t edge_gap_ns =
        std::max({pulse.high_ns, pulse.low_ns, pulse.direction_setup_ns, pulse.direction_hold_ns});
    // Up and down for each motor, one after the other.
    constexpr std::int64_t edges = 2 * axis_count;
    return ns_per_s / static_cast<double>(*printer.timing.late_ns +
                                          edges * (printer.timing.write_ns + edge_gap_ns));
}

double held_speed_mm_s(const Printer& printer, std::size_t axis) {
    const double held_hz = held_steps_per_s(printer);
    double share = 1;
    for (std::size_t motor = 0; motor < axis_count; ++motor) {
        const bool moves_axis =
            motor == axis ||
            (motor != axis_e && axis != axis_e &&
             (printer.kinematics == Kinematics::delta ||
              (printer.kinematics == Kinematics::corexy && motor != axis_z && axis != axis_z)));
        if (!moves_axis) continue;
        const double asked_hz =
            fastest_motor_mm_s(printer, motor) * printer.axes[motor].steps_per_mm;
        share = std::min(share, held_hz / asked_hz);
    }
    return share * printer.axes[axis].max_speed_mm_s;
}

}  // namespace lyr::config
