// Every contour becomes curves that are monotone across the rows; each row takes its crossings from the curves that
// straddle it, sorted along x, and keeps the stretches with positive winding.

#include "kernel/toolpath/rows.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

using std::numbers::pi;

struct Circle {
    Point2 centre;
    double radius_mm;
    double sweep_rad;
};

// None for a line, and for an arc that the model's resolution cannot tell from one: far centres cost digits.
std::optional<Circle> circle_of(const BoundaryPiece& piece) {
    const double k = piece.curvature_per_mm;
    if (std::abs(k) * piece.length_mm * piece.length_mm / 8 <= resolution_mm) return std::nullopt;
    const Vector2 left(-piece.start_tangent.y(), piece.start_tangent.x());
    return Circle{piece.start + left / k, 1 / std::abs(k), k * piece.length_mm};
}

class CurveList {
public:
    explicit CurveList(const Vector2& direction) : direction_(direction) {}

    void add(const BoundaryPiece& piece, std::uint32_t index) {
        const auto circle = circle_of(piece);
        if (circle) {
            add_arc(turned(piece.start), turned(piece.end),
                    {turned(circle->centre), circle->radius_mm, circle->sweep_rad}, index);
        } else {
            append(turned(piece.start), turned(piece.end), index);
        }
    }

    // Everything since the last call is a contour.
    void close() {
        const auto first = static_cast<std::uint32_t>(closed_);
        const auto last = static_cast<std::uint32_t>(curves_.size() - 1);
        for (std::uint32_t i = first; i <= last; ++i) {
            curves_[i].next = i == last ? first : i + 1;
            curves_[i].previous = i == first ? last : i - 1;
        }
        closed_ = curves_.size();
    }

    std::vector<RowCurve> take() { return std::move(curves_); }

private:
    Point2 turned(const Point2& p) const { return {direction_.dot(p), cross(direction_, p)}; }

    // Cuts the arc at the lowest and highest points of its circle.
    void add_arc(const Point2& from, const Point2& to, const Circle& circle, std::uint32_t piece) {
        const Vector2 radial = from - circle.centre;
        double angle = std::atan2(radial.y(), radial.x());
        const double last = angle + circle.sweep_rad, turn = circle.sweep_rad > 0 ? 1 : -1;
        Point2 at = from;
        // Extremes lie at odd multiples of a quarter turn.
        double extreme = pi * (turn > 0 ? std::floor(angle / pi + 0.5) + 0.5
                                        : std::ceil(angle / pi - 0.5) - 0.5);
        for (; turn * extreme < turn * last; extreme += turn * pi) {
            const double side = std::sin(extreme) > 0 ? 1 : -1;
            const Point2 top(circle.centre.x(), circle.centre.y() + side * circle.radius_mm);
            append_arc(at, top, circle, (angle + extreme) / 2, piece);
            at = top;
            angle = extreme;
        }
        append_arc(at, to, circle, (angle + last) / 2, piece);
    }

    RowCurve& append(const Point2& from, const Point2& to, std::uint32_t piece) {
        const bool falls = to.y() < from.y();
        curves_.push_back({.low = falls ? to : from,
                           .high = falls ? from : to,
                           .falls = falls,
                           .is_arc = false,
                           .right_half = false,
                           .centre = Point2::Zero(),
                           .radius_mm = 0,
                           .piece = piece,
                           .next = 0,
                           .previous = 0});
        return curves_.back();
    }

    void append_arc(const Point2& from, const Point2& to, const Circle& circle, double middle_rad,
                    std::uint32_t piece) {
        RowCurve& curve = append(from, to, piece);
        curve.is_arc = true;
        curve.right_half = std::cos(middle_rad) > 0;
        curve.centre = circle.centre;
        curve.radius_mm = circle.radius_mm;
    }

    Vector2 direction_;
    std::vector<RowCurve> curves_;
    std::size_t closed_ = 0;
};

std::vector<RowCurve> curves_of(std::span<const BoundaryPiece> boundary, const Vector2& direction) {
    CurveList list(direction);
    for (std::uint32_t i = 0; i < boundary.size(); ++i) {
        list.add(boundary[i], i);
        if (i + 1 == boundary.size() || boundary[i + 1].contour != boundary[i].contour)
            list.close();
    }
    return list.take();
}

// The first row that is not below y.
std::int64_t row_above(double y_mm, const RowGrid& grid) {
    return static_cast<std::int64_t>(std::ceil(y_mm / grid.pitch_mm - grid.shift - 0.5));
}

struct Crossing {
    double x_mm;
    std::uint32_t curve;
    int winding;
};

// At one x, what opens comes before what closes: touching regions are one.
bool is_before(const Crossing& a, const Crossing& b) {
    return a.x_mm != b.x_mm ? a.x_mm < b.x_mm : a.winding > b.winding;
}

// Rows have few crossings: each is put where it belongs.
void sort(std::span<Crossing> row) {
    for (std::size_t i = 1; i < row.size(); ++i) {
        const Crossing moving = row[i];
        std::size_t to = i;
        for (; to > 0 && is_before(moving, row[to - 1]); --to) row[to] = row[to - 1];
        row[to] = moving;
    }
}

void append_spans(std::span<const Crossing> row, std::vector<RowSpan>& spans) {
    int winding = 0;
    RowEnd start{};
    for (const Crossing& crossing : row) {
        const int before = winding;
        winding += crossing.winding;
        if (before <= 0 && winding > 0) start = {crossing.x_mm, crossing.curve};
        if (before > 0 && winding <= 0 && crossing.x_mm > start.x_mm) {
            spans.push_back({start, {crossing.x_mm, crossing.curve}});
        }
    }
}

// Sets the curves' rows, counted from the lowest of all, which is returned; `count` of them.
std::int64_t number_rows(std::vector<RowCurve>& curves, const RowGrid& grid, std::uint32_t& count) {
    double low = curves.front().low.y(), high = low;
    for (const RowCurve& curve : curves) {
        low = std::min(low, curve.low.y());
        high = std::max(high, curve.high.y());
    }
    const std::int64_t first = row_above(low, grid);
    count = static_cast<std::uint32_t>(row_above(high, grid) - first);
    for (RowCurve& curve : curves) {
        curve.first_row = static_cast<std::uint32_t>(row_above(curve.low.y(), grid) - first);
        curve.last_row = static_cast<std::uint32_t>(row_above(curve.high.y(), grid) - first);
    }
    return first;
}

}  // namespace

double crossing_x_mm(const RowCurve& curve, double y_mm) {
    // A row's height is rounded, a curve that is nearly level may be no higher than that: it must not be followed beyond
    // its ends.
    const double y = std::clamp(y_mm, curve.low.y(), curve.high.y());
    if (!curve.is_arc) {
        const double share = (y - curve.low.y()) / (curve.high.y() - curve.low.y());
        return curve.low.x() + share * (curve.high.x() - curve.low.x());
    }
    const double across = y - curve.centre.y(), r = curve.radius_mm;
    const double half = std::sqrt(std::max(0.0, (r - across) * (r + across)));
    return curve.centre.x() + (curve.right_half ? half : -half);
}

std::vector<RowSpan> spans_at(const Rows& rows, double y_mm) {
    std::vector<Crossing> crossings;
    for (std::uint32_t i = 0; i < rows.curves.size(); ++i) {
        const RowCurve& curve = rows.curves[i];
        if (curve.low.y() < y_mm && curve.high.y() >= y_mm)
            crossings.push_back({crossing_x_mm(curve, y_mm), i, curve.falls ? 1 : -1});
    }
    sort(crossings);
    std::vector<RowSpan> spans;
    append_spans(crossings, spans);
    return spans;
}

Rows rows_across(std::span<const BoundaryPiece> boundary, const RowGrid& grid) {
    Rows rows{.direction = {std::cos(grid.angle_rad), std::sin(grid.angle_rad)},
              .pitch_mm = grid.pitch_mm};
    rows.curves = curves_of(boundary, rows.direction);
    if (rows.curves.empty()) return rows;
    std::uint32_t count = 0;
    const std::int64_t first = number_rows(rows.curves, grid, count);
    rows.first_y_mm = (static_cast<double>(first) + grid.shift + 0.5) * grid.pitch_mm;

    std::vector<std::uint32_t> row_end(count + 1, 0);  // where the next crossing of row k - 1 goes
    for (const RowCurve& curve : rows.curves) {
        for (std::uint32_t row = curve.first_row; row < curve.last_row; ++row) ++row_end[row + 1];
    }
    for (std::size_t row = 1; row <= count; ++row) row_end[row] += row_end[row - 1];
    std::vector<Crossing> crossings(row_end.back());
    for (std::uint32_t i = 0; i < rows.curves.size(); ++i) {
        const RowCurve& curve = rows.curves[i];
        for (std::uint32_t row = curve.first_row; row < curve.last_row; ++row) {
            crossings[row_end[row]++] = {crossing_x_mm(curve, rows.y_mm(row)), i,
                                         curve.falls ? 1 : -1};
        }
    }
    rows.row_start.reserve(count + 1);
    rows.spans.reserve(crossings.size() / 2);
    std::uint32_t begin = 0;
    for (std::uint32_t row = 0; row < count; ++row) {
        const std::span<Crossing> of_row(crossings.data() + begin, row_end[row] - begin);
        begin = row_end[row];
        sort(of_row);
        rows.row_start.push_back(static_cast<std::uint32_t>(rows.spans.size()));
        append_spans(of_row, rows.spans);
    }
    rows.row_start.push_back(static_cast<std::uint32_t>(rows.spans.size()));
    return rows;
}

}  // namespace lyr
