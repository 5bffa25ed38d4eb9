// At each crossing a curve goes on along the other one instead: what results crosses nothing, and runs along the border of
// what is wound around so many times or more. Those are kept beside which that is once or more on the left and not at all
// on the right.

#include "kernel/toolpath/uncross.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "kernel/geometry/tolerance.h"
#include "kernel/toolpath/turns.h"

namespace lyr {
namespace {

// Bounds of turns are compared with a little less than half a circle, for round-off.
constexpr double crossing_turn_rad = 3;

// Curves that cross at a smaller angle (its sine) are not sure to.
constexpr double least_sine = 0.02;

// Windings are counted so far beside a contour, in the clearance: within it there is nothing else.
constexpr double probe_share = 0.5;

// Where a piece is crossed, from its middle on. The other piece's is the one with the bit of the index flipped.
struct Cut {
    std::uint32_t piece;
    double along_mm;
    Point2 point;
};

class Uncrosser {
public:
    Uncrosser(const BoundedRegion& curves, double clear_mm)
        : curves_(curves), pieces_(curves.boundary.pieces()), clear_mm_(clear_mm) {}

    std::optional<std::vector<Contour>> result() {
        if (!find_cuts()) return std::nullopt;
        sort_cuts();
        std::vector<Contour> kept;
        std::vector<bool> is_cut(curves_.contours.size(), false);
        for (const Cut& cut : cuts_) is_cut[pieces_[cut.piece].contour] = true;
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            const std::uint32_t contour = pieces_[i].contour;
            if (is_cut[contour] || (i > 0 && pieces_[i - 1].contour == contour)) continue;
            const std::optional<bool> bounds =
                is_border(pieces_[i].middle, pieces_[i].middle_tangent);
            if (!bounds) return std::nullopt;
            if (*bounds) kept.push_back(curves_.contours[contour]);
        }
        std::vector<bool> followed(cuts_.size(), false);
        for (std::uint32_t cut = 0; cut < cuts_.size(); ++cut) {
            if (followed[cut]) continue;
            const Path path = followed_from(cut, followed);
            const std::optional<bool> bounds = is_border(path);
            if (!bounds) return std::nullopt;
            if (*bounds) kept.push_back(path);
        }
        return kept;
    }

private:
    bool find_cuts();
    bool add_cuts(std::uint32_t a, std::uint32_t b);
    void sort_cuts();
    Path followed_from(std::uint32_t cut, std::vector<bool>& followed) const;
    void append(std::uint32_t piece, double from_mm, double to_mm, const Point2& end,
                Path& path) const;
    std::optional<bool> is_border(const Point2& point, const Vector2& tangent) const;
    std::optional<bool> is_border(const Path& path) const;
    std::uint32_t next_piece(std::uint32_t piece) const;

    const BoundedRegion& curves_;
    const std::vector<BoundaryPiece>& pieces_;
    double clear_mm_;
    std::vector<Cut> cuts_;
    std::vector<std::uint32_t> order_;   // of the cuts, by piece and along it
    std::vector<std::uint32_t> place_;   // by cut, in that order
    std::vector<std::uint32_t> firsts_;  // by contour, its first piece
};

// Where two curves are nearest to each other is an end of one of them, or a meeting of the whole lines or circles.
bool Uncrosser::add_cuts(std::uint32_t i, std::uint32_t j) {
    const BoundaryPiece &a = pieces_[i], &b = pieces_[j];
    const bool follows = a.contour == b.contour && a.end == b.start;
    const bool leads = a.contour == b.contour && b.end == a.start;
    if (follows && leads) return false;
    const auto is_shared = [&](const Point2& point) {
        return (follows && (point - a.end).norm() <= clear_mm_) ||
               (leads && (point - a.start).norm() <= clear_mm_);
    };
    const auto is_near = [&](const BoundaryPiece& piece, const Point2& point) {
        return !is_shared(point) && piece.distance_mm(point) <= clear_mm_;
    };
    if (is_near(a, b.start) || is_near(a, b.end) || is_near(b, a.start) || is_near(b, a.end))
        return false;
    const region::Curve one = a.curve(), other = b.curve();
    const region::Meetings found = region::meetings(one, other);
    for (int k = 0; k < found.count; ++k) {
        const Point2& point = found.points[static_cast<std::size_t>(k)];
        if (!is_near(a, point) || !is_near(b, point)) continue;
        const double sine =
            cross(region::tangent_beside(one, point), region::tangent_beside(other, point));
        if (std::abs(sine) < least_sine || a.distance_mm(point) > resolution_mm ||
            b.distance_mm(point) > resolution_mm)
            return false;
        cuts_.push_back({i, region::along_mm(one, point), point});
        cuts_.push_back({j, region::along_mm(other, point), point});
    }
    return true;
}

bool Uncrosser::find_cuts() {
    const Turns turns(pieces_);
    const Vector2 margin(clear_mm_, clear_mm_);
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
        const region::Box2 box = pieces_[i].box();
        const bool fails =
            curves_.boundary.any({box.min() - margin, box.max() + margin}, [&](std::uint32_t j) {
                return j > i && !turns.is_stretch(i, j, crossing_turn_rad) && !add_cuts(i, j);
            });
        if (fails) return false;
    }
    return true;
}

void Uncrosser::sort_cuts() {
    order_.resize(cuts_.size());
    place_.resize(cuts_.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tie(cuts_[a].piece, cuts_[a].along_mm, a) <
               std::tie(cuts_[b].piece, cuts_[b].along_mm, b);
    });
    for (std::uint32_t i = 0; i < order_.size(); ++i) place_[order_[i]] = i;
    firsts_.assign(curves_.contours.size(), 0);
    for (std::uint32_t i = static_cast<std::uint32_t>(pieces_.size()); i-- > 0;)
        firsts_[pieces_[i].contour] = i;
}

std::uint32_t Uncrosser::next_piece(std::uint32_t piece) const {
    const std::uint32_t contour = pieces_[piece].contour;
    const bool is_last = piece + 1 == pieces_.size() || pieces_[piece + 1].contour != contour;
    return is_last ? firsts_[contour] : piece + 1;
}

void Uncrosser::append(std::uint32_t piece, double from_mm, double to_mm, const Point2& end,
                       Path& path) const {
    const Point2 start = path.segments.empty() ? path.start : path.segments.back().end;
    if (start == end) return;
    const double sweep = pieces_[piece].curvature_per_mm * (to_mm - from_mm);
    path.segments.push_back(sweep == 0 ? Segment{end, 0} : arc_with_sweep(start, end, sweep));
}

// Along the piece of a cut to the next one, there on along the other piece, and so on.
Path Uncrosser::followed_from(std::uint32_t first, std::vector<bool>& followed) const {
    Path path{cuts_[first].point, {}};
    for (std::uint32_t cut = first; !followed[cut];) {
        followed[cut] = true;
        std::uint32_t piece = cuts_[cut].piece;
        double from_mm = cuts_[cut].along_mm;
        std::uint32_t place = place_[cut] + 1;
        while (place == order_.size() || cuts_[order_[place]].piece != piece) {
            append(piece, from_mm, pieces_[piece].length_mm / 2, pieces_[piece].end, path);
            piece = next_piece(piece);
            from_mm = -pieces_[piece].length_mm / 2;
            place =
                static_cast<std::uint32_t>(std::lower_bound(order_.begin(), order_.end(), piece,
                                                            [&](std::uint32_t c, std::uint32_t p) {
                                                                return cuts_[c].piece < p;
                                                            }) -
                                           order_.begin());
        }
        const std::uint32_t next = order_[place];
        append(piece, from_mm, cuts_[next].along_mm, cuts_[next].point, path);
        cut = next ^ 1u;
    }
    return path;
}

std::optional<bool> Uncrosser::is_border(const Point2& point, const Vector2& tangent) const {
    const Vector2 left = probe_share * clear_mm_ * left_of(tangent);
    const int inside = curves_.boundary.winding(point + left);
    const int outside = curves_.boundary.winding(point - left);
    if (inside != outside + 1) return std::nullopt;
    return inside == 1;
}

// From the middle of its longest segment.
std::optional<bool> Uncrosser::is_border(const Path& path) const {
    Point2 from = path.start;
    std::optional<BoundaryPoint> longest;
    double most_mm = 0;
    for (const Segment& segment : path.segments) {
        const double length = length_mm(from, segment);
        if (length > most_mm) {
            most_mm = length;
            const region::Curve curve = region::curve_of(from, segment);
            longest = BoundaryPoint{curve.middle, curve.tangent};
        }
        from = segment.end;
    }
    if (!longest) return std::nullopt;
    return is_border(longest->point, longest->tangent);
}

}  // namespace

std::optional<std::vector<Contour>> uncrossed(const BoundedRegion& curves, double clear_mm) {
    return Uncrosser(curves, clear_mm).result();
}

}  // namespace lyr
