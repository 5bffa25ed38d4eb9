// Union, intersection and difference of plane regions that are bounded by lines and arcs. No arc becomes a polygon.
//
// A region is a set of closed contours with the material on the left; a point is in it if they wind around it a
// positive number of times.
//
// Contract
//  1. The result's boundary is nowhere farther than `allowed_mm` from the input's. Corners and edges closer than a
//     quarter of it are one: solids that share a wall have none between them.
//  2. Its contours are closed and have the material on the left, whatever the input. No contour passes a point twice:
//     parts that touch in a point are contours that touch.
//  3. Arcs stay arcs of the circles they come from, and are whole again where nothing cuts them. A contour that is left
//     as it was is the input's, bit for bit.
//  4. A contour that the operation made and into which no disc of diameter `sliver_mm` fits (or `allowed_mm`, if that is
//     more) is left out and counted.
//  5. The result depends on the set of contours, not on their order, and is sorted: by the start's y, then its x.
//  6. Every result is checked by means of its own (verify.h, and the area's bounds); one that fails is made again
//     with the plane turned and with another snap. If none passes, the contours are returned as they were given, and
//     `unresolved` says so.
//
// Cost: n log n for n segments and meetings, as long as no curve meets and no height crosses a large part of them.

#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "kernel/contour/contour.h"

namespace lyr {

using Region = std::span<const Contour>;

// Sums over the contours: a region's own area, and how long its boundary is.
double area_mm2(Region region);
double length_mm(Region region);

// In the order of contract 5.
std::vector<Contour> sorted(Region contours);

struct RegionResult {
    std::vector<Contour> contours{};
    bool changed = false;        // false: just the input's contours
    std::size_t slivers = 0;     // left out
    std::size_t unresolved = 0;  // groups of regions that no attempt could settle
};

// What is in any of the regions. Windings are added up: where one region winds the wrong way round, it takes away from
// the others. Regions whose contours' boxes keep clear of all others' are returned as they are.
RegionResult united(std::span<const Region> regions, double allowed_mm, double sliver_mm = 0);

// What the contours wind around a positive number of times, where they cross themselves and each other.
RegionResult cleaned(Region contours, double allowed_mm, double sliver_mm = 0);

enum class Operation { unite, intersect, subtract };

// If unresolved: a's contours.
RegionResult combined(Region a, Region b, Operation operation, double allowed_mm,
                      double sliver_mm = 0);

// Which operands a point is in: bit k for operand k.
using Membership = std::uint32_t;
using Wanted = std::function<bool(Membership)>;  // false of 0
inline constexpr std::size_t most_operands = 8;

// Several regions of the same operands in one go, for little more than the cost of one: for each `wanted`, the points
// whose membership it takes. Where two of them meet, their boundaries have the same corners (what lies on one circle or
// line may be joined in one and not in the other). None if unresolved, or of more than most_operands.
std::optional<std::vector<RegionResult>> overlaid(std::span<const Region> operands,
                                                  std::span<const Wanted> wanted,
                                                  double allowed_mm);

}  // namespace lyr
