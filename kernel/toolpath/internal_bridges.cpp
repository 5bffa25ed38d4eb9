// Rows tell whether there is anything wide enough. Then an overlay gives what lies on sparse fill; opened and grown, it
// divides solid and top in a second one.

#include "kernel/toolpath/internal_bridges.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "kernel/region/verify.h"
#include "kernel/toolpath/islands.h"
#include "kernel/toolpath/offset.h"

namespace lyr {
namespace {

// Of a line's width: how far a bridge reaches over what holds it.
constexpr double anchor_share = 1;

// With so many rows to a disc of a bridge's least width, neighbouring ones have 0.6 of that in common; a little less is
// asked for, because of round-off.
constexpr double rows_to_a_disc = 2.5;
constexpr double common_share = 0.59;

using Contours = std::vector<Contour>;
using Results = std::optional<std::vector<RegionResult>>;

constexpr Membership solid = 1, top = 2, third = 4;

bool is_solid(Membership in) {
    return (in & (solid | top)) != 0;
}

bool may_bridge(const LayerSkins& skins, Region sparse_below, const SkinRequest& request) {
    const double least_mm = internal_bridge_widths * request.width_mm;
    const double pitch_mm = least_mm / rows_to_a_disc;
    const RowCover below(sparse_below, pitch_mm);
    const RowCover above = RowCover(skins.solid, pitch_mm).with(RowCover(skins.top, pitch_mm));
    return above.common(below).longest_pair_mm() >= common_share * least_mm;
}

// Without what is too narrow, the rest reaching over to where it is held. None: unresolved.
std::optional<Contours> opened(Region region, const SkinRequest& request) {
    const double half_mm = internal_bridge_widths / 2 * request.width_mm;
    OffsetRequest by{-half_mm, request.allowed_mm, Corner::mitre};
    OffsetResult deep = offset(region, by);
    if (deep.unresolved) return std::nullopt;
    if (deep.contours.empty()) return Contours();
    by.distance_mm = half_mm + anchor_share * request.width_mm;
    OffsetResult grown = offset(deep.contours, by);
    if (grown.unresolved) return std::nullopt;
    return std::move(grown.contours);
}

Results overlay(const LayerSkins& skins, Region other, std::span<const Wanted> wanted,
                const SkinRequest& request) {
    const std::array<Region, 3> operands{skins.solid, skins.top, other};
    return overlaid(operands, wanted, request.allowed_mm);
}

bool divide(LayerSkins& skins, Region bridges, const SkinRequest& request) {
    const std::array<Wanted, 3> wanted{
        [](Membership in) { return is_solid(in) && (in & third) != 0; },
        [](Membership in) { return (in & third) == 0 && (in & (solid | top)) == solid; },
        [](Membership in) { return (in & third) == 0 && (in & top) != 0; }};
    Results results = overlay(skins, bridges, wanted, request);
    if (!results) return false;
    for (const RegionResult& result : *results) skins.slivers += result.slivers;
    skins.internal_bridge = std::move((*results)[0].contours);
    skins.solid = std::move((*results)[1].contours);
    skins.top = std::move((*results)[2].contours);
    return true;
}

// Contours that an operation leaves as they were are so bit for bit. Around a bridge a ring may be left, with the outer
// contour of before.
bool is_among(Region part, Region before) {
    return std::all_of(part.begin(), part.end(), [&](const Contour& contour) {
        return std::find(before.begin(), before.end(), contour) != before.end();
    });
}

// Moves new parts that are narrower than a line, taken over their length, to the bridges. False: unresolved.
bool take_narrow(Contours& region, Region before, LayerSkins& skins, const SkinRequest& request) {
    Contours narrow, wide;
    for (const Contours& part : parts_of(region)) {
        const bool is_narrow =
            2 * area_mm2(part) < request.width_mm * length_mm(part) && !is_among(part, before);
        Contours& place = is_narrow ? narrow : wide;
        place.insert(place.end(), part.begin(), part.end());
    }
    if (narrow.empty()) return true;
    RegionResult all =
        combined(skins.internal_bridge, narrow, Operation::unite, request.allowed_mm);
    skins.internal_bridge = std::move(all.contours);
    skins.slivers += all.slivers;
    region = std::move(wide);
    return all.unresolved == 0;
}

// None: unresolved.
std::optional<LayerSkins> bridged(const LayerSkins& before, Region sparse_below,
                                  const SkinRequest& request) {
    const Wanted both = [](Membership in) { return is_solid(in) && (in & third) != 0; };
    const Results over = overlay(before, sparse_below, std::span(&both, 1), request);
    if (!over) return std::nullopt;
    const auto bridges = opened(over->front().contours, request);
    if (!bridges) return std::nullopt;
    LayerSkins skins = before;
    if (bridges->empty()) return skins;
    if (!divide(skins, *bridges, request) ||
        !take_narrow(skins.solid, before.solid, skins, request) ||
        !take_narrow(skins.top, before.top, skins, request))
        return std::nullopt;
    return skins;
}

}  // namespace

void add_internal_bridges(LayerSkins& skins, Region sparse_below, const SkinRequest& request) {
    if (sparse_below.empty() || (skins.solid.empty() && skins.top.empty())) return;
    if (!(request.width_mm > 0) || !(request.allowed_mm > 0)) {
        ++skins.unresolved;
        return;
    }
    // Unresolved layers may have numbers that are not finite, and are counted already.
    if (skins.unresolved > 0 || !may_bridge(skins, sparse_below, request)) return;
    auto result = bridged(skins, sparse_below, request);
    if (result) {
        skins = std::move(*result);
    } else {
        ++skins.unresolved;
    }
}

}  // namespace lyr
