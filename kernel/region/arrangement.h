// Contours as a plane graph: vertices, and edges between them that meet nowhere else.
//
// Contract
//  1. Vertices are more than half of `snap_mm` apart and in the sweep's order: rising y, then rising x. An end of a
//     contour's segment is a vertex where no other is so near.
//  2. A curve passes through the vertices that are within `snap_mm` beside it; of some that lie side by side, through the
//     nearest and those where it meets another curve. So a vertex is an edge's end or farther from it than round-off can
//     tell wrong.
//  3. Edges between the same vertices whose sagittas differ by no more than `snap_mm` are one; its change is the sum.
//     An edge over which no winding changes is none.
//  4. Every vertex is left as often as it is reached, for each operand by itself: what is closed stays closed.
//  5. Bending to its vertices an edge may come to cross another. A sweep finds out; refined() makes it a vertex.

#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "kernel/region/curve.h"

namespace lyr::region {

// How often each operand winds around a point; most operations have one or two.
struct Winding {
    int a = 0, b = 0;
    friend bool operator==(const Winding&, const Winding&) = default;
    Winding operator+(const Winding& other) const { return {a + other.a, b + other.b}; }
    Winding operator-(const Winding& other) const { return {a - other.a, b - other.b}; }
};

struct Input {
    const Contour* contour;
    Winding weight{1, 0};  // of its inside
};

inline constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// From its lower to its higher vertex.
struct Edge {
    std::uint32_t low, high;
    double sagitta_mm;
    double sweep_rad;
    Winding change;        // of the windings, from its left to its right
    std::uint32_t source;  // the curve whose shape it has
    bool along;            // whether that curve runs from low to high
};

// A curve of a contour, cut off the segment it belongs to.
struct Source {
    Curve curve;
    std::uint32_t contour, segment;
};

std::vector<Source> sources_of(std::span<const Input> inputs);

struct Arrangement {
    std::vector<Point2> vertices{};
    std::vector<Source> sources{};
    std::vector<Edge> edges{};           // by low vertex
    std::vector<std::uint32_t> steps{};  // by contour: how many edges it runs along
};

// Vertices are kept apart by this share of the snap; a meeting that moves to one is still within the snap of both
// curves.
inline constexpr double vertex_share = 0.5;

Edge turned_round(const Edge& edge);
Curve shape_of(const Edge& edge, const std::vector<Point2>& vertices);

// From vertices and edges in any order and direction to what the contract says.
void finish(const std::vector<Point2>& vertices, double snap_mm, Arrangement& arrangement);

Arrangement arranged(std::span<const Input> inputs, double snap_mm);

// A point that two edges of an arrangement have in common: what a sweep found.
struct Contact {
    Point2 point;
    std::uint32_t edge_a, edge_b;
};

// The same arrangement with these points as vertices of these edges.
Arrangement refined(const Arrangement& arrangement, std::span<const Contact> contacts,
                    double snap_mm);

}  // namespace lyr::region
