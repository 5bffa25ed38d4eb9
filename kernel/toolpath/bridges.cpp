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

using std::numbers::pi;

constexpr int directions = 36;
// Over lines; half the angle between them makes a stretch longer by a hundredth.
constexpr int directions_over_lines = 12;

// Of a bridge's edges, the longest ones: what is bounded by many has no direction of its own.
constexpr std::size_t most_edges = 4;

// Rows with which a direction is tried: a bridge that is held in one row and not in the next is none.
constexpr double rows_tried = 16;

constexpr double least_held = 0.5;
// What is as good as something else; a row more or less makes as much.
constexpr double as_good = 0.02;
// Of the mean stretch over lines, which a few rows meet by chance.
constexpr double as_short_over_lines = 0.1;

// What an arc turns by between the ends of a chord that stands for it.
constexpr double chord_turn = pi / 8;

double half_turn(double angle_rad) {
    const double angle = angle_rad - pi * std::floor(angle_rad / pi);
    return angle < pi ? angle : 0;
}

std::vector<double> candidates(std::span<const BoundaryPiece> boundary, double shortest_mm,
                               int all_round) {
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
    for (int i = 0; i < all_round; ++i) angles.push_back(pi * i / all_round);
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

// What holds the ends of lines: the region below, without its sparse fill.
struct Holding {
    Boundary below, sparse;

    bool operator()(const Point2& point) const {
        return sparse.winding(point) <= 0 && below.winding(point) > 0;
    }
};

bool is_held(const Holding& holding, const Point2& end, const Vector2& beyond) {
    return holding(end + beyond) || holding(end);
}

// None where the bridge is but a point wide.
Rows rows_to_try(std::span<const BoundaryPiece> boundary, double angle_rad) {
    const double extent = extent_mm(boundary, {-std::sin(angle_rad), std::cos(angle_rad)});
    if (extent <= resolution_mm) return {};
    return rows_across(boundary, {.angle_rad = angle_rad, .pitch_mm = extent / rows_tried});
}

BridgeSpan tried(std::span<const BoundaryPiece> boundary, const Holding& holding, double angle_rad,
                 double spacing_mm) {
    BridgeSpan trial{.angle_rad = angle_rad};
    const Rows rows = rows_to_try(boundary, angle_rad);
    const Vector2 beyond = spacing_mm / 2 * rows.direction;
    double length = 0;
    for (std::uint32_t row = 0; row < rows.count(); ++row) {
        for (const RowSpan& span : rows.spans_of(row)) {
            const double span_mm = span.end.x_mm - span.start.x_mm;
            length += span_mm;
            if (!is_held(holding, rows.in_plane(span.start.x_mm, rows.y_mm(row)), -beyond) ||
                !is_held(holding, rows.in_plane(span.end.x_mm, rows.y_mm(row)), beyond)) {
                continue;
            }
            trial.held += span_mm;
            trial.longest_mm = std::max(trial.longest_mm, span_mm);
        }
    }
    if (length > 0) trial.held /= length;
    return trial;
}

std::optional<BridgeSpan> best_of(const std::vector<BridgeSpan>& trials, double as_short) {
    double most_held = 0;
    for (const BridgeSpan& trial : trials) most_held = std::max(most_held, trial.held);
    if (most_held < least_held) return std::nullopt;
    std::vector<BridgeSpan> best;
    for (const BridgeSpan& trial : trials)
        if (trial.held >= most_held - as_good) best.push_back(trial);
    double shortest = best.front().longest_mm;
    for (const BridgeSpan& trial : best) shortest = std::min(shortest, trial.longest_mm);
    for (const BridgeSpan& trial : best)
        if (trial.longest_mm <= (1 + as_short) * shortest) return trial;
    return std::nullopt;
}

// Where lines cross each of the rows, with rising x.
std::vector<std::vector<double>> crossings_of(const Rows& rows, std::span<const Chord> lines) {
    std::vector<std::vector<double>> crossings(rows.count());
    if (crossings.empty()) return crossings;
    const Vector2 across(-rows.direction.y(), rows.direction.x());
    const auto first_above = [&](double y_mm) {
        const double row = std::ceil((y_mm - rows.first_y_mm) / rows.pitch_mm);
        return static_cast<std::uint32_t>(std::clamp<double>(row, 0, rows.count()));
    };
    for (const Chord& line : lines) {
        const double from_y = line.from.dot(across), to_y = line.to.dot(across);
        const auto [low, high] = std::minmax(from_y, to_y);
        for (std::uint32_t row = first_above(low), last = first_above(high); row < last; ++row) {
            const double share = (rows.y_mm(row) - from_y) / (to_y - from_y);
            crossings[row].push_back(
                (line.from + share * (line.to - line.from)).dot(rows.direction));
        }
    }
    for (std::vector<double>& row : crossings) std::sort(row.begin(), row.end());
    return crossings;
}

// The stretches of rows between what holds them.
struct Stretches {
    double length_mm = 0, held_mm = 0, squares_mm2 = 0;

    void add(double length, bool start_held, bool end_held) {
        if (length <= 0) return;
        length_mm += length;
        if (start_held && end_held) held_mm += length;
        squares_mm2 += length * length * (start_held && end_held ? 1 : 2);
    }
};

// Where a bridge's boundary is held: asked once for all directions, at points of it that lie so close.
class HeldBoundary {
public:
    HeldBoundary(std::span<const BoundaryPiece> boundary, const Holding& holding,
                 double spacing_mm) {
        for (const BoundaryPiece& piece : boundary) {
            first_.push_back(samples_.size());
            const int count = 1 + static_cast<int>(std::min(piece.length_mm / (4 * spacing_mm),
                                                            most_samples - 1));
            for (int i = 0; i < count; ++i) {
                const BoundaryPoint at = piece.at((i + 0.5) / count);
                const Vector2 outwards(at.tangent.y(), -at.tangent.x());
                samples_.push_back(
                    {at.point, is_held(holding, at.point, spacing_mm / 2 * outwards)});
            }
        }
        first_.push_back(samples_.size());
    }

    bool at(std::uint32_t piece, const Point2& point) const {
        const auto* nearest = &samples_[first_[piece]];
        for (std::size_t i = first_[piece] + 1; i < first_[piece + 1]; ++i)
            if ((samples_[i].point - point).squaredNorm() < (nearest->point - point).squaredNorm())
                nearest = &samples_[i];
        return nearest->held;
    }

private:
    // Of a piece.
    static constexpr double most_samples = 16;

    struct Sample {
        Point2 point;
        bool held;
    };
    std::vector<Sample> samples_{};
    std::vector<std::size_t> first_{};
};

// As tried(), over lines; the mean stretch in place of the longest row.
BridgeSpan tried_over(std::span<const Chord> lines, std::span<const BoundaryPiece> boundary,
                      const HeldBoundary& ends, double angle_rad) {
    const Rows rows = rows_to_try(boundary, angle_rad);
    const auto crossings = crossings_of(rows, lines);
    Stretches stretches;
    for (std::uint32_t row = 0; row < rows.count(); ++row) {
        const auto is_end_held = [&](const RowEnd& end) {
            return ends.at(rows.curves[end.curve].piece, rows.in_plane(end.x_mm, rows.y_mm(row)));
        };
        const std::vector<double>& stops = crossings[row];
        for (const RowSpan& span : rows.spans_of(row)) {
            double at = span.start.x_mm;
            bool held = is_end_held(span.start);
            for (auto stop = std::upper_bound(stops.begin(), stops.end(), at);
                 stop != stops.end() && *stop < span.end.x_mm; ++stop) {
                stretches.add(*stop - at, held, true);
                at = *stop;
                held = true;
            }
            stretches.add(span.end.x_mm - at, held, is_end_held(span.end));
        }
    }
    if (!(stretches.length_mm > 0)) return {.angle_rad = angle_rad};
    return {.angle_rad = angle_rad,
            .held = stretches.held_mm / stretches.length_mm,
            .longest_mm = stretches.squares_mm2 / stretches.length_mm};
}

std::optional<BridgeSpan> span_of(Region bridge, const Holding& holding,
                                  std::span<const Chord> lines, double spacing_mm) {
    const std::vector<BoundaryPiece> boundary = boundary_pieces(bridge);
    if (boundary.empty()) return std::nullopt;
    std::vector<BridgeSpan> trials;
    if (lines.empty()) {
        for (const double angle : candidates(boundary, spacing_mm, directions))
            trials.push_back(tried(boundary, holding, angle, spacing_mm));
        return best_of(trials, as_good);
    }
    const HeldBoundary ends(boundary, holding, spacing_mm);
    for (const double angle : candidates(boundary, spacing_mm, directions_over_lines))
        trials.push_back(tried_over(lines, boundary, ends, angle));
    return best_of(trials, as_short_over_lines);
}

bool is_valid(Region bridge, Region below, double spacing_mm) {
    return std::isfinite(spacing_mm) &&
           std::all_of(bridge.begin(), bridge.end(), region::is_finite) &&
           std::all_of(below.begin(), below.end(), region::is_finite);
}

}  // namespace

std::vector<Chord> chords_of(const Fill& fill) {
    std::vector<Chord> chords;
    for (const HatchRun& run : fill.runs) {
        const Vector2 across(-run.direction.y(), run.direction.x());
        double offset_mm = run.offset_mm;
        for (const HatchRow& row : run.rows) {
            const Point2 foot = offset_mm * across;
            chords.push_back(
                {foot + row.start_mm * run.direction, foot + row.end_mm * run.direction});
            offset_mm += run.pitch_mm;
        }
    }
    for (const Strand& strand : fill.strands) {
        for (const BoundaryPiece& piece : boundary_pieces(std::span(&strand.path, 1))) {
            const double turn = std::abs(piece.curvature_per_mm) * piece.length_mm;
            const int count = 1 + static_cast<int>(turn / chord_turn);
            for (int i = 0; i < count; ++i)
                chords.push_back({piece.at(static_cast<double>(i) / count).point,
                                  piece.at(static_cast<double>(i + 1) / count).point});
        }
    }
    return chords;
}

std::vector<Bridge> bridges_over(Region bridges, Region below, double spacing_mm) {
    return bridges_inside(bridges, below, {}, {}, spacing_mm);
}

std::vector<Bridge> bridges_inside(Region bridges, Region below, Region sparse_below,
                                   std::span<const Chord> lines, double spacing_mm) {
    std::vector<Bridge> result;
    if (bridges.empty()) return result;
    if (!is_valid(bridges, below, spacing_mm) || !is_valid(sparse_below, {}, spacing_mm)) {
        return {{{bridges.begin(), bridges.end()}, std::nullopt}};
    }
    const Holding holding{Boundary(below), Boundary(sparse_below)};
    for (std::vector<Contour>& part : parts_of(bridges)) {
        const auto span = span_of(part, holding, lines, spacing_mm);
        result.push_back({std::move(part), span ? std::optional(span->angle_rad) : std::nullopt});
    }
    return result;
}

std::optional<BridgeSpan> bridge_span(Region bridge, Region below, double spacing_mm) {
    if (!is_valid(bridge, below, spacing_mm)) return std::nullopt;
    return span_of(bridge, {Boundary(below), Boundary(Region())}, {}, spacing_mm);
}

std::optional<double> bridge_angle(Region bridge, Region below, double spacing_mm) {
    const auto span = bridge_span(bridge, below, spacing_mm);
    return span ? std::optional(span->angle_rad) : std::nullopt;
}

}  // namespace lyr
