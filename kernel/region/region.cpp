// Arrange, sweep, stitch, verify; once more in another way if the check fails.

#include "kernel/region/region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>

#include "kernel/geometry/tolerance.h"
#include "kernel/region/box_tree.h"
#include "kernel/region/stitch.h"
#include "kernel/region/verify.h"

namespace lyr {
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
    double allowed_mm, sliver_mm;
};

struct AreaBounds {
    double least_mm2, most_mm2;
    bool whole_operands = true;  // made of the operands' areas, not of those of parts of them
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

Contour reversed(const Contour& contour) {
    if (const auto* circle = std::get_if<FullCircle>(&contour)) {
        return FullCircle{circle->centre, circle->radius_mm, !circle->counter_clockwise};
    }
    const Path& path = std::get<Path>(contour);
    Path result{path.start, {}};
    for (std::size_t i = path.segments.size(); i-- > 0;) {
        const Point2& end = i == 0 ? path.start : path.segments[i - 1].end;
        result.segments.push_back({end, -path.segments[i].sagitta_mm});
    }
    return result;
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

std::vector<Contour> sorted(Region contours) {
    std::vector<const Contour*> order;
    for (const Contour& contour : contours) order.push_back(&contour);
    std::sort(order.begin(), order.end(),
              [](const Contour* a, const Contour* b) { return precedes(*a, *b); });
    std::vector<Contour> result;
    for (const Contour* contour : order) result.push_back(*contour);
    return result;
}

double area_mm2(Region region) {
    double area = 0;
    for (const Contour& contour : region) area += area_mm2(contour);
    return area;
}

struct Swept {
    region::Arrangement arrangement;
    region::Sweep sweep;
};

// As far as the rounds go; whether that is right is to be checked.
Swept swept(std::span<const Input> inputs, const Inside& inside, double snap_mm) {
    region::Arrangement arrangement = region::arranged(inputs, snap_mm);
    region::Sweep sweep = region::swept(arrangement, inside, snap_mm);
    for (int round = 1; round < most_rounds && !sweep.crossings.empty(); ++round) {
        arrangement = region::refined(arrangement, sweep.crossings, snap_mm);
        sweep = region::swept(arrangement, inside, snap_mm);
    }
    return {std::move(arrangement), std::move(sweep)};
}

// The bounds hold for regions that do not cross themselves. Where one winds around points the wrong way, or more than
// once, its area is less than that of the points in it, or more.
bool area_agrees(Region result, const Swept& swept, const Inside& inside, const AreaBounds& bounds,
                 double slack_mm2) {
    const auto& [arrangement, sweep] = swept;
    const double area = area_mm2(result);
    const double crossed =
        region::area_mm2(arrangement, sweep, [](const Winding& w) { return w.a < 0 || w.b < 0; });
    const double repeated =
        !bounds.whole_operands ? 0 : region::area_mm2(arrangement, sweep, [](const Winding& w) {
            return std::max(0, w.a - 1) + std::max(0, w.b - 1);
        });
    return std::abs(area - region::area_mm2(arrangement, sweep, inside)) <= slack_mm2 &&
           area >= bounds.least_mm2 - crossed - repeated - slack_mm2 &&
           area <= bounds.most_mm2 + crossed + slack_mm2;
}

std::optional<RegionResult> attempt(std::span<const Input> inputs, const Inside& inside,
                                    const Attempt& how, const AreaBounds& bounds,
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
    const Swept found = swept(seen, inside, snap_mm);
    const auto& [arrangement, sweep] = found;
    if (sweep.contradictions > 0 || !region::is_closed(sweep) ||
        sweep.worst_detour_mm > widths.allowed_mm ||
        !region::windings_agree(seen, arrangement, sweep, snap_mm)) {
        return std::nullopt;
    }
    const double sliver_mm = std::max(widths.allowed_mm, widths.sliver_mm);
    const region::Stitched stitched =
        region::stitched(seen, arrangement, sweep, join_share * widths.allowed_mm, sliver_mm);
    RegionResult result;
    result.changed = !stitched.built.empty() || stitched.whole.size() != inputs.size();
    result.slivers = stitched.slivers;
    for (const region::WholeInput& whole : stitched.whole) {
        const Contour& contour = *inputs[whole.input].contour;
        result.contours.push_back(whole.reversed ? reversed(contour) : contour);
        result.changed = result.changed || whole.reversed;
    }
    for (const Contour& contour : stitched.built) {
        result.contours.push_back(turned(contour, -how.turn_rad));
    }
    if (!area_agrees(result.contours, found, inside, bounds, sliver_mm * length)) {
        return std::nullopt;
    }
    result.contours = sorted(result.contours);
    return result;
}

std::optional<RegionResult> evaluated(std::vector<Input> inputs, const Inside& inside,
                                      const AreaBounds& bounds, const Widths& widths) {
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
        if (auto result = attempt(inputs, inside, how, bounds, widths)) return result;
    }
    return std::nullopt;
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
    const region::BoxTree tree(boxes);
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
    auto result = evaluated(std::move(inputs), [](const Winding& w) { return w.a > 0; },
                            {0, std::numeric_limits<double>::infinity()}, {allowed_mm, sliver_mm});
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

}  // namespace lyr
