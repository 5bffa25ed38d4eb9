// The loops of a face as points, and as steps in its surface's parameters.
//
// Contract
//  1. An edge that the face uses in both directions, a seam, bounds nothing and is left out.
//  2. Points of an edge lie so close that no two neighbours are an eighth of a turn apart.

#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "kernel/brep/model.h"

namespace lyr {

// The face's coedges in order, without seams.
std::vector<Coedge> bounding_coedges(const Model& model, const Face& face);

// Into how many equal steps of its parameter an edge is cut.
int outline_steps(const Edge& edge);

// The beginnings of `steps` equal steps, in the coedge's direction.
void append_outline(const Edge& edge, bool reversed, int steps, std::vector<Point3>& points);

// An apex or a pole: all values of one parameter, `free`, are the same point.
struct Pole {
    Point3 point;
    Eigen::Index free;
};

// Of a cone or a free-form surface.
std::vector<Pole> poles_of(const Surface& surface);

// The one that the point is; null: none.
const Pole* pole_at(const std::vector<Pole>& poles, const Point3& point);

// Of points that follow each other closely. At one of the poles given, the free parameter is any.
std::vector<Point2> parameters_along(const Surface& surface, const std::vector<Point3>& points,
                                     const std::vector<Pole>& poles = {});

// Of each parameter; 0: the surface is not closed that way.
std::array<double, 2> parameter_periods(const Surface& surface);

// The shorter of the two ways round.
inline double short_way(double difference, double period) {
    return period > 0 ? difference - period * std::round(difference / period) : difference;
}

}  // namespace lyr
