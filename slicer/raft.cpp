#include "slicer/raft.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "kernel/toolpath/infill.h"

namespace lyr::slicer {
namespace {

constexpr double margin_mm = 3;
constexpr double base_density = 0.5;

// Of the nozzle's bore: as thick as a line can be that is pressed flat.
constexpr double base_height_share = 0.75;

constexpr std::size_t dense_layers = 2;

std::vector<LayerSpan> raft_spans(const profile::Profile& profile) {
    std::vector<LayerSpan> spans;
    const std::size_t count = raft_layers(profile);
    double top_mm = 0;
    for (std::size_t i = 0; i < count; ++i) {
        double height_mm = i == 0 ? profile.layer.first_height_mm : profile.layer.height_mm;
        if (i == 0 && count > 1)
            height_mm = std::clamp(base_height_share * profile.nozzle.diameter_mm, height_mm,
                                   std::max(height_mm, profile.skin.width_mm));
        spans.push_back({top_mm, top_mm + height_mm});
        top_mm += height_mm;
    }
    return spans;
}

}  // namespace

std::size_t raft_layers(const profile::Profile& profile) {
    return profile.adhesion.kind == profile::AdhesionKind::raft ? profile.adhesion.raft_layers : 0;
}

double raft_reach_mm(const profile::Profile& profile) {
    return raft_layers(profile) > 0 ? margin_mm : 0;
}

double raised_mm(const profile::Profile& profile) {
    const std::vector<LayerSpan> raft = raft_spans(profile);
    return raft.empty() ? 0 : raft.back().top_mm + profile.adhesion.raft_gap_mm;
}

profile::Layer part_layers(const profile::Profile& profile) {
    profile::Layer layer = profile.layer;
    if (raft_layers(profile) > 0) layer.first_height_mm = layer.height_mm;
    return layer;
}

std::vector<LayerSpan> on_raft(std::vector<LayerSpan> part, const profile::Profile& profile) {
    std::vector<LayerSpan> spans = raft_spans(profile);
    if (spans.empty()) return part;
    const double raised = raised_mm(profile);
    for (const LayerSpan& span : part)
        spans.push_back({span.bottom_mm + raised, span.top_mm + raised});
    return spans;
}

std::vector<Piece> raft_pieces(std::size_t layer, Region footprint, const Options& options,
                               std::size_t& unresolved) {
    const profile::Profile& profile = options.profile;
    const double width_mm = profile.skin.width_mm, allowed_mm = options.tolerance().unite_mm();
    const auto grown = [&](Region region, double distance_mm) {
        OffsetResult result =
            offset(region, {.distance_mm = distance_mm, .allowed_mm = allowed_mm});
        unresolved += result.unresolved.has_value();
        return std::move(result.contours);
    };
    // Twice as far and back: gaps that are narrower than the margin are closed.
    const std::vector<Contour> closed = grown(footprint, 2 * margin_mm);
    const auto inset = [&](double inset_mm) { return grown(closed, -margin_mm - inset_mm); };
    std::vector<Piece> pieces;
    for (Contour& wall : inset(width_mm / 2))
        pieces.push_back({format::Role::raft, Strand{std::move(wall), width_mm}});
    const LayerSpan span = raft_spans(profile)[layer];
    const std::size_t count = raft_layers(profile);
    const bool is_dense = count == 1 || (layer > 0 && layer + dense_layers >= count);
    Fill lines = infill(inset(width_mm * (1.5 - profile.infill.overlap)),
                        {.pattern = InfillPattern::rectilinear,
                         .density = is_dense ? 1 : base_density,
                         .width_mm = width_mm,
                         .height_mm = span.height_mm(),
                         .angle_rad = profile.infill.angle_deg * std::numbers::pi / 180,
                         .z_mm = span.middle_mm(),
                         .layer = layer,
                         .allowed_mm = allowed_mm});
    unresolved += lines.unresolved;
    for (HatchRun& run : lines.runs) pieces.push_back({format::Role::raft, std::move(run)});
    for (Strand& strand : lines.strands) pieces.push_back({format::Role::raft, std::move(strand)});
    return pieces;
}

}  // namespace lyr::slicer
