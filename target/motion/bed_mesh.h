// How high the bed is: heights over a grid, bilinear in between, and with the height of the head less and less of them,
// if they are to fade out. The head is lifted by them; what it lays down then follows the bed.
//
// Contract
//  1. lift_mm() is the bilinear interpolation of the heights times what is left of it at that height of the head: all up
//     to z = 0, evenly less from there on, nothing from fade_mm on. Outside of the grid the height is that of the nearest
//     place on its edge. It has no jumps.
//  2. cell_at() gives a cell that contains the place, in whose bounds the lift is one polynomial: the product of a
//     bilinear function of x and y and a linear one of z.
//  3. shape() bounds what the lift does along any path.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "target/motion/path.h"

namespace lyr::motion {

// height + slope_x u + slope_y v + twist u v, with u = x - x_mm and v = y - y_mm; times share + share_slope z.
struct MeshCell {
    std::array<double, 3> low_mm{}, high_mm{};  // in x, y and z; infinite at the rim
    double x_mm = 0, y_mm = 0;
    double height_mm = 0, slope_x = 0, slope_y = 0, twist_per_mm = 0;
    double share = 1, share_slope_per_mm = 0;
};

// The largest sizes: of the slope, of what that changes by for a mm (twist) and at once (kink), and of what is lost of
// the lift for a mm upwards.
struct BedShape {
    double slope = 0, twist_per_mm = 0, kink = 0, fade_slope = 0, fade_per_mm = 0;
};

class BedMesh {
public:
    // `heights_mm` row by row along x, from the lowest y on; at least 2 by 2. Without fading, `fade_mm` is 0.
    BedMesh(const Point& first, const Point& last, std::size_t columns,
            std::vector<double> heights_mm, double fade_mm);

    double lift_mm(const Point& head) const;
    MeshCell cell_at(const Point& head) const;
    const BedShape& shape() const { return shape_; }

private:
    double at(std::size_t column, std::size_t row) const {
        return heights_mm_[row * columns_ + column];
    }
    void measure();

    Point first_;
    double pitch_x_mm_, pitch_y_mm_;
    std::size_t columns_, rows_;
    std::vector<double> heights_mm_;
    double fade_mm_;
    BedShape shape_;
};

}  // namespace lyr::motion
