// Runs grow upwards from the lowest interval that is left, on whichever side gives more links.
//
// Why a link is safe: between its ends the boundary goes from one row to the next without meeting either in between, and
// is nowhere deeper in the region than the limit. Whatever else there is between the two rows lies wholly on one side of
// the link.

#include "kernel/toolpath/hatch_runs.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

namespace lyr {
namespace {

using Index = std::uint32_t;

// The curves that each strip between two rows holds; strip k is below row k.
struct Strips {
    std::vector<Index> start;
    std::vector<Index> curves;

    std::span<const Index> curves_of(Index strip) const {
        return {curves.data() + start[strip], curves.data() + start[strip + 1]};
    }
};

Strips strips_of(const Rows& rows) {
    Strips strips{std::vector<Index>(rows.count() + 2, 0), {}};
    const auto for_strips = [&](auto take) {
        for (Index i = 0; i < rows.curves.size(); ++i) {
            const RowCurve& curve = rows.curves[i];
            for (Index strip = curve.first_row; strip <= curve.last_row; ++strip) take(strip, i);
        }
    };
    for_strips([&](Index strip, Index) { ++strips.start[strip + 1]; });
    for (std::size_t i = 1; i < strips.start.size(); ++i) strips.start[i] += strips.start[i - 1];
    strips.curves.resize(strips.start.back());
    std::vector<Index> next = strips.start;
    for_strips([&](Index strip, Index i) { strips.curves[next[strip]++] = i; });
    return strips;
}

// Over the chord of two of its points; it is no more than a semicircle.
double bulge_mm(const RowCurve& curve, const Point2& a, const Point2& b) {
    if (!curve.is_arc) return 0;
    const double half2 = (b - a).squaredNorm() / 4, r = curve.radius_mm;
    return half2 / (r + std::sqrt(std::max(0.0, r * r - half2)));
}

// The part of a curve between two heights.
struct CurvePart {
    Point2 low, high;
    double left_mm, right_mm;  // as far as it reaches
    double bulge_mm;           // over its chord
};

CurvePart part_between(const RowCurve& curve, double low_y, double high_y) {
    const auto at = [&](const Point2& end, double y) {
        return end.y() == y ? end : Point2(crossing_x_mm(curve, y), y);
    };
    const Point2 low = at(curve.low, std::max(low_y, curve.low.y()));
    const Point2 high = at(curve.high, std::min(high_y, curve.high.y()));
    CurvePart part{low, high, std::min(low.x(), high.x()), std::max(low.x(), high.x()),
                   bulge_mm(curve, low, high)};
    if (!curve.is_arc) return part;
    if (low.y() < curve.centre.y() && curve.centre.y() < high.y()) {
        if (curve.right_half) part.right_mm = curve.centre.x() + curve.radius_mm;
        if (!curve.right_half) part.left_mm = curve.centre.x() - curve.radius_mm;
    }
    return part;
}

class RunBuilder {
public:
    RunBuilder(const Rows& rows, const LinkLimits& limits)
        : rows_(rows), limits_(limits), strips_(strips_of(rows)), used_(rows.spans.size(), false) {}

    std::vector<HatchRun> runs() {
        std::vector<HatchRun> runs;
        for (Index row = 0; row < rows_.count(); ++row) {
            for (Index i = rows_.row_start[row]; i < rows_.row_start[row + 1]; ++i) {
                if (used_[i]) continue;
                if (length_mm(i) < limits_.shortest_mm) {
                    used_[i] = true;
                } else {
                    runs.push_back(run_from(row, i));
                }
            }
        }
        return runs;
    }

private:
    struct Step {
        Index span;
        bool linked;
    };
    struct Way {
        std::vector<Step> steps{};
        std::size_t links = 0;
    };

    double length_mm(Index span) const {
        return rows_.spans[span].end.x_mm - rows_.spans[span].start.x_mm;
    }

    HatchRun run_from(Index row, Index span) {
        const Way right = way_from(row, span, true), left = way_from(row, span, false);
        const auto rank = [](const Way& way) { return std::pair(way.links, way.steps.size()); };
        const bool to_right = rank(right) >= rank(left);
        const Way& way = to_right ? right : left;
        // One whose first row runs to the left is seen from the other side of the plane: everything changes its sign.
        const double sign = to_right ? 1 : -1;
        HatchRun run{.direction = sign * rows_.direction,
                     .offset_mm = sign * rows_.y_mm(row),
                     .pitch_mm = sign * rows_.pitch_mm};
        run.rows.reserve(way.steps.size());
        for (const Step& step : way.steps) {
            used_[step.span] = true;
            const RowSpan& of = rows_.spans[step.span];
            if (to_right) {
                run.rows.push_back({of.start.x_mm, of.end.x_mm, step.linked});
            } else {
                run.rows.push_back({-of.end.x_mm, -of.start.x_mm, step.linked});
            }
        }
        return run;
    }

    // Upwards as far as it goes.
    Way way_from(Index row, Index span, bool to_right) const {
        Way way{.steps = {{span, false}}};
        for (; row + 1 < rows_.count(); ++row, to_right = !to_right) {
            const Index here = way.steps.back().span;
            auto next = linked_to(row, here, to_right);
            const bool linked = next.has_value();
            if (!next) next = only_neighbour(row, here);
            if (!next || used_[*next] || length_mm(*next) < limits_.shortest_mm) break;
            way.steps.push_back({*next, linked});
            way.links += linked;
        }
        return way;
    }

    // The interval of the next row to which a straight link leads from the right or left end of this one.
    std::optional<Index> linked_to(Index row, Index span, bool right) const {
        const RowSpan& here = rows_.spans[span];
        const RowEnd& end = right ? here.end : here.start;
        const Point2 from(end.x_mm, rows_.y_mm(row));
        const auto above = curve_above(row, end.curve, right);
        if (!above) return std::nullopt;
        const Point2 to(crossing_x_mm(rows_.curves[*above], rows_.y_mm(row + 1)),
                        rows_.y_mm(row + 1));
        const auto next = span_ending_at(row + 1, to.x(), *above, right);
        if (!next || !is_safe(row, {from, end.curve}, {to, *above}, right)) return std::nullopt;
        return next;
    }

    // The interval of a row that has its right or left end at a crossing.
    std::optional<Index> span_ending_at(Index row, double x_mm, Index curve, bool right) const {
        const auto end = [&](const RowSpan& span) -> const RowEnd& {
            return right ? span.end : span.start;
        };
        const auto spans = rows_.spans_of(row);
        auto span = std::lower_bound(spans.begin(), spans.end(), x_mm,
                                     [&](const RowSpan& of, double x) { return end(of).x_mm < x; });
        for (; span != spans.end() && end(*span).x_mm == x_mm; ++span) {
            if (end(*span).curve == curve)
                return rows_.row_start[row] + static_cast<Index>(span - spans.begin());
        }
        return std::nullopt;
    }

    // Material is to the left: the boundary rises at right ends, and falls at left ones.
    Index upwards(Index curve, bool right) const {
        return right ? rows_.curves[curve].next : rows_.curves[curve].previous;
    }

    // The curve on which the boundary, going up from where this one meets the row, comes to the next row; none if it
    // returns before.
    std::optional<Index> curve_above(Index row, Index curve, bool right) const {
        if (rows_.curves[curve].last_row > row + 1) return curve;
        for (Index i = upwards(curve, right); i != curve; i = upwards(i, right)) {
            const RowCurve& at = rows_.curves[i];
            if (at.first_row == at.last_row) continue;
            return at.first_row == row + 1 && at.falls != right ? std::optional(i) : std::nullopt;
        }
        return std::nullopt;
    }

    struct LinkEnd {
        Point2 point;
        Index curve;
    };

    bool is_safe(Index row, const LinkEnd& from, const LinkEnd& to, bool right) const {
        const Vector2 link = to.point - from.point;
        const double length = link.norm();
        if (length > limits_.longest_link_mm) return false;
        const double inwards = right ? 1 : -1;
        Point2 at = from.point;
        double at_off = 0;
        for (Index i = from.curve;; i = upwards(i, right)) {
            const RowCurve& curve = rows_.curves[i];
            // The end that the boundary comes to on its way up; a level curve's is that which is not here yet.
            const bool rises = curve.falls != right;
            const Point2 end = i == to.curve ? to.point : (rises ? curve.high : curve.low);
            const double end_off = inwards * cross(link, end - from.point) / length;
            // Material is to the left of right ends: there, left halves of circles bulge into it.
            const double bulge = curve.right_half != right ? bulge_mm(curve, at, end) : 0;
            if (std::max({0.0, at_off, end_off}) + bulge > limits_.stray_mm) return false;
            if (i == to.curve) break;
            at = end;
            at_off = end_off;
        }
        return !is_blocked(row, from, to, right);
    }

    // By anything but the boundary that it runs along: an opposite wall, a contour between the rows.
    bool is_blocked(Index row, const LinkEnd& from, const LinkEnd& to, bool right) const {
        const double left_mm = std::min(from.point.x(), to.point.x());
        const double right_mm = std::max(from.point.x(), to.point.x());
        const Vector2 link = to.point - from.point, along = link / link.norm();
        for (const Index i : strips_.curves_of(row + 1)) {
            if (i == from.curve || i == to.curve) continue;
            const CurvePart part = part_between(rows_.curves[i], from.point.y(), to.point.y());
            if (part.left_mm > right_mm || part.right_mm < left_mm) continue;
            const double low = cross(along, part.low - from.point);
            const double high = cross(along, part.high - from.point);
            const bool beside =
                (low > 0) == (high > 0) && std::min(std::abs(low), std::abs(high)) > part.bulge_mm;
            if (!beside && !is_between(i, from.curve, to.curve, right)) return true;
        }
        return false;
    }

    bool is_between(Index curve, Index from, Index to, bool right) const {
        for (Index i = from; i != to; i = upwards(i, right)) {
            if (i == curve) return true;
        }
        return false;
    }

    // The interval that is all there is above this one, if this one is all there is below it.
    std::optional<Index> only_neighbour(Index row, Index span) const {
        const auto above = only_overlap(row + 1, span);
        if (!above || only_overlap(row, *above) != span) return std::nullopt;
        return above;
    }

    std::optional<Index> only_overlap(Index row, Index span) const {
        const RowSpan& with = rows_.spans[span];
        const auto spans = rows_.spans_of(row);
        const auto first =
            std::lower_bound(spans.begin(), spans.end(), with.start.x_mm,
                             [](const RowSpan& of, double x) { return of.end.x_mm <= x; });
        const auto overlaps = [&](auto at) {
            return at != spans.end() && at->start.x_mm < with.end.x_mm;
        };
        if (!overlaps(first) || overlaps(first + 1)) return std::nullopt;
        return rows_.row_start[row] + static_cast<Index>(first - spans.begin());
    }

    const Rows& rows_;
    LinkLimits limits_;
    Strips strips_;
    std::vector<bool> used_;
};

Point2 on_row(const HatchRun& run, std::size_t row, double along_mm) {
    const Vector2 left(-run.direction.y(), run.direction.x());
    return along_mm * run.direction +
           (run.offset_mm + static_cast<double>(row) * run.pitch_mm) * left;
}

}  // namespace

Point2 start_of(const HatchRun& run) {
    return on_row(run, 0, run.rows.front().start_mm);
}

Point2 end_of(const HatchRun& run) {
    const HatchRow& row = run.rows.back();
    return on_row(run, run.rows.size() - 1, run.rows.size() % 2 == 1 ? row.end_mm : row.start_mm);
}

double length_mm(const HatchRun& run) {
    double length = 0;
    Point2 at = start_of(run);
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
        const HatchRow& row = run.rows[i];
        const bool along = i % 2 == 0;
        if (row.linked) length += (on_row(run, i, along ? row.start_mm : row.end_mm) - at).norm();
        length += row.end_mm - row.start_mm;
        at = on_row(run, i, along ? row.end_mm : row.start_mm);
    }
    return length;
}

HatchRun reversed(const HatchRun& run) {
    const std::size_t last = run.rows.size() - 1;
    // The last row was run along the direction, or against it; now it is the first, and along it.
    const double sign = last % 2 == 0 ? -1 : 1;
    HatchRun back{.direction = sign * run.direction,
                  .offset_mm = sign * (run.offset_mm + static_cast<double>(last) * run.pitch_mm),
                  .pitch_mm = -sign * run.pitch_mm};
    back.rows.reserve(run.rows.size());
    for (std::size_t i = 0; i <= last; ++i) {
        const HatchRow& row = run.rows[last - i];
        const bool linked = i > 0 && run.rows[last - i + 1].linked;
        if (sign > 0) {
            back.rows.push_back({row.start_mm, row.end_mm, linked});
        } else {
            back.rows.push_back({-row.end_mm, -row.start_mm, linked});
        }
    }
    return back;
}

std::vector<HatchRun> hatch_runs(const Rows& rows, const LinkLimits& limits) {
    return RunBuilder(rows, limits).runs();
}

}  // namespace lyr
