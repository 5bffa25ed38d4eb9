// Parts of a surface over rectangles of its parameters, with bounds of their height and flatness (flatness.h).
//
// Contract
//  1. bounds() holds for every point of the cell: heights and flatness lie within. `most` may be more than one, by which
//     a cell that is not close to level is told from one that is.
//  2. halves() together are the cell; they divide along the parameter by which it varies more, in flatness or in height.

#pragma once

#include <array>

#include "kernel/geometry/bernstein_tensor.h"
#include "kernel/geometry/surface.h"

namespace lyr {

struct CellRect {
    Point2 low, high;

    Point2 middle() const { return (low + high) / 2; }
};

struct CellBounds {
    double bottom_mm, top_mm;
    double least, mean, most;  // flatness; `mean` is that of points of the cell
};

enum class CellMeasure { flatness, height };

// Of a leaning cylinder, cone or torus.
class RoundCell {
public:
    struct Interval {
        double low, high;
    };

    RoundCell(const Surface& surface, const CellRect& rect);

    const CellRect& rect() const { return rect_; }
    CellBounds bounds() const;
    std::array<RoundCell, 2> halves(CellMeasure by) const;

private:
    struct Form {
        enum class Kind { cylinder, cone, torus } kind;
        double origin_mm;     // height of the surface's origin
        double lean, rise;    // of the axis: its part across the vertical and along it
        double around_rad;    // where around the axis the surface looks up most
        double radius_mm;     // at the origin; of a torus the ring's
        double tube_mm;       // of a torus
        double sine, cosine;  // of a cone's half angle
    };
    // Bounds, and how wide they are for the cell's extent along either parameter.
    struct Terms {
        Interval normal, height;  // over the origin
        Vector2 normal_varies, height_varies;
    };

    double normal_z(const Point2& uv) const;
    Terms terms() const;

    Form form_;
    CellRect rect_;
};

// Of a free-form surface: one Bezier patch or a part of it.
class PatchCell {
public:
    PatchCell(const BezierPatch& patch, bool is_rational);

    const CellRect& rect() const { return rect_; }
    CellBounds bounds() const;
    std::array<PatchCell, 2> halves(CellMeasure by) const;

private:
    PatchCell() = default;

    CellRect rect_;
    double origin_mm_;
    bernstein::Tensor3 normal_;          // a direction
    bernstein::Tensor height_, weight_;  // the height over the origin is their quotient
};

}  // namespace lyr
