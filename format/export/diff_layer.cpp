// What is the same at both ends of a layer is cut off; of the rest, ends of motions are paired if there are
// as many of them, and each is compared with the nearest one if not.

#include "format/export/diff_layer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/constants.h"
#include "base/text.h"

namespace lyr::format {
namespace {

struct Scaled {
    std::int64_t nm;
    Point operator()(const Point& p) const { return {p.x * nm, p.y * nm, p.z * nm}; }
};

// To nanometres; false: it does not count.
bool normalize(Operation& operation, std::uint32_t quantum_nm) {
    const Scaled scaled{quantum_nm};
    return std::visit(
        [&](auto& o) {
            using Type = std::decay_t<decltype(o)>;
            if constexpr (requires { o.to; }) o.from = scaled(o.from), o.to = scaled(o.to);
            if constexpr (requires { o.sagitta; }) o.sagitta *= quantum_nm;
            if constexpr (requires { o.center_x; })
                o.center_x *= quantum_nm, o.center_y *= quantum_nm;
            if constexpr (requires { o.hatch; }) o.hatch = false;
            return !std::is_same_v<Type, HatchStart>;
        },
        operation);
}

std::string text(const char* format, double a, double b = 0, double c = 0) {
    char line[96];
    std::snprintf(line, sizeof line, format, a, b, c);
    return line;
}

std::string place(const Point& p) {
    return text("(%.3f, %.3f, %.3f)", static_cast<double>(p.x) / nm_per_mm,
                static_cast<double>(p.y) / nm_per_mm, static_cast<double>(p.z) / nm_per_mm);
}

struct Describe {
    std::string operator()(const LayerStart&) const { return "layer"; }
    std::string operator()(const HatchStart&) const { return "hatch"; }
    std::string operator()(const PathStart& o) const {
        return "path: " + std::string(name_of(o.style.role)) +
               text(", %g x %g mm", o.style.width_mm, o.style.height_mm) +
               text(", %g mm/s", o.style.speed_mm_s);
    }
    std::string operator()(const Line& o) const { return "line to " + place(o.to); }
    std::string operator()(const Arc& o) const {
        return "arc to " + place(o.to) +
               text(", sagitta %.3f mm", static_cast<double>(o.sagitta) / nm_per_mm);
    }
    std::string operator()(const Circle& o) const {
        return "circle about " + place({o.center_x, o.center_y, o.to.z});
    }
    std::string operator()(const Travel& o) const { return "travel to " + place(o.to); }
    std::string operator()(const Wipe& o) const { return "wipe to " + place(o.to); }
    std::string operator()(const Width& o) const { return text("width %g mm", o.width_mm); }
    std::string operator()(const Speed& o) const { return text("speed %g mm/s", o.speed_mm_s); }
    std::string operator()(const Acceleration& o) const {
        return text("acceleration %g mm/s2", o.acceleration_mm_s2);
    }
    std::string operator()(const TravelSpeed& o) const {
        return text("travel speed %g mm/s", o.speed_mm_s);
    }
    std::string operator()(const TravelAcceleration& o) const {
        return text("travel acceleration %g mm/s2", o.acceleration_mm_s2);
    }
    std::string operator()(const Retract& o) const { return text("retract to %g mm", o.depth_mm); }
    std::string operator()(const Temperature& o) const {
        return text("temperature %g deg C", o.target_c);
    }
    std::string operator()(const Fan& o) const {
        return text("fan %g at %g", static_cast<double>(o.fan), o.duty);
    }
    std::string operator()(const Dwell& o) const { return text("wait %g s", o.time_ms / 1e3); }
    std::string operator()(const Tool& o) const { return "tool " + std::to_string(o.tool); }
    std::string operator()(const Pause&) const { return "pause"; }
    std::string operator()(const Object& o) const { return "object " + std::to_string(o.object); }
};

using Operations = std::vector<Operation>;

struct Ends {
    std::vector<Point> points;

    Ends(const Operations& all, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            std::visit(
                [&](const auto& o) {
                    if constexpr (requires { o.to; }) points.push_back(o.to);
                },
                all[i]);
    }
};

double distance(const Point& a, const Point& b) {
    return std::hypot(static_cast<double>(a.x - b.x), static_cast<double>(a.y - b.y),
                      static_cast<double>(a.z - b.z));
}

// The greatest distance of a point from the nearest of the others, which are looked through from its own x on
// to both sides.
double farthest_from(const std::vector<Point>& points, std::vector<Point> others) {
    const auto by_x = [](const Point& a, const Point& b) { return a.x < b.x; };
    std::sort(others.begin(), others.end(), by_x);
    double farthest = 0;
    for (const Point& point : points) {
        auto right = std::lower_bound(others.begin(), others.end(), point, by_x);
        auto left = right;
        double nearest = INFINITY;
        const auto within = [&](const Point& other) {
            return std::abs(static_cast<double>(other.x - point.x)) < nearest;
        };
        while (true) {
            const bool goes_left = left != others.begin() && within(*(left - 1));
            const bool goes_right = right != others.end() && within(*right);
            if (goes_left) nearest = std::min(nearest, distance(point, *--left));
            if (goes_right) nearest = std::min(nearest, distance(point, *right++));
            // No end can be the farthest that is nearer than one already found.
            if ((!goes_left && !goes_right) || nearest <= farthest) break;
        }
        if (std::isfinite(nearest)) farthest = std::max(farthest, nearest);
    }
    return farthest;
}

double farthest_ends(const Ends& a, const Ends& b) {
    if (a.points.size() != b.points.size())
        return std::max(farthest_from(a.points, b.points), farthest_from(b.points, a.points));
    double farthest = 0;
    for (std::size_t i = 0; i < a.points.size(); ++i)
        farthest = std::max(farthest, distance(a.points[i], b.points[i]));
    return farthest;
}

void compare_states(const LayerOperations& a, const LayerOperations& b,
                    std::vector<std::string>& out) {
    const LayerState &s = a.layer.state, &t = b.layer.state;
    const auto differ = [&](const char* name, double of_a, double of_b, const char* unit) {
        if (of_a == of_b) return;
        out.push_back(std::string(name) + ' ' + shortest(of_a) + ", " + shortest(of_b) + unit);
    };
    if (!(a.start == b.start)) out.push_back("start " + place(a.start) + ", " + place(b.start));
    differ("thickness", s.height_mm, t.height_mm, " mm");
    differ("travel speed", s.travel_speed_mm_s, t.travel_speed_mm_s, " mm/s");
    differ("travel acceleration", s.travel_acceleration_mm_s2, t.travel_acceleration_mm_s2,
           " mm/s2");
    differ("tool", s.tool, t.tool, "");
    differ("object", s.object, t.object, "");
    differ("retracted", s.retracted_mm, t.retracted_mm, " mm");
    differ("retraction", s.retract_length_mm, t.retract_length_mm, " mm");
    differ("speed of retraction", s.retract_speed_mm_s, t.retract_speed_mm_s, " mm/s");
    differ("speed back", s.unretract_speed_mm_s, t.unretract_speed_mm_s, " mm/s");
    const auto same_heat = [](const HeaterTarget& one, const HeaterTarget& other) {
        return one.heater == other.heater && one.target_c == other.target_c;
    };
    if (!std::equal(s.temperatures.begin(), s.temperatures.end(), t.temperatures.begin(),
                    t.temperatures.end(), same_heat))
        out.push_back("temperatures");
    if (!std::equal(s.fans.begin(), s.fans.end(), t.fans.begin(), t.fans.end()))
        out.push_back("fans");
}

}  // namespace

Status LayerSequence::next() {
    const std::int64_t z_before = now_.start.z;
    const bool follows = has_;
    has_ = false;
    now_.operations.clear();
    if (!begun_) {
        const auto first = reader_.next();
        if (!first) return first.error();
        begun_ = true;
        ended_ = !*first;
    }
    if (ended_) return Done{};
    const std::uint32_t nm = reader_.header().quantum.nm;
    now_.layer = reader_.layer();
    const LayerState& state = now_.layer.state;
    const Quantum quantum = reader_.header().quantum;
    now_.start = Scaled{nm}({quantum.quanta(state.start_x_mm), quantum.quanta(state.start_y_mm),
                             quantum.quanta(state.z_mm)});
    has_ = true;
    if (follows && now_.start.z < z_before) ++pass_;
    while (const Operation* read = reader_.read()) {
        Operation operation = *read;
        if (std::holds_alternative<LayerStart>(operation)) return Done{};
        if (normalize(operation, nm)) now_.operations.push_back(operation);
    }
    ended_ = true;
    if (reader_.error()) return *reader_.error();
    return Done{};
}

int compare_heights(const LayerSequence& a, const LayerSequence& b) {
    if (a.pass() != b.pass()) return a.pass() < b.pass() ? -1 : 1;
    const std::int64_t z_a = a.now().start.z, z_b = b.now().start.z;
    return z_a < z_b ? -1 : z_a > z_b ? 1 : 0;
}

std::optional<LayerDifference> compare(const LayerOperations& a, const LayerOperations& b) {
    LayerDifference out;
    compare_states(a, b, out.state);
    const Operations &of_a = a.operations, &of_b = b.operations;
    std::size_t begin = 0, end_a = of_a.size(), end_b = of_b.size();
    while (begin < end_a && begin < end_b && of_a[begin] == of_b[begin]) ++begin;
    while (end_a > begin && end_b > begin && of_a[end_a - 1] == of_b[end_b - 1]) --end_a, --end_b;
    if (out.state.empty() && begin == end_a && begin == end_b) return std::nullopt;
    out.a = a.layer.index;
    out.b = b.layer.index;
    out.z_mm = a.layer.state.z_mm;
    out.operations_a = of_a.size();
    out.operations_b = of_b.size();
    if (begin == end_a && begin == end_b) return out;
    const auto described = [&](const Operations& all) {
        return begin < all.size() ? std::visit(Describe{}, all[begin]) : "the layer's end";
    };
    out.first = begin + 1;
    out.first_a = described(of_a);
    out.first_b = described(of_b);
    out.changed_a = end_a - begin;
    out.changed_b = end_b - begin;
    out.farthest_mm = farthest_ends(Ends(of_a, begin, end_a), Ends(of_b, begin, end_b)) / nm_per_mm;
    return out;
}

}  // namespace lyr::format
