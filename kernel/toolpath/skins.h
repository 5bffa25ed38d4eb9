// What of a layer's inside is solid because a layer near above or below does not cover it, and what is sparse.
//
// A layer has an outline (its section) and an inside (what is left within its walls). It is solid where one of the
// `top_layers` above it or of the `bottom_layers` below it has no material; above and below the part there is none. Of
// that, the bottom skin is what lies on the bed, a bridge what the next layer below does not hold, the top skin what the
// next one above leaves bare, the rest is solid fill.
//
// Contract
//  1. Top, bottom, bridge, solid and sparse are regions of their own that do not overlap; together they are the
//     inside, within `allowed_mm` of their boundaries. What is no wider than that is left out and counted.
//  2. What a layer of the window leaves bare is solid where a disc of the width of a line fits into it; what is narrower,
//     only where that is the neighbour of something wider. Rows half a width apart tell which layers are to be asked: one
//     that leaves bare, on each row, less than an eighth of a width more than others do is not.
//  3. Solid parts, bridges and top skins reach one width over what has to be solid, within the inside: there they are
//     anchored. Where they would overlap, a bridge comes before a top skin, and that before solid fill.
//  4. Parts of the sparse fill that are smaller than `min_sparse_mm2`, or narrower than a line taken over their length,
//     are solid.
//  5. Where an operation on regions could not be settled, or numbers are not finite or out of range, the whole layer is
//     solid, and counted as unresolved.
//  6. The result depends on the outlines of the window and on the inside, so layers can be made in any order and on any
//     number of threads.
//
// Cost: what the rows of the window say (row_cover.h), if the outlines are not the same bit for bit. Regions are only
// worked out where the rows say that there is something wide enough, and against those outlines only that leave it bare.

#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kernel/region/region.h"
#include "kernel/toolpath/row_cover.h"

namespace lyr {

struct SkinRequest {
    std::size_t top_layers = 5, bottom_layers = 4;
    double width_mm = 0.45;  // of a line
    double min_sparse_mm2 = 0;
    double allowed_mm = 0;
};

// A layer's outline as the layers around it see it.
class SkinOutline {
public:
    // Of the rows, for lines of a width.
    static double pitch_mm(double width_mm) { return width_mm / 2; }

    SkinOutline() = default;
    // The contours have the material on the left, wind around no point more than once, and outlive this.
    SkinOutline(Region region, double width_mm);

    Region region() const { return region_; }
    const RowCover& rows() const { return rows_; }
    bool is_finite() const { return finite_; }

private:
    Region region_{};
    RowCover rows_{};
    bool finite_ = true;
};

// Whether a disc of this diameter may lie in a layer and not in another (RowCover, contract 3); both were made for the width.
bool may_leave_bare(const SkinOutline& layer, const SkinOutline& other, double width_mm,
                    double diameter_mm);

struct LayerSkins {
    std::vector<Contour> top{}, bottom{}, bridge{}, solid{}, sparse{};
    std::vector<Contour> internal_bridge{};  // none from skins_of(): see internal_bridges.h
    std::size_t slivers = 0;                 // left out
    std::size_t unresolved = 0;
};

// `outlines` are those of all layers from the bed upwards, made for the request's width; only those of the window around
// `layer` are looked at. `inside` is within the layer's own outline.
LayerSkins skins_of(std::span<const SkinOutline> outlines, std::size_t layer, Region inside,
                    const SkinRequest& request);

}  // namespace lyr
