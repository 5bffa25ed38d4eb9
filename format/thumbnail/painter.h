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
    struct View {
        Canvas canvas;
        double scale = 0;  // samples a mm
        double left = 0, top = 0;
    };
    struct Pen;

    View view_of(ImageSize size, const PicturedBox& box) const;

    double high_z_mm_;
    std::vector<View> views_;
};

}  // namespace lyr::format
