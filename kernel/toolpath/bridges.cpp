// Each direction is tried with a few rows, and the ends of these are looked up in the region below.

#include "kernel/toolpath/bridges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kernel/geometry/tolerance.h"
#include "kernel/region/verify.h"
#include "kernel/toolpath/boundary.h"
#include "kernel/toolpath/islands.h"
#include "kernel/toolpath/rows.h"

namespace lyr {
namespace {

constexpr double pi = std::numbers::pi;

constexpr int directions = 36;

// Of a bridge's edges, the longest ones: what is bounded by many has no direction of its own.
constexpr std::size_t most_edges = 4;

// Rows with which a direction is tried: a bridge that is held in one row and not in the next is none.
constexpr double rows_tried = 16;

constexpr double least_held = 0.5;
// What is as good as something else; a row more or less makes as much.
constexpr double as_good = 0.02;

double half_turn(double angle_rad) {
    const double angle = angle_rad - pi * std::floor(angle_rad / pi);
    return angle < pi ? angle : 0;
}

std::vector<double> candidates(std::span<const BoundaryPiece> boundary, double shortest_mm) {
    std::vector<const BoundaryPiece*> edges;
    for (const BoundaryPiece& piece : boundary)
        if (piece.curvature_per_mm == 0 && piece.length_mm >= shortest_mm) edges.push_back(&piece);
    std::stable_sort(edges.begin(), edges.end(),
                     [](const auto* a, const auto* b) { return a->length_mm > b->length_mm; });
    edges.resize(std::min(edges.size(), most_edges));
    std::vector<double> angles;
    for (const BoundaryPiece* edge : edges) {
        const double angle = std::atan2(edge->start_tangent.y(), edge->start_tangent.x());
        angles.push_back(half_turn(angle));
        angles.push_back(half_turn(angle + pi / 2));
    }
    for (int i = 0; i < directions; ++i) angles.push_back(pi * i / directions);
    return angles;
}

// Nearly: of a full circle at least 0.7 of its diameter.
double extent_mm(std::span<const BoundaryPiece> boundary, const Vector2& across) {
    double low = boundary.front().start.dot(across), high = low;
    for (const BoundaryPiece& piece : boundary) {
        for (const double fraction : {0.0, 0.25, 0.5, 0.75}) {
            const double at = piece.at(fraction).point.dot(across);
            low = std::min(low, at);
            high = std::max(high, at);
        }
    }
    return high - low;
}

bool is_held(const Boundary& below, const Point2& end, const Vector2& beyond) {
    return below.winding(end) > 0 || below.winding(end + beyond) > 0;
}

BridgeSpan tried(std::span<const BoundaryPiece> boundary, const Boundary& below, double angle_rad,
                 double spacing_mm) {
    BridgeSpan trial{.angle_rad = angle_rad};
    const double extent = extent_mm(boundary, {-std::sin(angle_rad), std::cos(angle_rad)});
    if (extent <= resolution_mm) return trial;
    const Rows rows =
        rows_across(boundary, {.angle_rad = angle_rad, .pitch_mm = extent / rows_tried});
    const Vector2 beyond = spacing_mm / 2 * rows.direction;
    double length = 0;
    for (std::uint32_t row = 0; row < rows.count(); ++row) {
        for (const RowSpan& span : rows.spans_of(row)) {
            const double span_mm = span.end.x_mm - span.start.x_mm;
            length += span_mm;
            if (!is_held(below, rows.in_plane(span.start.x_mm, rows.y_mm(row)), -beyond) ||
                !is_held(below, rows.in_plane(span.end.x_mm, rows.y_mm(row)), beyond)) {
                continue;
            }
            trial.held += span_mm;
            trial.longest_mm = std::max(trial.longest_mm, span_mm);
        }
    }
    if (length > 0) trial.held /= length;
    return trial;
}

std::optional<BridgeSpan> best_of(const std::vector<BridgeSpan>& trials) {
    double most_held = 0;
    for (const BridgeSpan& trial : trials) most_held = std::max(most_held, trial.held);
    if (most_held < least_held) return std::nullopt;
    std::vector<BridgeSpan> best;
    for (const BridgeSpan& trial : trials)
        if (trial.held >= most_held - as_good) best.push_back(trial);
    double shortest = best.front().longest_mm;
    for (const BridgeSpan& trial : best) shortest = std::min(shortest, trial.longest_mm);
    for (const BridgeSpan& trial : best)
        if (trial.longest_mm <= (1 + as_good) * shortest) return trial;
    return std::nullopt;
}

std::optional<BridgeSpan> span_of(Region bridge, const Boundary& below, double spacing_mm) {
    const std::vector<BoundaryPiece> boundary = boundary_pieces(bridge);
    if (boundary.empty()) return std::nullopt;
    std::vector<BridgeSpan> trials;
    for (const double angle : candidates(boundary, spacing_mm))
        trials.push_back(tried(boundary, below, angle, spacing_mm));
    return best_of(trials);
}

bool is_valid(Region bridge, Region below, double spacing_mm) {
    return std::isfinite(spacing_mm) &&
           std::all_of(bridge.begin(), bridge.end(), region::is_finite) &&
           std::all_of(below.begin(), below.end(), region::is_finite);
}

}  // namespace

std::vector<Bridge> bridges_over(Region bridges, Region below, double spacing_mm) {
    std::vector<Bridge> result;
    if (bridges.empty()) return result;
    if (!is_valid(bridges, below, spacing_mm)) {
        return {{{bridges.begin(), bridges.end()}, std::nullopt}};
    }
    const Boundary holding(below);
    for (std::vector<Contour>& part : parts_of(bridges)) {
        const auto span = span_of(part, holding, spacing_mm);
        result.push_back({std::move(part), span ? std::optional(span->angle_rad) : std::nullopt});
    }
    return result;
}

std::optional<BridgeSpan> bridge_span(Region bridge, Region below, double spacing_mm) {
    if (!is_valid(bridge, below, spacing_mm)) return std::nullopt;
    return span_of(bridge, Boundary(below), spacing_mm);
}

std::optional<double> bridge_angle(Region bridge, Region below, double spacing_mm) {
    const auto span = bridge_span(bridge, below, spacing_mm);
    return span ? std::optional(span->angle_rad) : std::nullopt;
}

}  // namespace lyr
