// Each corner is moved to where its two sides meet when they are moved by half of the width. A wall was made by moving the
// outline inwards; where that rounded a corner off, the way back makes its chords so short that they round to a point.

#include "format/export/slice_outline.h"

#include <algorithm>
#include <cmath>

namespace lyr::format {
namespace {

// Sharper corners are cut off there, in half widths: as far out as those of a square.
constexpr double longest_mitre = 1.5;

bool is_within(const PlanePoint& p, const std::vector<PlanePoint>& polygon) {
    bool within = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const PlanePoint &a = polygon[i], &b = polygon[j];
        if ((a[1] > p[1]) != (b[1] > p[1]) &&
            p[0] < (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]) + a[0])
            within = !within;
    }
    return within;
}

// To the right of each side: away from material that lies on the left.
std::vector<PlanePoint> moved_outwards(const std::vector<PlanePoint>& polygon, double distance_mm) {
    std::vector<PlanePoint> sides(polygon.size());  // the normals of their sides
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const PlanePoint &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
        sides[i] = {(b[1] - a[1]) / length, -(b[0] - a[0]) / length};
    }
    std::vector<PlanePoint> moved;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const PlanePoint& before = sides[(i + polygon.size() - 1) % polygon.size()];
        const PlanePoint& after = sides[i];
        const double cosine = before[0] * after[0] + before[1] * after[1];
        const double turn = before[0] * after[1] - before[1] * after[0];
        const double reach = std::sqrt(2 / std::max(1e-9, 1 + cosine));
        if (turn > 0 && reach > longest_mitre) {
            for (const PlanePoint* side : {&before, &after})
                moved.push_back({polygon[i][0] + distance_mm * (*side)[0],
                                 polygon[i][1] + distance_mm * (*side)[1]});
            continue;
        }
        const double scale = distance_mm / std::max(1e-9, 1 + cosine);
        moved.push_back({polygon[i][0] + scale * (before[0] + after[0]),
                         polygon[i][1] + scale * (before[1] + after[1])});
    }
    return moved;
}

// To digits, without points that fall together.
std::vector<PlanePoint> rounded(const std::vector<PlanePoint>& polygon, double digit_mm) {
    std::vector<PlanePoint> out;
    for (const PlanePoint& p : polygon) {
        const PlanePoint q{std::round(p[0] / digit_mm) * digit_mm,
                           std::round(p[1] / digit_mm) * digit_mm};
        if (out.empty() || out.back() != q) out.push_back(q);
    }
    while (out.size() > 1 && out.front() == out.back()) out.pop_back();
    return out;
}

}  // namespace

std::vector<std::vector<PlanePoint>> outline_of(std::vector<Polyline> walls, double digit_mm) {
    for (Polyline& wall : walls) wall.points = rounded(wall.points, digit_mm);
    std::erase_if(walls, [](const Polyline& wall) { return wall.points.size() < 3; });
    std::vector<std::vector<PlanePoint>> outline;
    for (std::size_t i = 0; i < walls.size(); ++i) {
        std::size_t around = 0;
        for (std::size_t j = 0; j < walls.size(); ++j)
            if (j != i && is_within(walls[i].points.front(), walls[j].points)) ++around;
        std::vector<PlanePoint> polygon = walls[i].points;
        const bool is_hole = around % 2 == 1;
        if ((area_mm2(polygon) < 0) != is_hole) std::reverse(polygon.begin(), polygon.end());
        polygon = rounded(moved_outwards(polygon, walls[i].width_mm / 2), digit_mm);
        constexpr std::size_t least_points = 3;
        if (polygon.size() >= least_points) outline.push_back(std::move(polygon));
    }
    return outline;
}

}  // namespace lyr::format
