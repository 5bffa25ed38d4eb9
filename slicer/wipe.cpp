#include "slicer/wipe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/contour/turned_round.h"

namespace lyr::slicer {
namespace {

constexpr double half_turn_rad = std::numbers::pi;

Segment first_part(const Point2& from, const Segment& segment, double share) {
    const Point2 end = point_at(from, segment, share);
    if (segment.sagitta_mm == 0) return {end};
    return arc_with_sweep(from, end, share * sweep_rad(from, segment));
}

// The first `length_mm` of an open path.
Path beginning(const Path& path, double most_mm) {
    Path part{path.start, {}};
    Point2 from = path.start;
    for (const Segment& segment : path.segments) {
        const double own_mm = length_mm(from, segment);
        if (own_mm > most_mm) {
            if (most_mm > 0) part.segments.push_back(first_part(from, segment, most_mm / own_mm));
            return part;
        }
        part.segments.push_back(segment);
        most_mm -= own_mm;
        from = segment.end;
    }
    return part;
}

Path turn_around(const FullCircle& circle, const Point2& start, double most_mm) {
    const double turn_rad = std::min(most_mm / circle.radius_mm, 2 * half_turn_rad);
    const double sign = circle.counter_clockwise ? 1 : -1;
    Path part{start, {}};
    for (double done_rad = 0; done_rad < turn_rad;) {
        const double sweep_rad = std::min(turn_rad - done_rad, half_turn_rad);
        done_rad += sweep_rad;
        const Point2 end =
            circle.centre + Eigen::Rotation2Dd(sign * done_rad) * (start - circle.centre);
        const Point2& from = part.segments.empty() ? start : part.segments.back().end;
        part.segments.push_back(arc_with_sweep(from, end, sign * sweep_rad));
    }
    return part;
}

}  // namespace

Path wipe_along(const Strand& printed, const Point2& start, double most_mm) {
    if (const auto* circle = std::get_if<FullCircle>(&printed.path))
        return turn_around(*circle, start, most_mm);
    const Path& path = std::get<Path>(printed.path);
    return beginning(is_closed(printed) ? path : turned_round(path), most_mm);
}

Path wipe_along(const HatchRun& printed, double most_mm) {
    const Vector2 left(-printed.direction.y(), printed.direction.x());
    const auto point = [&](std::size_t row, bool at_end) {
        const double off_mm = printed.offset_mm + static_cast<double>(row) * printed.pitch_mm;
        const HatchRow& ends = printed.rows[row];
        return Point2((at_end ? ends.end_mm : ends.start_mm) * printed.direction + off_mm * left);
    };
    Path back{end_of(printed), {}};
    for (std::size_t row = printed.rows.size(); row-- > 0;) {
        const bool forward = row % 2 == 0;
        back.segments.push_back({point(row, !forward)});
        if (!printed.rows[row].linked || row == 0) break;
        back.segments.push_back({point(row - 1, !forward)});
    }
    return beginning(back, most_mm);
}

double depth_before_wipe_mm(const Path& wipe, const profile::Profile& profile) {
    const profile::Travel& travel = profile.travel;
    const double wiping_s = length_mm(Contour(wipe)) / profile.speed.travel_mm_s;
    const double left_mm = travel.retract_length_mm - wiping_s * travel.retract_speed_mm_s;
    return std::max(left_mm, travel.retract_before_wipe * travel.retract_length_mm);
}

std::vector<format::WipePiece> wipe_pieces(const Path& wipe, const Vector2& shift) {
    std::vector<format::WipePiece> pieces;
    const auto append = [&](const Segment& segment) {
        const Point2 to = segment.end + shift;
        pieces.push_back({to.x(), to.y(), segment.sagitta_mm});
    };
    Point2 from = wipe.start;
    for (const Segment& segment : wipe.segments) {
        if (std::abs(sweep_rad(from, segment)) > half_turn_rad) {
            const Segment half = first_part(from, segment, 0.5);
            append(half);
            append(arc_with_sweep(half.end, segment.end, sweep_rad(from, segment) / 2));
        } else {
            append(segment);
        }
        from = segment.end;
    }
    return pieces;
}

}  // namespace lyr::slicer
