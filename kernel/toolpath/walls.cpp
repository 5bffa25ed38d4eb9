// As long as a boundary that moves inwards loses no edge and meets no other part of itself, its length changes evenly
// with the distance; so the area between two distances is their difference times the mean of the lengths. Where it is
// not, something is narrow: then, and only then, each wall is compared with what is wide enough for it.

#include "kernel/toolpath/walls.h"

#include <cmath>

#include "kernel/toolpath/infill.h"

namespace lyr {
namespace {

// Walls closer to their own opposite side than this share of their spacing overlap too much.
constexpr double least_space_share = 0.75;

// Area that is filled twice or not at all and not looked into, of a wall of a layer: a square of this edge.
constexpr double unseen_mm = 0.25;

// Corners as sharp as two fifths of a radian are wide enough: beyond, a nozzle cannot tell the tip from a line.
constexpr double mitre_limit = 5;

// By how much parts that are wide enough are cut wider than they are, so that their own boundary is left as it is; a
// share of the width.
constexpr double cut_margin_share = 0.05;

class WallMaker {
public:
    WallMaker(Region outline, const WallRequest& request)
        : request_(request),
          base_(outline.begin(), outline.end()),
          spacing_mm_(line_spacing_mm(request.width_mm, request.overlap * request.height_mm)) {}

    Walls make() {
        walls_.inside = base_;
        if (request_.count == 0) return std::move(walls_);
        const double last_mm = middle_mm(request_.count - 1);
        walls_.inside = shrunk(last_mm + spacing_mm_ / 2);
        const bool is_plain = is_even(base_, walls_.inside, last_mm + spacing_mm_ / 2);
        for (std::uint32_t depth = 0; depth < request_.count && !base_.empty(); ++depth)
            is_plain ? add(shrunk(middle_mm(depth)), depth) : add_careful(depth);
        if (!is_plain) walls_.inside = base_.empty() ? base_ : inside_;
        return std::move(walls_);
    }

private:
    double middle_mm(std::uint32_t depth) const {
        return request_.width_mm / 2 + depth * spacing_mm_;
    }

    // Whether the boundaries at two distances are what an even change leads to from one to the other.
    static bool is_even(Region outer, Region inner, double distance_mm) {
        const double between = area_mm2(outer) - area_mm2(inner);
        const double expected = distance_mm * (length_mm(outer) + length_mm(inner)) / 2;
        return std::abs(between - expected) <= unseen_mm * unseen_mm;
    }

    std::vector<Contour> offset_by(Region region, double distance_mm, Corner corner) {
        if (region.empty()) return {};
        OffsetResult result = offset(region, {.distance_mm = distance_mm,
                                              .allowed_mm = request_.allowed_mm,
                                              .corner = corner,
                                              .mitre_limit = mitre_limit});
        walls_.second_method += result.second_method;
        walls_.unresolved += result.unresolved.has_value();
        return std::move(result.contours);
    }

    // By a distance from the outline.
    std::vector<Contour> shrunk(double distance_mm) {
        return offset_by(base_, base_mm_ - distance_mm, request_.corner);
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

    // One wall, without its narrow parts, and what is within it.
    void add_careful(std::uint32_t depth) {
        const double middle = middle_mm(depth);
        const double outer_mm = depth == 0 ? 0 : middle - spacing_mm_ / 2;
        const std::vector<Contour> outer = depth == 0 ? base_ : inside_;
        std::vector<Contour> wall = shrunk(middle);
        // make() has found it already, unless a wall was cut since.
        const bool is_known = depth + 1 == request_.count && base_mm_ == 0;
        std::vector<Contour> inner = is_known ? walls_.inside : shrunk(middle + spacing_mm_ / 2);
        const bool is_wanted = depth == 0 ? request_.thin_walls : request_.gap_fill;
        if (is_wanted && !is_even(outer, inner, middle + spacing_mm_ / 2 - outer_mm)) {
            std::vector<Contour> wide = wide_parts(wall, middle);
            const bool is_cut = area_mm2(wall) - area_mm2(wide) > unseen_mm * unseen_mm;
            if (is_cut) wall = std::move(wide);
            const std::vector<Contour> covered = offset_by(wall, middle - outer_mm, Corner::mitre);
            // Else only edges have vanished.
            if (is_cut || area_mm2(outer) - area_mm2(covered) > unseen_mm * unseen_mm) {
                base_ = wall;
                base_mm_ = middle;
                inner = shrunk(middle + spacing_mm_ / 2);
                add_narrow(outer, covered, depth);
            }
        }
        add(wall, depth);
        inside_ = std::move(inner);
    }

    // The parts of a wall whose opposite sides are far enough from each other.
    std::vector<Contour> wide_parts(Region wall, double middle_mm) {
        const double half_mm = least_space_share * spacing_mm_ / 2;
        const std::vector<Contour> kernel = shrunk(middle_mm + half_mm);
        const double margin_mm = cut_margin_share * request_.width_mm;
        const std::vector<Contour> wide = offset_by(kernel, half_mm + margin_mm, Corner::mitre);
        if (wide.empty()) return {};
        return operated(wall, wide, Operation::intersect);
    }

    // What of `outer` a wall and its flanks do not cover, if a line fits into it.
    void add_narrow(Region outer, Region covered, std::uint32_t depth) {
        const std::vector<Contour> rest = covered.empty()
                                              ? std::vector<Contour>(outer.begin(), outer.end())
                                              : operated(outer, covered, Operation::subtract);
        const double half_mm = request_.min_width_mm / 2;
        const std::vector<Contour> fit = offset_by(rest, -half_mm, Corner::round);
        const std::vector<Contour> opened = offset_by(fit, half_mm, Corner::mitre);
        const std::vector<Contour> narrow =
            opened.empty() ? opened : operated(opened, rest, Operation::intersect);
        walls_.left_out_mm2 += area_mm2(rest) - area_mm2(narrow);
        auto& list = depth == 0 ? walls_.thin : walls_.gaps;
        list.insert(list.end(), narrow.begin(), narrow.end());
    }

    WallRequest request_;
    std::vector<Contour>
        base_;            // what walls are offsets of: the outline, or the last wall that was cut
    double base_mm_ = 0;  // its distance from the outline
    double spacing_mm_;
    std::vector<Contour>
        inside_;  // what the last wall leaves, where walls are looked at one by one
    Walls walls_;
};

}  // namespace

Walls walls(Region outline, const WallRequest& request) {
    return WallMaker(outline, request).make();
}

}  // namespace lyr
