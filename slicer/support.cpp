#include "slicer/support.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "base/nearest_name.h"
#include "base/text.h"
#include "kernel/section/level_face.h"
#include "kernel/toolpath/infill.h"
#include "kernel/toolpath/support_tree.h"

namespace lyr::slicer {
namespace {

// How far support reaches out beside what it holds at least: enough for a pillar of two walls and a line under a point.
constexpr double least_margin_mm = 1;

// PrusaSlicer's limit for bridges that need no support.
constexpr double longest_bridge_mm = 10;

// A face that leans out by nearly a right angle is blocked as far as this from its edge, in lengths that it leans out by
// in a layer: round it may be flatter below than where it is cut.
constexpr double blocked_reach = 2;
constexpr double most_blocked_mm = 50;

double radians(double degrees) {
    return degrees * std::numbers::pi / 180;
}

double skin_width_mm(const Options& options) {
    return options.profile.skin.width_mm;
}

SupportRequest request_of(const Options& options) {
    const profile::Support& support = options.profile.support;
    return {.gap_z_mm = support.gap_z_mm,
            .gap_xy_mm = support.gap_xy_mm,
            .interface_layers = support.interface_layers,
            .on_bed_only = support.on_bed_only,
            .width_mm = skin_width_mm(options),
            .allowed_mm = options.tolerance().unite_mm()};
}

// What the layer below carries: as far as a face of the limit leans out in a layer, and half a line.
double ledge_mm(const LayerSpan& span, const Options& options) {
    return span.height_mm() * std::tan(radians(options.profile.support.angle_deg)) +
           skin_width_mm(options) / 2;
}

// The edges of one layer, by face.
OverhangEdges edges_at(const Cutter& cutter, const LayerSpan& span,
                       const std::vector<bool>& is_blocked, const Options& options) {
    OverhangEdges edges;
    const double limit_rad = radians(options.profile.support.angle_deg);
    for (LeaningSpan& found : cutter.leaning(span.middle_mm(), limit_rad)) {
        if (!is_blocked.empty() && is_blocked[found.face.value]) {
            const double out_mm =
                span.height_mm() * std::tan(std::clamp(found.most_rad, 0.0, radians(89.9)));
            edges.blocked.push_back(
                {std::move(found.path),
                 std::min(most_blocked_mm, blocked_reach * out_mm + options.tolerance().total_mm)});
        } else {
            edges.leaning.push_back(std::move(found.path));
        }
    }
    return edges;
}

// Undersides that are blocked by themselves, each for the first layer cut above it.
std::map<std::size_t, std::vector<Contour>> blocked_areas(const Model& model,
                                                          std::span<const FaceId> blocked,
                                                          std::span<const SupportLevel> levels,
                                                          const Options& options) {
    std::map<std::size_t, std::vector<Contour>> areas;
    for (const FaceId id : blocked) {
        const auto face = level_face(model, id, options.tolerance());
        if (!face || !face->looks_down) continue;
        const auto above =
            std::partition_point(levels.begin(), levels.end(), [&](const SupportLevel& level) {
                return (level.bottom_mm + level.top_mm) / 2 < face->z_mm;
            });
        std::vector<Contour>& area = areas[static_cast<std::size_t>(above - levels.begin())];
        area.insert(area.end(), face->region.begin(), face->region.end());
    }
    return areas;
}

void append(Fill fill, format::Role role, std::vector<Piece>& pieces) {
    for (HatchRun& run : fill.runs) pieces.push_back({role, std::move(run)});
    for (Strand& strand : fill.strands) pieces.push_back({role, std::move(strand)});
}

std::string some_of(std::span<const std::string> names) {
    constexpr std::size_t most = 8;
    std::string list;
    for (const std::string& name : names.first(std::min(most, names.size())))
        list += (list.empty() ? "" : ", ") + in_quotes(name);
    if (names.size() > most) list += " and " + std::to_string(names.size() - most) + " more";
    return list;
}

}  // namespace

Result<std::vector<FaceId>> blocked_faces(const Model& model, const profile::Support& support) {
    std::vector<FaceId> faces;
    for (const std::string& name : support.blockers) {
        const std::size_t before = faces.size();
        for (std::uint32_t f = 0; f < model.faces.size(); ++f) {
            const SourceId source = model.faces[f].source;
            const auto known = model.face_names.find(source);
            if ((known != model.face_names.end() && known->second == name) ||
                '#' + std::to_string(source) == name)
                faces.push_back(FaceId{f});
        }
        if (faces.size() > before) continue;
        std::vector<std::string> names;
        for (const auto& [source, known] : model.face_names)
            if (std::find(names.begin(), names.end(), known) == names.end()) names.push_back(known);
        const std::string nearest = nearest_name(name, names);
        std::string message = "support.blockers: no face is named " + in_quotes(name);
        if (!nearest.empty())
            message += "; did you mean " + in_quotes(nearest) + '?';
        else if (!names.empty())
            message += "; the file's faces are named " + some_of(names);
        if (names.empty())
            message +=
                "; the file's faces have no names, but \"#123\" is the face of instance #123";
        return Diagnostic{Severity::error, ExitStatus::usage, message, {}};
    }
    return faces;
}

SupportPlan::SupportPlan(std::span<const OutlinedLayer> layers, std::span<const LayerSpan> spans,
                         std::size_t first)
    : layers_(layers), first_(first), overhangs_(layers.size()) {
    for (std::size_t i = 0; i < layers.size(); ++i)
        levels_.push_back({spans[i].bottom_mm, spans[i].top_mm, layers[i].outline, {}});
}

void SupportPlan::find_overhangs(const Model& model, const Cutter& cutter,
                                 std::span<const FaceId> blocked, const Options& options) {
    const unsigned threads = thread_count(options);
    std::vector<bool> is_blocked;
    if (!blocked.empty()) is_blocked.resize(model.faces.size());
    for (const FaceId face : blocked) is_blocked[face.value] = true;
    const auto span_of = [&](std::size_t i) {
        return LayerSpan{levels_[i].bottom_mm, levels_[i].top_mm};
    };
    std::vector<OverhangEdges> edges(levels_.size());
    in_order(
        levels_.size(), threads,
        [&](std::size_t i) { return edges_at(cutter, span_of(i), is_blocked, options); },
        [&](std::size_t i, OverhangEdges found) {
            edges[i] = std::move(found);
            return true;
        });
    for (auto& [layer, area] : blocked_areas(model, blocked, levels_, options))
        if (layer < levels_.size()) edges[layer].blocked_area = std::move(area);
    in_order(
        levels_.size(), threads,
        [&](std::size_t i) {
            if (i <= first_) return Overhang{};
            const double ledge = ledge_mm(span_of(i), options);
            const bool flat =
                may_leave_bare(layers_[i].seen, layers_[i - 1].seen, skin_width_mm(options), ledge);
            return overhang_of(
                layers_[i].outline, layers_[i - 1].outline, edges[i], edges[i - 1].leaning, flat,
                {.ledge_mm = ledge,
                 .margin_mm = std::max(least_margin_mm,
                                       options.profile.support.gap_xy_mm + skin_width_mm(options)),
                 .longest_bridge_mm = longest_bridge_mm,
                 .width_mm = skin_width_mm(options),
                 .allowed_mm = options.tolerance().unite_mm()});
        },
        [&](std::size_t i, Overhang found) {
            overhangs_[i] = std::move(found);
            return true;
        });
    for (std::size_t i = 0; i < levels_.size(); ++i) levels_[i].overhang = overhangs_[i].contours;
}

void SupportPlan::find_areas(const Options& options, Diagnostics& diagnostics) {
    const SupportRequest request = request_of(options);
    std::size_t used = 0;
    for (std::size_t i = 0; i < levels_.size(); ++i)
        if (!levels_[i].overhang.empty()) used = i + 1;
    std::vector<LayerRoom> rooms(levels_.size());
    in_order(
        used, thread_count(options), [&](std::size_t i) { return room_of(levels_, i, request); },
        [&](std::size_t i, LayerRoom made) {
            rooms[i] = std::move(made);
            return true;
        });
    areas_ = options.profile.support.kind == profile::SupportKind::tree
                 ? support_tree(levels_, rooms, {.support = request})
                 : support_areas(levels_, rooms, request);
    const auto warn = [&](std::size_t layer, const std::string& message) {
        diagnostics.push_back({Severity::warning,
                               ExitStatus::geometry,
                               message,
                               {.layer = static_cast<int>(layer + 1),
                                .z_mm = (levels_[layer].bottom_mm + levels_[layer].top_mm) / 2}});
    };
    if (!areas_.out_of_reach.empty())
        warn(*std::min_element(areas_.out_of_reach.begin(), areas_.out_of_reach.end()),
             areas_.out_of_reach.size() == 1
                 ? "the layer has overhangs with no room for support under them"
                 : counted(areas_.out_of_reach.size(), "layer") +
                       ", this one first, have overhangs with no room for support under them");
    for (const std::size_t layer : areas_.unresolved)
        warn(layer, "the support of the layer could not be worked out");
    for (std::size_t i = 0; i < overhangs_.size(); ++i)
        if (overhangs_[i].unresolved > 0)
            warn(i, "the overhangs of the layer could not be worked out");
}

Region SupportPlan::area(std::size_t layer) const {
    return empty() ? Region() : Region(areas_.layers[layer]);
}

std::vector<Contour> SupportPlan::with_part(std::size_t layer, const Options& options,
                                            std::size_t& unresolved) const {
    const std::vector<Contour>& part = layers_[layer].outline;
    if (area(layer).empty()) return part;
    RegionResult both =
        combined(part, area(layer), Operation::unite, options.tolerance().unite_mm());
    unresolved += both.unresolved;
    return std::move(both.contours);
}

std::vector<Contour> SupportPlan::footprint(const Options& options, std::size_t& unresolved) const {
    std::vector<Contour> first = with_part(first_, options, unresolved);
    if (area(0).empty()) return first;
    RegionResult all = combined(first, area(0), Operation::unite, options.tolerance().unite_mm());
    unresolved += all.unresolved;
    return std::move(all.contours);
}

std::vector<Piece> SupportPlan::pieces(std::size_t layer, const Options& options,
                                       std::size_t& unresolved) const {
    std::vector<Piece> pieces;
    const Region area = this->area(layer);
    if (area.empty()) return pieces;
    const profile::Profile& profile = options.profile;
    const double width_mm = skin_width_mm(options), allowed_mm = options.tolerance().unite_mm();
    const auto inset = [&](double distance_mm) {
        OffsetResult result = offset(area, {.distance_mm = -distance_mm, .allowed_mm = allowed_mm});
        unresolved += result.unresolved.has_value();
        return std::move(result.contours);
    };
    for (Contour& wall : inset(width_mm / 2))
        pieces.push_back({format::Role::support, Strand{std::move(wall), width_mm}});
    // The ends of lines reach into the wall as those of infill do.
    DividedSupport parts = divided(inset(width_mm * (1.5 - profile.infill.overlap)), levels_, layer,
                                   request_of(options));
    unresolved += parts.unresolved;
    const double angle_rad = radians(profile.infill.angle_deg);
    const auto fill = [&](Region region, double density, double angle, format::Role role) {
        if (region.empty() || density == 0) return;
        Fill lines = infill(region, {.pattern = InfillPattern::aligned,
                                     .density = density,
                                     .width_mm = width_mm,
                                     .height_mm = levels_[layer].top_mm - levels_[layer].bottom_mm,
                                     .angle_rad = angle,
                                     .z_mm = levels_[layer].top_mm,
                                     .layer = layer,
                                     .allowed_mm = allowed_mm});
        unresolved += lines.unresolved;
        append(std::move(lines), role, pieces);
    };
    if (profile.support.kind == profile::SupportKind::grid)
        fill(parts.sparse, profile.support.density, angle_rad, format::Role::support);
    fill(parts.interface, 1, angle_rad + std::numbers::pi / 2, format::Role::support_interface);
    if (layer == first_ && first_ > 0) {
        const double height_mm = levels_[layer].top_mm - levels_[layer].bottom_mm;
        const double air_mm = levels_[layer].bottom_mm - levels_[layer - 1].top_mm;
        for (Piece& piece : pieces) piece.flow = (height_mm + air_mm) / height_mm;
    }
    return pieces;
}

}  // namespace lyr::slicer
