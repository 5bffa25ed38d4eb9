#include "slicer/balance.h"

#include <algorithm>
#include <numbers>

#include "base/text.h"
#include "kernel/toolpath/infill.h"
#include "slicer/material_map.h"

namespace lyr::slicer {
namespace {

using Kind = Imbalance::Kind;

// Of good prints no layer is off by as much as five squares as wide as a line (docs/algorithms/balance.md): where edges vanish
// and walls meet, sums of lengths and widths are not quite areas, the more the longer these are. Of small parts it is less,
// but a square at least.
constexpr double least_squares = 1, most_squares = 5, least_missing_share = 0.1;
constexpr double missing_share = 0.005, missing_along_outline_mm = 0.006;

// Walls that meet lie over each other by up to a quarter of their spacing, and fill that fits nowhere else does: more is
// laid down on purpose than less.
constexpr double surplus_share = 0.1;

// So many runs of layers are told one by one.
constexpr std::size_t most_told = 5;

// Calls take(way, lapped_mm, flow) for all that walls and solid fill lay down. What is lapped of the width is the
// neighbours'; the outermost walls have a neighbour on one side only, thin walls none.
template <class Take>
void for_laid(const OutlinedLayer& layer, const LayerFill& fill, const LayerSpan& span,
              const profile::Profile& profile, Take take) {
    const double height_mm = span.height_mm(), fill_width_mm = profile.skin.width_mm;
    const double fill_lap_mm = fill_width_mm - line_spacing_mm(fill_width_mm, height_mm);
    const double lap_mm = profile.perimeters.overlap * fill_lap_mm;
    for (std::size_t i = 0; i < layer.walls.strands.size(); ++i)
        take(layer.walls.strands[i], layer.walls.depths[i] == 0 ? lap_mm / 2 : lap_mm, 1);
    for (std::size_t i = fill.support; i < fill.pieces.size(); ++i) {
        const Piece& piece = fill.pieces[i];
        if (piece.role == format::Role::sparse_infill) continue;
        double lapped_mm = fill_lap_mm;
        if (piece.role == format::Role::thin_wall) lapped_mm = 0;
        if (piece.role == format::Role::gap_fill) lapped_mm = lap_mm;
        std::visit([&](const auto& way) { take(way, lapped_mm, piece.flow); }, piece.way);
    }
}

double laid_mm2(const OutlinedLayer& layer, const LayerFill& fill, const LayerSpan& span,
                const profile::Profile& profile) {
    struct Sum {
        double fill_width_mm, laid_mm2 = 0;

        void operator()(const Strand& strand, double lapped_mm, double flow) {
            laid_mm2 += flow * (flat_area_mm2(strand) - lapped_mm * length_mm(strand.path));
        }
        void operator()(const HatchRun& run, double lapped_mm, double flow) {
            laid_mm2 += flow * (fill_width_mm - lapped_mm) * length_mm(run);
        }
    };
    Sum sum{profile.skin.width_mm};
    for_laid(layer, fill, span, profile, std::ref(sum));
    return sum.laid_mm2;
}

MaterialMap map_of(const OutlinedLayer& layer, const LayerFill& fill, const LayerSpan& span,
                   const profile::Profile& profile) {
    region::Box2 box;
    for (const Contour& contour : layer.outline) box.extend(region::box_of(contour));
    MaterialMap map(box, profile.skin.width_mm);
    map.ask_for(layer.outline, 1);
    map.ask_for(fill.sparse, -1);
    for_laid(layer, fill, span, profile, [&](const auto& way, double lapped_mm, double flow) {
        map.lay(way, lapped_mm, flow);
    });
    return map;
}

Diagnostic warning(const std::string& message, const Location& where) {
    return {Severity::warning, ExitStatus::geometry, message, where};
}

std::string text_of(const Imbalance& worst, const std::string& layers) {
    const char* what = worst.kind == Kind::too_little ? "less" : "more";
    return what + (" is laid down than the part asks for in " + layers) +
           formatted("; most here, by %.3g mm2 or %.2g %% of what is to be solid", worst.off_mm2,
                     100 * worst.off_mm2 / worst.solid_mm2);
}

}  // namespace

std::optional<Imbalance> imbalance_of(const OutlinedLayer& layer, const LayerFill& fill,
                                      const LayerSpan& span, const profile::Profile& profile) {
    if (layer.outline.empty()) return std::nullopt;
    const double square_mm2 = profile.perimeters.width_mm * profile.perimeters.width_mm;
    const double told_mm2 = layer.walls.too_thin_mm2 + fill.thin_left_out_mm2;
    const double solid_mm2 = layer.printed.area_mm2 - area_mm2(fill.sparse) - told_mm2;
    const double missing_mm2 = solid_mm2 - laid_mm2(layer, fill, span, profile);
    const auto map = [&] { return map_of(layer, fill, span, profile); };
    if (-missing_mm2 > std::max(least_squares * square_mm2, surplus_share * solid_mm2))
        return Imbalance{Kind::too_much, -missing_mm2, solid_mm2, map().most_surplus()};
    const double most_mm2 =
        std::clamp(least_missing_share * solid_mm2, least_squares * square_mm2,
                   most_squares * square_mm2) +
        std::min(missing_share * solid_mm2, missing_along_outline_mm * layer.printed.length_mm);
    if (!profile.perimeters.gap_fill || !(missing_mm2 > most_mm2)) return std::nullopt;
    return Imbalance{Kind::too_little, missing_mm2, solid_mm2, map().most_missing()};
}

void BalanceReport::add(const std::optional<Imbalance>& found, std::size_t index) {
    if (!found) return;
    const bool goes_on =
        !runs_.empty() && runs_.back().last + 1 == index && runs_.back().worst.kind == found->kind;
    if (!goes_on) runs_.push_back({.first = index});
    Run& run = runs_.back();
    run.last = index;
    if (found->off_mm2 <= run.worst.off_mm2) return;
    run.worst = *found;
    run.worst_layer = index;
}

void BalanceReport::finish(std::span<const LayerSpan> spans, Diagnostics& diagnostics) const {
    for (const Run& run : std::span(runs_).first(std::min(runs_.size(), most_told)))
        diagnostics.push_back(warning(
            text_of(run.worst, counted(run.last + 1 - run.first, "layer") +
                                   formatted(", from z = %.6g to %.6g mm",
                                             spans[run.first].bottom_mm, spans[run.last].top_mm)),
            {.layer = static_cast<int>(run.worst_layer + 1),
             .x_mm = run.worst.at.x(),
             .y_mm = run.worst.at.y(),
             .z_mm = spans[run.worst_layer].middle_mm()}));
    if (runs_.size() > most_told)
        diagnostics.push_back(
            warning("so it is in " + counted(runs_.size() - most_told, "other run") + " of layers",
                    {.layer = static_cast<int>(runs_[most_told].worst_layer + 1),
                     .z_mm = spans[runs_[most_told].worst_layer].middle_mm()}));
}

}  // namespace lyr::slicer
