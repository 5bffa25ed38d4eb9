// Where the straight way leaves the region it comes upon a contour, and where it meets that contour for the last time it
// is in the region again: a contour divides the plane, so there is no other way back. Between the two the contour leads
// along, either way round. A string along it, pulled tight, is straight but for bends that all turn the same way. Each of
// its straight parts may come upon other contours, and is treated alike.

#include "kernel/toolpath/detour.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/constants.h"

namespace lyr {
namespace {

// Bends beside an arc are no farther from it than this, besides their distance to the boundary.
constexpr double arc_slack_mm = 0.1;
// Beside a corner: at most this turn at a bend keeps it within 1.5 times the distance. A right angle is below it for sure.
constexpr double most_turn_rad = 1.6;
// Turns below this are round-off between tangent segments, or too flat to bend for.
constexpr double least_turn_rad = 1e-6;
// How often the boundary is asked for one way: about 100 us.
constexpr int most_questions = 100;
// Detours from detours. A way that needs more of them is a maze.
constexpr int most_depth = 8;

using Polyline = std::vector<Point2>;

double length_of(const Polyline& line) {
    double length = 0;
    for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
    return length;
}

// How far along the piece a point on it is.
double along_mm(const BoundaryPiece& piece, const Point2& point) {
    const Vector2 offset = point - piece.start;
    const double k = piece.curvature_per_mm, ahead = offset.dot(piece.start_tangent);
    if (k == 0) return ahead;
    double angle = std::atan2(std::abs(k) * ahead, 1 - k * cross(piece.start_tangent, offset));
    if (angle < 0) angle += full_turn_rad;
    // Round-off may put it outside, near to one of the ends.
    const double sweep = std::abs(k) * piece.length_mm;
    if (angle > (sweep + full_turn_rad) / 2) return 0;
    return std::min(angle / std::abs(k), piece.length_mm);
}

}  // namespace

Detours::Detours(Region inside, double allowed_mm, double most_extra_mm, double clear_mm)
    : boundary_(inside),
      allowed_mm_(allowed_mm),
      most_extra_mm_(most_extra_mm),
      clear_mm_(clear_mm) {
    outlines_.resize(inside.size());
    piece_at_mm_.reserve(boundary_.pieces().size());
    for_neighbours(boundary_.pieces(),
                   [&](const BoundaryPiece& before, const BoundaryPiece& piece) {
                       Outline& outline = outlines_[piece.contour];
                       piece_at_mm_.push_back(outline.length_mm);
                       add_bends(before, piece, outline);
                       outline.length_mm += piece.length_mm;
                   });
}

// The corner before the piece, then the piece itself, if they turn right: away from the region. Both are arcs about a
// centre, a corner one without radius; the bends are corners of a polygon around that.
void Detours::add_bends(const BoundaryPiece& before, const BoundaryPiece& piece,
                        Outline& outline) const {
    const double distance = 2 * allowed_mm_;
    const auto add = [&](const Point2& centre, double radius, const Vector2& first_normal,
                         double turn, double most_turn, double length) {
        const double round = radius + distance;
        const double count = std::max(1.0, std::ceil(turn / most_turn));
        const double reach = round / std::cos(turn / count / 2);
        for (double i = 0.5; i < count; ++i) {
            const Vector2 normal = Eigen::Rotation2Dd(-turn * i / count) * first_normal;
            outline.bends.push_back(
                {centre + reach * normal, outline.length_mm + length * i / count});
        }
    };
    const Vector2 &in = before.end_tangent, &out = piece.start_tangent;
    const double turn = piece.is_circle ? 0 : -std::atan2(cross(in, out), in.dot(out));
    if (turn > least_turn_rad) add(piece.start, 0, left_of(in), turn, most_turn_rad, 0);
    if (piece.curvature_per_mm >= 0) return;
    const double radius = -1 / piece.curvature_per_mm;
    const double slack_turn =
        2 * std::acos((radius + distance) / (radius + distance + arc_slack_mm));
    add(piece.start - radius * left_of(out), radius, left_of(out), piece.length_mm / radius,
        std::min(slack_turn, most_turn_rad), piece.length_mm);
}

// An end on the boundary, or hardly outside, is as good as one inside it. In a corner it takes two steps.
Point2 Detours::moved_inside(Point2 point) const {
    for (int step = 0; step < 2; ++step) {
        const auto nearest = boundary_.nearest(point, allowed_mm_);
        if (!nearest) break;
        const Carrier carrier = boundary_.pieces()[*nearest].carrier();
        const Vector2 normal =
            (left_of(carrier.tangent) - carrier.curvature_per_mm * (point - carrier.start))
                .normalized();
        point += (offset_mm(carrier, point) + 2 * allowed_mm_) * normal;
    }
    return point;
}

class Detours::Search {
public:
    explicit Search(const Detours& detours) : detours_(detours) {}

    // From the last point of `line` on. If false, `line` is as it was.
    bool append(const Point2& to, double most_mm, int depth, Polyline& line) {
        if (--questions_left_ < 0 || depth > most_depth) return false;
        const Point2 from = line.back();
        std::vector<BoundaryCrossing> crossings;
        detours_.boundary_.crossings(from, to, crossings);
        if (crossings.empty()) {
            line.push_back(to);
            return true;
        }
        const auto contour_of = [&](const BoundaryCrossing& crossing) {
            return detours_.boundary_.pieces()[crossing.piece].contour;
        };
        const BoundaryCrossing& first = crossings.front();
        const auto last = std::find_if(crossings.rbegin(), crossings.rend(), [&](const auto& c) {
            return contour_of(c) == contour_of(first);
        });
        if (!first.leaves || last->leaves) return false;
        const Outline& outline = detours_.outlines_[contour_of(first)];
        const double out = place_of(first, from, to), back = place_of(*last, from, to);
        Polyline one = tight(from, to, outline, out, back, true);
        Polyline other = tight(from, to, outline, out, back, false);
        if (length_of(other) < length_of(one)) std::swap(one, other);
        return append_shorter(one, other, most_mm, depth, line);
    }

    // Where a way around several contours is slack, from neighbour to neighbour of a bend may be shorter.
    void tighten(Polyline& line) {
        for (std::size_t i = 1; i + 1 < line.size();) {
            const double now = (line[i] - line[i - 1]).norm() + (line[i + 1] - line[i]).norm();
            Polyline part{line[i - 1]};
            if (!append(line[i + 1], now, 0, part) || length_of(part) >= now * least_gain) {
                ++i;
                continue;
            }
            line.erase(line.begin() + static_cast<std::ptrdiff_t>(i));
            line.insert(line.begin() + static_cast<std::ptrdiff_t>(i), part.begin() + 1,
                        part.end() - 1);
            i = std::max<std::size_t>(1, i - 1);
        }
    }

    // Bends farther from what they go around, all of them as far, where that meets nothing else; or else one by one.
    void clear(Polyline& line, double most_mm) const {
        const std::size_t last = line.size() - 1;
        if (last < 2) return;
        for (double by_mm = detours_.clear_mm_; by_mm > 2 * detours_.allowed_mm_; by_mm /= 2)
            if (clear(line, 1, last, by_mm, most_mm)) return;
        for (std::size_t i = 1; i < last; ++i)
            for (double by_mm = detours_.clear_mm_; by_mm > 2 * detours_.allowed_mm_; by_mm /= 2)
                if (clear(line, i, i + 1, by_mm, most_mm)) break;
    }

private:
    // Bends [first, last).
    bool clear(Polyline& line, std::size_t first, std::size_t last, double by_mm,
               double most_mm) const {
        Polyline moved = line;
        for (std::size_t i = first; i < last; ++i) {
            const Vector2 aside =
                (line[i] - line[i - 1]).normalized() - (line[i + 1] - line[i]).normalized();
            moved[i] += by_mm * aside.normalized();
        }
        if (length_of(moved) > most_mm) return false;
        std::vector<BoundaryCrossing> crossings;
        for (std::size_t i = first; i <= last; ++i) {
            detours_.boundary_.crossings(moved[i - 1], moved[i], crossings);
            if (!crossings.empty()) return false;
        }
        line = std::move(moved);
        return true;
    }

    // A way that is not shorter than this share of another is as long.
    static constexpr double least_gain = 1 - 1e-9;

    double place_of(const BoundaryCrossing& crossing, const Point2& from, const Point2& to) const {
        const Point2 point = from + crossing.along_mm * (to - from).normalized();
        return detours_.piece_at_mm_[crossing.piece] +
               along_mm(detours_.boundary_.pieces()[crossing.piece], point);
    }

    // A string along the outline's bends from one place to another.
    static Polyline tight(const Point2& from, const Point2& to, const Outline& outline, double out,
                          double back, bool forward) {
        Polyline line{from};
        const double side = forward ? 1 : -1;
        const auto add = [&](const Point2& point) {
            while (line.size() > 1) {
                const Point2 &last = line.back(), &before = line[line.size() - 2];
                if (side * cross(last - before, point - last) < 0) break;
                line.pop_back();
            }
            line.push_back(point);
        };
        const std::size_t count = outline.bends.size();
        const double length = outline.length_mm;
        const auto ahead = [&](double place) {
            const double way = forward ? place - out : out - place;
            return way < 0 ? way + length : way;
        };
        const auto next =
            std::upper_bound(outline.bends.begin(), outline.bends.end(), out,
                             [](double place, const Bend& bend) { return place < bend.at_mm; });
        const auto start = static_cast<std::size_t>(next - outline.bends.begin());
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t at = forward ? start + i : start + count - 1 - i;
            const Bend& bend = outline.bends[at % count];
            if (ahead(bend.at_mm) > ahead(back)) break;
            add(bend.point);
        }
        add(to);
        return line;
    }

    bool append_shorter(const Polyline& one, const Polyline& other, double most_mm, int depth,
                        Polyline& line) {
        Polyline first{line.back()}, second{line.back()};
        const bool found = append_all(one, most_mm, depth, first);
        const double most_other = found ? std::min(most_mm, length_of(first)) : most_mm;
        const bool better = append_all(other, most_other * least_gain, depth, second);
        if (!found && !better) return false;
        const Polyline& best = better ? second : first;
        line.insert(line.end(), best.begin() + 1, best.end());
        return true;
    }

    bool append_all(const Polyline& string, double most_mm, int depth, Polyline& line) {
        double left = most_mm - length_of(string);
        for (std::size_t i = 1; i < string.size(); ++i) {
            if (left < 0) return false;
            const double straight = (string[i] - string[i - 1]).norm();
            const std::size_t before = line.size() - 1;
            if (!append(string[i], straight + left, depth + 1, line)) return false;
            double length = 0;
            for (std::size_t k = before + 1; k < line.size(); ++k)
                length += (line[k] - line[k - 1]).norm();
            left -= length - straight;
        }
        return left >= 0;
    }

    const Detours& detours_;
    int questions_left_ = most_questions;
};

Travel Detours::way(const Point2& from, const Point2& to) const {
    const Point2 start = moved_inside(from), end = moved_inside(to);
    if (boundary_.winding(start) <= 0 || boundary_.winding(end) <= 0) return {{}, true};
    Search search(*this);
    Polyline line{start};
    const double most_mm = (end - start).norm() + most_extra_mm_;
    if (!search.append(end, most_mm, 0, line)) return {{}, true};
    search.tighten(line);
    search.clear(line, most_mm);
    return {{line.begin() + 1, line.end() - 1}, false};
}

}  // namespace lyr
