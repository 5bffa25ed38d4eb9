#include "target/config/homing_keys.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "target/config/key_rules.h"

namespace lyr::config {
namespace {

constexpr Range positions_mm{-10'000, 10'000};
constexpr Range speeds_mm_s{0, 1'000, true};
constexpr std::array<std::string_view, 2> end_names{"low", "high"};

void append_endstop(std::vector<Key>& keys, std::size_t i) {
    const std::string axis = "axis." + std::string(axis_names[i]) + '.';
    append_input(keys, axis + "endstop", [i](Draft& draft) -> std::optional<Pin>& {
        return draft.printer.endstops[i].input;
    });
    keys.push_back(choice(axis + "endstop_end", end_names, [i](Draft& draft, std::size_t end) {
        draft.printer.endstops[i].at_high_end = end == 1;
    }));
    keys.push_back(number(axis + "endstop_mm", positions_mm, [i](Draft& draft, double value) {
        draft.printer.endstops[i].at_mm = value;
    }));
    const auto append = [&](const char* name, Range range, double Endstop::*field) {
        keys.push_back(number(axis + name, range, [i, field](Draft& draft, double value) {
            draft.printer.endstops[i].*field = value;
        }));
    };
    append("home_speed_mm_s", speeds_mm_s, &Endstop::fast_mm_s);
    append("home_slow_mm_s", speeds_mm_s, &Endstop::slow_mm_s);
    append("home_back_off_mm", {0.1, 100}, &Endstop::back_off_mm);
}

// "xyz" in any order.
Complaint apply_order(const toml::node& node, Homing& homing) {
    const std::string text = node.value<std::string>().value_or("");
    std::string sorted = text;
    std::sort(sorted.begin(), sorted.end());
    if (sorted != "xyz") return "expected \"xyz\" in any order";
    for (std::size_t i = 0; i < homing.order.size(); ++i)
        homing.order[i] = static_cast<std::size_t>(text[i] - 'x');
    return std::nullopt;
}

void append_homing(std::vector<Key>& keys) {
    keys.push_back({"homing.order", false, false, [](const toml::node& node, Draft& draft) {
                        return apply_order(node, draft.printer.homing);
                    }});
    const auto append = [&](const char* name, Range range, double Homing::*field) {
        keys.push_back(number(name, range, [field](Draft& draft, double value) {
            draft.printer.homing.*field = value;
        }));
    };
    append("homing.lift_mm", {0, 100}, &Homing::lift_mm);
    append("homing.margin_mm", {0.1, 1'000}, &Homing::margin_mm);
    append("homing.tolerance_mm", {0.001, 10}, &Homing::tolerance_mm);
    append("homing.settle_ms", {0, 100}, &Homing::settle_ms);
    keys.push_back(flag("homing.before_print", [](Draft& draft, bool value) {
        draft.printer.homing.before_print = value;
    }));
}

Probe& probe_of(Draft& draft) {
    std::optional<Probe>& probe = draft.printer.probe;
    if (!probe) probe.emplace();
    return *probe;
}

// A list of as many numbers as `store` takes.
template <std::size_t N>
Key list(std::string path, const char* what, Range range,
         const std::function<void(Draft&, const std::array<double, N>&)>& store) {
    return {std::move(path), false, false,
            [what, range, store](const toml::node& node, Draft& draft) -> Complaint {
                const auto values = numbers_in<N>(node, range);
                if (!values)
                    return "expected a list " + std::string(what) + ", each " + text_of(range);
                store(draft, *values);
                return std::nullopt;
            }};
}

void append_probe(std::vector<Key>& keys) {
    append_input(keys, "probe.input",
                 [](Draft& draft) -> std::optional<Pin>& { return probe_of(draft).input; });
    keys.push_back(list<3>("probe.offset_mm", "[x, y, z]", {-500, 500},
                           [](Draft& draft, const auto& v) { probe_of(draft).offset_mm = v; }));
    keys.push_back(list<2>("probe.home_mm", "[x, y]", positions_mm,
                           [](Draft& draft, const auto& v) { probe_of(draft).home_mm = v; }));
    const auto append = [&](const char* name, Range range, double Probe::*field) {
        keys.push_back(number(
            name, range, [field](Draft& draft, double value) { probe_of(draft).*field = value; }));
    };
    append("probe.speed_mm_s", speeds_mm_s, &Probe::fast_mm_s);
    append("probe.slow_mm_s", speeds_mm_s, &Probe::slow_mm_s);
    append("probe.lift_mm", {0.1, 100}, &Probe::lift_mm);
    append("probe.tolerance_mm", {0.001, 10}, &Probe::tolerance_mm);
    append("probe.reach_mm", {0.1, 100}, &Probe::reach_mm);
    keys.push_back(number("probe.samples", {1, 20}, [](Draft& draft, double value) {
        probe_of(draft).samples = static_cast<int>(std::lround(value));
    }));
}

// As many rows as there are points along y, each with a height for every point along x.
Complaint apply_heights(const toml::node& node, BedMesh& mesh) {
    constexpr std::size_t most = 100;
    constexpr Range heights_mm{-50, 50};
    const char* what =
        "expected a list of 2 to 100 rows, each a list of as many heights from -50 to 50";
    const auto* rows = node.as_array();
    if (!rows || rows->size() < 2 || rows->size() > most) return what;
    std::vector<std::vector<double>> heights;
    for (const toml::node& entry : *rows) {
        const auto* row = entry.as_array();
        if (!row || row->size() < 2 || row->size() > most) return what;
        std::vector<double>& values = heights.emplace_back();
        for (const toml::node& place : *row) {
            const auto value = number_in(place, heights_mm);
            if (!value) return what;
            values.push_back(*value);
        }
        if (values.size() != heights.front().size()) return what;
    }
    mesh.heights_mm = std::move(heights);
    return std::nullopt;
}

void append_mesh(std::vector<Key>& keys) {
    keys.push_back(list<4>("mesh.area_mm", "[x, y, x, y] of two corners", positions_mm,
                           [](Draft& draft, const auto& v) {
                               draft.printer.mesh.area_mm = v;
                               draft.printer.mesh.has_area = true;
                           }));
    keys.push_back(
        list<2>("mesh.points", "[along x, along y]", {2, 100}, [](Draft& draft, const auto& v) {
            draft.printer.mesh.points = {static_cast<int>(std::lround(v[0])),
                                         static_cast<int>(std::lround(v[1]))};
        }));
    keys.push_back(number("mesh.fade_mm", {0, 1'000},
                          [](Draft& draft, double value) { draft.printer.mesh.fade_mm = value; }));
    keys.push_back({"mesh.heights_mm", false, false, [](const toml::node& node, Draft& draft) {
                        return apply_heights(node, draft.printer.mesh);
                    }});
}

Complaint apply_bumps(const toml::node& node, SimulatedMachine& machine) {
    const char* what = "expected a list of bumps [x, y, height, radius], radius above 0";
    const auto* bumps = node.as_array();
    if (!bumps) return what;
    machine.bumps.clear();
    for (const toml::node& entry : *bumps) {
        const auto values = numbers_in<4>(entry, positions_mm);
        if (!values || !((*values)[3] > 0)) return what;
        machine.bumps.push_back({(*values)[0], (*values)[1], (*values)[2], (*values)[3]});
    }
    return std::nullopt;
}

void append_simulated(std::vector<Key>& keys) {
    keys.push_back(
        list<3>("simulate.head_mm", "[x, y, z]", positions_mm,
                [](Draft& draft, const auto& v) { draft.printer.simulated.head_mm = v; }));
    keys.push_back(number("simulate.bed_mm", {-50, 50}, [](Draft& draft, double value) {
        draft.printer.simulated.bed_mm = value;
    }));
    keys.push_back(
        list<2>("simulate.bed_tilt", "[along x, along y]", {-0.1, 0.1},
                [](Draft& draft, const auto& v) { draft.printer.simulated.bed_tilt = v; }));
    keys.push_back({"simulate.bumps", false, false, [](const toml::node& node, Draft& draft) {
                        return apply_bumps(node, draft.printer.simulated);
                    }});
    keys.push_back(number("simulate.probe_noise_mm", {0, 1}, [](Draft& draft, double value) {
        draft.printer.simulated.probe_noise_mm = value;
    }));
    keys.push_back(
        list<3>("simulate.probe_offset_mm", "[x, y, z]", {-500, 500},
                [](Draft& draft, const auto& v) { draft.printer.simulated.probe_offset_mm = v; }));
    const auto towers = [&](const char* name, std::array<double, 3> SimulatedMachine::*field) {
        keys.push_back(list<3>(name, "of three", {-20, 20}, [field](Draft& draft, const auto& v) {
            draft.printer.simulated.*field = v;
        }));
    };
    towers("simulate.arm_error_mm", &SimulatedMachine::arm_error_mm);
    towers("simulate.radius_error_mm", &SimulatedMachine::radius_error_mm);
    towers("simulate.angle_error_deg", &SimulatedMachine::angle_error_deg);
    towers("simulate.endstop_error_mm", &SimulatedMachine::endstop_error_mm);
}

void append_endstop_problems(const Printer& printer, std::size_t number, Problems& problems) {
    const Endstop& endstop = printer.endstops[number];
    if (!endstop.input) return;
    const bool is_delta = printer.kinematics == Kinematics::delta;
    // Each tower of a delta stands for the height of the head.
    const std::size_t limited = is_delta ? static_cast<std::size_t>(axis_z) : number;
    const Axis& axis = printer.axes[limited];
    const bool is_high = endstop.at_high_end || is_delta;
    const std::string path = "axis." + std::string(axis_names[number]) + '.';
    const std::string range =
        formatted("axis.%s.range_mm = [%g, %g]", std::string(axis_names[limited]).c_str(),
                  axis.min_mm, axis.max_mm);
    if (endstop.at_mm && (is_high ? *endstop.at_mm <= axis.min_mm : *endstop.at_mm >= axis.max_mm))
        problems.emplace_back(
            path + "endstop_mm",
            formatted(": %g is at the other end of %s%s", *endstop.at_mm, range.c_str(),
                      is_delta  ? ""
                      : is_high ? "; endstop_end = \"low\" would have it there"
                                : "; endstop_end = \"high\" would have it there"));
    if (endstop.back_off_mm >= axis.max_mm - axis.min_mm)
        problems.emplace_back(path + "home_back_off_mm", ": longer than all of " + range);
}

// How high the head goes before anything is homed, and before the bed is probed.
void append_height_problems(const Printer& printer, const Given& given, Problems& problems) {
    const Axis& z = printer.axes[axis_z];
    const double room_mm = z.max_mm - z.min_mm;
    const std::string range = formatted("axis.z.range_mm = [%g, %g]", z.min_mm, z.max_mm);
    const auto key = [&](const char* name) { return given(name) ? name : "axis.z.range_mm"; };
    const bool has_probe = printer.probe && printer.probe->input;
    const bool lifts =
        printer.kinematics != Kinematics::delta && (printer.endstops[axis_z].input || has_probe);
    if (lifts && printer.homing.lift_mm >= room_mm)
        problems.emplace_back(
            key("homing.lift_mm"),
            formatted(": homing.lift_mm = %g is more than all of ", printer.homing.lift_mm) +
                range);
    if (!has_probe) return;
    const Probe& probe = *printer.probe;
    const double offset_mm = std::max(0.0, probe.offset_mm[2]);
    if (offset_mm + probe.lift_mm + probe.reach_mm > room_mm)
        problems.emplace_back(
            key(given("probe.reach_mm") ? "probe.reach_mm" : "probe.lift_mm"),
            formatted(": probing begins at probe.lift_mm = %g and probe.reach_mm = %g over where "
                      "the probe triggers, which is more than all of ",
                      probe.lift_mm, probe.reach_mm) +
                range);
}

void append_probe_problems(const Printer& printer, const Given& given, Problems& problems) {
    if (!printer.probe || !printer.probe->input) return;
    const auto need = [&](const std::string& key, double x_mm, double y_mm) {
        if (probe_reaches(printer, x_mm, y_mm)) return true;
        problems.emplace_back(
            key, formatted(": the probe cannot get to x = %g, y = %g, since with probe.offset_mm "
                           "= [%g, %g, %g] the head would stand at x = %g, y = %g",
                           x_mm, y_mm, printer.probe->offset_mm[0], printer.probe->offset_mm[1],
                           printer.probe->offset_mm[2], x_mm - printer.probe->offset_mm[0],
                           y_mm - printer.probe->offset_mm[1]));
        return false;
    };
    const bool is_delta = printer.kinematics == Kinematics::delta;
    const Axis &x = printer.axes[axis_x], &y = printer.axes[axis_y];
    const auto& offset_mm = printer.probe->offset_mm;
    if (is_delta ? std::hypot(offset_mm[0], offset_mm[1]) >= printer.delta.reach_mm
                 : std::abs(offset_mm[0]) >= x.max_mm - x.min_mm ||
                       std::abs(offset_mm[1]) >= y.max_mm - y.min_mm)
        problems.emplace_back("probe.offset_mm",
                              ": so far from the nozzle the probe is never over the bed");
    else if (given("probe.home_mm"))
        need("probe.home_mm", (*printer.probe->home_mm)[0], (*printer.probe->home_mm)[1]);
    else if (!is_delta && !printer.endstops[axis_z].input &&
             !probe_reaches(printer, (x.min_mm + x.max_mm) / 2, (y.min_mm + y.max_mm) / 2))
        problems.emplace_back("probe.offset_mm",
                              ": with it the probe, which homes z, cannot get to the middle of the "
                              "bed; say in probe.home_mm where it can");
    // What has been measured already was within reach.
    if (!printer.mesh.has_area || !printer.mesh.heights_mm.empty()) return;
    const auto& [x0, y0, x1, y1] = printer.mesh.area_mm;
    for (const auto& [x_mm, y_mm] : {std::pair{x0, y0}, {x1, y0}, {x0, y1}, {x1, y1}})
        if (!need("mesh.area_mm", x_mm, y_mm)) return;
}

void append_mesh_problems(const BedMesh& mesh, Problems& problems) {
    const auto& [x0, y0, x1, y1] = mesh.area_mm;
    if (mesh.has_area && !(x0 < x1 && y0 < y1))
        problems.emplace_back("mesh.area_mm",
                              ": the first corner must be the lower one in x and y");
    if (mesh.heights_mm.empty()) return;
    double most_mm = 0;
    for (const std::vector<double>& row : mesh.heights_mm)
        for (const double height_mm : row) most_mm = std::max(most_mm, std::abs(height_mm));
    if (mesh.fade_mm > 0 && mesh.fade_mm <= most_mm)
        problems.emplace_back(
            "mesh.fade_mm",
            formatted(
                ": the bed is up to %g mm off by mesh.heights_mm; fade it out over many times "
                "that, or never (0)",
                most_mm));
    if (!mesh.has_area) problems.emplace_back("mesh.heights_mm", ": needs mesh.area_mm beside it");
    const std::size_t rows = mesh.heights_mm.size(), columns = mesh.heights_mm.front().size();
    if (columns != static_cast<std::size_t>(mesh.points[0]) ||
        rows != static_cast<std::size_t>(mesh.points[1]))
        problems.emplace_back(
            "mesh.heights_mm",
            formatted(": %zu rows of %zu heights are not the mesh.points = [%d, %d]", rows, columns,
                      mesh.points[0], mesh.points[1]));
}

// A simulated head that its endstops would never find, or that its arms do not hold.
void append_simulated_problems(const Printer& printer, Problems& problems) {
    const SimulatedMachine& truth = printer.simulated;
    const bool is_delta = printer.kinematics == Kinematics::delta;
    if (is_delta)
        for (std::size_t i = 0; i < truth.arm_error_mm.size(); ++i)
            if (printer.delta.radius_mm[i] + truth.radius_error_mm[i] + printer.delta.reach_mm >=
                printer.delta.arm_mm[i] + truth.arm_error_mm[i]) {
                problems.emplace_back("simulate",
                                      ": with these errors an arm does not reach delta.reach_mm");
                break;
            }
    if (!truth.head_mm) return;
    const auto& head_mm = *truth.head_mm;
    if (is_delta && std::hypot(head_mm[0], head_mm[1]) > printer.delta.reach_mm)
        problems.emplace_back("simulate.head_mm", ": farther from the middle than delta.reach_mm");
    for (std::size_t i = axis_x; i <= axis_z && !is_delta; ++i) {
        const double margin_mm = printer.homing.margin_mm;
        const double nearest_mm = std::clamp(head_mm[i], printer.axes[i].min_mm - margin_mm,
                                             printer.axes[i].max_mm + margin_mm);
        if (printer.endstops[i].input && nearest_mm != head_mm[i])
            problems.emplace_back("simulate.head_mm",
                                  formatted(": %s, by more than homing.margin_mm = %g",
                                            outside(printer, i, head_mm[i])->c_str(), margin_mm));
    }
}

}  // namespace

bool probe_reaches(const Printer& printer, double x_mm, double y_mm) {
    // Corners that are exactly on a limit are within it.
    constexpr double rounding_mm = 1e-6;
    const std::array<double, 2> head_mm{x_mm - printer.probe->offset_mm[0],
                                        y_mm - printer.probe->offset_mm[1]};
    for (const std::size_t axis : {axis_x, axis_y})
        if (head_mm[axis] < printer.axes[axis].min_mm - rounding_mm ||
            head_mm[axis] > printer.axes[axis].max_mm + rounding_mm)
            return false;
    return printer.kinematics != Kinematics::delta ||
           std::hypot(head_mm[0], head_mm[1]) <= printer.delta.reach_mm + rounding_mm;
}

bool is_calibration_key(std::string_view path) {
    constexpr std::array<std::string_view, 10> keys{
        "delta.radius_mm",   "delta.tower_angle_deg", "axis.x.endstop_mm", "axis.y.endstop_mm",
        "axis.z.endstop_mm", "probe.offset_mm",       "mesh.area_mm",      "mesh.points",
        "mesh.heights_mm",   "mesh.fade_mm"};
    return std::find(keys.begin(), keys.end(), path) != keys.end();
}

void append_homing_keys(std::vector<Key>& keys) {
    for (std::size_t axis = axis_x; axis <= axis_z; ++axis) append_endstop(keys, axis);
    append_homing(keys);
    append_probe(keys);
    append_mesh(keys);
    append_simulated(keys);
}

Problems homing_problems(const Printer& printer, const Given& given) {
    Problems problems;
    const bool is_delta = printer.kinematics == Kinematics::delta;
    std::size_t inputs = 0;
    for (std::size_t axis = axis_x; axis <= axis_z; ++axis) {
        const Endstop& endstop = printer.endstops[axis];
        const std::string path = "axis." + std::string(axis_names[axis]) + '.';
        inputs += endstop.input ? 1 : 0;
        append_endstop_problems(printer, axis, problems);
        if (endstop.slow_mm_s > endstop.fast_mm_s)
            problems.emplace_back(
                path + "home_slow_mm_s",
                formatted(": faster than %shome_speed_mm_s = %g", path.c_str(), endstop.fast_mm_s));
        if (is_delta && given(path + "endstop_end") && !endstop.at_high_end)
            problems.emplace_back(path + "endstop_end",
                                  ": the endstops of a delta are at the high end");
    }
    if (is_delta && inputs != 0 && inputs != 3)
        problems.emplace_back("axis", ": a delta needs the endstops of all three towers or none");
    if (printer.probe && printer.probe->slow_mm_s > printer.probe->fast_mm_s)
        problems.emplace_back("probe.slow_mm_s", formatted(": faster than probe.speed_mm_s = %g",
                                                           printer.probe->fast_mm_s));
    if (is_delta && inputs == 0 && printer.probe && printer.probe->input)
        problems.emplace_back("probe.input",
                              ": a delta is probed only after it has been homed by its endstops, "
                              "axis.x.endstop and so on, which it has none of");
    append_height_problems(printer, given, problems);
    append_probe_problems(printer, given, problems);
    append_mesh_problems(printer.mesh, problems);
    append_simulated_problems(printer, problems);
    return problems;
}

}  // namespace lyr::config
