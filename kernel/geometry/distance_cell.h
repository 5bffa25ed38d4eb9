// Parts of a Bezier patch and how far they are from a point.

#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "kernel/geometry/bspline_jet.h"

namespace lyr {

// A part of a Bezier patch, in homogeneous coordinates about the point in question.
struct Cell {
    Window window = {Point2::Zero(), Point2::Zero()};
    std::vector<Eigen::Vector4d> points = {};
};

Cell cell_about(BezierPatch patch, const Point3& point);

// At the middle of one parameter (0: u, 1: v).
std::pair<Cell, Cell> halves(Cell cell, int degree_u, int degree_v, int along);

double box_distance_mm(const Cell& cell);

// The squared distance along a cell in Bernstein form, of twice the degrees: numerator and squared weight.
class DistanceForm {
public:
    DistanceForm(const Cell& cell, int degree_u, int degree_v);

    // No point of the cell is nearer; the error falls with the square of the cell's size.
    double lower_bound_mm() const;

    // Whether the numerator is convex: where weights are one, the squared distance.
    bool is_convex() const;

    bool varies_more_along_u() const;

private:
    std::size_t size_u_, size_v_;
    std::vector<double> numerator_, weight_;
};

}  // namespace lyr
