// Where in a layer too little or too much is laid down: what its section asks for, and what strands lay.
//
// Contract
//  1. A square is bare if all of it is asked for and no strand, round at its ends and corners, lies in it. Spots are bare
//     squares side by side.
//  2. Around every place, asked and laid are summed up.
//
// Cost: the squares, and what is laid, its length and width in squares.

#pragma once

#include <cstdint>
#include <vector>

#include "kernel/region/curve.h"
#include "kernel/toolpath/hatch_runs.h"
#include "kernel/toolpath/strand.h"

namespace lyr::slicer {

class MaterialMap {
public:
    // Runs are as wide as that.
    MaterialMap(const region::Box2& box, double run_width_mm);

    // What has a share of -1 is taken away again.
    void ask_for(Region region, double share);
    // So much of the width is not laid, as neighbours lap over it.
    void lay(const Strand& strand, double lapped_mm, double flow);
    void lay(const HatchRun& run, double lapped_mm, double flow);

    struct Spot {
        double area_mm2 = 0;
        Point2 at = Point2::Zero();
    };
    Spot largest_bare() const;
    // Where the most is missing, or the most is too much.
    Point2 most_missing() const { return most(1); }
    Point2 most_surplus() const { return most(-1); }

private:
    enum Mark : std::uint8_t { asked = 1, laid = 2 };
    // Of squares one beside the other.
    struct Grid {
        Grid(const region::Box2& box, double least_edge_mm, double most_squares);
        std::size_t at(const Point2& point) const;
        Point2 middle(std::size_t square) const;

        double edge_mm;
        Point2 corner;
        std::size_t columns, rows;
    };
    // As much of the width is laid.
    void lay_line(const Point2& from, const Segment& segment, double width_mm, double laid_mm);
    void lay_disc(const Point2& middle, double width_mm);
    Point2 most(double sign) const;

    double run_width_mm_;
    Grid fine_, coarse_;
    std::vector<std::uint8_t> marks_;  // of fine squares
    std::vector<double> missing_mm2_;  // of coarse ones
};

}  // namespace lyr::slicer
