// A picture in shades, drawn with thick strokes at twice its size or more, and then smoothed and coloured.
//
// Contract
//  1. The bytes depend on the calls only.
//  2. What lies outside the picture is cut off, wherever it is.

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/metadata.h"

namespace lyr::format {

struct ImageSize {
    std::uint32_t width = 0, height = 0;  // pixels
};

class Canvas {
public:
    // A pixel of the largest picture has so many in each direction.
    static constexpr std::uint32_t samples = 2;

    explicit Canvas(ImageSize size);

    // In samples, y downwards.
    struct Stroke {
        double from_x = 0, from_y = 0, to_x = 0, to_y = 0;
        double radius = 0;
        double drop = 0;         // how far it reaches down, too: the height of a wall
        std::uint8_t shade = 0;  // 1, dark, to 255; 0 is nothing
        // How near the viewer its ends are, in any unit: it hides what is farther, and what is as near.
        double from_near = 0, to_near = 0;
    };
    void draw(const Stroke& stroke);

    // The canvas' middle with so many samples to a pixel; a transparent background. A PNG with a palette.
    Thumbnail thumbnail(ImageSize size, double samples_a_pixel) const;

private:
    struct Span {
        double low = 0, high = 0;
        float near = 0;
        std::uint8_t shade = 0;
    };
    // From a sample on, as many as lie between low and high of `count`, each `step` behind the one before.
    void fill(std::size_t first, std::size_t step, std::size_t count, const Span& span);

    std::size_t columns_, rows_;
    std::vector<std::uint8_t> shades_;
    std::vector<float> nears_;
};

}  // namespace lyr::format
