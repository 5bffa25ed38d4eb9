#include "slicer/adaptive.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <span>

#include "kernel/brep/placement.h"
#include "kernel/section/flatness.h"
#include "slicer/layer_sequence.h"
#include "slicer/raft.h"

namespace lyr::slicer {
namespace {

// How far a part may reach out of its face: a share of the thinnest layer.
constexpr double reach_share = 1.0 / 8;

// A message names no more faces than this.
constexpr std::size_t named_faces = 3;

// Level faces so close to each other that one end of a layer serves all.
struct LevelFaces {
    double bottom_mm, top_mm;
    std::vector<SourceId> sources;
    bool is_top = false;  // the part's own top is among them

    double height_mm() const { return is_top ? top_mm : (bottom_mm + top_mm) / 2; }
};

struct Surveyed {
    std::vector<FlatPart> parts;
    std::vector<LevelFaces> levels;  // rising, the part's top last
};

std::vector<LevelFaces> joined(std::vector<std::pair<double, SourceId>> faces, double top_mm) {
    for (auto& face : faces) face.first = std::min(face.first, top_mm);
    faces.emplace_back(top_mm, 0);
    std::sort(faces.begin(), faces.end());
    std::vector<LevelFaces> levels;
    for (const auto& [z, source] : faces) {
        if (levels.empty() || z - levels.back().bottom_mm > level_rise_mm)
            levels.push_back({z, z, {}});
        levels.back().top_mm = z;
        if (source > 0) levels.back().sources.push_back(source);
    }
    levels.back().is_top = true;
    return levels;
}

Surveyed survey(const Model& model, double part_height_mm, const FlatnessLimits& limits,
                unsigned threads) {
    const FlatnessSurvey faces(model, limits);
    std::vector<FlatPart> parts;
    std::vector<std::pair<double, SourceId>> levels;
    in_order(
        model.faces.size(), threads, [&](std::size_t i) { return faces.of(FaceId{i}); },
        [&](std::size_t i, const FaceFlatness& face) {
            parts.insert(parts.end(), face.parts.begin(), face.parts.end());
            if (face.level_mm) levels.emplace_back(*face.level_mm, model.faces[i].source);
            return true;
        });
    return {std::move(parts), joined(std::move(levels), part_height_mm)};
}

std::string names_of(const LevelFaces& level) {
    const std::size_t count = level.sources.size();
    if (count == 0) return "the part's top";
    if (count == 1) return "the level face";
    std::string text = "the level faces";
    for (std::size_t i = 0; i < std::min(count, named_faces); ++i)
        text += (i == 0 ? " #" : ", #") + std::to_string(level.sources[i]);
    if (count > named_faces) text += " and " + std::to_string(count - named_faces) + " more";
    return text;
}

// A warning for each height of level faces at which no layer ends.
void warn_of_missed(std::span<const LevelFaces> levels, std::span<const LayerSpan> spans,
                    Diagnostics& diagnostics) {
    for (const LevelFaces& level : levels) {
        const double z = level.height_mm();
        const auto over = std::lower_bound(
            spans.begin(), spans.end(), z,
            [](const LayerSpan& span, double height) { return span.top_mm < height; });
        const double above = over == spans.end() ? spans.back().top_mm : over->top_mm;
        const double below = over == spans.end() ? above : over->bottom_mm;
        const double end = above - z < z - below ? above : below;
        if (std::abs(end - z) <= level_rise_mm) continue;
        char text[160];
        std::snprintf(text, sizeof text,
                      " at %.6g mm: no layer can end there, the next one ends at %.6g mm", z, end);
        // Several are named in the text.
        const SourceId source = level.sources.size() == 1 ? level.sources.front() : 0;
        diagnostics.push_back({Severity::warning,
                               ExitStatus::geometry,
                               names_of(level) + text,
                               {.entity = source, .z_mm = z}});
    }
}

std::vector<LayerSpan> spans_of(const Surveyed& surveyed, const FlatnessProfile& flatness,
                                const profile::Layer& layer) {
    std::vector<LayerSpan> spans{{0, layer.first_height_mm}};
    std::vector<double> heights;
    for (const LevelFaces& level : surveyed.levels)
        if (level.height_mm() > layer.first_height_mm + resolution_mm)
            heights.push_back(level.height_mm());
    if (heights.empty()) return spans;
    const StepLimits limits{layer.cusp_mm, {layer.min_height_mm, layer.max_height_mm}};
    for (const double end : landings(layer.first_height_mm, heights, limits.thickness)) {
        for (const double top : layer_tops(spans.back().top_mm, end, flatness, limits))
            spans.push_back({spans.back().top_mm, top});
    }
    return spans;
}

// Of all layers but the first, whose thickness has other reasons.
AdaptiveFigures figures_of(std::span<const LayerSpan> spans, const FlatnessProfile& flatness,
                           const profile::Layer& layer) {
    AdaptiveFigures figures{.thinnest_mm = layer.max_height_mm};
    double flattest = 0;
    for (std::size_t i = 0; i < spans.size(); ++i) {
        if (i == 0) continue;
        const LayerSpan& span = spans[i];
        figures.thickest_mm = std::max(figures.thickest_mm, span.height_mm());
        figures.thinnest_mm = std::min(figures.thinnest_mm, span.height_mm());
        const double there = flatness.between(span.bottom_mm, span.top_mm);
        flattest = std::max(flattest, there);
        if (there * span.height_mm() > layer.cusp_mm + resolution_mm) ++figures.deeper_layers;
    }
    const double thickness = flattest > 0 ? layer.cusp_mm / flattest : layer.max_height_mm;
    figures.uniform_mm = std::clamp(thickness, layer.min_height_mm, layer.max_height_mm);
    figures.uniform_layers =
        1 + static_cast<std::size_t>(std::ceil(
                (spans.back().top_mm - spans[0].top_mm - resolution_mm) / figures.uniform_mm));
    return figures;
}

}  // namespace

LayerPlan adaptive_plan(const Model& placed, double part_height_mm, const Options& options,
                        Diagnostics& diagnostics) {
    const profile::Layer& layer = options.profile.layer;
    const Surveyed surveyed = survey(placed, part_height_mm,
                                     {.least = layer.cusp_mm / layer.max_height_mm,
                                      .most = layer.cusp_mm / layer.min_height_mm,
                                      .height_mm = reach_share * layer.min_height_mm},
                                     thread_count(options));
    const FlatnessProfile flatness(surveyed.parts);
    LayerPlan plan{.spans = spans_of(surveyed, flatness, layer), .figures = {}};
    plan.figures = figures_of(plan.spans, flatness, layer);
    warn_of_missed(surveyed.levels, plan.spans, diagnostics);
    return plan;
}

std::vector<LayerSpan> planned_layers(const Model& placed, const Options& options, Summary& summary,
                                      Diagnostics& diagnostics) {
    const double height_mm = summary.box.sizes().z();
    const profile::Layer layer = part_layers(options.profile);
    if (!layer.adaptive) return on_raft(layer_spans(height_mm, layer), options.profile);
    Options of_part = options;
    of_part.profile.layer = layer;
    const Model lowered = transformed(
        placed, Eigen::Affine3d(Eigen::Translation3d(0, 0, -raised_mm(options.profile))));
    LayerPlan plan = adaptive_plan(lowered, height_mm, of_part, diagnostics);
    summary.adaptive = plan.figures;
    return on_raft(std::move(plan.spans), options.profile);
}

}  // namespace lyr::slicer
