// Rows say which outlines of the window leave something wide enough bare, and which of them say it all. One overlay with
// these gives what is bare; opened, so that what is too narrow goes, and grown, it is laid over the inside and divides it.

#include "kernel/toolpath/skins.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "kernel/region/verify.h"
#include "kernel/toolpath/islands.h"
#include "kernel/toolpath/offset.h"

namespace lyr {
namespace {

// With two rows in a width, a disc of a width has an interval of sqrt(3)/2 widths on one of them; a little less is asked
// for, because of round-off.
constexpr double wide_share = 0.86;

// Of a width: what rows find bare because of one more outline, in shorter intervals only, is not worth an operand.
constexpr double narrow_share = 0.125;

// Of a width: how far what is solid reaches over what has to be.
constexpr double anchor_share = 1;

using Contours = std::vector<Contour>;

// The layers that decide what is solid, and what is so without asking them.
struct Window {
    std::size_t first, last;  // [first, last), the layer itself among them
    bool all_solid, all_top, all_bottom;
};

Window window_of(std::size_t layer, std::size_t count, const SkinRequest& request) {
    const std::size_t top = request.top_layers, bottom = request.bottom_layers;
    return {.first = layer - std::min(layer, bottom),
            .last = std::min(count, layer + top + 1),
            .all_solid = layer < bottom || layer + top >= count,
            .all_top = layer + 1 == count && top > 0,
            .all_bottom = layer == 0 && bottom > 0};
}

// An outline and what it leaves bare of the inside.
struct Bare {
    std::size_t layer;
    RowCover rows;
};

// Outlines of other shapes than the layer's own, each once. What is farther says more, as a rule, but the next ones
// above and below are asked for themselves too.
std::vector<Bare> bare_rows(std::span<const SkinOutline> outlines, std::size_t layer,
                            const Window& window, Region inside, const SkinRequest& request) {
    std::vector<std::size_t> others;
    const auto is_new = [&](std::size_t other) {
        const Region region = outlines[other].region();
        return !std::ranges::equal(region, outlines[layer].region()) &&
               std::none_of(others.begin(), others.end(), [&](std::size_t known) {
                   return std::ranges::equal(region, outlines[known].region());
               });
    };
    // From the layer outwards, so that of the same outlines the nearest counts.
    for (std::size_t k = layer + 1; k < window.last; ++k)
        if (is_new(k)) others.push_back(k);
    for (std::size_t k = layer; k-- > window.first;)
        if (is_new(k)) others.push_back(k);
    std::vector<Bare> result;
    if (others.empty()) return result;
    const RowCover rows(inside, SkinOutline::pitch_mm(request.width_mm));
    for (const std::size_t other : others)
        result.push_back({other, rows.without(outlines[other].rows())});
    return result;
}

// The outlines that leave bare, to within what is narrow, all that any of them does; none if that is nowhere wide.
std::vector<std::size_t> decisive(std::vector<Bare> bare, const SkinRequest& request) {
    std::stable_sort(bare.begin(), bare.end(), [](const Bare& a, const Bare& b) {
        return a.rows.length_mm() > b.rows.length_mm();
    });
    std::vector<std::size_t> layers;
    RowCover together;
    for (const Bare& one : bare) {
        if (one.rows.without(together).longest_mm() <= narrow_share * request.width_mm) continue;
        together = together.with(one.rows);
        layers.push_back(one.layer);
    }
    if (together.longest_mm() < wide_share * request.width_mm) layers.clear();
    return layers;
}

// The outlines to be asked what they leave bare, by layer: all together for what is solid, the next ones for skins.
struct Questions {
    std::vector<std::size_t> solid{};
    std::vector<std::size_t> top{}, bridge{};  // one or none

    bool empty() const { return solid.empty() && top.empty() && bridge.empty(); }
};

// An overlay has room for these beside the inside and the two next outlines.
constexpr std::size_t most_decisive = most_operands - 3;

Questions questions_of(std::span<const SkinOutline> outlines, std::size_t layer,
                       const Window& window, Region inside, const SkinRequest& request) {
    std::vector<Bare> bare = bare_rows(outlines, layer, window, inside, request);
    // Of the same outlines only one is among them.
    const auto wide = [&](std::size_t other) -> std::vector<std::size_t> {
        for (const Bare& one : bare) {
            if (std::ranges::equal(outlines[one.layer].region(), outlines[other].region()) &&
                one.rows.longest_mm() >= wide_share * request.width_mm) {
                return {one.layer};
            }
        }
        return {};
    };
    Questions questions;
    if (layer + 1 < window.last) questions.top = wide(layer + 1);
    if (layer > window.first) questions.bridge = wide(layer - 1);
    if (!window.all_solid) questions.solid = decisive(std::move(bare), request);
    return questions;
}

// Bare parts of the inside, at first just what the questions say.
struct Parts {
    Contours solid{}, top{}, bridge{};
    std::size_t slivers = 0;
};

using Settled = std::optional<Parts>;

// What of the first operand is not in all of those.
Wanted bare_of(Membership all) {
    return [all](Membership in) { return (in & 1) != 0 && (in & all) != all; };
}

class Operands {
public:
    Operands(std::span<const SkinOutline> outlines, Region inside)
        : outlines_(outlines), regions_{inside} {}

    Membership add(std::span<const std::size_t> layers) {
        Membership all = 0;
        for (const std::size_t layer : layers) {
            const auto found = std::find(layers_.begin(), layers_.end(), layer);
            const auto place = static_cast<std::size_t>(found - layers_.begin());
            if (found == layers_.end()) {
                layers_.push_back(layer);
                regions_.push_back(outlines_[layer].region());
            }
            all |= Membership{1} << (place + 1);
        }
        return all;
    }

    std::span<const Region> regions() const { return regions_; }

private:
    std::span<const SkinOutline> outlines_;
    std::vector<std::size_t> layers_{};
    std::vector<Region> regions_;
};

// For parts of more outlines than an overlay has room for.
bool unite(Contours& region, Region other, double allowed_mm, std::size_t& slivers) {
    RegionResult result = combined(region, other, Operation::unite, allowed_mm);
    region = std::move(result.contours);
    slivers += result.slivers;
    return result.unresolved == 0;
}

Settled bare_parts(std::span<const SkinOutline> outlines, Region inside, const Questions& questions,
                   const SkinRequest& request) {
    Parts parts;
    std::span<const std::size_t> left = questions.solid;
    const std::size_t now = std::min(left.size(), most_decisive);
    Operands operands(outlines, inside);
    const std::array wanted{bare_of(operands.add(left.first(now))),
                            bare_of(operands.add(questions.top)),
                            bare_of(operands.add(questions.bridge))};
    auto results = overlaid(operands.regions(), wanted, request.allowed_mm);
    if (!results) return std::nullopt;
    for (const RegionResult& result : *results) parts.slivers += result.slivers;
    parts.solid = std::move((*results)[0].contours);
    parts.top = std::move((*results)[1].contours);
    parts.bridge = std::move((*results)[2].contours);
    for (const std::size_t layer : left.subspan(now)) {
        const RegionResult more =
            combined(inside, outlines[layer].region(), Operation::subtract, request.allowed_mm);
        if (more.unresolved > 0 ||
            !unite(parts.solid, more.contours, request.allowed_mm, parts.slivers)) {
            return std::nullopt;
        }
    }
    return parts;
}

// Without what is narrower than a line, and reaching over the rest to where it is anchored. False: unresolved.
bool grow(Contours& region, const SkinRequest& request) {
    if (region.empty()) return true;
    OffsetRequest by{-request.width_mm / 2, request.allowed_mm, Corner::mitre};
    OffsetResult deep = offset(region, by);
    region = std::move(deep.contours);
    if (deep.unresolved || region.empty()) return !deep.unresolved;
    by.distance_mm = (0.5 + anchor_share) * request.width_mm;
    OffsetResult grown = offset(region, by);
    region = std::move(grown.contours);
    return !grown.unresolved;
}

bool grow(Parts& parts, const SkinRequest& request) {
    return grow(parts.solid, request) && grow(parts.top, request) && grow(parts.bridge, request);
}

// In the order in which they come before each other.
enum Kind : std::size_t { bridge, top, solid, sparse };

// What a point of the inside is, by where else it is: a bit each.
Kind kind_of(Membership in, const Window& window) {
    if ((in & 8) != 0) return bridge;
    if ((in & 4) != 0 || window.all_top) return top;
    return (in & 2) != 0 || window.all_solid ? solid : sparse;
}

std::optional<LayerSkins> divided(Region inside, const Parts& parts, const Window& window,
                                  const SkinRequest& request) {
    LayerSkins skins;
    const std::array<Contours*, 4> places{&skins.bridge, &skins.top, &skins.solid, &skins.sparse};
    if (parts.solid.empty() && parts.top.empty() && parts.bridge.empty()) {
        places[kind_of(1, window)]->assign(inside.begin(), inside.end());
        return skins;
    }
    const std::array<Region, 4> operands{inside, parts.solid, parts.top, parts.bridge};
    std::vector<Wanted> wanted;
    for (const Kind kind : {bridge, top, solid, sparse}) {
        wanted.push_back([kind, &window](Membership in) {
            return (in & 1) != 0 && kind_of(in, window) == kind;
        });
    }
    auto results = overlaid(operands, wanted, request.allowed_mm);
    if (!results) return std::nullopt;
    skins.slivers = parts.slivers;
    for (std::size_t i = 0; i < places.size(); ++i) {
        *places[i] = std::move((*results)[i].contours);
        skins.slivers += (*results)[i].slivers;
    }
    return skins;
}

// Smaller than it may be, or narrower than a line, taken over its length.
bool is_small(Region part, const SkinRequest& request) {
    const double area = area_mm2(part);
    return area < request.min_sparse_mm2 || 2 * area < request.width_mm * length_mm(part);
}

// Moves small parts of the sparse fill to the solid one. False: unresolved.
bool fill_small(LayerSkins& skins, const SkinRequest& request) {
    Contours small, large;
    for (const Contours& part : parts_of(skins.sparse)) {
        Contours& place = is_small(part, request) ? small : large;
        place.insert(place.end(), part.begin(), part.end());
    }
    if (small.empty()) return true;
    skins.sparse = std::move(large);
    return unite(skins.solid, small, request.allowed_mm, skins.slivers);
}

bool all_finite(Region region) {
    return std::all_of(region.begin(), region.end(), region::is_finite);
}

bool is_valid(std::span<const SkinOutline> outlines, std::size_t layer, Region inside,
              const SkinRequest& request) {
    if (layer >= outlines.size() || !(request.width_mm > 0) || !(request.allowed_mm > 0) ||
        !all_finite(inside)) {
        return false;
    }
    const Window window = window_of(layer, outlines.size(), request);
    const auto asked = outlines.subspan(window.first, window.last - window.first);
    return std::all_of(asked.begin(), asked.end(),
                       [](const SkinOutline& outline) { return outline.is_finite(); });
}

std::optional<LayerSkins> settled(std::span<const SkinOutline> outlines, std::size_t layer,
                                  Region inside, const SkinRequest& request) {
    const Window window = window_of(layer, outlines.size(), request);
    LayerSkins skins;
    if (window.all_bottom) {
        skins.bottom.assign(inside.begin(), inside.end());
        return skins;
    }
    const Questions questions = questions_of(outlines, layer, window, inside, request);
    Settled parts = Parts();
    if (!questions.empty()) parts = bare_parts(outlines, inside, questions, request);
    if (!parts || !grow(*parts, request)) return std::nullopt;
    auto result = divided(inside, *parts, window, request);
    if (!result || !fill_small(*result, request)) return std::nullopt;
    return result;
}

}  // namespace

SkinOutline::SkinOutline(Region region, double width_mm)
    : region_(region), finite_(width_mm > 0 && all_finite(region)) {
    if (finite_) rows_ = RowCover(region, pitch_mm(width_mm));
}

bool may_leave_bare(const SkinOutline& layer, const SkinOutline& other, double width_mm,
                    double diameter_mm) {
    const double pitch_mm = SkinOutline::pitch_mm(width_mm);
    const double longest_mm = layer.rows().without(other.rows()).longest_mm();
    return longest_mm * longest_mm >= diameter_mm * diameter_mm - pitch_mm * pitch_mm;
}

LayerSkins skins_of(std::span<const SkinOutline> outlines, std::size_t layer, Region inside,
                    const SkinRequest& request) {
    if (inside.empty()) return {};
    std::optional<LayerSkins> result;
    if (is_valid(outlines, layer, inside, request))
        result = settled(outlines, layer, inside, request);
    if (result) return std::move(*result);
    return {.solid = {inside.begin(), inside.end()}, .unresolved = 1};
}

}  // namespace lyr
