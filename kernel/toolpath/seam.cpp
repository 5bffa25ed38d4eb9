// Candidates are the segments' ends, the middles of arcs that turn far enough to be a rounded corner, and one place that
// the choice itself asks for: the foot of a point, or the rearmost point. Filters keep the best by one property after
// the other, each with some slack, so that what is equal but for round-off is decided by the next one.

#include "kernel/toolpath/seam.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "base/constants.h"
#include "kernel/region/curve.h"

namespace lyr {
namespace {

// In widths of the line. A corner with the rounding that an offset by half the width made of it is no longer than this
// up to a turn of 140 degrees.
constexpr double corner_widths = 1.25;
// A corner is preferred to a smooth place that is by less than this nearer, or farther to the rear.
constexpr double pull_widths = 2;
// A seam below belongs to a contour that is not farther from it: about what a wall at 80 degrees recedes by in a layer
// of half the width.
constexpr double reach_widths = 3;
// Two places are as far to the rear if they differ by less.
constexpr double rear_tie_widths = 0.1;
// A segment is not split so near to its end: the short piece would only slow the nozzle down.
constexpr double shortest_piece_widths = 0.1;
// Corners are as sharp as each other if their turns differ by less: far more than the error of fitted arcs.
constexpr double sharpness_tie_rad = 0.1;

struct Candidate {
    Seam seam;
    double at_mm;         // along the contour
    double turn_rad = 0;  // within the width of a corner
};

// A segment of the contour where it lies.
struct Piece {
    Point2 start;
    Segment segment;
    double at_mm, length_mm, sweep_rad;
    double before_rad = 0;  // turned from the contour's start to this piece's, its corner included
};

double length_of(const Point2& start, const Segment& segment, double sweep) {
    const double chord = (segment.end - start).norm(), s = segment.sagitta_mm;
    return sweep == 0 ? chord : std::abs(sweep * (chord * chord / 4 + s * s) / (2 * s));
}

std::vector<Piece> pieces_of(const Path& path) {
    std::vector<Piece> pieces;
    pieces.reserve(path.segments.size());
    Point2 from = path.start;
    double at = 0;
    for (const Segment& segment : path.segments) {
        const double sweep = sweep_rad(from, segment), length = length_of(from, segment, sweep);
        pieces.push_back({from, segment, at, length, sweep});
        at += length;
        from = segment.end;
    }
    return pieces;
}

double corner_between(const Piece& before, const Piece& after) {
    const Vector2 in = end_tangent(before.start, before.segment);
    const Vector2 out = start_tangent(after.start, after.segment);
    return std::atan2(cross(in, out), in.dot(out));
}

// How much a closed path turns within a window of its length.
class Turning {
public:
    Turning(std::vector<Piece>& pieces, double window_mm) : pieces_(pieces) {
        length_mm_ = pieces.back().at_mm + pieces.back().length_mm;
        half_mm_ = std::min(window_mm, length_mm_ / 4) / 2;
        double turned = 0;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            turned += corner_between(pieces[i == 0 ? pieces.size() - 1 : i - 1], pieces[i]);
            pieces[i].before_rad = turned;
            turned += pieces[i].sweep_rad;
        }
        total_rad_ = turned;
    }

    // `piece` is where `at_mm` is.
    double around(double at_mm, std::size_t piece) const {
        return until(at_mm + half_mm_, piece) - until(at_mm - half_mm_, piece);
    }

private:
    // A window is short: few steps lead from a piece near by.
    double until(double at_mm, std::size_t i) const {
        double rounds = 0;
        while (at_mm < pieces_[i].at_mm) {
            if (i-- > 0) continue;
            i = pieces_.size() - 1;
            at_mm += length_mm_;
            --rounds;
        }
        while (at_mm > pieces_[i].at_mm + pieces_[i].length_mm) {
            if (++i < pieces_.size()) continue;
            i = 0;
            at_mm -= length_mm_;
            ++rounds;
        }
        const Piece& piece = pieces_[i];
        const double share = piece.length_mm > 0 ? (at_mm - piece.at_mm) / piece.length_mm : 0;
        return rounds * total_rad_ + piece.before_rad +
               std::clamp(share, 0.0, 1.0) * piece.sweep_rad;
    }

    std::span<const Piece> pieces_;
    double length_mm_, half_mm_, total_rad_;
};

// The fraction of a segment at which it is nearest to a point.
double foot_of(const Piece& piece, const Point2& point) {
    const Vector2 chord = piece.segment.end - piece.start, offset = point - piece.start;
    const auto circle = circle_of(piece.start, piece.segment);
    if (!circle) {
        const double square = chord.squaredNorm();
        return square > 0 ? std::clamp(offset.dot(chord) / square, 0.0, 1.0) : 0;
    }
    const Vector2 from = piece.start - circle->centre, to = point - circle->centre;
    const double turn = piece.sweep_rad > 0 ? 1 : -1;
    double angle = std::atan2(turn * cross(from, to), from.dot(to));
    if (angle < 0) angle += full_turn_rad;
    const double fraction = angle / std::abs(piece.sweep_rad);
    if (fraction <= 1) return fraction;
    return offset.squaredNorm() <= (point - piece.segment.end).squaredNorm() ? 0 : 1;
}

// Of a full circle the point in this direction.
Seam on_circle(const FullCircle& circle, const Vector2& direction) {
    const double length = direction.norm();
    const Vector2 unit = length > 0 ? Vector2(direction / length) : Vector2(0, 1);
    return {circle.centre + circle.radius_mm * unit};
}

double distance_to(std::span<const Piece> pieces, const Point2& point, std::size_t* nearest) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if ((point - pieces[i].start).norm() - pieces[i].length_mm >= least) continue;
        const double distance = distance_mm(pieces[i].start, pieces[i].segment, point);
        if (distance >= least) continue;
        least = distance;
        if (nearest) *nearest = i;
    }
    return least;
}

// The seam below that is nearest to the contour, if one is beside it.
template <class Distance>
std::optional<Point2> seam_below(const Contour& contour, const SeamRequest& request,
                                 Distance distance) {
    if (request.below.empty()) return std::nullopt;
    double least = reach_widths * request.width_mm;
    region::Box2 box = region::box_of(contour);
    box = {box.min() - Vector2(least, least), box.max() + Vector2(least, least)};
    std::optional<Point2> found;
    for (const Point2& point : request.below) {
        if (!box.contains(point)) continue;
        const double away = distance(point);
        if (away > least || (away == least && found)) continue;
        least = away;
        found = point;
    }
    return found;
}

// Keeps those whose score is no more than `slack` above the least.
template <class Score>
void keep_least(std::vector<Candidate>& candidates, double slack, Score score) {
    const auto value = [&](const Candidate& c) { return static_cast<double>(score(c)); };
    double least = std::numeric_limits<double>::infinity();
    for (const Candidate& candidate : candidates) least = std::min(least, value(candidate));
    std::erase_if(candidates, [&](const Candidate& c) { return value(c) > least + slack; });
}

// Concave corners hide a seam best.
enum Visibility { hidden, at_corner, on_wall };

Visibility visibility(const Candidate& candidate) {
    if (candidate.turn_rad <= -corner_rad) return hidden;
    return candidate.turn_rad >= corner_rad ? at_corner : on_wall;
}

auto distance_from(const Point2& point) {
    return [point](const Candidate& c) { return (c.seam.point - point).norm(); };
}

class SeamSearch {
public:
    SeamSearch(const Path& path, const SeamRequest& request)
        : pieces_(pieces_of(path)),
          turning_(pieces_, corner_widths * request.width_mm),
          width_mm_(request.width_mm) {
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            if (pieces_[i].length_mm == 0) continue;
            add(i, 0);
            if (std::abs(pieces_[i].sweep_rad) >= corner_rad) add(i, 0.5);
        }
    }

    double distance(const Point2& point) const { return distance_to(pieces_, point, nullptr); }

    Seam nearest(const Point2& point) {
        std::size_t piece = 0;
        distance_to(pieces_, point, &piece);
        add(piece, foot_of(pieces_[piece], point));
        keep_least(candidates_, pull_widths * width_mm_, distance_from(point));
        keep_best_hidden();
        keep_least(candidates_, 0, distance_from(point));
        return seam();
    }

    Seam rear() {
        for (std::size_t i = 0; i < pieces_.size(); ++i) add_top(i);
        keep_least(candidates_, pull_widths * width_mm_, backwards);
        keep_best_hidden();
        keep_rearmost();
        return seam();
    }

    Seam sharp(const std::optional<Point2>& below) {
        keep_best_hidden();
        if (visibility(candidates_.front()) == on_wall) return below ? nearest(*below) : rear();
        keep_least(candidates_, sharpness_tie_rad,
                   [](const Candidate& c) { return -std::abs(c.turn_rad); });
        if (below) keep_least(candidates_, 0, distance_from(*below));
        keep_rearmost();
        return seam();
    }

private:
    static double backwards(const Candidate& candidate) { return -candidate.seam.point.y(); }

    void keep_rearmost() {
        keep_least(candidates_, rear_tie_widths * width_mm_, backwards);
        keep_least(candidates_, 0, [](const Candidate& c) { return c.seam.point.x(); });
    }

    void keep_best_hidden() {
        for (Candidate& candidate : candidates_)
            candidate.turn_rad = turning_.around(candidate.at_mm, candidate.seam.segment);
        keep_least(candidates_, 0, visibility);
    }

    // Within the piece, unless that would leave a short piece.
    void add(std::size_t i, double fraction) {
        const double least = shortest_piece_widths * width_mm_, length = pieces_[i].length_mm;
        if (fraction * length < least) fraction = 0;
        if (fraction > 0 && (1 - fraction) * length < least) {
            i = i + 1 == pieces_.size() ? 0 : i + 1;
            fraction = 0;
        }
        const Piece& piece = pieces_[i];
        const double at = piece.at_mm + fraction * piece.length_mm;
        const Point2 point =
            fraction == 0 ? piece.start : point_at(piece.start, piece.segment, fraction);
        candidates_.push_back({{point, i, fraction}, at});
    }

    // Where an arc is farthest in y between its ends.
    void add_top(std::size_t i) {
        const auto circle = circle_of(pieces_[i].start, pieces_[i].segment);
        if (!circle) return;
        add(i, foot_of(pieces_[i], circle->centre + Vector2(0, circle->radius_mm)));
    }

    Seam seam() const { return candidates_.front().seam; }

    std::vector<Piece> pieces_;
    Turning turning_;
    double width_mm_;
    std::vector<Candidate> candidates_;
};

Seam seam_of_circle(const FullCircle& circle, const SeamRequest& request) {
    if (request.choice == SeamChoice::nearest)
        return on_circle(circle, request.head - circle.centre);
    if (request.choice == SeamChoice::rear) return on_circle(circle, {0, 1});
    const auto below = seam_below(circle, request, [&](const Point2& point) {
        return std::abs((point - circle.centre).norm() - circle.radius_mm);
    });
    return on_circle(circle, below ? Vector2(*below - circle.centre) : Vector2(0, 1));
}

}  // namespace

Seam seam_of(const Contour& contour, const SeamRequest& request) {
    if (const auto* circle = std::get_if<FullCircle>(&contour))
        return seam_of_circle(*circle, request);
    const Path& path = std::get<Path>(contour);
    if (length_mm(contour) == 0) return {path.start};
    SeamSearch search(path, request);
    if (request.choice == SeamChoice::nearest) return search.nearest(request.head);
    if (request.choice == SeamChoice::rear) return search.rear();
    const auto below =
        seam_below(contour, request, [&](const Point2& point) { return search.distance(point); });
    if (request.choice == SeamChoice::aligned && below) return search.nearest(*below);
    return search.sharp(below);
}

Contour started_at(const Contour& contour, const Seam& seam) {
    const auto* path = std::get_if<Path>(&contour);
    if (!path || path->segments.empty()) return contour;
    const std::size_t count = path->segments.size(), first = seam.segment;
    const Point2 before = first == 0 ? path->start : path->segments[first - 1].end;
    const Segment& split = path->segments[first];
    const bool within = seam.fraction > 0;
    Path result{within ? seam.point : before, {}};
    result.segments.reserve(count + 1);
    const double sweep = sweep_rad(before, split);
    if (within) {
        result.segments.push_back(
            arc_with_sweep(seam.point, split.end, sweep * (1 - seam.fraction)));
    }
    for (std::size_t i = within ? 1 : 0; i < count; ++i)
        result.segments.push_back(path->segments[(first + i) % count]);
    if (within)
        result.segments.push_back(arc_with_sweep(before, seam.point, sweep * seam.fraction));
    return result;
}

Strand started_at(const Strand& closed, const Seam& seam) {
    Strand result{started_at(closed.path, seam), closed.width_mm, closed.widths_mm};
    if (result.widths_mm.empty()) return result;
    std::rotate(result.widths_mm.begin(),
                result.widths_mm.begin() + static_cast<std::ptrdiff_t>(seam.segment),
                result.widths_mm.end());
    if (seam.fraction > 0) result.widths_mm.push_back(result.widths_mm.front());
    return result;
}

}  // namespace lyr
