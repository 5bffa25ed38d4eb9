// Between two rows the boundary turns back at a cap, which the row faces from inside, or at a dent, which the row beyond
// faces. A cap is followed where it is far from its row, a dent as a whole.

#include "kernel/toolpath/row_gaps.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "kernel/geometry/tolerance.h"
#include "kernel/toolpath/boundary_ruler.h"

namespace lyr {
namespace {

using Index = std::uint32_t;

class GapFinder {
public:
    GapFinder(std::span<const BoundaryPiece> boundary, const Rows& rows, const GapLimits& limits)
        : boundary_(boundary), rows_(rows), limits_(limits), ruler_(boundary) {}

    GapLines lines() {
        for (Index first = 0; first < rows_.curves.size();
             first = rows_.curves[first].previous + 1) {
            add_contour(first);
        }
        return std::move(found_);
    }

private:
    bool is_met(Index curve) const {
        return rows_.curves[curve].first_row < rows_.curves[curve].last_row;
    }

    void add_contour(Index first) {
        Index start = first;
        while (!is_met(start)) {
            start = rows_.curves[start].next;
            if (start == first) return add_island(first);
        }
        Index from = start;
        do {
            Index to = rows_.curves[from].next;
            while (!is_met(to)) to = rows_.curves[to].next;
            if (rows_.curves[from].falls != rows_.curves[to].falls) add_turn(from, to);
            from = to;
        } while (from != start);
    }

    // The boundary leaves a row on one curve and comes back to it on another.
    void add_turn(Index from, Index to) {
        const RowCurve& curve = rows_.curves[from];
        const Index row = curve.falls ? curve.first_row : curve.last_row - 1;
        const double y = rows_.y_mm(row), away = curve.falls ? -1 : 1;
        const double from_x = crossing_x_mm(curve, y), to_x = crossing_x_mm(rows_.curves[to], y);
        // Material is to the left: a cap above a row is gone round from the right to the left.
        if (away * (from_x - to_x) > 0) {
            add_cap(from, to, y + away * limits_.beyond_mm, away);
        } else if (away * (y - extreme_y(from, to, away)) + rows_.pitch_mm > limits_.beyond_mm) {
            add_between(from, to, y);
        }
    }

    void add_cap(Index from, Index to, double level_mm, double away) {
        const auto reaches = [&](Index i) {
            const RowCurve& curve = rows_.curves[i];
            return curve.low.y() < level_mm && curve.high.y() >= level_mm;
        };
        Index first = from, last = to;
        while (!reaches(first)) {
            if (first == to) return;
            first = rows_.curves[first].next;
        }
        while (!reaches(last)) last = rows_.curves[last].previous;
        const bool both_sides =
            rows_.curves[first].falls == (away < 0) && rows_.curves[last].falls == (away > 0);
        if (both_sides) add_between(first, last, level_mm);
    }

    // Along the boundary between two points at one height.
    void add_between(Index from, Index to, double y_mm) {
        const double from_x = crossing_x_mm(rows_.curves[from], y_mm);
        const double to_x = crossing_x_mm(rows_.curves[to], y_mm);
        if (std::abs(from_x - to_x) < limits_.shortest_mm) return;
        const BoundaryPlace start = place(from, from_x, y_mm), end = place(to, to_x, y_mm);
        Path path{start.point, {}};
        ruler_.append_forward(start, end, path.segments);
        found_.paths.push_back(std::move(path));
    }

    BoundaryPlace place(Index curve, double x_mm, double y_mm) const {
        return place_on(boundary_, rows_.curves[curve].piece, rows_.in_plane(x_mm, y_mm));
    }

    // The farthest that the boundary gets from the row between two curves.
    double extreme_y(Index from, Index to, double away) const {
        const auto far = [&](Index i) {
            const RowCurve& curve = rows_.curves[i];
            return away > 0 ? curve.high.y() : curve.low.y();
        };
        double extreme = far(from);
        for (Index i = from; i != to;) {
            i = rows_.curves[i].next;
            extreme = away > 0 ? std::max(extreme, far(i)) : std::min(extreme, far(i));
        }
        return extreme;
    }

    void add_island(Index first) {
        double low = rows_.curves[first].low.y(), high = low;
        Index i = first;
        do {
            low = std::min(low, rows_.curves[i].low.y());
            high = std::max(high, rows_.curves[i].high.y());
            i = rows_.curves[i].next;
        } while (i != first);
        const double middle = (low + high) / 2;
        const auto is_own = [&](const RowEnd& end) {
            return contour_of(end.curve) == contour_of(first);
        };
        const std::size_t before = found_.paths.size();
        std::optional<bool> is_hole;
        for (const RowSpan& span : spans_at(rows_, middle)) {
            const bool starts = is_own(span.start), ends = is_own(span.end);
            if (!starts && !ends) continue;
            // The first thing to be met from the left of a hole is where the material around it ends.
            if (!is_hole) is_hole = !starts;
            if (*is_hole) return;
            if (span.end.x_mm - span.start.x_mm <= resolution_mm) continue;
            found_.paths.push_back({rows_.in_plane(span.start.x_mm, middle),
                                    {{rows_.in_plane(span.end.x_mm, middle)}}});
        }
        if (found_.paths.size() == before) ++found_.islands_left_out;
    }

    std::uint32_t contour_of(Index curve) const {
        return boundary_[rows_.curves[curve].piece].contour;
    }

    std::span<const BoundaryPiece> boundary_;
    const Rows& rows_;
    GapLimits limits_;
    BoundaryRuler ruler_;
    GapLines found_;
};

}  // namespace

GapLines gap_lines(std::span<const BoundaryPiece> boundary, const Rows& rows,
                   const GapLimits& limits) {
    return GapFinder(boundary, rows, limits).lines();
}

}  // namespace lyr
