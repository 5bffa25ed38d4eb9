// A search by the number of arcs. Arcs end on the curve, but not along its tangent: where the curvature changes by k' a
// length, arcs of length l with both ends on the curve repeat if their tangents there are off the curve's by k' l^2 / 12,
// and they stay within k' l^3 / 125 of it. Circles that need not meet stay within k' l^3 / 192, so arcs that share
// tangents are at least 1.16 times as many. Such an arc is given by where it starts, its tangent there and where it ends,
// and its tangent at the end follows: the longest arc now may leave a tangent with which only short ones go on. So of
// what n arcs can reach several places are kept, the farthest for each range of the tangent's error, and the arcs
// of all of them are tried. The chain ends with two arcs between given tangents, a biarc, as soon as one is near enough.

#include "kernel/contour/arc_chain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

// Arcs may turn by less than a right angle: beyond that, equal tangent lengths make poor biarcs.
constexpr double least_cosine_of_turn = 0.2;

// The most that arcs may end off the curve's tangent, as a sine. More is within the bound only about a turn much sharper than the
// bound is wide, and cannot be taken back there.
constexpr double most_error = 0.15;

// How many are kept of the places that n arcs reach. More of them, or more of the shorter arcs below, save an arc in a hundred.
constexpr std::size_t kept_places = 5;

// What is kept is this share as far from the place that one arc less reaches as the farthest.
constexpr double least_share = 0.6;

// Besides the longest arc from a place, these shares of it are tried, for the tangents that they end with.
constexpr std::array shorter_shares = {0.9, 0.75};

// Points of a stretch are looked at in strides first: most biarcs that are too long are so by far.
constexpr std::size_t stride = 4;

// Neighbours that are farther apart than this share of the stretch do not show what arcs do between them: there the cubic
// through them is looked at, in so many places; a single span is all that arcs can be held to, in more.
constexpr double wide_share = 1.0 / 16;
constexpr std::size_t places_between = 3;
constexpr int places_in_single_span = 9;

using PlacesInSpan = std::array<Point2, places_between>;

// The sagitta of the arc over `chord` that leaves along `tangent`.
double sagitta_from_tangent(const Vector2& chord, const Vector2& tangent) {
    const double length = chord.norm();
    return length / 2 * cross(tangent, chord) / (length + tangent.dot(chord));
}

// The cubic with two neighbours' points and tangents, at a share of the way.
Point2 between(const CurvePoint& a, const CurvePoint& b, double share) {
    const double length = (b.point - a.point).norm(), rest = 1 - share;
    return rest * rest * (1 + 2 * share) * a.point + share * share * (1 + 2 * rest) * b.point +
           share * rest * length * (rest * a.tangent - share * b.tangent);
}

// Points one beside the other, for the processor's vectors.
using Block = Eigen::Array<double, 8, 1>;
constexpr std::uint32_t block_size = Block::SizeAtCompileTime;

bool all_between(double least, const Block& values, double most) {
    return least <= values.minCoeff() && values.maxCoeff() <= most;
}

// Whether points are within a distance of a whole line or circle: offset_mm(), but without its square root.
class Band {
public:
    Band(const Carrier& carrier, double bound_mm) : carrier_(carrier) {
        // With curvature k, an offset o to the right is where 2 q.n + k q^2 (see offset_mm) is 2 o + k o^2. The centre
        // is where that is least (or most, if it lies to the right).
        const double k = carrier.curvature_per_mm;
        const double inwards_mm = bound_mm * std::abs(k) < 1 ? bound_mm : 1 / std::abs(k);
        const double left_mm = k > 0 ? inwards_mm : bound_mm,
                     right_mm = k > 0 ? bound_mm : inwards_mm;
        least_mm_ = left_mm * (k * left_mm - 2);
        most_mm_ = right_mm * (k * right_mm + 2);
    }

    bool has(const Point2& point) const {
        const Vector2 offset = point - carrier_.start;
        const double measure_mm =
            2 * cross(offset, carrier_.tangent) + carrier_.curvature_per_mm * offset.squaredNorm();
        return least_mm_ <= measure_mm && measure_mm <= most_mm_;
    }

    bool has_all(const Block& x, const Block& y) const {
        const Block along_x = x - carrier_.start.x(), along_y = y - carrier_.start.y();
        const Block measures_mm =
            2 * (along_x * carrier_.tangent.y() - along_y * carrier_.tangent.x()) +
            carrier_.curvature_per_mm * (along_x * along_x + along_y * along_y);
        return all_between(least_mm_, measures_mm, most_mm_);
    }

private:
    Carrier carrier_;
    double least_mm_, most_mm_;
};

// Along an arc from a point, which leaves along `tangent`.
double curvature_per_mm(const Vector2& chord, const Vector2& tangent) {
    return 2 * cross(tangent, chord) / chord.squaredNorm();
}

// The tangent at an arc's other end: it turns by twice the angle to the chord.
Vector2 tangent_beyond(const Vector2& chord, const Vector2& tangent) {
    return 2 * chord.dot(tangent) / chord.squaredNorm() * chord - tangent;
}

// What is straight to the model's own resolution is a line.
Segment straightened(Segment arc) {
    if (std::abs(arc.sagitta_mm) <= resolution_mm) arc.sagitta_mm = 0;
    return arc;
}

// A place that a number of arcs reach.
struct Place {
    std::uint32_t at;      // of the points
    std::uint32_t before;  // the place that the last arcs come from
    Vector2 tangent;       // of the arcs
    double error;          // of it, against the curve's: the sine of the angle
    Segment last;
    std::optional<Segment> last_but_one{};  // where two arcs were added at once
};

class Search {
public:
    Search(std::span<const CurvePoint> points, double bound_mm)
        : points_(points),
          bound_mm_(bound_mm),
          last_(static_cast<std::uint32_t>(points.size() - 1)),
          x_(points.size()),
          y_(points.size()) {
        for (std::uint32_t i = 0; i <= last_; ++i) {
            x_[i] = point(i).point.x();
            y_[i] = point(i).point.y();
        }
        for (std::uint32_t i = 0; i < last_; ++i)
            widest_mm2_ =
                std::max(widest_mm2_, (point(i + 1).point - point(i).point).squaredNorm());
        places_.push_back({0, 0, points.front().tangent, 0, {points.front().point}, {}});
        reached_[0].push_back(0);
    }

    void run(std::vector<Segment>& out) {
        for (std::size_t arcs = 0;; ++arcs) {
            const std::vector<std::uint32_t> kept = keep(reached_[arcs % 3]);
            for (const std::uint32_t place : kept)
                if (finish(place)) return trace_back(out);
            auto& one_more = reached_[(arcs + 1) % 3];
            for (const std::uint32_t place : kept) add_arc(place, one_more);
            if (!kept.empty()) add_biarc(kept.front(), reached_[(arcs + 2) % 3]);
            if (one_more.empty() && reached_[(arcs + 2) % 3].empty()) {
                if (!add_other_way(one_more)) add_chord(farthest_, one_more);
                if (places_.back().at == last_) return trace_back(out);
            }
        }
    }

private:
    const CurvePoint& point(std::uint32_t at) const { return points_[at]; }

    // The farthest for each range of the tangent's error, the farthest of all first. What fewer arcs reached is dropped.
    std::vector<std::uint32_t> keep(std::vector<std::uint32_t>& reached) {
        std::vector<std::uint32_t> kept;
        const std::uint32_t before = places_[farthest_].at;
        std::uint32_t farthest = before;
        for (const std::uint32_t p : reached) farthest = std::max(farthest, places_[p].at);
        const double least_at = before + least_share * (farthest - before);
        std::erase_if(reached,
                      [&](std::uint32_t p) { return p != 0 && !(places_[p].at > least_at); });
        if (reached.empty()) return kept;
        const auto [low, high] = std::minmax_element(
            reached.begin(), reached.end(),
            [&](auto a, auto b) { return places_[a].error < places_[b].error; });
        const double least = places_[*low].error, range = places_[*high].error - least;
        std::array<std::optional<std::uint32_t>, kept_places> best{};
        for (const std::uint32_t p : reached) {
            const double share = range > 0 ? (places_[p].error - least) / range : 0;
            auto& own =
                best[std::min(kept_places - 1, static_cast<std::size_t>(share * kept_places))];
            if (!own || places_[p].at > places_[*own].at) own = p;
        }
        for (const auto& p : best)
            if (p) kept.push_back(*p);
        std::sort(kept.begin(), kept.end(), [&](std::uint32_t a, std::uint32_t b) {
            return places_[a].at != places_[b].at ? places_[a].at > places_[b].at : a < b;
        });
        farthest_ = kept.front();
        reached.clear();
        return kept;
    }

    // Calls try_end(end), whether arcs to there are within the bound, for farther ends while they are, then for those
    // between. Gives the farthest, or `from`.
    template <class TryEnd>
    std::uint32_t farthest(std::uint32_t from, std::uint32_t guess, TryEnd try_end) const {
        std::uint32_t good = from, bad = last_ + 1;
        for (std::uint32_t end = std::clamp(guess, from + 1, last_); good + 1 < bad;) {
            (try_end(end) ? good : bad) = end;
            const std::uint32_t doubled = std::min(last_, from + 2 * (good - from));
            // Finer gains nothing.
            if (bad - good <= (good - from) / 16) break;
            end = doubled > good && doubled < bad ? doubled : good + (bad - good) / 2;
            if (end <= good) break;
        }
        return good;
    }

    void add_arc(std::uint32_t from, std::vector<std::uint32_t>& reached) {
        const std::uint32_t start = places_[from].at;
        const auto try_end = [&](std::uint32_t end) {
            if (end == last_) return false;  // only a biarc arrives along the tangent
            const Vector2 chord = point(end).point - point(start).point,
                          leaving = places_[from].tangent;
            const Vector2 arriving = tangent_beyond(chord, leaving);
            const double error = cross(point(end).tangent, arriving);
            if (!(chord.dot(leaving) > 0) || !(leaving.dot(arriving) > least_cosine_of_turn) ||
                !(std::abs(error) <= most_error) || !(point(end).tangent.dot(arriving) > 0))
                return false;
            const Segment arc{point(end).point, sagitta_from_tangent(chord, leaving)};
            const Band band({point(start).point, leaving, curvature_per_mm(chord, leaving)},
                            bound_mm_);
            if (!within(start, end, band)) return false;
            reached.push_back(static_cast<std::uint32_t>(places_.size()));
            places_.push_back({end, from, arriving, error, arc, {}});
            return true;
        };
        const std::uint32_t length = farthest(start, start + last_length_, try_end) - start;
        if (length == 0) return;
        last_length_ = length;
        for (const double share : shorter_shares) {
            const auto shorter = static_cast<std::uint32_t>(share * length);
            if (shorter > 0) try_end(start + shorter);
        }
    }

    // Two arcs that end along the tangent.
    std::optional<Place> biarc(std::uint32_t from, std::uint32_t end) const {
        const std::uint32_t start = places_[from].at;
        const CurvePoint here{point(start).point, places_[from].tangent}, &goal = point(end);
        const Vector2 chord = goal.point - here.point, sum = here.tangent + goal.tangent;
        const double turn = here.tangent.dot(goal.tangent);
        if (!(turn > least_cosine_of_turn) || !(chord.dot(here.tangent) > 0) ||
            !(chord.dot(goal.tangent) > 0))
            return std::nullopt;
        // |chord - d (here + goal)| = 2 d: the positive root, in the form that does not cancel.
        const double b = chord.dot(sum), c = chord.squaredNorm();
        const double d = c / (b + std::sqrt(b * b + 2 * (1 - turn) * c));
        const Point2 joint = 0.5 * (here.point + goal.point + d * (here.tangent - goal.tangent));
        const Segment first{joint, sagitta_from_tangent(joint - here.point, here.tangent)};
        const Segment second{goal.point, -sagitta_from_tangent(joint - goal.point, -goal.tangent)};
        const Vector2 along_joint = tangent_beyond(joint - here.point, here.tangent);
        const Band before(
            {here.point, here.tangent, curvature_per_mm(joint - here.point, here.tangent)},
            bound_mm_);
        const Band after({joint, along_joint, curvature_per_mm(goal.point - joint, along_joint)},
                         bound_mm_);
        const auto is_near = [&](const Point2& p) {
            return ((p - joint).dot(along_joint) < 0 ? before : after).has(p);
        };
        if (!within(start, end, is_near)) return std::nullopt;
        return Place{end, from, goal.tangent, 0, second, first};
    }

    void add_biarc(std::uint32_t from, std::vector<std::uint32_t>& reached) {
        std::optional<Place> best;
        const std::uint32_t start = places_[from].at;
        farthest(start, start + 2 * last_length_, [&](std::uint32_t end) {
            const auto found = biarc(from, end);
            if (found) best = found;
            return found.has_value();
        });
        if (!best) return;
        reached.push_back(static_cast<std::uint32_t>(places_.size()));
        places_.push_back(*best);
    }

    bool finish(std::uint32_t from) {
        const auto found = biarc(from, last_);
        if (found) places_.push_back(*found);
        return found.has_value();
    }

    // No arc goes on from the farthest place, with the tangent it is reached with: it is reached along the curve's own
    // tangent instead, with two arcs from an earlier place.
    bool add_other_way(std::vector<std::uint32_t>& reached) {
        if (places_[farthest_].error == 0) return false;
        const std::uint32_t end = places_[farthest_].at;
        for (auto from = static_cast<std::uint32_t>(places_.size()); from-- > 0;) {
            if (places_[from].at >= end) continue;
            const auto found = biarc(from, end);
            if (!found) continue;
            reached.push_back(static_cast<std::uint32_t>(places_.size()));
            places_.push_back(*found);
            farthest_ = from;
            return true;
        }
        return false;
    }

    // No arc is within the bound: past this point with a chord, without regard to the tangent.
    void add_chord(std::uint32_t from, std::vector<std::uint32_t>& reached) {
        const std::uint32_t end = places_[from].at + 1;
        reached.push_back(static_cast<std::uint32_t>(places_.size()));
        places_.push_back({end, from, point(end).tangent, 0, {point(end).point, 0}, {}});
    }

    // Of an arc from one point to another.
    struct Ends {
        Point2 origin;
        Vector2 chord;
        double least, most;  // of the product with the chord

        bool has_between(const Point2& p) const {
            const double along = chord.dot(p - origin);
            return least <= along && along <= most;
        }
    };
    Ends ends_of(std::uint32_t start, std::uint32_t end) const {
        const Vector2 chord = point(end).point - point(start).point;
        const double length = chord.norm();
        return {point(start).point, chord, -length * bound_mm_, length * (length + bound_mm_)};
    }

    // Whether all points are near, and none is before the start or past the end: not even where the curve goes out and
    // comes back.
    template <class IsNear>
    bool within(std::uint32_t start, std::uint32_t end, IsNear is_near) const {
        const Ends ends = ends_of(start, end);
        const auto is_beside = [&](const Point2& p) { return ends.has_between(p) && is_near(p); };
        for (std::size_t first = stride; first > 0; --first)
            for (std::size_t i = start + first; i < end; i += stride)
                if (!is_beside(points_[i].point)) return false;
        return spans_within(start, end, ends.chord, is_beside);
    }

    bool within(std::uint32_t start, std::uint32_t end, const Band& band) const {
        const Ends ends = ends_of(start, end);
        const auto is_beside = [&](const Point2& p) { return ends.has_between(p) && band.has(p); };
        if (!is_beside(point(start + (end - start) / 2).point)) return false;
        if (end - start <= block_size) {
            for (std::uint32_t i = start + 1; i < end; ++i)
                if (!is_beside(points_[i].point)) return false;
        }
        // The last block may look at points again.
        for (std::uint32_t i = start + 1; end - start > block_size && i < end; i += block_size)
            if (!block_within(std::min(i, end - block_size), ends, band)) return false;
        return spans_within(start, end, ends.chord, is_beside);
    }

    bool block_within(std::uint32_t first, const Ends& ends, const Band& band) const {
        const Eigen::Map<const Block> x(&x_[first]), y(&y_[first]);
        const Block along =
            ends.chord.x() * (x - ends.origin.x()) + ends.chord.y() * (y - ends.origin.y());
        return all_between(ends.least, along, ends.most) && band.has_all(x, y);
    }

    template <class IsBeside>
    bool spans_within(std::uint32_t start, std::uint32_t end, const Vector2& chord,
                      IsBeside is_beside) const {
        const double wide2 = wide_share * wide_share * chord.squaredNorm();
        if (widest_mm2_ <= wide2) return true;
        if (end == start + 1) return cubic_within(start, is_beside);
        for (std::uint32_t i = start; i < end; ++i) {
            if (!((point(i + 1).point - point(i).point).squaredNorm() > wide2)) continue;
            for (const Point2& p : places_in_span(i))
                if (!is_beside(p)) return false;
        }
        return true;
    }

    template <class IsBeside>
    bool cubic_within(std::uint32_t span, IsBeside is_beside) const {
        for (int k = 1; k <= places_in_single_span; ++k)
            if (!is_beside(between(point(span), point(span + 1),
                                   static_cast<double>(k) / (places_in_single_span + 1))))
                return false;
        return true;
    }

    // Many arcs are tried along one span.
    const PlacesInSpan& places_in_span(std::uint32_t span) const {
        if (in_spans_.empty()) in_spans_.resize(last_);
        std::optional<PlacesInSpan>& places = in_spans_[span];
        if (!places) {
            places.emplace();
            for (std::size_t k = 0; k < places_between; ++k)
                (*places)[k] = between(point(span), point(span + 1),
                                       static_cast<double>(k + 1) / (places_between + 1));
        }
        return *places;
    }

    void trace_back(std::vector<Segment>& out) const {
        const std::size_t first = out.size();
        for (auto p = static_cast<std::uint32_t>(places_.size() - 1); p != 0;
             p = places_[p].before) {
            out.push_back(straightened(places_[p].last));
            if (places_[p].last_but_one) out.push_back(straightened(*places_[p].last_but_one));
        }
        std::reverse(out.begin() + static_cast<std::ptrdiff_t>(first), out.end());
    }

    std::span<const CurvePoint> points_;
    double bound_mm_;
    std::uint32_t last_;
    std::vector<double> x_, y_;      // of the points
    double widest_mm2_ = 0;          // between neighbours
    std::uint32_t farthest_ = 0;     // of all kept places
    std::uint32_t last_length_ = 8;  // of an arc, in points: where to look first
    std::vector<Place> places_;
    mutable std::vector<std::optional<PlacesInSpan>> in_spans_;  // made when they are asked for
    std::array<std::vector<std::uint32_t>, 3> reached_;          // by n, n + 1 and n + 2 arcs
};

}  // namespace

void chain_arcs(std::span<const CurvePoint> points, double bound_mm, std::vector<Segment>& out) {
    Search(points, bound_mm).run(out);
}

}  // namespace lyr
