// From the bed upwards, where a branch may be so that it can still come down to the bed; from the top downwards, the
// branches: each goes towards its neighbour as far as that allows.

#include "kernel/toolpath/support_tree.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "kernel/toolpath/boundary.h"
#include "kernel/toolpath/hatch.h"
#include "kernel/toolpath/offset.h"
#include "kernel/toolpath/point_tree.h"

namespace lyr {
namespace {

using Contours = std::vector<Contour>;

struct Branch {
    Point2 at;
    double radius_mm;
    bool to_bed;
};

// Places that keep a distance in space; asked for in buckets of that size.
class Tips {
public:
    explicit Tips(double spacing_mm) : spacing_mm_(spacing_mm) {}

    // Unless there is one within the spacing.
    bool add(const Point3& tip) {
        if (is_near(tip, spacing_mm_)) return false;
        tips_[{bucket(tip.x()), bucket(tip.y())}].push_back(tip);
        return true;
    }

    bool is_near(const Point3& place, double distance_mm) const {
        const long x = bucket(place.x()), y = bucket(place.y());
        const auto reach = std::lround(std::ceil(distance_mm / spacing_mm_));
        for (long i = x - reach; i <= x + reach; ++i) {
            for (long k = y - reach; k <= y + reach; ++k) {
                const auto found = tips_.find({i, k});
                if (found == tips_.end()) continue;
                for (const Point3& tip : found->second)
                    if ((tip - place).norm() < distance_mm) return true;
            }
        }
        return false;
    }

private:
    long bucket(double mm) const { return std::lround(std::floor(mm / spacing_mm_)); }

    double spacing_mm_;
    std::map<std::pair<long, long>, std::vector<Point3>> tips_;
};

// The nearest point of a piece of boundary.
Point2 foot_on(const BoundaryPiece& piece, const Point2& point) {
    const double distance = piece.distance_mm(point);
    Point2 foot;
    if (piece.curvature_per_mm == 0) {
        const double along = (point - piece.start).dot(piece.start_tangent);
        foot = piece.start + std::clamp(along, 0.0, piece.length_mm) * piece.start_tangent;
    } else {
        const Vector2 left(-piece.start_tangent.y(), piece.start_tangent.x());
        const Point2 centre = piece.start + left / piece.curvature_per_mm;
        foot = centre + (point - centre).normalized() / std::abs(piece.curvature_per_mm);
    }
    const auto off = [&](const Point2& at) { return std::abs((at - point).norm() - distance); };
    for (const Point2& end : {piece.start, piece.end})
        if (off(end) < off(foot)) foot = end;
    return foot;
}

// A region that branches keep out of.
class Obstacle {
public:
    Obstacle(Region region, double beside_mm) : boundary_(region), beside_mm_(beside_mm) {}

    bool holds(const Point2& point) const { return boundary_.winding(point) > 0; }

    // Out of it, no farther than `most_mm` from `from`; `wish` if that is possible.
    std::optional<Point2> way_out(const Point2& from, const Point2& wish, double most_mm) const {
        for (const Point2& at : {wish, from}) {
            if (!holds(at)) return at;
            const auto exit = exit_from(at, most_mm + beside_mm_);
            if (exit && !holds(*exit) && (*exit - from).norm() <= most_mm) return exit;
        }
        return std::nullopt;
    }

    // Towards the way out, if that is within a distance.
    Point2 towards_exit(const Point2& from, double within_mm, double most_mm) const {
        const auto exit = exit_from(from, within_mm);
        if (!exit) return from;
        const Vector2 way = *exit - from;
        return way.norm() <= most_mm ? *exit : Point2(from + most_mm * way.normalized());
    }

private:
    std::optional<Point2> exit_from(const Point2& at, double within_mm) const {
        const auto nearest = boundary_.nearest(at, within_mm);
        if (!nearest) return std::nullopt;
        const Point2 foot = foot_on(boundary_.pieces()[*nearest], at);
        const Vector2 out = foot - at;
        return out.isZero() ? foot : Point2(foot + beside_mm_ * out.normalized());
    }

    Boundary boundary_;
    double beside_mm_;
};

class Tree {
public:
    Tree(std::span<const SupportLevel> levels, std::span<const LayerRoom> rooms,
         const TreeRequest& request)
        : levels_(levels),
          rooms_(rooms),
          request_(request),
          allowed_mm_(request.support.allowed_mm),
          begin_(beginnings(levels, rooms, request.support.gap_z_mm)),
          tips_(request.spacing_mm) {}

    SupportAreas areas() {
        result_.layers.resize(levels_.size());
        for (std::size_t i = 0; i < begin_.size(); ++i)
            if (!begin_[i].empty()) count_ = i + 1;
        find_obstacles();
        for (std::size_t i = count_; i-- > 0;) {
            descend(i);
            add_tips(i);
            draw(i);
        }
        if (request_.support.on_bed_only) keep_on_bed();
        for (const std::size_t layer : narrow_)
            if (!is_held(layer)) result_.out_of_reach.push_back(layer);
        return std::move(result_);
    }

private:
    template <class Result>
    Contours settled(std::size_t layer, Result made) {
        if (is_unresolved(made)) result_.unresolved.push_back(layer);
        return std::move(made.contours);
    }
    static bool is_unresolved(const RegionResult& made) { return made.unresolved > 0; }
    static bool is_unresolved(const OffsetResult& made) { return made.unresolved.has_value(); }

    Contours grown(std::size_t layer, const Contours& region, double distance_mm) {
        if (region.empty()) return {};
        return settled(layer,
                       offset(region, {.distance_mm = distance_mm, .allowed_mm = allowed_mm_}));
    }

    Contours changed(std::size_t layer, const Contours& a, const Contours& b, Operation operation) {
        if (b.empty()) return operation == Operation::intersect ? Contours{} : a;
        if (a.empty()) return operation == Operation::unite ? b : Contours{};
        return settled(layer, combined(a, b, operation, allowed_mm_));
    }

    double step_mm(std::size_t layer) const {
        return (levels_[layer].top_mm - levels_[layer].bottom_mm) *
               std::tan(request_.branch_angle_rad);
    }

    // Where a tip's circle collides; and where its middle does so in this layer or, whatever way it takes, in one below.
    void find_obstacles() {
        collides_.resize(count_);
        blocked_.resize(count_);
        roofs_.resize(levels_.size());
        for (std::size_t i = 0; i < count_; ++i) {
            collides_[i] = grown(i, rooms_[i].clear, request_.tip_radius_mm);
            blocked_[i] = rooms_[i].clear;
            if (i == 0) continue;
            const Contours below = grown(i, blocked_[i - 1], beside_mm() - step_mm(i));
            blocked_[i] = changed(i, rooms_[i].clear, below, Operation::unite);
        }
    }

    // How far out of an obstacle a branch is moved: well clear of round-off.
    double beside_mm() const { return 4 * allowed_mm_; }

    void descend(std::size_t i) {
        if (branches_.empty()) return;
        const Obstacle blocked(blocked_[i], beside_mm()), collides(collides_[i], beside_mm()),
            clear(rooms_[i].clear, beside_mm());
        const double step = step_mm(i + 1);
        const double wider =
            (levels_[i].top_mm - levels_[i].bottom_mm) * std::tan(request_.growth_angle_rad);
        std::vector<Branch> next;
        for (const Wish& wish : wishes(blocked, collides, step)) {
            Branch moved = wish.branch;
            moved.radius_mm = std::min(request_.most_radius_mm, moved.radius_mm + wider);
            moved.to_bed = moved.to_bed || !blocked.holds(moved.at);
            std::optional<Point2> to;
            if (wish.meets) to = wish.to;
            if (!to && moved.to_bed) to = next_place(blocked, collides, wish, step);
            moved.to_bed = to.has_value();
            if (!to) to = next_place(clear, collides, {wish.branch, wish.branch.at}, step);
            if (!to) continue;  // it stands on the part
            moved.at = *to;
            next.push_back(moved);
        }
        branches_ = std::move(next);
    }

    // Where a branch is to go: a step towards its neighbour, if there is height to meet; or just where it meets it.
    struct Wish {
        Branch branch;
        Point2 to;
        bool meets = false;
    };

    // A tip next to a wall has less room than its circle takes: it leaves the wall step by step.
    std::optional<Point2> next_place(const Obstacle& hard, const Obstacle& collides,
                                     const Wish& wish, double step_mm) const {
        const Point2& from = wish.branch.at;
        const auto to = collides.holds(from)
                            ? collides.towards_exit(from, 2 * request_.tip_radius_mm, step_mm)
                            : collides.way_out(from, wish.to, step_mm).value_or(from);
        return hard.holds(to) ? hard.way_out(from, from, step_mm) : to;
    }

    std::vector<Wish> wishes(const Obstacle& blocked, const Obstacle& collides,
                             double step_mm) const {
        std::vector<Point2> points;
        for (const Branch& branch : branches_) points.push_back(branch.at);
        const PointTree tree(points);
        std::vector<bool> gone(branches_.size(), false);
        std::vector<PointTree::Found> found;
        std::vector<Wish> result;
        const double reach_mm = 2 * height_left_mm_ * std::tan(request_.branch_angle_rad);
        for (std::uint32_t b = 0; b < branches_.size(); ++b) {
            if (gone[b]) continue;
            Wish wish{branches_[b], points[b]};
            tree.nearest(points[b], 2, found);
            for (const PointTree::Found& other : found) {
                const double distance = std::sqrt(other.square_mm2);
                if (other.index == b || gone[other.index] || distance > reach_mm) continue;
                const Point2 middle = (points[b] + points[other.index]) / 2;
                const Branch& neighbour = branches_[other.index];
                if (distance > 2 * step_mm) {
                    wish.to = points[b] + step_mm / distance * (points[other.index] - points[b]);
                } else if (other.index > b && (wish.branch.to_bed || neighbour.to_bed) &&
                           !blocked.holds(middle) && !collides.holds(middle)) {
                    gone[other.index] = true;
                    wish = {{points[b], std::max(wish.branch.radius_mm, neighbour.radius_mm), true},
                            middle,
                            true};
                    break;
                }
            }
            result.push_back(wish);
        }
        return result;
    }

    void add_tips(std::size_t i) {
        height_left_mm_ = levels_[i].bottom_mm;
        for (const std::size_t above : begin_[i]) {
            roofs_[above] = roof(i, rooms_[above].contact);
            const Contours room =
                changed(i, rooms_[above].contact, rooms_[i].clear, Operation::subtract);
            const Contours middles = grown(i, room, -request_.support.width_mm / 2);
            if (middles.empty()) narrow_.push_back(above);
            const Obstacle blocked(blocked_[i], beside_mm());
            for (const Point2& tip : places(middles)) {
                const bool to_bed = !blocked.holds(tip);
                if (!to_bed && request_.support.on_bed_only) continue;
                if (!tips_.add({tip.x(), tip.y(), levels_[i].top_mm})) continue;
                branches_.push_back({tip, request_.tip_radius_mm, to_bed});
            }
        }
    }

    // Of an overhang that has no room for a tip of its own: there may be others beside it.
    bool is_held(std::size_t layer) const {
        const std::vector<Point2> contact = places(rooms_[layer].contact);
        return std::any_of(contact.begin(), contact.end(), [&](const Point2& at) {
            return tips_.is_near({at.x(), at.y(), levels_[layer].bottom_mm}, tip_reach_mm());
        });
    }
    double tip_reach_mm() const { return 1.25 * request_.spacing_mm; }

    // What a wall below cuts off from a branch does not stand on the wall. Roofs reach out from the tips that carry them.
    void keep_on_bed() {
        for (std::size_t i = 1; i < count_; ++i) {
            const Contours beside = grown(i, result_.layers[i - 1], step_mm(i));
            std::vector<Region> held = roofs_at(i);
            held.push_back(beside);
            result_.layers[i] = changed(i, result_.layers[i], settled(i, united(held, allowed_mm_)),
                                        Operation::intersect);
        }
    }

    std::vector<Region> roofs_at(std::size_t i) const {
        std::vector<Region> roofs;
        const std::size_t end = std::min(begin_.size() - i, request_.support.interface_layers) + i;
        for (std::size_t k = i; k < end; ++k)
            for (const std::size_t above : begin_[k]) roofs.push_back(roofs_[above]);
        return roofs;
    }

    // Where no tip is wanted, it would lie on air.
    Contours roof(std::size_t i, const Contours& contact) {
        if (!request_.support.on_bed_only) return contact;
        const Contours held = changed(i, contact, blocked_[i], Operation::subtract);
        return changed(i, contact, grown(i, held, 2 * request_.tip_radius_mm),
                       Operation::intersect);
    }

    // All along the boundary, and rows within.
    std::vector<Point2> places(const Contours& region) const {
        const double pitch_mm = request_.spacing_mm / 4;
        std::vector<Point2> result;
        for (const BoundaryPiece& piece : boundary_pieces(region)) {
            const int parts = 1 + static_cast<int>(piece.length_mm / pitch_mm);
            for (int k = 0; k < parts; ++k)
                result.push_back(piece.at(static_cast<double>(k) / parts).point);
        }
        const Hatch rows = hatch(region, 0, pitch_mm);
        for (std::size_t row = 0; row < rows.row_count(); ++row) {
            const double y = rows.first_offset_mm + static_cast<double>(row) * rows.pitch_mm;
            for (std::uint32_t s = rows.row_start[row]; s < rows.row_start[row + 1]; ++s) {
                const HatchSpan& span = rows.spans[s];
                for (double k = std::ceil(span.start_mm / pitch_mm); k * pitch_mm < span.end_mm;
                     ++k)
                    result.push_back({k * pitch_mm, y});
            }
        }
        return result;
    }

    void draw(std::size_t i) {
        std::vector<Contours> parts;
        for (const Branch& branch : branches_)
            parts.push_back({FullCircle{branch.at, branch.radius_mm, true}});
        std::vector<Region> regions = roofs_at(i);
        regions.insert(regions.end(), parts.begin(), parts.end());
        if (regions.empty()) return;
        const Contours all = settled(i, united(regions, allowed_mm_));
        result_.layers[i] = rooms_[i].clear.empty()
                                ? all
                                : settled(i, combined(all, rooms_[i].clear, Operation::subtract,
                                                      allowed_mm_, request_.support.width_mm / 2));
    }

    std::span<const SupportLevel> levels_;
    std::span<const LayerRoom> rooms_;
    const TreeRequest& request_;
    double allowed_mm_;
    std::vector<std::vector<std::size_t>> begin_;  // by layer: overhangs whose support begins here
    Tips tips_;
    std::size_t count_ = 0;  // layers with support
    std::vector<Contours> collides_{}, blocked_{};
    std::vector<Contours> roofs_{};  // by overhang's layer
    std::vector<Branch> branches_{};
    double height_left_mm_ = 0;          // over the bed
    std::vector<std::size_t> narrow_{};  // layers whose overhangs have no room for a line
    SupportAreas result_{};
};

}  // namespace

SupportAreas support_tree(std::span<const SupportLevel> levels, std::span<const LayerRoom> rooms,
                          const TreeRequest& request) {
    return Tree(levels, rooms, request).areas();
}

}  // namespace lyr
