// Rows tell which layers may have anything over air; regions are only worked out for these.

#include "slicer/air_below.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/text.h"
#include "kernel/region/curve.h"
#include "kernel/toolpath/boundary.h"
#include "kernel/toolpath/bridges.h"
#include "kernel/toolpath/islands.h"
#include "kernel/toolpath/offset.h"

namespace lyr::slicer {
namespace {

// Of lines side by side over air, each held by the one before: what reaches out by more droops.
constexpr double carried_lines = 4;

struct AirBelow {
    std::size_t islands = 0;
    Contour first_island{};
    double hanging_mm2 = 0;
    Point2 hanging_at = Point2::Zero();
    std::size_t unresolved = 0;
};

Point2 middle_of(const Contour& contour) {
    return region::box_of(contour).center();
}

class LayerOverAir {
public:
    LayerOverAir(const OutlinedLayer& layer, const OutlinedLayer& below, const Options& options)
        : layer_(layer),
          below_(below),
          width_mm_(options.profile.skin.width_mm),
          pitch_mm_(SkinOutline::pitch_mm(width_mm_)),
          allowed_mm_(options.tolerance().unite_mm()) {}

    AirBelow found() {
        if (!layer_.seen.is_finite() || !below_.seen.is_finite()) return {.unresolved = 1};
        const double longest_mm = layer_.seen.rows().without(below_.seen.rows()).longest_mm();
        if (longest_mm < pitch_mm_ && !has_small_island()) return {};
        const std::vector<Contour> held = without_islands();
        // Rows (RowCover, contract 3) that are shorter hold no disc of that size.
        const double reach_mm = carried_lines * width_mm_;
        if (longest_mm * longest_mm >= reach_mm * reach_mm - pitch_mm_ * pitch_mm_)
            find_hanging(held, reach_mm);
        return std::move(found_);
    }

private:
    // One that rows may miss.
    bool has_small_island() const {
        const double most_mm2 = 4 * pitch_mm_ * pitch_mm_;
        return std::any_of(layer_.outline.begin(), layer_.outline.end(), [&](const Contour& c) {
            const double area = area_mm2(c);
            return area > 0 && area < most_mm2;
        });
    }

    // Islands with air below are found, and the rest returned.
    std::vector<Contour> without_islands() {
        std::vector<Contour> held;
        for (const std::vector<Contour>& island : parts_of(layer_.outline)) {
            const RowCover rows(island, pitch_mm_);
            if (rows.common(below_.seen.rows()).length_mm() > 0 || is_held(island)) {
                held.insert(held.end(), island.begin(), island.end());
            } else if (found_.islands++ == 0) {
                found_.first_island = island.front();
            }
        }
        return held;
    }

    // Where rows miss what is narrow.
    bool is_held(Region island) {
        return area_mm2(combined_with_below(island, Operation::intersect)) > 0;
    }

    std::vector<Contour> combined_with_below(Region region, Operation operation) {
        RegionResult result = combined(region, below_.outline, operation, allowed_mm_);
        found_.unresolved += result.unresolved;
        return std::move(result.contours);
    }

    std::vector<Contour> offset_by(Region region, double distance_mm) {
        OffsetResult result =
            offset(region, {.distance_mm = distance_mm, .allowed_mm = allowed_mm_});
        found_.unresolved += result.unresolved.has_value();
        return std::move(result.contours);
    }

    void find_hanging(Region held, double reach_mm) {
        if (held.empty()) return;
        const std::vector<Contour> over_air = combined_with_below(held, Operation::subtract);
        const std::vector<Contour> wide =
            offset_by(offset_by(over_air, -reach_mm / 2), reach_mm / 2);
        for (const std::vector<Contour>& part : parts_of(wide)) {
            if (bridge_span(part, below_.outline, width_mm_)) continue;
            if (found_.hanging_mm2 == 0) found_.hanging_at = middle_of(part.front());
            found_.hanging_mm2 += area_mm2(part);
        }
    }

    const OutlinedLayer& layer_;
    const OutlinedLayer& below_;
    double width_mm_, pitch_mm_, allowed_mm_;
    AirBelow found_{};
};

// The solid whose section comes nearest to a place.
SolidId solid_at(const Section& section, const Point2& place, double within_mm) {
    SolidId nearest{0};
    double least_mm = within_mm;
    for (const SolidSection& solid : section.solids) {
        const double distance_mm = Boundary(solid.contours).distance_mm(place, within_mm);
        if (distance_mm < least_mm) {
            nearest = solid.solid;
            least_mm = distance_mm;
        }
    }
    return nearest;
}

class Report {
public:
    void add(AirBelow found, std::size_t layer) {
        if (found.islands > 0) {
            if (islands_ == 0) first_island_ = {layer, std::move(found.first_island)};
            islands_ += found.islands;
        }
        if (found.unresolved > 0 && unresolved_layers_++ == 0) first_unresolved_ = layer;
        if (found.hanging_mm2 == 0) return;
        if (hanging_layers_++ == 0) first_hanging_ = {layer, found.hanging_at};
        most_mm2_ = std::max(most_mm2_, found.hanging_mm2);
    }

    void finish(std::span<const LayerSpan> spans, const Model& model, const Cutter& cutter,
                Diagnostics& diagnostics) const {
        const auto warn = [&](const std::string& message, std::size_t layer,
                              std::optional<Point2> at, SourceId entity) {
            Location where{.entity = entity,
                           .layer = static_cast<int>(layer + 1),
                           .z_mm = spans[layer].middle_mm()};
            if (at) {
                where.x_mm = at->x();
                where.y_mm = at->y();
            }
            diagnostics.push_back({Severity::warning, ExitStatus::geometry,
                                   message + " (support.kind is none)", where});
        };
        if (islands_ > 0) {
            const auto& [layer, island] = first_island_;
            const Section section = cutter.cut(spans[layer].middle_mm());
            const Solid& solid = model[solid_at(section, start_of(island),
                                                region::box_of(island).diagonal().norm())];
            std::string message = "of solid " + in_quotes(solid.name) +
                                  " a part begins in mid-air: nothing is printed under it";
            if (islands_ > 1) message += ", nor under " + counted(islands_ - 1, "other island");
            warn(message, layer, middle_of(island), solid.source);
        }
        if (hanging_layers_ > 0)
            warn("in " + counted(hanging_layers_, "layer") + formatted(most_text, most_mm2_),
                 first_hanging_.first, first_hanging_.second, 0);
        if (unresolved_layers_ > 0)
            warn("in " + counted(unresolved_layers_, "layer") +
                     ", first here, it could not be worked out what hangs over air",
                 first_unresolved_, std::nullopt, 0);
    }

private:
    static constexpr const char* most_text =
        " the part reaches far out over air without being a bridge, first here; by up to %.3g mm2";

    std::size_t islands_ = 0, hanging_layers_ = 0, unresolved_layers_ = 0, first_unresolved_ = 0;
    double most_mm2_ = 0;
    std::pair<std::size_t, Contour> first_island_{};
    std::pair<std::size_t, Point2> first_hanging_{};
};

}  // namespace

void warn_of_air_below(std::span<const OutlinedLayer> layers, std::span<const LayerSpan> spans,
                       std::size_t first, const Model& model, const Cutter& cutter,
                       const Options& options, Diagnostics& diagnostics) {
    Report report;
    in_order(
        layers.size(), thread_count(options),
        [&](std::size_t i) {
            return i <= first ? AirBelow{}
                              : LayerOverAir(layers[i], layers[i - 1], options).found();
        },
        [&](std::size_t i, AirBelow found) {
            report.add(std::move(found), i);
            return true;
        });
    report.finish(spans, model, cutter, diagnostics);
}

}  // namespace lyr::slicer
