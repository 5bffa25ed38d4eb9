#include "kernel/toolpath/fitted_walls.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kernel/geometry/tolerance.h"
#include "kernel/toolpath/boundary.h"
#include "kernel/toolpath/centre_lines.h"

namespace lyr {
namespace {

// Walls that run opposite ways within half a radian are side by side.
const double opposite_cosine = -std::cos(0.5);

// Of a wall's width.
constexpr double look_share = 0.5;

// Where walls turn by less, they do not meet in a corner of their own.
constexpr double corner_sine = 0.1;
// How far a corner moves at most, in shifts of the walls that meet there.
constexpr double most_corner_shifts = 4;
// Shifts that differ by less are one: a step in the wall would be smaller than what is printed.
constexpr double least_step_mm = 0.002;
// Steps go slanting, along so much of the runs beside them, of the width: sideways, each would make the wall longer by itself.
constexpr double slant_share = 0.0625, most_slant_of_run = 0.25;

Vector2 tangent_at(const BoundaryPiece& piece, const Point2& point) {
    if (piece.curvature_per_mm == 0) return piece.start_tangent;
    const Point2 centre = piece.start + left_of(piece.start_tangent) / piece.curvature_per_mm;
    const Vector2 along = left_of(point - centre).normalized();
    return piece.curvature_per_mm > 0 ? along : -along;
}

// A stretch of a piece that is as much farther from the wall beside it than the spacing.
struct Run {
    const BoundaryPiece* piece;
    double from, to;  // in [0, 1]
    double slack_mm;

    double shift_mm() const { return slack_mm / 4; }
    double slant(double width_mm) const {
        return std::min(slant_share * width_mm / piece->length_mm, most_slant_of_run * (to - from));
    }
    double sweep_rad() const { return sweep_rad(to - from); }
    double sweep_rad(double share) const {
        return piece->curvature_per_mm * piece->length_mm * share;
    }
    BoundaryPoint start() const {
        return from == 0 ? BoundaryPoint{piece->start, piece->start_tangent} : piece->at(from);
    }
    BoundaryPoint end() const {
        return to == 1 ? BoundaryPoint{piece->end, piece->end_tangent} : piece->at(to);
    }
};

// Where a run ends and the next one starts.
struct Meeting {
    Point2 end, start;
};

Meeting meeting_of(const Run& before, const Run& after) {
    const BoundaryPoint a = before.end(), b = after.start();
    const double shift_a = before.shift_mm(), shift_b = after.shift_mm();
    const Vector2 left_a = left_of(a.tangent), left_b = left_of(b.tangent);
    const double sine = cross(left_a, left_b);
    if (std::abs(sine) > corner_sine) {
        const Vector2 move = (shift_a * b.tangent - shift_b * a.tangent) / sine;
        if (move.norm() <= most_corner_shifts * std::max(std::abs(shift_a), std::abs(shift_b)))
            return {a.point + move, a.point + move};
    } else if (std::abs(shift_a - shift_b) <= least_step_mm) {
        const Point2 both = a.point + (shift_a + shift_b) / 2 * left_a;
        return {both, both};
    }
    return {a.point + shift_a * left_a, b.point + shift_b * left_b};
}

bool is_step(const Run& before, const Run& after) {
    const double sine = cross(before.end().tangent, after.start().tangent);
    return std::abs(sine) <= corner_sine &&
           std::abs(before.shift_mm() - after.shift_mm()) > least_step_mm;
}

// From the end of one run to the start of the next.
double sweep_between_rad(const Run& before, const Run& after) {
    if (before.piece == after.piece && before.to <= after.from)
        return before.sweep_rad(after.from - before.to);
    return before.sweep_rad(1 - before.to) + after.sweep_rad(after.from);
}

class Fitter {
public:
    Fitter(Region walls, double width_mm, const FitRequest& request)
        : boundary_(walls), width_mm_(width_mm), request_(request) {}

    // The runs of each wall; none where it stays as it is.
    std::vector<std::vector<Run>> runs(std::size_t walls) const {
        std::vector<std::vector<Run>> result(walls);
        for (const BoundaryPiece& piece : boundary_.pieces())
            add_runs(piece, result[piece.contour]);
        for (std::vector<Run>& wall : result)
            if (std::all_of(wall.begin(), wall.end(), [](const Run& r) { return r.slack_mm == 0; }))
                wall.clear();
        return result;
    }

private:
    void add_runs(const BoundaryPiece& piece, std::vector<Run>& runs) const {
        if (is_alone(piece)) {
            runs.push_back({&piece, 0, 1, 0});
            return;
        }
        const double steps = std::ceil(piece.length_mm / (look_share * width_mm_));
        const std::size_t first = runs.size();
        for (double k = 0; k < steps; ++k) {
            const double slack = slack_mm(piece.at((k + 0.5) / steps));
            if (runs.size() > first && is_one(runs.back().slack_mm, slack)) {
                runs.back().to = (k + 1) / steps;
            } else {
                runs.push_back({&piece, k / steps, (k + 1) / steps, slack});
            }
        }
    }

    // Whether surely nothing that runs the opposite way is near.
    bool is_alone(const BoundaryPiece& piece) const {
        if (turns_far(piece)) return false;
        const Vector2 margin(request_.greatest_mm, request_.greatest_mm);
        const region::Box2 box = piece.box();
        return !boundary_.any({box.min() - margin, box.max() + margin}, [&](std::uint32_t i) {
            const BoundaryPiece& other = boundary_.pieces()[i];
            return turns_far(other) || other.middle_tangent.dot(piece.middle_tangent) < 0;
        });
    }

    // By so much that its middle says little of its ends.
    static bool turns_far(const BoundaryPiece& piece) {
        return std::abs(piece.curvature_per_mm) * piece.length_mm > 1;
    }

    static bool is_one(double a_mm, double b_mm) {
        return std::abs(a_mm - b_mm) <= 2 * width_step_mm && (a_mm == 0) == (b_mm == 0);
    }

    double slack_mm(const BoundaryPoint& at) const {
        std::vector<BoundaryCrossing> crossings;
        boundary_.crossings(at.point, at.point + request_.greatest_mm * left_of(at.tangent),
                            crossings);
        for (const BoundaryCrossing& crossing : crossings) {
            if (crossing.along_mm <= resolution_mm) continue;
            const Point2 place = at.point + crossing.along_mm * left_of(at.tangent);
            const Vector2 other = tangent_at(boundary_.pieces()[crossing.piece], place);
            const bool is_beside = other.dot(at.tangent) <= opposite_cosine;
            return is_beside && crossing.along_mm >= request_.least_mm
                       ? crossing.along_mm - request_.spacing_mm
                       : 0;
        }
        return 0;
    }

    Boundary boundary_;
    double width_mm_;
    FitRequest request_;
};

Strand strand_of(std::vector<Run> runs, double width_mm) {
    const Run& first = runs.front();
    if (runs.size() == 1 && first.piece->is_circle) {
        const double curvature = first.piece->curvature_per_mm;
        const Point2 centre = first.piece->start + left_of(first.piece->start_tangent) / curvature;
        const double radius_mm = std::abs(1 / curvature - first.shift_mm());
        return {FullCircle{centre, radius_mm, curvature > 0}, width_mm + first.slack_mm / 2};
    }
    for (std::size_t i = 0; i < runs.size(); ++i) {
        Run &before = runs[i], &after = runs[(i + 1) % runs.size()];
        if (!is_step(before, after)) continue;
        before.to -= before.slant(width_mm);
        after.from += after.slant(width_mm);
    }
    std::vector<Meeting> meetings;
    for (std::size_t i = 0; i < runs.size(); ++i)
        meetings.push_back(meeting_of(runs[i], runs[(i + 1) % runs.size()]));
    Path path{meetings.back().start, {}};
    Strand strand{.path = {}, .width_mm = width_mm + first.slack_mm / 2};
    Point2 at = path.start;
    const auto add = [&](const Segment& segment, double slack_mm) {
        if (segment.end == at) return;
        path.segments.push_back(segment);
        strand.widths_mm.push_back(width_mm + slack_mm / 2);
        at = segment.end;
    };
    const auto go = [&](const Point2& end, double sweep, double slack_mm) {
        add(sweep == 0 || end == at ? Segment{end} : arc_with_sweep(at, end, sweep), slack_mm);
    };
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const Run &run = runs[i], &next = runs[(i + 1) % runs.size()];
        go(meetings[i].end, run.sweep_rad(), run.slack_mm);
        // A step is as narrow as what is narrower: there the outer flank is nearer.
        go(meetings[i].start, sweep_between_rad(run, next), std::min(run.slack_mm, next.slack_mm));
    }
    strand.path = std::move(path);
    return strand;
}

}  // namespace

void fit_side_by_side(std::span<Strand> walls, const FitRequest& request) {
    if (walls.empty()) return;
    std::vector<Contour> contours;
    for (const Strand& wall : walls) contours.push_back(wall.path);
    const double width_mm = walls.front().width_mm;
    const Fitter fitter(contours, width_mm, request);
    const std::vector<std::vector<Run>> runs = fitter.runs(walls.size());
    for (std::size_t i = 0; i < walls.size(); ++i)
        if (!runs[i].empty()) walls[i] = strand_of(runs[i], width_mm);
}

}  // namespace lyr
