#include "kernel/toolpath/infill_lines.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "kernel/toolpath/row_gaps.h"
#include "kernel/toolpath/strand_links.h"

namespace lyr {
namespace {

using std::numbers::pi;

// The lines of a cube pattern's faces move by this much of the height: faces of a cube on its corner have normals that
// lean by atan(1/sqrt 2) out of the plane.
constexpr double cubic_slope = std::numbers::sqrt2 / 2;

// What straight links of runs may cut off the boundary, of the width: less than walls vary by, and the more, the fewer
// travels.
constexpr double stray_share = 0.05;

// Links of runs, in spacings: along a boundary that leans by 2 degrees against the rows. Between two rows a link goes
// astray nowhere; a travel of that length would cost more.
constexpr double longest_straight_link = 25;

// Gaps beside the last row are filled if they are wider than this many spacings: then what is too much there is no more
// than what would be missing.
constexpr double widest_gap = 0.5;

}  // namespace

std::vector<RowGrid> row_grids(const InfillRequest& request) {
    const double spacing = line_spacing_mm(request.width_mm, request.height_mm) / request.density;
    const double angle = request.angle_rad;
    // Rows at multiples of the pitch.
    constexpr double on_origin = -0.5;
    switch (request.pattern) {
        case InfillPattern::rectilinear:
            return {{request.layer % 2 == 0 ? angle : angle + pi / 2, spacing}};
        case InfillPattern::aligned:
            return {{angle, spacing}};
        case InfillPattern::grid:
            return {{angle, 2 * spacing}, {angle + pi / 2, 2 * spacing}};
        case InfillPattern::triangles:
            return {{angle, 3 * spacing, on_origin},
                    {angle + pi / 3, 3 * spacing, on_origin},
                    {angle + 2 * pi / 3, 3 * spacing, on_origin}};
        case InfillPattern::cubic: {
            const double pitch = 3 * spacing, shift = -cubic_slope * request.z_mm / pitch;
            return {{angle, pitch, shift},
                    {angle + 2 * pi / 3, pitch, shift},
                    {angle + 4 * pi / 3, pitch, shift}};
        }
        default:
            return {};
    }
}

void fill_with_runs(std::span<const BoundaryPiece> boundary, const RowGrid& grid,
                    const InfillRequest& request, Fill& fill) {
    const Rows rows = rows_across(boundary, grid);
    auto runs = hatch_runs(rows, {.stray_mm = request.allowed_mm + stray_share * request.width_mm,
                                  .longest_link_mm = longest_straight_link * grid.pitch_mm,
                                  .shortest_mm = request.allowed_mm});
    fill.runs.insert(fill.runs.end(), std::make_move_iterator(runs.begin()),
                     std::make_move_iterator(runs.end()));
    GapLines gaps = gap_lines(
        boundary, rows, {.beyond_mm = widest_gap * grid.pitch_mm, .shortest_mm = request.width_mm});
    for (Path& path : gaps.paths) {
        fill.strands.push_back({.path = std::move(path), .width_mm = request.width_mm});
    }
    fill.left_out += gaps.islands_left_out;
}

void fill_with_strands(std::span<const BoundaryPiece> boundary, std::span<const RowGrid> grids,
                       const InfillRequest& request, Fill& fill) {
    std::vector<OpenStrand> strands;
    double spacing = 0;
    for (const RowGrid& grid : grids) {
        spacing = grid.pitch_mm;
        const Rows rows = rows_across(boundary, grid);
        const auto place = [&](const RowEnd& end, double y_mm) {
            return place_on(boundary, rows.curves[end.curve].piece, rows.in_plane(end.x_mm, y_mm));
        };
        for (std::uint32_t row = 0; row < rows.count(); ++row) {
            for (const RowSpan& span : rows.spans_of(row)) {
                if (span.end.x_mm - span.start.x_mm < request.allowed_mm) continue;
                const BoundaryPlace start = place(span.start, rows.y_mm(row));
                const BoundaryPlace end = place(span.end, rows.y_mm(row));
                strands.push_back({start, end, {{end.point}}});
            }
        }
    }
    for (Path& path : linked(boundary, strands, longest_link * spacing)) {
        fill.strands.push_back({.path = std::move(path), .width_mm = request.width_mm});
    }
}

}  // namespace lyr
