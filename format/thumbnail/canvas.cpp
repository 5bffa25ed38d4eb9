// Strokes are spans across their steeper direction, one a column or row.

#include "format/thumbnail/canvas.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lyr::format {
namespace {

struct Color {
    std::uint8_t red, green, blue;
};

constexpr Color darkest{22, 48, 74}, lightest{150, 216, 255};

// The palette: nothing, then edges of three degrees of cover, then what is covered in full.
constexpr std::size_t edge_shades = 8, full_shades = 32;
constexpr std::array<std::uint8_t, 3> edge_alphas{64, 136, 208};
constexpr std::size_t colors = 1 + edge_alphas.size() * edge_shades + full_shades;

std::uint8_t mixed(std::uint8_t dark, std::uint8_t light, std::size_t shade, std::size_t count) {
    const std::size_t part = light - dark;
    return static_cast<std::uint8_t>(dark + part * shade / (count - 1));
}

std::array<std::uint8_t, 4 * colors> palette() {
    std::array<std::uint8_t, 4 * colors> out{};
    std::size_t at = 4;
    const auto put = [&](std::size_t shade, std::size_t count, std::uint8_t alpha) {
        out[at++] = mixed(darkest.red, lightest.red, shade, count);
        out[at++] = mixed(darkest.green, lightest.green, shade, count);
        out[at++] = mixed(darkest.blue, lightest.blue, shade, count);
        out[at++] = alpha;
    };
    for (const std::uint8_t alpha : edge_alphas)
        for (std::size_t shade = 0; shade < edge_shades; ++shade) put(shade, edge_shades, alpha);
    for (std::size_t shade = 0; shade < full_shades; ++shade) put(shade, full_shades, 255);
    return out;
}

// Of a pixel whose samples have this sum of shades, and of which so many have one.
std::uint8_t color_index(std::size_t sum, std::size_t covered, std::size_t all) {
    if (covered == 0) return 0;
    const std::size_t shade = sum / covered;
    if (covered == all)
        return static_cast<std::uint8_t>(colors - full_shades + shade * full_shades / 256);
    const std::size_t degree = (covered - 1) * edge_alphas.size() / (all - 1);
    return static_cast<std::uint8_t>(1 + degree * edge_shades + shade * edge_shades / 256);
}

std::vector<std::byte> png_of(const std::vector<std::uint8_t>& pixels, ImageSize size) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = size.width;
    image.height = size.height;
    image.format = PNG_FORMAT_RGBA_COLORMAP;
    image.colormap_entries = colors;
    const auto map = palette();
    png_alloc_size_t bytes = 0;
    const auto stride = static_cast<png_int_32>(size.width);
    if (!png_image_write_to_memory(&image, nullptr, &bytes, 0, pixels.data(), stride, map.data()))
        return {};
    std::vector<std::byte> out(bytes);
    if (!png_image_write_to_memory(&image, out.data(), &bytes, 0, pixels.data(), stride,
                                   map.data()))
        return {};
    out.resize(bytes);
    return out;
}

}  // namespace

Canvas::Canvas(ImageSize size)
    : columns_(std::size_t{size.width} * samples),
      rows_(std::size_t{size.height} * samples),
      shades_(columns_ * rows_),
      nears_(columns_ * rows_, -std::numeric_limits<float>::infinity()) {}

namespace {

// The first sample whose middle is not below a place, of `count`. A cast cuts off faster than std::ceil() rounds.
std::size_t first_sample(double at, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(at + 0.5, 0.0, static_cast<double>(count)));
}

}  // namespace

void Canvas::fill(std::size_t first, std::size_t step, std::size_t count, const Span& span) {
    const std::size_t end = first + first_sample(span.high, count) * step;
    for (std::size_t at = first + first_sample(span.low, count) * step; at < end; at += step) {
        if (span.near < nears_[at]) continue;
        nears_[at] = span.near;
        shades_[at] = span.shade;
    }
}

void Canvas::draw(const Stroke& stroke) {
    const double dx = stroke.to_x - stroke.from_x, dy = stroke.to_y - stroke.from_y;
    const bool flat = std::abs(dx) >= std::abs(dy);
    // Along the axis that it runs along most, and across it; there it is wider than its radius.
    const double from = flat ? stroke.from_x : stroke.from_y, way = flat ? dx : dy;
    const double across = flat ? stroke.from_y : stroke.from_x, rise = flat ? dy : dx;
    const double length = std::abs(way), low = std::min(from, from + way);
    const double reach =
        length > 0 ? stroke.radius * std::sqrt(dx * dx + dy * dy) / length : stroke.radius;
    const double high = low + length + stroke.radius + (flat ? 0 : stroke.drop);
    const std::size_t count = flat ? columns_ : rows_, end = first_sample(high, count);
    const double a_way = length > 0 ? 1 / way : 0;
    for (std::size_t line = first_sample(low - stroke.radius, count); line < end; ++line) {
        const double on_it = std::clamp(static_cast<double>(line) + 0.5, low, low + length);
        const double share = (on_it - from) * a_way;
        const double middle = across + rise * share;
        const double near = stroke.from_near + (stroke.to_near - stroke.from_near) * share;
        const Span span{middle - reach, middle + reach + (flat ? stroke.drop : 0),
                        static_cast<float>(near), stroke.shade};
        if (flat)
            fill(line, columns_, rows_, span);
        else
            fill(line * columns_, 1, columns_, span);
    }
}

Thumbnail Canvas::thumbnail(ImageSize size, double samples_a_pixel) const {
    const auto borders = [&](std::uint32_t pixels, std::size_t count) {
        std::vector<std::size_t> at;
        const auto all = static_cast<double>(count);
        for (std::uint32_t i = 0; i <= pixels; ++i)
            at.push_back(static_cast<std::size_t>(
                std::clamp(std::round(all / 2 + (i - pixels / 2.0) * samples_a_pixel), 0.0, all)));
        return at;
    };
    const std::vector<std::size_t> columns = borders(size.width, columns_),
                                   rows = borders(size.height, rows_);
    std::vector<std::uint8_t> pixels(std::size_t{size.width} * size.height);
    for (std::size_t y = 0; y < size.height; ++y) {
        for (std::size_t x = 0; x < size.width; ++x) {
            std::size_t sum = 0, covered = 0;
            for (std::size_t row = rows[y]; row < rows[y + 1]; ++row)
                for (std::size_t column = columns[x]; column < columns[x + 1]; ++column) {
                    const std::uint8_t shade = shades_[row * columns_ + column];
                    sum += shade;
                    covered += shade > 0;
                }
            const std::size_t all = (rows[y + 1] - rows[y]) * (columns[x + 1] - columns[x]);
            pixels[y * size.width + x] = color_index(sum, covered, all);
        }
    }
    return {size.width, size.height, png_of(pixels, size)};
}

}  // namespace lyr::format
