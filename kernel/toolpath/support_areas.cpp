// From the top down: a layer's support is that of the layer above and what begins here, less what is kept clear.

#include "kernel/toolpath/support_areas.h"

#include <algorithm>
#include <utility>

#include "kernel/geometry/tolerance.h"
#include "kernel/region/curve.h"
#include "kernel/toolpath/offset.h"

namespace lyr {
namespace {

using Contours = std::vector<Contour>;

region::Box2 box_of(Region region) {
    region::Box2 box;
    for (const Contour& contour : region) box.extend(region::box_of(contour));
    return box;
}

// The layers of which `near` is true, from `layer` on in one direction.
template <class Near>
std::vector<Region> parts_while(std::span<const SupportLevel> levels, std::size_t layer, int step,
                                Near near) {
    std::vector<Region> parts;
    for (auto k = static_cast<std::ptrdiff_t>(layer) + step;
         k >= 0 && k < std::ssize(levels) && near(levels[static_cast<std::size_t>(k)]); k += step)
        parts.push_back(levels[static_cast<std::size_t>(k)].part);
    return parts;
}

// Overlays are of few operands; more are united first.
std::vector<Contours> gathered(const std::vector<Region>& regions, const region::Box2& where,
                               double allowed_mm, std::size_t& unresolved) {
    constexpr std::size_t most = 3;
    std::vector<Region> near;
    for (const Region& region : regions)
        if (!region.empty() && box_of(region).intersects(where)) near.push_back(region);
    std::vector<Contours> result;
    if (near.size() <= most) {
        for (const Region& region : near) result.emplace_back(region.begin(), region.end());
        return result;
    }
    RegionResult all = united(near, allowed_mm);
    unresolved += all.unresolved;
    result.push_back(std::move(all.contours));
    return result;
}

class Columns {
public:
    Columns(std::span<const SupportLevel> levels, std::span<const LayerRoom> rooms,
            const SupportRequest& request)
        : levels_(levels),
          rooms_(rooms),
          request_(request),
          begin_(beginnings(levels, rooms, request.gap_z_mm)) {}

    SupportAreas areas() {
        result_.layers.resize(levels_.size());
        is_cut_.resize(levels_.size());
        for (std::size_t i = levels_.size(); i-- > 0;) descend(i);
        for (std::size_t i = 1; i < levels_.size(); ++i)
            if (!result_.layers[i].empty()) keep_standing(i);
        return std::move(result_);
    }

private:
    void settle(std::size_t layer, std::size_t unresolved) {
        if (unresolved > 0) result_.unresolved.push_back(layer);
    }

    void descend(std::size_t i) {
        std::vector<Region> regions;
        for (const std::size_t above : begin_[i]) regions.push_back(rooms_[above].contact);
        if (i + 1 < levels_.size() && !result_.layers[i + 1].empty())
            regions.push_back(result_.layers[i + 1]);
        if (regions.empty()) return;
        RegionResult all = regions.size() == 1
                               ? RegionResult{.contours = {regions[0].begin(), regions[0].end()}}
                               : united(regions, request_.allowed_mm);
        const Contours& clear = rooms_[i].clear;
        RegionResult left = clear.empty() ? std::move(all)
                                          : combined(all.contours, clear, Operation::subtract,
                                                     request_.allowed_mm, sliver_mm());
        settle(i, all.unresolved + left.unresolved + rooms_[i].unresolved);
        is_cut_[i] = !clear.empty();
        result_.layers[i] = std::move(left.contours);
        if (!begin_[i].empty()) look_for_room(i);
    }

    // Into what is narrower no line fits: it would go all the way down and never be printed.
    double sliver_mm() const { return request_.width_mm / 2; }

    bool holds(std::size_t i, std::size_t above) const {
        const OffsetResult middles =
            offset(result_.layers[i],
                   {.distance_mm = -request_.width_mm / 2, .allowed_mm = request_.allowed_mm});
        return !combined(middles.contours, levels_[above].overhang, Operation::intersect,
                         request_.allowed_mm)
                    .contours.empty();
    }

    // Under the uppermost edge of a slope there may be room beside the part only: then support reaches out by a line more.
    void reach_out(std::size_t i, std::size_t above) {
        const SupportLevel& level = levels_[above];
        const OffsetResult reach =
            offset(level.part, {.distance_mm = request_.gap_xy_mm + request_.width_mm,
                                .allowed_mm = request_.allowed_mm});
        const RegionResult contact =
            combined(level.overhang, reach.contours, Operation::intersect, request_.allowed_mm);
        const RegionResult free = combined(contact.contours, rooms_[i].clear, Operation::subtract,
                                           request_.allowed_mm, sliver_mm());
        RegionResult all =
            combined(result_.layers[i], free.contours, Operation::unite, request_.allowed_mm);
        settle(i, reach.unresolved.has_value() + contact.unresolved + free.unresolved +
                      all.unresolved);
        result_.layers[i] = std::move(all.contours);
    }

    void look_for_room(std::size_t i) {
        for (const std::size_t above : begin_[i]) {
            if (holds(i, above)) continue;
            reach_out(i, above);
            if (!holds(i, above)) result_.out_of_reach.push_back(above);
        }
    }

    // What of a layer is over support or, but for the gap, over the part.
    void keep_standing(std::size_t i) {
        // Nothing was taken off below, so the layer below is as large.
        if (!is_cut_[i - 1] && !request_.on_bed_only) return;
        RegionResult standing = combined(
            result_.layers[i], request_.on_bed_only ? result_.layers[i - 1] : carried_over(i),
            Operation::intersect, request_.allowed_mm, sliver_mm());
        settle(i, standing.unresolved);
        is_cut_[i] = true;
        result_.layers[i] = std::move(standing.contours);
    }

    Contours moved(std::size_t i, Region region, double outwards_mm) {
        OffsetResult result =
            offset(region, {.distance_mm = outwards_mm, .allowed_mm = request_.allowed_mm});
        settle(i, result.unresolved.has_value());
        return std::move(result.contours);
    }

    // What lies below a layer, with the gaps between support and part, which lines reach over.
    Contours carried_over(std::size_t i) {
        const double low_mm = levels_[i].bottom_mm - request_.gap_z_mm + resolution_mm;
        // Rings that are too narrow for a line carry nothing.
        const Contours support =
            moved(i, moved(i, result_.layers[i - 1], -sliver_mm() / 2), sliver_mm() / 2);
        std::vector<Region> below{support};
        for (std::size_t k = i; k-- > 0;) {
            below.push_back(levels_[k].part);
            if (levels_[k].top_mm <= low_mm) break;
        }
        std::erase_if(below, [](const Region& region) { return region.empty(); });
        if (below.empty()) return {};
        const RegionResult all = united(below, request_.allowed_mm);
        const double half_gap_mm = request_.gap_xy_mm / 2 + sliver_mm();
        settle(i, all.unresolved);
        return moved(i, moved(i, all.contours, half_gap_mm), -half_gap_mm);
    }

    std::span<const SupportLevel> levels_;
    std::span<const LayerRoom> rooms_;
    const SupportRequest& request_;
    std::vector<std::vector<std::size_t>> begin_;  // by layer: overhangs whose support begins here
    std::vector<bool> is_cut_{};  // by layer: whether it may be smaller than the one above
    SupportAreas result_{};
};

// The interface's layers over the part: the regions of the part that they lie over.
std::vector<Region> parts_stood_on(std::span<const SupportLevel> levels, std::size_t layer,
                                   const SupportRequest& request) {
    const double from_mm = levels[layer].bottom_mm - request.gap_z_mm + resolution_mm;
    std::vector<Region> parts;
    for (std::size_t k = layer; k-- > 0 && parts.size() < request.interface_layers;)
        if (levels[k].top_mm <= from_mm) parts.push_back(levels[k].part);
    return parts;
}

std::vector<Region> overhangs_over(std::span<const SupportLevel> levels, std::size_t layer,
                                   const SupportRequest& request) {
    std::vector<Region> overhangs;
    const std::size_t end = std::min(levels.size() - layer, request.interface_layers) + layer;
    for (std::size_t i = layer + 1; i < levels.size(); ++i) {
        const std::size_t at = highest_support(levels, i, request.gap_z_mm);
        if (at == levels.size()) continue;
        if (at >= end) break;
        if (at >= layer) overhangs.push_back(levels[i].overhang);
    }
    return overhangs;
}

}  // namespace

std::size_t highest_support(std::span<const SupportLevel> levels, std::size_t layer,
                            double gap_z_mm) {
    const double top_mm = levels[layer].bottom_mm - gap_z_mm + resolution_mm;
    for (std::size_t k = layer; k-- > 0;)
        if (levels[k].top_mm <= top_mm) return k;
    return levels.size();
}

std::vector<std::vector<std::size_t>> beginnings(std::span<const SupportLevel> levels,
                                                 std::span<const LayerRoom> rooms,
                                                 double gap_z_mm) {
    std::vector<std::vector<std::size_t>> begin(levels.size());
    for (std::size_t i = 0; i < levels.size(); ++i) {
        if (rooms[i].contact.empty()) continue;
        const std::size_t at = highest_support(levels, i, gap_z_mm);
        if (at < levels.size()) begin[at].push_back(i);
    }
    return begin;
}

LayerRoom room_of(std::span<const SupportLevel> levels, std::size_t layer,
                  const SupportRequest& request) {
    const SupportLevel& level = levels[layer];
    const double low_mm = level.bottom_mm - request.gap_z_mm + resolution_mm;
    const double high_mm = level.top_mm + request.gap_z_mm - resolution_mm;
    std::vector<Region> parts = parts_while(
        levels, layer, -1, [&](const SupportLevel& below) { return below.top_mm > low_mm; });
    const std::vector<Region> above = parts_while(
        levels, layer, 1, [&](const SupportLevel& over) { return over.bottom_mm < high_mm; });
    parts.insert(parts.end(), above.begin(), above.end());
    std::erase_if(parts, [](const Region& part) { return part.empty(); });
    LayerRoom result;
    const auto grown = [&](double distance_mm) {
        OffsetResult around =
            offset(level.part, {.distance_mm = distance_mm, .allowed_mm = request.allowed_mm});
        result.unresolved += around.unresolved.has_value();
        return std::move(around.contours);
    };
    const auto take = [&](RegionResult made) {
        result.unresolved += made.unresolved;
        return std::move(made.contours);
    };
    const Contours beside = grown(request.gap_xy_mm);
    parts.push_back(beside);
    result.clear = take(united(parts, request.allowed_mm));
    if (level.overhang.empty()) return result;
    const Contours reach = request.gap_xy_mm < request.width_mm ? grown(request.width_mm) : beside;
    result.contact =
        take(combined(level.overhang, reach, Operation::intersect, request.allowed_mm));
    return result;
}

SupportAreas support_areas(std::span<const SupportLevel> levels, std::span<const LayerRoom> rooms,
                           const SupportRequest& request) {
    return Columns(levels, rooms, request).areas();
}

DividedSupport divided(Region inside, std::span<const SupportLevel> levels, std::size_t layer,
                       const SupportRequest& request) {
    DividedSupport result;
    if (inside.empty()) return result;
    const region::Box2 box = box_of(inside);
    std::vector<Contours> dense = gathered(overhangs_over(levels, layer, request), box,
                                           request.allowed_mm, result.unresolved);
    for (Contours& part : gathered(parts_stood_on(levels, layer, request), box, request.allowed_mm,
                                   result.unresolved))
        dense.push_back(std::move(part));
    std::vector<Region> operands{inside};
    operands.insert(operands.end(), dense.begin(), dense.end());
    const Wanted sparse = [](Membership in) { return in == 1; };
    const Wanted interface = [](Membership in) { return (in & 1) && in != 1; };
    const Wanted wanted[] = {sparse, interface};
    if (operands.size() == 1) {
        result.sparse.assign(inside.begin(), inside.end());
    } else if (auto parts = overlaid(operands, wanted, request.allowed_mm)) {
        result.sparse = std::move((*parts)[0].contours);
        result.interface = std::move((*parts)[1].contours);
    } else {
        ++result.unresolved;
        result.interface.assign(inside.begin(), inside.end());
    }
    return result;
}

}  // namespace lyr
