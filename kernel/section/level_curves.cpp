// One crossing on each border piece whose ends are on different sides of the plane. A cell's crossings are paired: going
// counter-clockwise around it, a curve with the high side on its left begins where the border falls through the
// plane and ends where it rises. In a cell that is monotone in v the curves are graphs over u, which orders them.
// Curves are then followed from cell to cell, and sampled inside a cell by solving for the plane.

#include "kernel/section/level_curves.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "kernel/geometry/root.h"
#include "kernel/geometry/tolerance.h"
#include "kernel/section/bezier_patch.h"

namespace lyr {
namespace {

// Places are found on chords (freeform_section.cpp): these must not stray far from their curve.
constexpr double farthest_from_chord_mm = 0.02;

// The greatest value of s^2 (1 - s)^2 (s - 1/2), by its slope in the middle.
constexpr double skew_share = 0.143;

// By how much of its length a cubic strays that has one end's tangent turned by a radian: the greatest value of s (1 - s)^2.
constexpr double wrong_end_share = 4.0 / 27;

constexpr std::uint32_t none = ~std::uint32_t{0};

// A crossing as an end of a cell's curve.
struct CellEnd {
    std::int32_t cell;
    bool is_start;
    std::uint32_t crossing;
    Point2 uv;  // in the cell's own parameters, which differ from the neighbour's at a seam
    double order;
};

struct CellCurve {
    std::int32_t cell;
    CellEnd start, end;
};

// A cell's curve being sampled. Its middle is asked for more than once.
struct Sampled {
    const CellCurve& curve;
    std::optional<CurvePoint> middle{};
};

// The end of a cell's curve: that of the next one may begin there.
struct Reached {
    const BezierPatch* patch;
    Point2 uv;
    CurvePoint at;
};

class Tracker {
public:
    Tracker(const HeightMesh& mesh, double z_mm, double allowed_mm)
        : mesh_(mesh), z_mm_(z_mm), allowed_mm_(allowed_mm) {}

    std::vector<LevelCurve> curves() {
        find_ends();
        pair_ends();
        return follow();
    }

private:
    void find_ends();
    void pair_ends();
    std::vector<LevelCurve> follow();
    LevelCurve follow_from(std::uint32_t first_curve);
    void add_end(const BorderPiece& piece, std::int32_t cell, bool cell_is_left, bool rises,
                 double at, std::uint32_t crossing);
    Vector2 extent(const CellCurve& curve) const;
    double bend_mm(const CellCurve& curve) const;
    int first_spans(Sampled& sampled, const CurvePoint& start, double chord_mm) const;
    bool is_corner(const CurvePoint& before, const CurvePoint& at, const Vector2& leaving,
                   const CurvePoint& after) const;
    void sample(const CellCurve& curve, LevelCurve& out, std::optional<Reached>& reached) const;
    void refine(Sampled& sampled, double from, const CurvePoint& start, double to,
                const CurvePoint& end, int depth, bool settled, LevelCurve& out) const;
    CurvePoint point_at(Sampled& sampled, double share) const;
    Point2 solve(const CellCurve& curve, double share) const;
    Point2 solve_across(const CellCurve& curve, double share) const;
    CurvePoint point_at(const BezierPatch& patch, const Point2& uv) const;

    const HeightMesh& mesh_;
    double z_mm_, allowed_mm_;
    std::uint32_t crossing_count_ = 0;
    std::vector<CellEnd> ends_;
    std::vector<CellCurve> cell_curves_;
    std::vector<std::uint32_t> curve_from_;  // by crossing
    std::vector<bool> reached_, followed_;   // by crossing, by cell curve
};

void Tracker::add_end(const BorderPiece& piece, std::int32_t cell, bool cell_is_left, bool rises,
                      double at, std::uint32_t crossing) {
    if (cell < 0) return;
    const MonotoneCell& c = mesh_.cells[static_cast<std::size_t>(cell)];
    const Point2 uv = piece.along_u ? Point2(at, cell_is_left ? c.from_v : c.to_v)
                                    : Point2(cell_is_left ? c.to_u : c.from_u, at);
    // Along the curve u rises where dz/dv > 0 and v falls where dz/du > 0.
    double order = 0;
    if (c.kind == CellKind::graph_over_v) {
        order = c.rises_u ? -uv.y() : uv.y();
    } else if (c.kind != CellKind::flat) {
        order = c.rises_v ? uv.x() : -uv.x();
    }
    ends_.push_back({cell, rises != cell_is_left, crossing, uv, order});
}

void Tracker::find_ends() {
    mesh_.pieces_by_height.stab(z_mm_, [&](std::uint32_t item) {
        const BorderPiece& piece = mesh_.pieces[item];
        const double from = mesh_.vertices[piece.from].z_mm, to = mesh_.vertices[piece.to].z_mm;
        const bool rises = from <= z_mm_;
        const double guess = piece.start + (z_mm_ - from) / (to - from) * (piece.end - piece.start);
        const IsoLine line(mesh_.patches[piece.patch], piece.along_u, piece.fixed);
        const double at = line.crossing(z_mm_, piece.start, piece.end, !rises, guess);
        const std::uint32_t crossing = crossing_count_++;
        add_end(piece, piece.left, true, rises, at, crossing);
        add_end(piece, piece.right, false, rises, at, crossing);
    });
}

void Tracker::pair_ends() {
    std::sort(ends_.begin(), ends_.end(), [](const CellEnd& a, const CellEnd& b) {
        return std::tie(a.cell, a.is_start, a.order, a.crossing) <
               std::tie(b.cell, b.is_start, b.order, b.crossing);
    });
    curve_from_.assign(crossing_count_, none);
    reached_.assign(crossing_count_, false);
    for (std::size_t first = 0; first < ends_.size();) {
        std::size_t starts = first, last = first;
        while (last < ends_.size() && ends_[last].cell == ends_[first].cell) ++last;
        while (starts < last && !ends_[starts].is_start) ++starts;
        // As many start as end, for the border of a cell rises as often as it falls; or else a curve stays open, and is
        // reported as that.
        for (std::size_t i = 0; i < std::min(starts - first, last - starts); ++i) {
            const CellEnd &end = ends_[first + i], &start = ends_[starts + i];
            curve_from_[start.crossing] = static_cast<std::uint32_t>(cell_curves_.size());
            reached_[end.crossing] = true;
            cell_curves_.push_back({start.cell, start, end});
        }
        first = last;
    }
}

std::vector<LevelCurve> Tracker::follow() {
    std::vector<LevelCurve> result;
    followed_.assign(cell_curves_.size(), false);
    for (std::uint32_t c = 0; c < cell_curves_.size(); ++c) {
        if (!reached_[cell_curves_[c].start.crossing]) result.push_back(follow_from(c));
    }
    for (std::uint32_t c = 0; c < cell_curves_.size(); ++c) {
        if (!followed_[c]) result.push_back(follow_from(c));
    }
    return result;
}

LevelCurve Tracker::follow_from(std::uint32_t first_curve) {
    LevelCurve result{{}, {}, false, cell_curves_[first_curve].start.uv};
    std::optional<Reached> reached;
    std::uint32_t next = first_curve;
    while (next != none && !followed_[next]) {
        followed_[next] = true;
        sample(cell_curves_[next], result, reached);
        next = curve_from_[cell_curves_[next].end.crossing];
    }
    result.closed = next == first_curve;
    if (result.closed) {
        const std::size_t n = result.points.size();
        result.points.back().point = result.points.front().point;
        result.closes_in_corner =
            n > 2 && is_corner(result.points[n - 2], result.points.back(),
                               result.points.front().tangent, result.points[1]);
    }
    result.key.push_back(0);
    for (std::size_t i = 1; i < result.points.size(); ++i) {
        result.key.push_back(result.key.back() +
                             (result.points[i].point - result.points[i - 1].point).norm());
    }
    return result;
}

CurvePoint Tracker::point_at(const BezierPatch& patch, const Point2& uv) const {
    const Partials at = partials(patch, uv);
    const Vector2 along = (at.dv.z() * at.du - at.du.z() * at.dv).head<2>();
    const double length = along.norm();
    return {at.point.head<2>(), length > 0 ? Vector2(along / length) : Vector2::Zero()};
}

// Between the ends of a curve that is monotone in both: across the line between them, in the box that they span.
Point2 Tracker::solve_across(const CellCurve& curve, double share) const {
    const MonotoneCell& cell = mesh_.cells[static_cast<std::size_t>(curve.cell)];
    const BezierPatch& patch = mesh_.patches[cell.patch];
    const Vector2 along = curve.end.uv - curve.start.uv;
    const Vector2 up(std::abs(along.x()) * (cell.rises_u ? 1 : -1),
                     std::abs(along.y()) * (cell.rises_v ? 1 : -1));
    const Point2 base = curve.start.uv + share * along;
    const double reach = std::min(share, 1 - share);
    const auto above = [&](double t) {
        const Partials at = partials(patch, base + t * up);
        return std::pair(at.point.z() - z_mm_, at.du.z() * up.x() + at.dv.z() * up.y());
    };
    return base + bracketed_root(above, -reach, reach, false, 0, resolution_mm / 100) * up;
}

Point2 Tracker::solve(const CellCurve& curve, double share) const {
    const MonotoneCell& cell = mesh_.cells[static_cast<std::size_t>(curve.cell)];
    const Point2 chord = curve.start.uv + share * (curve.end.uv - curve.start.uv);
    const BezierPatch& patch = mesh_.patches[cell.patch];
    switch (cell.kind) {
        case CellKind::flat:
            return chord;
        case CellKind::both:
            return solve_across(curve, share);
        case CellKind::graph_over_u:
            return {chord.x(),
                    IsoLine(patch, false, chord.x())
                        .crossing(z_mm_, cell.from_v, cell.to_v, !cell.rises_v, chord.y())};
        case CellKind::graph_over_v:
            return {IsoLine(patch, true, chord.y())
                        .crossing(z_mm_, cell.from_u, cell.to_u, !cell.rises_u, chord.x()),
                    chord.y()};
    }
    return chord;
}

CurvePoint Tracker::point_at(Sampled& sampled, double share) const {
    if (share == 0.5 && sampled.middle) return *sampled.middle;
    const CellCurve& curve = sampled.curve;
    const MonotoneCell& cell = mesh_.cells[static_cast<std::size_t>(curve.cell)];
    const CurvePoint at = point_at(mesh_.patches[cell.patch], solve(curve, share));
    if (share == 0.5) sampled.middle = at;
    return at;
}

// Halves a span until the cubic through its ends foretells the middle, point and tangent. What the cubic is off is s^2 (1 -
// s)^2 times a polynomial, whose value in the middle the point tells, and the tangent its slope. The middle is kept, and of
// the first part a sixteenth remains: it goes with the fourth power of the length.
void Tracker::refine(Sampled& sampled, double from, const CurvePoint& start, double to,
                     const CurvePoint& end, int depth, bool settled, LevelCurve& out) const {
    constexpr int deepest = 40;
    const double length = (end.point - start.point).norm();
    if (length <= resolution_mm || depth > deepest) return;
    if (settled && sagitta_mm(start, end) <= allowed_mm_) return;
    const double middle = 0.5 * (from + to);
    const CurvePoint at = point_at(sampled, middle);
    // Against the cubic as a curve: where along it the middle comes to lie is the parameter's affair.
    const double share = std::clamp(
        (at.point - start.point).dot(end.point - start.point) / (length * length), 0.0, 1.0);
    const CurvePoint foretold = between(start, end, share);
    const double off = (foretold.point - at.point).norm();
    const double skew = skew_share * length * std::abs(cross(foretold.tangent, at.tangent));
    const bool fine = off <= allowed_mm_ && skew <= allowed_mm_ &&
                      sagitta_mm(start, end) <= farthest_from_chord_mm;
    if (!fine) refine(sampled, from, start, middle, at, depth + 1, true, out);
    out.points.push_back(at);
    if (!fine) refine(sampled, middle, at, to, end, depth + 1, true, out);
}

// Of a box in the parameters that holds the curve.
Vector2 Tracker::extent(const CellCurve& curve) const {
    const MonotoneCell& cell = mesh_.cells[static_cast<std::size_t>(curve.cell)];
    Vector2 box = (curve.end.uv - curve.start.uv).cwiseAbs();
    if (cell.kind == CellKind::graph_over_u)
        box.y() = std::min(box.x() * cell.steepest, cell.to_v - cell.from_v);
    if (cell.kind == CellKind::graph_over_v)
        box.x() = std::min(box.y() * cell.steepest, cell.to_u - cell.from_u);
    return box;
}

// How far the surface is from being bicubic where the curve runs, at most.
double Tracker::bend_mm(const CellCurve& curve) const {
    const MonotoneCell& cell = mesh_.cells[static_cast<std::size_t>(curve.cell)];
    const BezierPatch& patch = mesh_.patches[cell.patch];
    const QuarticPart& whole = mesh_.quartic_parts[cell.patch];
    const Vector2 box = extent(curve);
    const double share_u = box.x() / (patch.to_u - patch.from_u);
    const double share_v = box.y() / (patch.to_v - patch.from_v);
    const double u2 = share_u * share_u, v2 = share_v * share_v;
    return whole.along_u_mm * u2 * u2 + whole.along_v_mm * v2 * v2;
}

// Into how many spans a cell's curve is divided to begin with: one that comes back to where it began (a cell may go once
// around a closed surface) has no chord to measure against.
int Tracker::first_spans(Sampled& sampled, const CurvePoint& start, double chord_mm) const {
    const CellCurve& curve = sampled.curve;
    const MonotoneCell& cell = mesh_.cells[static_cast<std::size_t>(curve.cell)];
    if (cell.kind == CellKind::flat) return 0;
    // Ends and tangents alone do not tell of a bend between them: a curve of degree 4 can leave along its chord and
    // arrive along it. With a point for every other degree none is left between two; nor are there any on spans that are
    // nearly cubic, which goes with the fourth power of their length.
    const BezierPatch& patch = mesh_.patches[cell.patch];
    const double cubic_spans = std::ceil(std::sqrt(std::sqrt(bend_mm(curve) / (allowed_mm_ / 4))));
    const int most = std::max(patch.degree_u, patch.degree_v) / 2 + 1;
    const int spans = static_cast<int>(std::clamp(cubic_spans, 1.0, static_cast<double>(most)));
    if (chord_mm > farthest_from_chord_mm) return spans;
    const CurvePoint middle = point_at(sampled, 0.5);
    const bool returns = (middle.point - start.point).norm() > std::max(chord_mm, resolution_mm);
    return returns ? std::max(spans, 4) : spans;
}

// Whether a point that is left with another tangent than it is reached with makes the cubics beside it stray.
bool Tracker::is_corner(const CurvePoint& before, const CurvePoint& at, const Vector2& leaving,
                        const CurvePoint& after) const {
    const double step = std::max((at.point - before.point).norm(), (after.point - at.point).norm());
    return wrong_end_share * step * angle_between(at.tangent, leaving) > allowed_mm_;
}

void Tracker::sample(const CellCurve& curve, LevelCurve& out,
                     std::optional<Reached>& reached) const {
    const MonotoneCell& cell = mesh_.cells[static_cast<std::size_t>(curve.cell)];
    const BezierPatch& patch = mesh_.patches[cell.patch];
    const bool goes_on = reached && reached->uv == curve.start.uv &&
                         (reached->patch == &patch || mesh_.is_smooth_at(reached->uv));
    CurvePoint start = goes_on ? reached->at : point_at(patch, curve.start.uv);
    CurvePoint end = point_at(patch, curve.end.uv);
    reached = Reached{&patch, curve.end.uv, end};
    const Vector2 chord = end.point - start.point;
    const double length = chord.norm();
    Sampled sampled{curve};
    const int spans = first_spans(sampled, start, length);
    // At a level point of the surface, and in a flat cell, the tangent says nothing.
    const Vector2 direction = length > 0 ? Vector2(chord / length) : start.tangent;
    if (cell.kind == CellKind::flat || start.tangent.isZero()) start.tangent = direction;
    if (cell.kind == CellKind::flat || end.tangent.isZero()) end.tangent = direction;
    if (out.points.empty()) {
        out.points.push_back(start);
    } else if (length <= resolution_mm && spans < 2) {
        return;
    }
    const std::size_t border = out.points.size();
    CurvePoint from = start;
    for (int i = 1; i <= spans; ++i) {
        const double share = static_cast<double>(i) / spans;
        const CurvePoint to = i == spans ? end : point_at(sampled, share);
        refine(sampled, share - 1.0 / spans, from, share, to, 0, spans > 1, out);
        if (i < spans) out.points.push_back(to);
        from = to;
    }
    out.points.push_back(end);
    if (border > 1 && is_corner(out.points[border - 2], out.points[border - 1], start.tangent,
                                out.points[border])) {
        const CurvePoint after{out.points[border - 1].point, start.tangent};
        out.points.insert(out.points.begin() + static_cast<std::ptrdiff_t>(border), after);
    }
}

}  // namespace

CurvePoint between(const CurvePoint& start, const CurvePoint& end, double share) {
    const double s = share, r = 1 - share, length = (end.point - start.point).norm();
    const Point2 point = r * r * (1 + 2 * s) * start.point + s * s * (3 - 2 * s) * end.point +
                         r * s * length * (r * start.tangent - s * end.tangent);
    const Vector2 tangent =
        6 * r * s * (end.point - start.point) +
        length * (r * (1 - 3 * s) * start.tangent + s * (3 * s - 2) * end.tangent);
    const double speed = tangent.norm();
    return {point, speed > 0 ? Vector2(tangent / speed) : start.tangent};
}

double sagitta_mm(const CurvePoint& start, const CurvePoint& end) {
    const Vector2 chord = end.point - start.point;
    const double length = chord.norm();
    // Twice the tangent of half the angle is the angle and a little more.
    const auto angle = [&](const Vector2& tangent) {
        return 2 * std::abs(cross(tangent, chord)) / (length + tangent.dot(chord));
    };
    return length > 0 ? length / 8 * (angle(start.tangent) + angle(end.tangent)) : 0;
}

std::vector<LevelCurve> level_curves(const HeightMesh& mesh, double z_mm, bool forward,
                                     double allowed_mm) {
    std::vector<LevelCurve> curves = Tracker(mesh, z_mm, allowed_mm).curves();
    if (forward) return curves;
    for (LevelCurve& curve : curves) {
        std::reverse(curve.points.begin(), curve.points.end());
        std::reverse(curve.key.begin(), curve.key.end());
        const double length = curve.key.front();
        for (CurvePoint& point : curve.points) point.tangent = -point.tangent;
        for (double& key : curve.key) key = length - key;
    }
    return curves;
}

}  // namespace lyr
