// What thumbnails show, read back from their PNG files.

#include "format/thumbnail/painter.h"

#include <doctest/doctest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace lyr;
using namespace lyr::format;

namespace {

struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;

    const std::uint8_t* at(std::uint32_t x, std::uint32_t y) const {
        return &rgba[4 * (std::size_t{y} * width + x)];
    }
    // Red, green and blue together; -1: nothing is drawn there.
    int brightness(std::uint32_t x, std::uint32_t y) const {
        const std::uint8_t* p = at(x, y);
        return p[3] < 255 ? -1 : p[0] + p[1] + p[2];
    }
    std::size_t drawn() const {
        std::size_t count = 0;
        for (std::size_t i = 3; i < rgba.size(); i += 4) count += rgba[i] > 0;
        return count;
    }
};

Picture picture_of(const Thumbnail& thumbnail) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_memory(&image, thumbnail.png.data(), thumbnail.png.size()));
    image.format = PNG_FORMAT_RGBA;
    Picture out{image.width, image.height, {}};
    out.rgba.resize(PNG_IMAGE_SIZE(image));
    REQUIRE(png_image_finish_read(&image, nullptr, out.rgba.data(), 0, nullptr));
    CHECK(out.width == thumbnail.width);
    CHECK(out.height == thumbnail.height);
    return out;
}

// A layer of a box of 40 x 20 mm: its wall, and a skin within.
EncodedLayer box_layer(double z_mm, Role wall = Role::outer_wall, bool skin = true) {
    LayerState state;
    state.z_mm = z_mm;
    state.height_mm = 0.4;
    LayerEncoder layer(Quantum{1000}, state);
    layer.begin_path({wall, 0.45, 0.4, 1, 60, 0});
    layer.line_to(40, 0);
    layer.line_to(40, 20);
    layer.line_to(0, 20);
    layer.line_to(0, 0);
    if (skin) {
        layer.begin_path({Role::top_skin, 0.45, 0.4, 1, 60, 0});
        for (int i = 1; i < 44; ++i) {
            const double y = 0.45 * i, x = i % 2 ? 39.5 : 0.5;
            layer.travel_to(40 - x, y);
            layer.line_to(x, y);
        }
    }
    auto encoded = layer.finish();
    REQUIRE(encoded.ok());
    return *encoded;
}

std::vector<EncodedLayer> box() {
    std::vector<EncodedLayer> layers;
    for (int i = 1; i <= 40; ++i) layers.push_back(box_layer(0.4 * i));
    return layers;
}

std::vector<Thumbnail> painted(const std::vector<EncodedLayer>& layers) {
    ThumbnailPainter painter({0, 0, 40, 20, 16});
    for (const EncodedLayer& layer : layers) painter.add(layer);
    return painter.thumbnails();
}

}  // namespace

TEST_CASE("thumbnails 3: both sizes, small, the same bytes each time") {
    const std::vector<Thumbnail> once = painted(box()), again = painted(box());
    REQUIRE(once.size() == 2);
    CHECK(once[0].width == 400);
    CHECK(once[0].height == 300);
    CHECK(once[1].width == 220);
    CHECK(once[1].height == 124);
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(once[i].png == again[i].png);
        CHECK(once[i].png.size() < 20000);
    }
}

TEST_CASE(
    "thumbnails 1 and 2: the box fits the picture, its top is the lightest, its sides differ") {
    for (const Thumbnail& thumbnail : painted(box())) {
        const Picture picture = picture_of(thumbnail);
        const std::uint32_t w = picture.width, h = picture.height;
        for (std::uint32_t x = 0; x < w; ++x) {
            CHECK(picture.at(x, 0)[3] == 0);
            CHECK(picture.at(x, h - 1)[3] == 0);
        }
        for (std::uint32_t y = 0; y < h; ++y) {
            CHECK(picture.at(0, y)[3] == 0);
            CHECK(picture.at(w - 1, y)[3] == 0);
        }
        CHECK(picture.drawn() > std::size_t{w} * h / 5);
        // Down the middle: the top first, then one side of the box, with nothing in between.
        std::vector<int> down;
        for (std::uint32_t y = 0; y < h; ++y)
            if (picture.brightness(w / 2, y) >= 0) down.push_back(picture.brightness(w / 2, y));
        REQUIRE(down.size() > 20);
        const int top = down[down.size() / 6], side = down[down.size() * 9 / 10];
        CHECK(top > side + 100);
    }
}

TEST_CASE("thumbnails 1: what is nearer hides what is farther, in whatever order layers come") {
    std::vector<EncodedLayer> layers = box();
    const Picture upwards = picture_of(painted(layers)[0]);
    std::reverse(layers.begin(), layers.end());
    const Picture downwards = picture_of(painted(layers)[0]);
    std::size_t different = 0;
    for (std::size_t i = 0; i < upwards.rgba.size(); i += 4)
        different += std::abs(upwards.rgba[i] - downwards.rgba[i]) > 24;
    CHECK(upwards.drawn() == downwards.drawn());
    CHECK(different < upwards.drawn() / 100);
}

TEST_CASE("thumbnails 2: a skirt is left out") {
    const Picture nothing = picture_of(painted({})[0]);
    CHECK(nothing.drawn() == 0);
    CHECK(picture_of(painted({box_layer(0.4, Role::skirt, false)})[0]).drawn() == 0);
    CHECK(picture_of(painted({box_layer(0.4, Role::outer_wall, false)})[0]).drawn() > 100);
}

TEST_CASE("canvas 2: strokes of all directions, far outside or through, are cut off") {
    for (const double far : {10.0, 1e3, 1e6, 1e9}) {
        Canvas canvas({20, 10});
        for (int i = 0; i < 64; ++i) {
            const double angle = i * 0.0982, x = far * std::cos(angle), y = far * std::sin(angle);
            canvas.draw({20 - x, 10 - y, 20 + x, 10 + y, 2, 3, 200});
            canvas.draw({x, y, x + 1, y + 1, 2, 3, 200});
        }
        canvas.draw({20, 10, 20, 10, 4, 0, 200});
        const Picture picture = picture_of(canvas.thumbnail({20, 10}, Canvas::samples));
        CHECK(picture.brightness(10, 5) > 0);
        CHECK(picture.drawn() <= 200);
    }
}

TEST_CASE("canvas: the nearer of two strokes that cross is seen, whichever is drawn first") {
    const Canvas::Stroke near{0, 10, 40, 10, 4, 0, 250, 2, 2}, far{20, 0, 20, 20, 4, 0, 50, 1, 1};
    for (const bool near_first : {true, false}) {
        Canvas canvas({20, 10});
        canvas.draw(near_first ? near : far);
        canvas.draw(near_first ? far : near);
        const Picture picture = picture_of(canvas.thumbnail({20, 10}, Canvas::samples));
        CHECK(picture.brightness(10, 5) > 450);
        CHECK(picture.brightness(10, 1) < 350);
    }
}
