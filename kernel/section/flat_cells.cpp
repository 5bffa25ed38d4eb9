// Cells are halved until their bounds are close enough. The boundary of the face is boxes in the parameters; a cell knows
// those that it meets. One that meets none is in the face as a whole or out of it, which its middle says.

#include "kernel/section/flat_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "kernel/section/containment.h"
#include "kernel/section/face_outline.h"
#include "kernel/section/parameter_cell.h"

namespace lyr {
namespace {

constexpr double half_turn_rad = std::numbers::pi;

// Half of flatness_slack for what a cell's bound is above its flatness, half for what is above that of other cells.
constexpr double cell_slack = flatness_slack / 2;

// Of a free-form surface, as a share of its width: closer to its own border, an edge trims nothing off.
constexpr double rim_share = 1e-5;

// Weights that differ from one by less are one but for the digits of the file. They move a point by that share of the surface's
// size at most, and cost twice the degrees.
constexpr double even_weights = 1e-9;

// Cells this much lower than FlatnessLimits::height_mm are not divided further, whatever their flatness.
constexpr double lowest_share = 1.0 / 8;

// Halvings of a whole surface down to round-off, in either parameter.
constexpr int most_halvings = 100;

// Of one face. None of 63,025 faces of real files comes to more than an eighth of as many parts. Beyond, bounds hold but
// are not close.
constexpr std::size_t most_divided = std::size_t{1} << 20;

// A stretch of the boundary lies in each. Through a seam, a box runs on beyond the period.
std::vector<CellRect> boundary_boxes(const Model& model, const Face& face) {
    const auto period = parameter_periods(face.surface);
    const auto step = [&](const Point2& from, const Point2& to) {
        return Vector2(short_way(to.x() - from.x(), period[0]),
                       short_way(to.y() - from.y(), period[1]));
    };
    const std::vector<Pole> poles = poles_of(face.surface);
    std::vector<CellRect> boxes;
    for (const Coedge& coedge : bounding_coedges(model, face)) {
        const Edge& edge = model[coedge.edge];
        std::vector<Point3> points;
        append_outline(edge, coedge.reversed, 2 * outline_steps(edge), points);
        points.push_back(evaluate(edge.curve, coedge.reversed ? edge.t_start : edge.t_end));
        std::vector<Point2> uv = parameters_along(face.surface, points, poles);
        // An edge that ends at a pole comes to it as its neighbour does.
        if (const Pole* pole = pole_at(poles, points.front()))
            uv.front()[pole->free] = uv[1][pole->free];
        if (const Pole* pole = pole_at(poles, points.back()))
            uv.back()[pole->free] = uv[uv.size() - 2][pole->free];
        for (std::size_t i = 0; i + 2 < uv.size(); i += 2) {
            const Point2 middle = uv[i] + step(uv[i], uv[i + 1]);
            const Point2 end = middle + step(middle, uv[i + 2]);
            // A parabola through the three leaves their box by a quarter of this at most.
            const Vector2 bulge = (middle - (uv[i] + end) / 2).cwiseAbs();
            boxes.push_back({uv[i].cwiseMin(middle).cwiseMin(end) - bulge,
                             uv[i].cwiseMax(middle).cwiseMax(end) + bulge});
        }
    }
    return boxes;
}

bool is_rational(const BSplineSurface& surface) {
    const auto [least, most] = std::minmax_element(surface.weights.begin(), surface.weights.end());
    return !surface.weights.empty() && (*least < 1 - even_weights || *most > 1 + even_weights);
}

bool is_at_rim(const CellRect& box, const BSplineSurface& surface) {
    const auto along = [&](Eigen::Index k, double start, double end, bool closed) {
        const double near = rim_share * (end - start);
        return !closed && (box.high[k] <= start + near || box.low[k] >= end - near);
    };
    return along(0, surface.start_u(), surface.end_u(), surface.closed_u) ||
           along(1, surface.start_v(), surface.end_v(), surface.closed_v);
}

using Boxes = std::vector<std::uint32_t>;

// The flatness that a face has somewhere at about a height, as far as it is known.
class Attained {
public:
    Attained() = default;
    Attained(double bottom_mm, double top_mm, double bin_mm)
        : bottom_mm_(bottom_mm), bin_mm_(std::max(bin_mm, (top_mm - bottom_mm) / most_bins)) {
        flatness_.assign(bin(top_mm, most_bins) + 1, 0);
    }

    void add(double bottom_mm, double top_mm, double flatness) {
        for (std::size_t i = bin(bottom_mm); i <= bin(top_mm); ++i)
            flatness_[i] = std::max(flatness_[i], flatness);
    }

    // Over all heights between two.
    double least(double bottom_mm, double top_mm) const {
        return *std::min_element(flatness_.begin() + static_cast<std::ptrdiff_t>(bin(bottom_mm)),
                                 flatness_.begin() + static_cast<std::ptrdiff_t>(bin(top_mm)) + 1);
    }

private:
    static constexpr double most_bins = 1 << 16;

    std::size_t bin(double z_mm) const {
        return bin(z_mm, static_cast<double>(flatness_.size()) - 1);
    }
    std::size_t bin(double z_mm, double last) const {
        return static_cast<std::size_t>(std::clamp((z_mm - bottom_mm_) / bin_mm_, 0.0, last));
    }

    double bottom_mm_ = 0, bin_mm_ = 1;
    std::vector<double> flatness_;
};

class Divider {
public:
    Divider(const Model& model, FaceId face, const std::vector<double>& vertex_level_mm,
            const FlatnessLimits& limits)
        : face_(model[face]),
          limits_(limits),
          period_(parameter_periods(face_.surface)),
          boxes_(boundary_boxes(model, face_)),
          containment_(model, face, vertex_level_mm, true) {
        if (const auto* spline = std::get_if<SharedBSplineSurface>(&face_.surface))
            std::erase_if(boxes_, [&](const CellRect& box) { return is_at_rim(box, **spline); });
    }

    const std::vector<CellRect>& boxes() const { return boxes_; }
    bool holds_apex() const { return containment_.holds_apex(); }

    // Of all cells of the surface.
    template <class Cell>
    std::vector<FlatPart> parts(std::vector<Cell> cells, HeightRange loops) {
        Boxes all(boxes_.size());
        std::iota(all.begin(), all.end(), 0u);
        std::vector<Pending<Cell>> pending;
        HeightRange hull = loops;
        for (Cell& cell : cells) {
            auto first = entered(std::move(cell), all, true);
            if (!first) continue;
            hull = {std::min(hull.bottom_mm, first->bounds.bottom_mm),
                    std::max(hull.top_mm, first->bounds.top_mm)};
            pending.push_back(std::move(*first));
        }
        if (pending.empty()) return {};
        attained_ = Attained(hull.bottom_mm, hull.top_mm, limits_.height_mm);
        std::stable_sort(pending.begin(), pending.end(), [](const auto& a, const auto& b) {
            return a.bounds.most > b.bounds.most;
        });
        for (const Pending<Cell>& cell : pending) divide(cell, 0);
        return cut_off(loops);
    }

private:
    // Cut off at the lowest and highest points of the face, which are on its loops or level.
    std::vector<FlatPart> cut_off(HeightRange loops) {
        for (const FlatPart& part : level_) {
            loops.bottom_mm = std::min(loops.bottom_mm, part.bottom_mm);
            loops.top_mm = std::max(loops.top_mm, part.top_mm);
        }
        for (FlatPart& part : parts_) {
            part.bottom_mm = std::max(part.bottom_mm, loops.bottom_mm);
            part.top_mm = std::min(part.top_mm, loops.top_mm);
        }
        std::erase_if(parts_, [](const FlatPart& p) { return !(p.bottom_mm < p.top_mm); });
        return std::move(parts_);
    }

    bool meets(const CellRect& cell, const CellRect& box) const {
        for (const Eigen::Index k : {0, 1}) {
            const double apart =
                short_way(box.middle()[k] - cell.middle()[k], period_[static_cast<std::size_t>(k)]);
            const double reach = (box.high[k] - box.low[k] + cell.high[k] - cell.low[k]) / 2;
            if (!(std::abs(apart) < reach)) return false;
        }
        return true;
    }

    template <class Cell>
    struct Pending {
        Cell cell;
        CellBounds bounds;
        Boxes boxes;  // that the cell meets
    };

    // What of a cell is to be looked into; `around`: the boxes that the cell around it meets.
    template <class Cell>
    std::optional<Pending<Cell>> entered(Cell cell, const Boxes& around, bool is_first) const {
        const CellBounds bounds = cell.bounds();
        if (bounds.most <= limits_.least) return std::nullopt;
        Boxes boxes;
        for (const std::uint32_t box : around)
            if (meets(cell.rect(), boxes_[box])) boxes.push_back(box);
        const bool leaves_boundary = boxes.empty() && (is_first || !around.empty());
        if (leaves_boundary && !containment_.holds_parameters(cell.rect().middle()))
            return std::nullopt;
        return Pending<Cell>{std::move(cell), bounds, std::move(boxes)};
    }

    template <class Cell>
    void divide(const Pending<Cell>& at, int halvings) {
        const CellBounds& bounds = at.bounds;
        const double rise_mm = bounds.top_mm - bounds.bottom_mm;
        const bool is_whole = at.boxes.empty();
        const bool is_close =
            bounds.least >= limits_.most ||
            bounds.most <= (1 + cell_slack) * std::max(bounds.mean, limits_.least);
        if ((is_close && (is_whole || rise_mm <= limits_.height_mm)) ||
            rise_mm <= lowest_share * limits_.height_mm || halvings == most_halvings ||
            ++divided_ > most_divided)
            return take(bounds, is_whole);
        if (bounds.most <= (1 + cell_slack) * attained_.least(bounds.bottom_mm, bounds.top_mm))
            return take(bounds, is_whole);
        auto halves = at.cell.halves(is_close ? CellMeasure::height : CellMeasure::flatness);
        std::array parts{entered(std::move(halves[0]), at.boxes, false),
                         entered(std::move(halves[1]), at.boxes, false)};
        // The flatter one first: what it attains may settle the other.
        if (parts[0] && parts[1] && parts[1]->bounds.most > parts[0]->bounds.most)
            std::swap(parts[0], parts[1]);
        for (const auto& part : parts)
            if (part) divide(*part, halvings + 1);
    }

    void take(const CellBounds& bounds, bool is_whole) {
        const double flatness = bounds.most >= limits_.most ? 1 : bounds.most;
        parts_.push_back({bounds.bottom_mm, bounds.top_mm, flatness});
        if (!is_whole) return;
        if (bounds.most >= 1) level_.push_back(parts_.back());
        attained_.add(bounds.bottom_mm, bounds.top_mm, bounds.least);
    }

    const Face& face_;
    FlatnessLimits limits_;
    std::array<double, 2> period_;
    std::vector<CellRect> boxes_;
    Containment containment_;
    Attained attained_;
    std::size_t divided_ = 0;
    std::vector<FlatPart> parts_, level_;
};

// The whole of a round surface that the face can be on, in parts no wider than a quarter turn.
std::vector<CellRect> round_rects(const Surface& surface, const Divider& divider) {
    double low = -half_turn_rad, high = half_turn_rad;
    int rows = 4;
    if (const auto* torus = std::get_if<Torus>(&surface)) {
        const double ratio = torus->major_mm / torus->minor_mm;
        // Beyond this angle of the tube, a spindle torus is on its inner sheet.
        const double pole = ratio < 1 ? std::acos(-ratio) : half_turn_rad;
        low = torus->inner_sheet ? pole : -pole;
        high = torus->inner_sheet ? 2 * half_turn_rad - pole : pole;
    } else {
        rows = 1;
        low = std::numeric_limits<double>::infinity();
        high = -low;
        for (const CellRect& box : divider.boxes()) {
            low = std::min(low, box.low.y());
            high = std::max(high, box.high.y());
        }
        if (const auto* cone = std::get_if<Cone>(&surface)) {
            const double apex = -cone->radius_mm / std::tan(cone->half_angle_rad);
            low = divider.holds_apex() ? apex : std::max(low, apex);
        }
    }
    std::vector<CellRect> rects;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; low < high && j < rows; ++j) {
            const double u = (i - 2) * half_turn_rad / 2, height = (high - low) / rows;
            rects.push_back(
                {{u, low + j * height}, {u + half_turn_rad / 2, low + (j + 1) * height}});
        }
    }
    return rects;
}

}  // namespace

std::vector<FlatPart> flat_cells(const Model& model, FaceId id,
                                 const std::vector<double>& vertex_level_mm, HeightRange loops,
                                 const FlatnessLimits& limits) {
    Divider divider(model, id, vertex_level_mm, limits);
    const Surface& surface = model[id].surface;
    if (const auto* spline = std::get_if<SharedBSplineSurface>(&surface)) {
        std::vector<PatchCell> cells;
        for (const BezierPatch& patch : bezier_patches(**spline).patches)
            cells.emplace_back(patch, is_rational(**spline));
        return divider.parts(std::move(cells), loops);
    }
    std::vector<RoundCell> cells;
    for (const CellRect& rect : round_rects(surface, divider)) cells.emplace_back(surface, rect);
    return divider.parts(std::move(cells), loops);
}

}  // namespace lyr
