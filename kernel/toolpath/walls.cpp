// As long as a boundary that moves inwards loses no edge and meets no other part of itself, its length changes evenly
// with the distance; so the area between two distances is their difference times the mean of the lengths. But so it is
// where all of it shrinks to a point, and a tip that is sharper than a wall can fill goes back evenly too: contours must
// be as many, and tips blunt. Where it is not so, a wall whose boundary keeps clear of itself and which reaches all that
// lies outside it has lost but edges. Only the others are compared with what is wide enough for them.

#include "kernel/toolpath/walls.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "kernel/toolpath/clearance.h"
#include "kernel/toolpath/fitted_walls.h"
#include "kernel/toolpath/infill.h"
#include "kernel/toolpath/islands.h"
#include "kernel/toolpath/lost_webs.h"
#include "kernel/toolpath/strip_area.h"

namespace lyr {
namespace {

// Walls closer to their own opposite side than this share of their spacing overlap too much.
constexpr double least_space_share = 0.75;

// Area that is filled twice or not at all and not looked into, of a wall of a layer: a square of this edge.
constexpr double unseen_mm = 0.25;

// In half widths of a line, how far a corner's tip may be from the middle of the line around it, which reaches but one. Corners
// of less than 44 degrees are narrow at their tips: of 45, a line 0.45 mm wide leaves what is `unseen_mm`. Between walls of a
// part that is sparse inside anyway, and where walls themselves are mitred, it is 23 degrees.
constexpr double mitre_limit = 5, tip_limit = 2.65;

// By how much parts that are wide enough are cut wider than they are, so that their own boundary is left as it is; a
// share of the width.
constexpr double cut_margin_share = 0.05;

// Of a neck in which walls are not taken off each other, at most: half of it are the flanks of their ends.
constexpr double longest_neck_widths = 2;

// How far around narrow parts joints reach: discs that fit where no wall does are smaller, and so are all those of what
// is cut off them by the mitred corners of the walls' flanks.
constexpr double joint_widths = 2;

// How far within a wall's flank strands end, as a share of the wall's width: where a rib leaves it, the wall comes to a
// corner that points into the rib, and this much of the strand makes up for the notches beside it.
constexpr double joint_overlap_share = 0.1;

class WallMaker {
public:
    WallMaker(Region outline, const WallRequest& request)
        : request_(request),
          base_(outline.begin(), outline.end()),
          spacing_mm_(line_spacing_mm(request.width_mm, request.overlap * request.height_mm)) {}

    Walls make() {
        inner_.resize(request_.count + 1);
        if (!request_.thin_walls && request_.count > 0 && !base_.empty())
            walls_.left_out_mm2 = walls_.too_thin_mm2 = std::max(0.0, unreached_mm2(base_, 0));
        for (std::uint32_t depth = 0; depth < request_.count && !base_.empty(); ++depth) {
            const bool leaves_gap = !is_whole(depth) && separate_narrow(depth);
            if (leaves_gap && depth > 0) fit(depth - 1);
            // Further in there is nothing either.
            if (inner(depth).empty()) return std::move(walls_);
            add(inner(depth), depth);
            const bool is_near = request_.solid && request_.gap_fill && is_beside_itself_;
            if (is_near || loses_strip(depth)) fit(depth);
        }
        walls_.inside = inner(request_.count);
        if (request_.gap_fill && request_.count > 0) fill_strips();
        return std::move(walls_);
    }

private:
    // From the outline: of a wall, or after the last one of what it leaves.
    double middle_mm(std::uint32_t depth) const {
        const double middle = request_.width_mm / 2 + depth * spacing_mm_;
        if (depth < request_.count) return middle;
        return depth == 0 ? 0 : middle - spacing_mm_ / 2;
    }

    double limit(std::uint32_t depth) const {
        return depth == 0 || request_.solid ? tip_limit : mitre_limit;
    }

    // What lies that deep, made when it is asked for. Stays where it is.
    const std::vector<Contour>& inner(std::uint32_t depth) {
        std::optional<std::vector<Contour>>& found = inner_[depth];
        if (!found) found = shrunk(middle_mm(depth));
        return *found;
    }

    // From the wall's middle to the flank that it has in common with the one before, or to the outline.
    double outwards_mm(std::uint32_t depth) const {
        return depth == 0 ? request_.width_mm / 2 : spacing_mm_ / 2;
    }

    // What the walls before leave. Stays where it is until another depth's is asked for.
    const std::vector<Contour>& outer(std::uint32_t depth) {
        if (depth == 0) return base_;
        if (!outer_ || outer_depth_ != depth)
            outer_ = shrunk(middle_mm(depth) - outwards_mm(depth));
        outer_depth_ = depth;
        return *outer_;
    }

    // Whether the wall needs no narrow parts taken off it, or none are to be.
    bool is_whole(std::uint32_t depth) {
        is_beside_itself_ = true;
        if (!(depth == 0 ? request_.thin_walls : request_.gap_fill)) return true;
        const std::vector<Contour>& before = depth == 0 ? base_ : inner(depth - 1);
        const double before_mm = depth == 0 ? 0 : middle_mm(depth - 1);
        const bool reaches = is_even(before, inner(depth), middle_mm(depth) - before_mm) &&
                             !has_sharp_tip(before, limit(depth));
        if (reaches &&
            is_even(inner(depth), inner(depth + 1), middle_mm(depth + 1) - middle_mm(depth))) {
            is_beside_itself_ = false;
            return true;
        }
        return !is_small(inner(depth)) && !is_narrow(depth) &&
               (reaches || is_reached(outer(depth), depth));
    }

    // Contours that lie around material, and the area of all.
    struct Extent {
        double area_mm2 = 0;
        std::ptrdiff_t outer = 0;
    };

    static Extent extent_of(Region region) {
        Extent extent;
        for (const Contour& contour : region) {
            const double area = lyr::area_mm2(contour);
            extent.area_mm2 += area;
            extent.outer += area > 0;
        }
        return extent;
    }

    // Where a neck or a web is too narrow for a wall, there is a part more or a hole less.
    static bool has_same_parts(Region a, Region b) {
        return a.size() == b.size() && extent_of(a).outer == extent_of(b).outer;
    }

    // Whether a wall is all around what the walls before leave. Gaps between walls may be cut in two.
    static bool goes_around(Region outside, Region wall, std::uint32_t depth) {
        return depth == 0 ? has_same_parts(outside, wall) : wall.size() >= outside.size();
    }

    // Whether the boundaries at two distances are what an even change leads to from one to the other.
    static bool is_even(Region outer, Region inner, double distance_mm) {
        if (outer.size() != inner.size()) return false;
        const Extent out = extent_of(outer), in = extent_of(inner);
        if (out.outer != in.outer) return false;
        const double between = out.area_mm2 - in.area_mm2;
        const double expected = distance_mm * (length_mm(outer) + length_mm(inner)) / 2;
        return std::abs(between - expected) <= unseen_mm * unseen_mm;
    }

    // Whether a wall may be smaller than itself: a region has discs as large as its area over its length at least.
    bool is_small(Region wall) const {
        const double radius_mm = least_space_share * spacing_mm_ / 2;
        return std::any_of(wall.begin(), wall.end(), [&](const Contour& contour) {
            const double area = lyr::area_mm2(contour);
            return area > 0 && area < radius_mm * lyr::length_mm(contour);
        });
    }

    // Of the direction before and behind the corners to the left. Smooth ones cost a comparison.
    static bool has_sharp_tip(Region region, double limit) {
        const double bluntest_cosine = -std::cos(2 * std::asin(1 / limit));
        return std::any_of(region.begin(), region.end(), [&](const Contour& contour) {
            const auto* path = std::get_if<Path>(&contour);
            if (!path || path->segments.empty()) return false;
            const std::size_t count = path->segments.size();
            Point2 from = path->start;
            Vector2 before = end_tangent(count > 1 ? path->segments[count - 2].end : path->start,
                                         path->segments.back());
            for (const Segment& segment : path->segments) {
                const Vector2 after = start_tangent(from, segment);
                if (before.dot(after) < bluntest_cosine && cross(before, after) > 0) return true;
                before = end_tangent(from, segment);
                from = segment.end;
            }
            return false;
        });
    }

    // Whether the wall's sides are near each other along more than is left alone.
    bool is_narrow(std::uint32_t depth) {
        const Boundary boundary(inner(depth));
        const auto between_mm2 = [&](double apart_mm) {
            return narrow_mm2(boundary, apart_mm, limit(depth));
        };
        // Of what lies between them, a third is filled twice at most.
        const double beside_mm2 = between_mm2(most_apart_mm());
        is_beside_itself_ = beside_mm2 > 3 * unseen_mm * unseen_mm;
        return beside_mm2 > unseen_mm * unseen_mm &&
               between_mm2(least_space_share * spacing_mm_) > unseen_mm * unseen_mm;
    }

    // How much of a region is outside of what lies within it and a flank around that.
    static double unreached_mm2(Region outside, Region within, double flank_mm, double mitred_mm) {
        return area_mm2(outside) - area_mm2(within) -
               strip_mm2(Boundary(within), flank_mm, mitred_mm);
    }

    // The same of what the walls before leave, and the wall as it is.
    double unreached_mm2(Region outside, std::uint32_t depth) {
        const double flank_mm = outwards_mm(depth);
        return unreached_mm2(outside, inner(depth), flank_mm, limit(depth) * flank_mm);
    }

    // What has no wall at all may be small, and still is a part that would be missed.
    bool is_reached(Region outside, std::uint32_t depth) {
        return goes_around(outside, inner(depth), depth) &&
               unreached_mm2(outside, depth) <= unseen_mm * unseen_mm;
    }

    std::vector<Contour> offset_by(const BoundedRegion& region, double distance_mm, Corner corner,
                                   double limit = mitre_limit, const CornersOf* mitred = nullptr) {
        if (region.contours.empty()) return {};
        OffsetResult result = offset(region, {.distance_mm = distance_mm,
                                              .allowed_mm = request_.allowed_mm,
                                              .corner = corner,
                                              .mitre_limit = limit,
                                              .mitred = mitred});
        walls_.second_method += result.second_method;
        walls_.unresolved += result.unresolved.has_value();
        return std::move(result.contours);
    }

    const BoundedRegion& bounded() {
        if (!bounded_) bounded_.emplace(base_);
        return *bounded_;
    }

    // By a distance from the outline.
    std::vector<Contour> shrunk(double distance_mm) {
        if (distance_mm == base_mm_) return base_;
        return offset_by(bounded(), base_mm_ - distance_mm, request_.corner);
    }

    // What lies that deep made larger. Corners of the outermost wall are mitred, but not where it points into what is narrow;
    // between walls, mitres leave fewer and shorter gaps.
    std::vector<Contour> grown(Region inner, std::uint32_t depth, double inside_mm,
                               double distance_mm) {
        const CornersOf corners{bounded().boundary, inside_mm - base_mm_};
        return offset_by(BoundedRegion(inner), distance_mm, Corner::mitre, limit(depth),
                         depth == 0 ? &corners : nullptr);
    }

    // Walls from here on are offsets of this one.
    void set_base(std::vector<Contour> wall, std::uint32_t depth) {
        base_ = std::move(wall);
        base_mm_ = middle_mm(depth);
        bounded_.reset();
        outer_.reset();
        std::fill(inner_.begin() + depth, inner_.end(), std::nullopt);
    }

    std::vector<Contour> operated(Region a, Region b, Operation operation) {
        RegionResult result = combined(a, b, operation, request_.allowed_mm);
        walls_.unresolved += result.unresolved;
        return std::move(result.contours);
    }

    void add(const std::vector<Contour>& contours, std::uint32_t depth) {
        for (const Contour& contour : contours) {
            walls_.strands.push_back({contour, request_.width_mm});
            walls_.depths.push_back(depth);
        }
    }

    // Nearer than what is cut are walls in short necks only. In sparse parts these overlap.
    double least_apart_mm() const {
        return request_.solid ? spacing_mm_ - 2 * (request_.width_mm - request_.min_width_mm)
                              : least_space_share * spacing_mm_;
    }

    // How far apart opposite walls may be that have no line between them.
    double most_apart_mm() const { return spacing_mm_ + request_.min_gap_mm; }

    // The width of a strip is twice its area over the length of its boundary, that of anything else is more.
    static bool is_strip(double area_mm2, double length_mm, double width_mm) {
        return 2 * area_mm2 <= width_mm * length_mm;
    }

    static bool is_strip(Region part, double width_mm) {
        return is_strip(area_mm2(part), lyr::length_mm(part), width_mm);
    }

    // Whether a part of the region is one. Which part a hole is in is only asked where it matters.
    static bool has_strip(Region region, double width_mm) {
        double holes_mm2 = 0, holes_mm = 0;
        std::vector<std::pair<double, double>> outer;  // areas and lengths
        for (const Contour& contour : region) {
            const double area = lyr::area_mm2(contour), length = lyr::length_mm(contour);
            if (area > 0) {
                outer.push_back({area, length});
            } else {
                holes_mm2 -= area;
                holes_mm += length;
            }
        }
        const bool may_be = std::any_of(outer.begin(), outer.end(), [&](const auto& part) {
            return is_strip(part.first - holes_mm2, part.second + holes_mm, width_mm);
        });
        if (!may_be || outer.size() == 1 || outer.size() == region.size()) return may_be;
        const auto parts = parts_of(region);
        return std::any_of(parts.begin(), parts.end(),
                           [&](const auto& part) { return is_strip(part, width_mm); });
    }

    // Whether a part of the wall is but two walls side by side, and nothing is further in.
    bool loses_strip(std::uint32_t depth) {
        return request_.gap_fill && inner(depth + 1).size() < inner(depth).size() &&
               has_strip(inner(depth), most_apart_mm());
    }

    // What the innermost walls leave and is no wider than a line: these are made wider, or it is a gap.
    void fill_strips() {
        if (!has_strip(walls_.inside, spacing_mm_)) return;
        std::vector<Contour> rest;
        for (const std::vector<Contour>& part : parts_of(walls_.inside)) {
            const bool is_fitted = is_strip(part, request_.min_gap_mm);
            if (is_fitted) fit(request_.count - 1);
            auto& list = is_strip(part, spacing_mm_) && !is_fitted ? walls_.gaps : rest;
            list.insert(list.end(), part.begin(), part.end());
        }
        walls_.inside = std::move(rest);
    }

    void fit(std::uint32_t depth) {
        if (fitted_ > depth) return;
        fitted_ = depth + 1;
        const auto first = std::lower_bound(walls_.depths.begin(), walls_.depths.end(), depth);
        const auto last = std::upper_bound(first, walls_.depths.end(), depth);
        fit_side_by_side(std::span(walls_.strands)
                             .subspan(static_cast<std::size_t>(first - walls_.depths.begin()),
                                      static_cast<std::size_t>(last - first)),
                         {.spacing_mm = spacing_mm_,
                          .least_mm = least_apart_mm(),
                          .greatest_mm = most_apart_mm()});
    }

    // Takes off a wall where its opposite sides are too near each other, and lists what it does not cover. Whether something
    // is left out that is too narrow for a line.
    bool separate_narrow(std::uint32_t depth) {
        const std::vector<Contour>& outside = outer(depth);
        std::vector<Contour> wall = inner(depth);
        const bool is_around = goes_around(outside, wall, depth);
        std::vector<Contour> wide =
            with_short_necks(wall, wide_parts(wall, depth, depth > 0 || is_around));
        const bool is_cut = wide.size() < wall.size() || !is_around ||
                            area_mm2(wall) - area_mm2(wide) > unseen_mm * unseen_mm;
        if (!is_cut && is_reached(outside, depth)) return false;
        if (is_cut) wall = std::move(wide);
        const std::vector<Contour> covered =
            grown(wall, depth, middle_mm(depth), outwards_mm(depth));
        // Else only edges have vanished.
        if (!is_cut && goes_around(outside, covered, depth) &&
            area_mm2(outside) - area_mm2(covered) <= unseen_mm * unseen_mm)
            return false;
        const bool leaves_gap = add_narrow(outside, covered, depth);
        if (!wall.empty()) add_joint(outside, wall, depth);
        set_base(std::move(wall), depth);
        return leaves_gap;
    }

    // The parts of a wall whose opposite sides are far enough from each other.
    std::vector<Contour> wide_parts(Region wall, std::uint32_t depth, bool may_be_all) {
        const double half_mm = least_space_share * spacing_mm_ / 2;
        const double margin_mm = cut_margin_share * request_.width_mm;
        const double inside_mm = middle_mm(depth) + half_mm;
        const std::vector<Contour> core = shrunk(inside_mm);
        // Of outermost walls not all corners are mitred.
        const double mitred_mm = depth == 0 ? 0 : limit(depth) * half_mm;
        if (may_be_all && has_same_parts(wall, core) &&
            unreached_mm2(wall, core, half_mm, mitred_mm) <= unseen_mm * unseen_mm)
            return {wall.begin(), wall.end()};
        const std::vector<Contour> wide = grown(core, depth, inside_mm, half_mm + margin_mm);
        if (wide.empty()) return {};
        return operated(wall, wide, Operation::intersect);
    }

    // Between the flanks of two ends that are less than two lines apart there is no room for a strand: rather than a gap
    // they leave, two walls beside each other go through.
    std::vector<Contour> with_short_necks(Region wall, std::vector<Contour> wide) {
        if (wide.empty() || has_same_parts(wall, wide)) return wide;
        const Boundary flanks(wall);
        // Half of what is around a neck: its length, and across at each end.
        const double longest_mm =
            longest_neck_widths * request_.width_mm + least_space_share * spacing_mm_;
        std::vector<Contour> necks;
        for (const auto& part : parts_of(operated(wall, wide, Operation::subtract)))
            if (lyr::length_mm(part) <= 2 * longest_mm &&
                sides_on(part, flanks, request_.allowed_mm) >= 2)
                necks.insert(necks.end(), part.begin(), part.end());
        return necks.empty() ? wide : operated(wide, necks, Operation::unite);
    }

    // What of `outer` a wall and its flanks do not cover, if a line fits into it. Whether anything else is more than is
    // left alone.
    bool add_narrow(Region outer, Region covered, std::uint32_t depth) {
        const std::vector<Contour> rest = covered.empty()
                                              ? std::vector<Contour>(outer.begin(), outer.end())
                                              : operated(outer, covered, Operation::subtract);
        const double least_mm = depth == 0 ? request_.min_width_mm : request_.min_gap_mm;
        // What is as wide as that but for what is allowed would vanish.
        const double half_mm = std::max(least_mm / 4, least_mm / 2 - request_.allowed_mm);
        const BoundedRegion bounded_rest(rest);
        const std::vector<Contour> fit = offset_by(bounded_rest, -half_mm, Corner::round);
        const CornersOf corners{bounded_rest.boundary, half_mm};
        const std::vector<Contour> opened =
            offset_by(BoundedRegion(fit), half_mm, Corner::mitre, limit(depth),
                      depth == 0 ? &corners : nullptr);
        const std::vector<Contour> narrow =
            opened.empty() ? opened : operated(opened, rest, Operation::intersect);
        const double left_out_mm2 = area_mm2(rest) - area_mm2(narrow);
        walls_.left_out_mm2 += left_out_mm2;
        const bool is_seen = left_out_mm2 > unseen_mm * unseen_mm;
        if (depth == 0) {
            walls_.too_thin_mm2 =
                is_seen ? beyond_mm2(rest, covered) - beyond_mm2(narrow, covered) : left_out_mm2;
            walls_.lost_web = lost_web(rest, narrow, bounded().boundary,
                                       {request_.min_width_mm, request_.allowed_mm});
        }
        auto& list = depth == 0 ? walls_.thin : walls_.gaps;
        list.insert(list.end(), narrow.begin(), narrow.end());
        return is_seen;
    }

    // Without the notches beside corners of walls that point into it: strands that end there cover these.
    double beyond_mm2(Region rest, Region covered) {
        if (covered.empty() || rest.empty()) return area_mm2(rest);
        const std::vector<Contour> beside =
            offset_by(BoundedRegion(covered), request_.min_width_mm, Corner::round);
        return area_mm2(operated(rest, beside, Operation::subtract));
    }

    // Where the narrow parts that a wall leaves of `outer` go over into it.
    void add_joint(Region outer, Region wall, std::uint32_t depth) {
        const std::vector<Contour>& narrow = depth == 0 ? walls_.thin : walls_.gaps;
        if (narrow.empty()) return;
        const std::vector<Contour> near =
            offset_by(BoundedRegion(narrow), joint_widths * request_.width_mm, Corner::mitre);
        const double end_mm = outwards_mm(depth) - joint_overlap_share * request_.width_mm;
        auto& list = depth == 0 ? walls_.thin_joints : walls_.gap_joints;
        list.push_back({operated(outer, near, Operation::intersect),
                        offset_by(BoundedRegion(wall), end_mm, Corner::round)});
    }

    WallRequest request_;
    // What walls are offsets of: the outline, or the last wall that was cut, and its distance from the outline.
    std::vector<Contour> base_;
    double base_mm_ = 0;
    std::optional<BoundedRegion> bounded_;
    double spacing_mm_;
    bool is_beside_itself_ = false;  // the wall that was looked at last has sides side by side
    std::uint32_t fitted_ = 0;       // the walls outside of this depth need not be fitted again
    std::vector<std::optional<std::vector<Contour>>> inner_;  // by depth
    std::optional<std::vector<Contour>> outer_;               // of that depth
    std::uint32_t outer_depth_ = 0;
    Walls walls_;
};

}  // namespace

Walls walls(Region outline, const WallRequest& request) {
    return WallMaker(outline, request).make();
}

}  // namespace lyr
