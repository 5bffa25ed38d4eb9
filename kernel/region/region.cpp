// Arrange, sweep, stitch, verify; once more in another way if the check fails.

#include "kernel/region/region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>

#include "kernel/contour/turned_round.h"
#include "kernel/geometry/tolerance.h"
#include "kernel/region/box_tree.h"
#include "kernel/region/stitch.h"
#include "kernel/region/verify.h"

namespace lyr {

double area_mm2(Region region) {
    double area = 0;
    for (const Contour& contour : region) area += area_mm2(contour);
    return area;
}

double length_mm(Region region) {
    double length = 0;
    for (const Contour& contour : region) length += length_mm(contour);
    return length;
}

namespace {

using region::Input;
using region::Inside;
using region::Winding;

// Shares of allowed_mm. A curve bends to a vertex by one snap, to one that was moved there once more by two; what lies
// on one circle is joined within the other half. Below resolution_mm the input itself is not exact.
constexpr double snap_share = 0.25;
constexpr double join_share = 0.5;

// What is hard to tell in one direction of the sweep, or falls between being one and being two at one snap, seldom is
// so in another.
struct Attempt {
    double turn_rad, snap_factor;
};
constexpr std::array<Attempt, 3> attempts{{{0, 1}, {1, 1}, {2, 0.25}}};

// Edges that bend to a vertex and cross others for that are cut there and arranged again; the second time is the last,
// as a rule.
constexpr int most_rounds = 8;

struct Widths {
    Widths(double allowed, double sliver)
        : allowed_mm(allowed), sliver_mm(std::max(allowed, sliver)) {}

    double allowed_mm, sliver_mm;
};

struct AreaBounds {
    double least_mm2, most_mm2;
    bool whole_operands = true;  // made of the operands' areas, not of those of parts of them
};

constexpr AreaBounds any_area{0, std::numeric_limits<double>::infinity()};

// One of the results that an arrangement is made for.
struct Part {
    Inside inside;
    AreaBounds bounds;
};

Contour turned(const Contour& contour, double angle_rad) {
    if (angle_rad == 0) return contour;
    const Eigen::Rotation2Dd rotation(angle_rad);
    if (const auto* circle = std::get_if<FullCircle>(&contour)) {
        return FullCircle{rotation * circle->centre, circle->radius_mm, circle->counter_clockwise};
    }
    Path path = std::get<Path>(contour);
    path.start = rotation * path.start;
    for (Segment& segment : path.segments) segment.end = rotation * segment.end;
    return path;
}

// A total order of contours by their numbers.
bool precedes(const Contour& a, const Contour& b) {
    const auto key = [](const Contour& contour) {
        const Point2 start = start_of(contour);
        return std::tuple(start.y(), start.x(), contour.index());
    };
    if (key(a) != key(b)) return key(a) < key(b);
    if (const auto* circle = std::get_if<FullCircle>(&a)) {
        const auto& other = std::get<FullCircle>(b);
        return std::tuple(circle->radius_mm, circle->counter_clockwise) <
               std::tuple(other.radius_mm, other.counter_clockwise);
    }
    const auto& left = std::get<Path>(a).segments;
    const auto& right = std::get<Path>(b).segments;
    return std::lexicographical_compare(
        left.begin(), left.end(), right.begin(), right.end(),
        [](const Segment& one, const Segment& other) {
            return std::tuple(one.end.y(), one.end.x(), one.sagitta_mm) <
                   std::tuple(other.end.y(), other.end.x(), other.sagitta_mm);
        });
}

struct Swept {
    region::Arrangement arrangement;
    std::vector<region::Sweep> sweeps;  // by part
};

// As far as the rounds go; whether that is right is to be checked. What crosses does not depend on the part.
Swept swept(std::span<const Input> inputs, std::span<const Part> parts, double snap_mm) {
    Swept result{region::arranged(inputs, snap_mm), {}};
    region::Arrangement& arrangement = result.arrangement;
    region::Sweep first = region::swept(arrangement, parts[0].inside, snap_mm);
    for (int round = 1; round < most_rounds && !first.crossings.empty(); ++round) {
        arrangement = region::refined(arrangement, first.crossings, snap_mm);
        first = region::swept(arrangement, parts[0].inside, snap_mm);
    }
    result.sweeps.push_back(std::move(first));
    for (const Part& part : parts.subspan(1)) {
        result.sweeps.push_back(region::swept(arrangement, part.inside, snap_mm));
    }
    return result;
}

// The bounds hold for regions that do not cross themselves. Where one winds around points the wrong way, or more than
// once, its area is less than that of the points in it, or more.
bool area_agrees(Region result, const region::Arrangement& arrangement, const region::Sweep& sweep,
                 const Part& part, double slack_mm2) {
    const AreaBounds& bounds = part.bounds;
    const double area = area_mm2(result);
    const double crossed =
        region::area_mm2(arrangement, sweep, [](const Winding& w) { return w.a < 0 || w.b < 0; });
    const double repeated =
        !bounds.whole_operands ? 0 : region::area_mm2(arrangement, sweep, [](const Winding& w) {
            return std::max(0, w.a - 1) + std::max(0, w.b - 1);
        });
    return std::abs(area - region::area_mm2(arrangement, sweep, part.inside)) <= slack_mm2 &&
           area >= bounds.least_mm2 - crossed - repeated - slack_mm2 &&
           area <= bounds.most_mm2 + crossed + slack_mm2;
}

bool is_sound(const region::Sweep& sweep, double allowed_mm) {
    return sweep.contradictions == 0 && region::is_closed(sweep) &&
           sweep.worst_detour_mm <= allowed_mm;
}

// Of inputs that have been turned.
RegionResult contours_of(std::span<const Input> inputs, std::span<const Input> seen,
                         const region::Arrangement& arrangement, const region::Sweep& sweep,
                         double turn_rad, const Widths& widths) {
    const region::Stitched found = region::stitched(
        seen, arrangement, sweep, join_share * widths.allowed_mm, widths.sliver_mm);
    RegionResult result;
    result.changed = !found.built.empty() || found.whole.size() != inputs.size();
    result.slivers = found.slivers;
    for (const region::WholeInput& whole : found.whole) {
        const Contour& contour = *inputs[whole.input].contour;
        result.contours.push_back(whole.reversed ? turned_round(contour) : contour);
        result.changed = result.changed || whole.reversed;
    }
    for (const Contour& contour : found.built) {
        result.contours.push_back(turned(contour, -turn_rad));
    }
    return result;
}

// By part; none if any of them fails its check.
std::optional<std::vector<RegionResult>> attempt(std::span<const Input> inputs,
                                                 std::span<const Part> parts, const Attempt& how,
                                                 const Widths& widths) {
    std::vector<Contour> contours;
    for (const Input& input : inputs) contours.push_back(turned(*input.contour, how.turn_rad));
    std::vector<Input> seen(inputs.begin(), inputs.end());
    double length = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        seen[i].contour = &contours[i];
        length += length_mm(contours[i]);
    }
    const double snap_mm =
        std::max(resolution_mm, snap_share * widths.allowed_mm * how.snap_factor);
    const auto [arrangement, sweeps] = swept(seen, parts, snap_mm);
    if (!std::all_of(sweeps.begin(), sweeps.end(),
                     [&](const auto& sweep) { return is_sound(sweep, widths.allowed_mm); }) ||
        !region::windings_agree(seen, arrangement, sweeps[0], snap_mm)) {
        return std::nullopt;
    }
    std::vector<RegionResult> results;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        RegionResult result =
            contours_of(inputs, seen, arrangement, sweeps[i], how.turn_rad, widths);
        if (!area_agrees(result.contours, arrangement, sweeps[i], parts[i],
                         widths.sliver_mm * length)) {
            return std::nullopt;
        }
        result.contours = sorted(result.contours);
        results.push_back(std::move(result));
    }
    return results;
}

std::optional<std::vector<RegionResult>> evaluated(std::vector<Input> inputs,
                                                   std::span<const Part> parts,
                                                   const Widths& widths) {
    if (!std::all_of(inputs.begin(), inputs.end(),
                     [](const Input& input) { return region::is_finite(*input.contour); })) {
        return std::nullopt;
    }
    std::sort(inputs.begin(), inputs.end(), [](const Input& a, const Input& b) {
        if (precedes(*a.contour, *b.contour)) return true;
        if (precedes(*b.contour, *a.contour)) return false;
        return std::tie(a.weight.a, a.weight.b) < std::tie(b.weight.a, b.weight.b);
    });
    for (const Attempt& how : attempts) {
        if (auto results = attempt(inputs, parts, how, widths)) return results;
    }
    return std::nullopt;
}

std::optional<RegionResult> evaluated(std::vector<Input> inputs, const Inside& inside,
                                      const AreaBounds& bounds, const Widths& widths) {
    const Part part{inside, bounds};
    auto results = evaluated(std::move(inputs), std::span(&part, 1), widths);
    if (!results) return std::nullopt;
    return std::move(results->front());
}

void add(RegionResult& total, RegionResult part) {
    total.contours.insert(total.contours.end(), part.contours.begin(), part.contours.end());
    total.changed = total.changed || part.changed;
    total.slivers += part.slivers;
    total.unresolved += part.unresolved;
}

// As they were given.
RegionResult unresolved(std::span<const Region> regions) {
    RegionResult result{.unresolved = 1};
    for (const Region& region : regions) {
        result.contours.insert(result.contours.end(), region.begin(), region.end());
    }
    return result;
}

// For each region the least of those that its contours' boxes hang together with.
std::vector<std::size_t> groups_of(std::span<const Region> regions, double allowed_mm) {
    std::vector<region::Box2> boxes;
    std::vector<std::size_t> owner;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        for (const Contour& contour : regions[r]) {
            region::Box2 box = region::box_of(contour);
            const Vector2 margin(allowed_mm, allowed_mm);
            boxes.push_back({box.min() - margin, box.max() + margin});
            owner.push_back(r);
        }
    }
    std::vector<std::size_t> group(regions.size());
    std::iota(group.begin(), group.end(), std::size_t{0});
    const auto find = [&](std::size_t r) {
        while (group[r] != r) r = group[r] = group[group[r]];
        return r;
    };
    const region::BoxTree tree(boxes, region::BoxOrder::any);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        tree.meeting(boxes[i], [&](std::uint32_t j) {
            const std::size_t a = find(owner[i]), b = find(owner[j]);
            group[std::max(a, b)] = std::min(a, b);
        });
    }
    for (std::size_t r = 0; r < regions.size(); ++r) group[r] = find(r);
    return group;
}

RegionResult united_group(std::span<const Region> regions, const Widths& widths) {
    std::vector<Input> inputs;
    AreaBounds bounds{0, 0, false};
    for (const Region& region : regions) {
        const double area = area_mm2(region);
        bounds.least_mm2 = std::max(bounds.least_mm2, area);
        bounds.most_mm2 += std::max(0.0, area);
        for (const Contour& contour : region) inputs.push_back({&contour, {1, 0}});
    }
    auto result = evaluated(
        std::move(inputs), [](const Winding& w) { return w.a > 0; }, bounds, widths);
    return result ? std::move(*result) : unresolved(regions);
}

// Each operand's windings are a digit of a number: eight bits, as if it wound around nothing 128 times.
constexpr std::size_t operands_per_number = most_operands / 2;
constexpr int digit_bits = 8;
constexpr std::uint32_t no_winding = 128, no_windings = 0x80808080;

Winding weight_of(std::size_t operand) {
    const int digit = 1 << (digit_bits * static_cast<int>(operand % operands_per_number));
    return operand < operands_per_number ? Winding{digit, 0} : Winding{0, digit};
}

Membership membership(const Winding& winding) {
    Membership result = 0;
    std::uint32_t bit = 1;
    for (const int number : {winding.a, winding.b}) {
        std::uint32_t digits = static_cast<std::uint32_t>(number) + no_windings;
        for (std::size_t i = 0; i < operands_per_number; ++i, digits >>= digit_bits, bit <<= 1) {
            if ((digits & 0xff) > no_winding) result |= bit;
        }
    }
    return result;
}

AreaBounds bounds_of(Operation operation, double a_mm2, double b_mm2) {
    switch (operation) {
        case Operation::unite:
            return {std::max(a_mm2, b_mm2), a_mm2 + b_mm2};
        case Operation::intersect:
            return {0, std::min(a_mm2, b_mm2)};
        default:
            return {std::max(0.0, a_mm2 - b_mm2), a_mm2};
    }
}

}  // namespace

std::vector<Contour> sorted(Region contours) {
    std::vector<const Contour*> order;
    for (const Contour& contour : contours) order.push_back(&contour);
    std::sort(order.begin(), order.end(),
              [](const Contour* a, const Contour* b) { return precedes(*a, *b); });
    std::vector<Contour> result;
    for (const Contour* contour : order) result.push_back(*contour);
    return result;
}

RegionResult united(std::span<const Region> regions, double allowed_mm, double sliver_mm) {
    for (const Region& region : regions) {
        if (!std::all_of(region.begin(), region.end(), region::is_finite))
            return unresolved(regions);
    }
    const std::vector<std::size_t> group = groups_of(regions, allowed_mm);
    std::vector<std::vector<Region>> groups(regions.size());
    for (std::size_t r = 0; r < regions.size(); ++r) groups[group[r]].push_back(regions[r]);
    RegionResult result;
    for (const std::vector<Region>& members : groups) {
        if (members.size() > 1) {
            add(result, united_group(members, {allowed_mm, sliver_mm}));
        } else if (!members.empty()) {
            result.contours.insert(result.contours.end(), members[0].begin(), members[0].end());
        }
    }
    result.contours = sorted(result.contours);
    return result;
}

RegionResult cleaned(Region contours, double allowed_mm, double sliver_mm) {
    std::vector<Input> inputs;
    for (const Contour& contour : contours) inputs.push_back({&contour, {1, 0}});
    auto result = evaluated(std::move(inputs), [](const Winding& w) { return w.a > 0; }, any_area,
                            {allowed_mm, sliver_mm});
    return result ? std::move(*result) : unresolved(std::span(&contours, 1));
}

RegionResult combined(Region a, Region b, Operation operation, double allowed_mm,
                      double sliver_mm) {
    std::vector<Input> inputs;
    for (const Contour& contour : a) inputs.push_back({&contour, {1, 0}});
    for (const Contour& contour : b) inputs.push_back({&contour, {0, 1}});
    const auto inside = [operation](const Winding& w) {
        const bool in_a = w.a > 0, in_b = w.b > 0;
        switch (operation) {
            case Operation::unite:
                return in_a || in_b;
            case Operation::intersect:
                return in_a && in_b;
            default:
                return in_a && !in_b;
        }
    };
    auto result =
        evaluated(std::move(inputs), inside, bounds_of(operation, area_mm2(a), area_mm2(b)),
                  {allowed_mm, sliver_mm});
    return result ? std::move(*result) : unresolved(std::span(&a, 1));
}

std::optional<std::vector<RegionResult>> overlaid(std::span<const Region> operands,
                                                  std::span<const Wanted> wanted,
                                                  double allowed_mm) {
    if (operands.size() > most_operands) return std::nullopt;
    std::vector<Input> inputs;
    for (std::size_t i = 0; i < operands.size(); ++i) {
        for (const Contour& contour : operands[i]) inputs.push_back({&contour, weight_of(i)});
    }
    std::vector<Part> parts;
    for (const Wanted& is_wanted : wanted) {
        parts.push_back({[&](const Winding& w) { return is_wanted(membership(w)); }, any_area});
    }
    if (parts.empty()) return std::vector<RegionResult>{};
    return evaluated(std::move(inputs), parts, {allowed_mm, 0});
}

}  // namespace lyr
