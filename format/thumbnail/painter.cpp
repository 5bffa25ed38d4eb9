// The head's paths are projected and drawn as strokes as wide as the strand, those of walls as high, too.

#include "format/thumbnail/painter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "format/arc.h"
#include "format/chunk_decoder.h"

namespace lyr::format {
namespace {

// The model is turned by 30 degrees, and looked at from 35 degrees over the bed.
constexpr double turn_cos = 0.866, turn_sin = 0.5, rise_sin = 0.574, rise_cos = 0.819;
// Where the light comes from, in the picture: left, towards the viewer.
constexpr double light_x = -0.707, light_y = -0.707;
// Shades of 255.
constexpr double darkest_wall = 80, brightest_wall = 205, skin = 245, inside = 225;
// The lowest layer is a little darker than the highest.
constexpr double least_height_share = 0.82;
// Of the picture's width and height that stays free.
constexpr double margin = 0.04;
// An empty print has a scale, too.
constexpr double least_extent_mm = 1e-3;
// An arc's chords turn by no more than this.
constexpr double most_turn_rad = 0.35;

struct Projected {
    double x = 0, y = 0;  // y upwards, mm
    double near = 0;      // mm towards the viewer
};

Projected projected(double x_mm, double y_mm, double z_mm) {
    const double right = x_mm * turn_cos + y_mm * turn_sin;
    const double away = y_mm * turn_cos - x_mm * turn_sin;
    return {right, away * rise_sin + z_mm * rise_cos, z_mm * rise_sin - away * rise_cos};
}

bool is_wall(Role role) {
    switch (role) {
        case Role::outer_wall:
        case Role::overhang_wall:
        case Role::thin_wall:
        case Role::support:
        case Role::brim:
        case Role::raft:
        case Role::prime_tower:
            return true;
        default:
            return false;
    }
}

// Under walls and skins of the layers above, but where a wall's top is seen; there a layer or two lower does as well.
constexpr std::size_t hidden_every = 3;

bool is_mostly_hidden(Role role) {
    return role == Role::inner_wall || role == Role::gap_fill || role == Role::solid_infill ||
           role == Role::sparse_infill || role == Role::internal_bridge;
}

double pixels_a_mm(ImageSize size, double width_mm, double height_mm) {
    const double free = 1 - 2 * margin;
    return std::min(free * size.width / width_mm, free * size.height / height_mm);
}

// Of a vertical wall in this direction, on the side that is seen.
double wall_shade(double dx, double dy) {
    const double length = std::sqrt(dx * dx + dy * dy);
    if (!(length > 0)) return brightest_wall;
    const double right = (dx * turn_cos + dy * turn_sin) / length;
    const double away = (dy * turn_cos - dx * turn_sin) / length;
    double normal_x = away, normal_y = -right;
    if (normal_y > 0) normal_x = -normal_x, normal_y = -normal_y;
    const double lit = std::clamp(normal_x * light_x + normal_y * light_y, 0.0, 1.0);
    return darkest_wall + (brightest_wall - darkest_wall) * lit;
}

}  // namespace

// Draws the motions of one layer.
struct ThumbnailPainter::Pen {
    ThumbnailPainter& painter;
    double mm;         // a quantum
    double share = 1;  // of the shade, by height
    bool draws_hidden = true;
    PathStyle style{};

    bool is_wanted() const {
        return style.role != Role::skirt && (draws_hidden || !is_mostly_hidden(style.role));
    }

    void line(double x0, double y0, double x1, double y1, double z) {
        if (!is_wanted()) return;
        const bool wall = is_wall(style.role);
        const double base = wall                           ? wall_shade(x1 - x0, y1 - y0)
                            : style.role == Role::top_skin ? skin
                                                           : inside;
        const auto shade = static_cast<std::uint8_t>(std::clamp(base * share, 1.0, 255.0));
        const Projected from = projected(x0, y0, z), to = projected(x1, y1, z);
        const double scale = painter.scale_;
        painter.canvas_.draw(
            {(from.x - painter.left_mm_) * scale, (painter.top_mm_ - from.y) * scale,
             (to.x - painter.left_mm_) * scale, (painter.top_mm_ - to.y) * scale,
             std::max(0.5, style.width_mm / 2 * scale),
             wall ? style.height_mm * rise_cos * scale : 0, shade, from.near, to.near});
    }

    void turn(const Point& from, const Point& to, double center_x, double center_y, double sweep) {
        if (!is_wanted()) return;
        const double z = static_cast<double>(to.z) * mm;
        double x = static_cast<double>(from.x), y = static_cast<double>(from.y);
        const double dx = x - center_x, dy = y - center_y;
        const int steps = 1 + static_cast<int>(std::abs(sweep) / most_turn_rad);
        for (int i = 1; i <= steps; ++i) {
            const double angle = sweep * i / steps, c = std::cos(angle), s = std::sin(angle);
            const double next_x = center_x + dx * c - dy * s, next_y = center_y + dx * s + dy * c;
            line(x * mm, y * mm, next_x * mm, next_y * mm, z);
            x = next_x, y = next_y;
        }
    }

    void take(const Line& l) {
        line(static_cast<double>(l.from.x) * mm, static_cast<double>(l.from.y) * mm,
             static_cast<double>(l.to.x) * mm, static_cast<double>(l.to.y) * mm,
             static_cast<double>(l.to.z) * mm);
    }
    void take(const Arc& arc) {
        if (!is_wanted()) return;
        const ArcShape shape = arc_shape(arc);
        turn(arc.from, arc.to, shape.center_x, shape.center_y, shape.sweep_rad);
    }
    void take(const Circle& circle) {
        constexpr double whole = 2 * std::numbers::pi;
        turn(circle.from, circle.to, static_cast<double>(circle.center_x),
             static_cast<double>(circle.center_y), circle.counter_clockwise ? whole : -whole);
    }
    template <class Other>
    void take(const Other&) {}
};

ThumbnailPainter::ThumbnailPainter(const PicturedBox& box)
    : high_z_mm_(box.high_z_mm), canvas_(large_thumbnail) {
    double low_x = INFINITY, low_y = INFINITY, high_x = -INFINITY, high_y = -INFINITY;
    for (const double x : {box.low_x_mm, box.high_x_mm})
        for (const double y : {box.low_y_mm, box.high_y_mm})
            for (const double z : {0.0, box.high_z_mm}) {
                const Projected corner = projected(x, y, z);
                low_x = std::min(low_x, corner.x), high_x = std::max(high_x, corner.x);
                low_y = std::min(low_y, corner.y), high_y = std::max(high_y, corner.y);
            }
    width_mm_ = std::max(high_x - low_x, least_extent_mm);
    height_mm_ = std::max(high_y - low_y, least_extent_mm);
    scale_ = Canvas::samples * pixels_a_mm(large_thumbnail, width_mm_, height_mm_);
    left_mm_ = (low_x + high_x) / 2 - large_thumbnail.width * Canvas::samples / scale_ / 2;
    top_mm_ = (low_y + high_y) / 2 + large_thumbnail.height * Canvas::samples / scale_ / 2;
}

void ThumbnailPainter::add(const EncodedLayer& layer) {
    const Quantum quantum = layer.quantum;
    MotionHistory history;
    ChunkDecoder decoder(history);
    decoder.begin_layer({quantum.quanta(layer.state.start_x_mm),
                         quantum.quanta(layer.state.start_y_mm), quantum.quanta(layer.state.z_mm)},
                        quantum);
    Pen pen{*this, quantum.mm(1)};
    pen.draws_hidden = layers_++ % hidden_every == 0 || layer.state.z_mm >= high_z_mm_;
    const double height = high_z_mm_ > 0 ? std::clamp(layer.state.z_mm / high_z_mm_, 0.0, 1.0) : 1;
    pen.share = least_height_share + (1 - least_height_share) * height;
    Operation operation;
    for (const EncodedLayer::Chunk& chunk : layer.chunks) {
        decoder.begin_chunk(std::span(layer.bytes).subspan(chunk.begin, chunk.end - chunk.begin),
                            chunk.operations);
        while (decoder.next(operation) == ChunkDecoder::Step::operation) {
            pen.style = decoder.style();
            std::visit([&](const auto& one) { pen.take(one); }, operation);
        }
    }
}

std::vector<Thumbnail> ThumbnailPainter::thumbnails() const {
    std::vector<Thumbnail> out;
    for (const ImageSize size : {large_thumbnail, small_thumbnail})
        out.push_back(canvas_.thumbnail(size, scale_ / pixels_a_mm(size, width_mm_, height_mm_)));
    return out;
}

}  // namespace lyr::format
