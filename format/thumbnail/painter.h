// Pictures of a print for the displays of printers, from the print's own paths: no model and no triangle.
//
// Contract
//  1. Seen from in front, from one side and from above, in parallel. What is nearer hides what is farther, in
//     whatever order layers come.
//  2. Walls are shaded by the direction they face; what is level is light. Skirts are left out.
//  3. The bytes depend on the calls only.

#pragma once

#include <vector>

#include "format/thumbnail/canvas.h"
#include "format/writer.h"

namespace lyr::format {

// What the firmwares' screens and their web interfaces show.
inline constexpr ImageSize small_thumbnail{220, 124}, large_thumbnail{400, 300};

// What the picture shows, on the bed (z = 0).
struct PicturedBox {
    double low_x_mm = 0, low_y_mm = 0, high_x_mm = 0, high_y_mm = 0, high_z_mm = 0;
};

class ThumbnailPainter {
public:
    explicit ThumbnailPainter(const PicturedBox& box);

    void add(const EncodedLayer& layer);

    std::vector<Thumbnail> thumbnails() const;

private:
    struct Pen;

    // In the picture, of what is shown.
    double width_mm_ = 0, height_mm_ = 0, left_mm_ = 0, top_mm_ = 0;
    double high_z_mm_;
    double scale_;  // samples a mm
    std::size_t layers_ = 0;
    Canvas canvas_;
};

}  // namespace lyr::format
