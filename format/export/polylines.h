// Motions of a layer as polylines, for formats that have no arcs.
//
// Contract
//  1. Motions that extrude and go on from each other with one kind of role are one polyline; walls of all kinds are one
//     kind. Lines of a hatch are pairs of points each.
//  2. Ends of motions are points of it, exactly; an arc is followed within the tolerance by as few chords as that takes, all
//     alike.
//  3. A polyline is closed if it ends where it began; the point is then in it once. A wall whose ends are less than its
//     width apart is closed too: that is the gap other slicers leave at a seam.

#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "format/operation.h"

namespace lyr::format {

using PlanePoint = std::array<double, 2>;  // mm

struct Polyline {
    Role role = Role::other;
    double width_mm = 0;  // at its beginning
    bool hatch = false;   // pairs of points
    bool closed = false;
    std::vector<PlanePoint> points{};
};

struct PlaneBox {
    PlanePoint low{1, 1}, high{0, 0};

    bool empty() const { return low[0] > high[0]; }
    void add(const PlanePoint& point, double around_mm = 0) {
        const bool first = empty();
        for (std::size_t i = 0; i < point.size(); ++i) {
            low[i] = first ? point[i] - around_mm : std::min(low[i], point[i] - around_mm);
            high[i] = first ? point[i] + around_mm : std::max(high[i], point[i] + around_mm);
        }
    }
};

// Signed: positive if it turns counter-clockwise.
double area_mm2(const std::vector<PlanePoint>& closed);

class PolylineCollector {
public:
    PolylineCollector(Quantum quantum, double tolerance_mm)
        : quantum_(quantum), tolerance_mm_(tolerance_mm) {}

    void take(const Operation& operation, const PathStyle& style);
    // All since the last call.
    std::vector<Polyline> finish();

private:
    PlanePoint in_mm(const Point& point) const;
    Polyline& open(const Point& from, const PathStyle& style, bool hatch);
    void turn(double center_x, double center_y, const Point& from, double sweep_rad,
              const Point& to, const PathStyle& style);
    void close();

    Quantum quantum_;
    double tolerance_mm_;
    std::vector<Polyline> done_{};
    bool drawing_ = false;
    Point begin_{}, at_{};
};

}  // namespace lyr::format
