// In the rows' own coordinates (x along, y across) every contour becomes y-monotone lines and arcs; each row takes
// its crossings from the pieces that straddle it, sorted along x, and keeps the stretches with positive winding.

#include "kernel/toolpath/hatch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>

namespace lyr {
namespace {

constexpr double pi = std::numbers::pi;

// A piece that meets each row at most once.
struct Piece {
    Point2 low, high;
    int winding;  // +1: the contour falls here, and the region is to the right of the crossing
    std::optional<ArcCircle> circle;
    bool right_half = false;  // of the circle
};

struct Crossing {
    std::uint32_t row;
    double x_mm;
    int winding;
};

double crossing_x(const Piece& piece, double y) {
    if (!piece.circle) {
        const double share = (y - piece.low.y()) / (piece.high.y() - piece.low.y());
        return piece.low.x() + share * (piece.high.x() - piece.low.x());
    }
    const double across = y - piece.circle->centre.y(), r = piece.circle->radius_mm;
    const double half = std::sqrt(std::max(0.0, (r - across) * (r + across)));
    return piece.circle->centre.x() + (piece.right_half ? half : -half);
}

class PieceList {
public:
    void add_line(const Point2& from, const Point2& to) { add(from, to, std::nullopt, false); }

    // Cuts the arc at the lowest and highest points of its circle.
    void add_arc(const Point2& from, const Point2& to, const ArcCircle& circle, double sweep) {
        const Vector2 radial = from - circle.centre;
        double angle = std::atan2(radial.y(), radial.x());
        const double last = angle + sweep, turn = sweep > 0 ? 1 : -1;
        Point2 at = from;
        // Extremes lie at odd multiples of a quarter turn.
        double extreme = pi * (turn > 0 ? std::floor(angle / pi + 0.5) + 0.5
                                        : std::ceil(angle / pi - 0.5) - 0.5);
        for (; turn * extreme < turn * last; extreme += turn * pi) {
            const double side = std::sin(extreme) > 0 ? 1 : -1;
            const Point2 top(circle.centre.x(), circle.centre.y() + side * circle.radius_mm);
            add(at, top, circle, std::cos((angle + extreme) / 2) > 0);
            at = top;
            angle = extreme;
        }
        add(at, to, circle, std::cos((angle + last) / 2) > 0);
    }

    const std::vector<Piece>& pieces() const { return pieces_; }

private:
    void add(const Point2& from, const Point2& to, const std::optional<ArcCircle>& circle,
             bool right_half) {
        const bool falls = to.y() < from.y();
        pieces_.push_back(
            {falls ? to : from, falls ? from : to, falls ? 1 : -1, circle, right_half});
    }

    std::vector<Piece> pieces_;
};

PieceList pieces_of(std::span<const Contour> contours, const Vector2& direction) {
    const auto turned = [&](const Point2& p) {
        return Point2(direction.dot(p), cross(direction, p));
    };
    PieceList list;
    for (const Contour& contour : contours) {
        if (const auto* circle = std::get_if<FullCircle>(&contour)) {
            const Point2 centre = turned(circle->centre);
            const Point2 start = centre + Vector2(circle->radius_mm, 0);
            list.add_arc(start, start, {centre, circle->radius_mm},
                         circle->counter_clockwise ? 2 * pi : -2 * pi);
            continue;
        }
        const Path& path = std::get<Path>(contour);
        Point2 from = path.start;
        for (const Segment& segment : path.segments) {
            if (const auto circle = circle_of(from, segment)) {
                list.add_arc(turned(from), turned(segment.end),
                             {turned(circle->centre), circle->radius_mm}, sweep_rad(from, segment));
            } else {
                list.add_line(turned(from), turned(segment.end));
            }
            from = segment.end;
        }
    }
    return list;
}

// Rows whose y is in [low, high): low is not above such a row, high is.
struct RowRange {
    std::int64_t first, last;
};

RowRange rows_between(double low, double high, double pitch_mm) {
    return {static_cast<std::int64_t>(std::ceil(low / pitch_mm - 0.5)),
            static_cast<std::int64_t>(std::ceil(high / pitch_mm - 0.5))};
}

double row_y(std::int64_t row, double pitch_mm) {
    return (static_cast<double>(row) + 0.5) * pitch_mm;
}

void append_spans(std::span<const Crossing> row, std::vector<HatchSpan>& spans) {
    int winding = 0;
    double start = 0;
    for (const Crossing& crossing : row) {
        const int before = winding;
        winding += crossing.winding;
        if (before <= 0 && winding > 0) start = crossing.x_mm;
        if (before > 0 && winding <= 0 && crossing.x_mm > start) {
            spans.push_back({start, crossing.x_mm});
        }
    }
}

}  // namespace

Hatch hatch(std::span<const Contour> contours, double angle_rad, double pitch_mm) {
    Hatch result;
    result.direction = {std::cos(angle_rad), std::sin(angle_rad)};
    result.pitch_mm = pitch_mm;
    const PieceList list = pieces_of(contours, result.direction);
    if (list.pieces().empty()) return result;

    double low = list.pieces().front().low.y(), high = low;
    for (const Piece& piece : list.pieces()) {
        low = std::min(low, piece.low.y());
        high = std::max(high, piece.high.y());
    }
    const RowRange all = rows_between(low, high, pitch_mm);
    result.first_offset_mm = row_y(all.first, pitch_mm);

    std::vector<Crossing> crossings;
    for (const Piece& piece : list.pieces()) {
        const RowRange met = rows_between(piece.low.y(), piece.high.y(), pitch_mm);
        for (std::int64_t row = met.first; row < met.last; ++row) {
            crossings.push_back({static_cast<std::uint32_t>(row - all.first),
                                 crossing_x(piece, row_y(row, pitch_mm)), piece.winding});
        }
    }
    // At one x, what opens comes before what closes: touching regions are one.
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
        return std::tie(a.row, a.x_mm, b.winding) < std::tie(b.row, b.x_mm, a.winding);
    });
    auto at = crossings.begin();
    for (std::int64_t row = all.first; row < all.last; ++row) {
        const auto index = static_cast<std::uint32_t>(row - all.first);
        auto last = at;
        while (last != crossings.end() && last->row == index) ++last;
        result.row_start.push_back(static_cast<std::uint32_t>(result.spans.size()));
        append_spans({at, last}, result.spans);
        at = last;
    }
    result.row_start.push_back(static_cast<std::uint32_t>(result.spans.size()));
    return result;
}

}  // namespace lyr
