#include "kernel/toolpath/hatch.h"

#include <utility>

#include "kernel/toolpath/rows.h"

namespace lyr {

Hatch hatch(std::span<const Contour> contours, double angle_rad, double pitch_mm) {
    Rows rows =
        rows_across(boundary_pieces(contours), {.angle_rad = angle_rad, .pitch_mm = pitch_mm});
    Hatch result{.direction = rows.direction,
                 .first_offset_mm = rows.first_y_mm,
                 .pitch_mm = pitch_mm,
                 .row_start = std::move(rows.row_start),
                 .spans = {}};
    result.spans.reserve(rows.spans.size());
    for (const RowSpan& span : rows.spans) {
        result.spans.push_back({span.start.x_mm, span.end.x_mm});
    }
    return result;
}

}  // namespace lyr
