#include "bench/accuracy.h"

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <vector>

#include "bench/scratch_file.h"
#include "format/reader.h"
#include "kernel/contour/arc.h"
#include "slicer/bounds.h"
#include "slicer/slicer.h"

namespace lyr::bench {
namespace {

// A piece of an outermost wall's middle, in the model's own coordinates.
struct WallPiece {
    Point2 start;
    Segment segment;
    double z_mm, width_mm;

    // On the wall's outer flank, which is what is to lie on the surface.
    Point2 flank_at(double fraction) const {
        const Eigen::Rotation2Dd turned(fraction * sweep_rad(start, segment));
        const Vector2 along = turned * start_tangent(start, segment);
        return point_at(start, segment, fraction) + width_mm / 2 * Vector2(along.y(), -along.x());
    }
};

// Follows the operations of a print and keeps the walls.
class Walls {
public:
    // `origin`: where the print's origin lies in the model.
    Walls(double quantum_mm, double layer_height_mm, const Point3& origin)
        : quantum_mm_(quantum_mm), layer_height_mm_(layer_height_mm), origin_(origin) {}

    void operator()(const format::Operation& operation) {
        if (const auto* layer = std::get_if<format::LayerStart>(&operation))
            z_mm_ = (layer->index + 0.5) * layer_height_mm_ + origin_.z();
        if (const auto* path = std::get_if<format::PathStart>(&operation)) {
            style_ = path->style;
            path_begin_ = pieces_.size();
        }
        if (const auto* width = std::get_if<format::Width>(&operation))
            change_width(width->width_mm);
        if (style_.role != format::Role::outer_wall) return;
        if (const auto* line = std::get_if<format::Line>(&operation))
            add(line->from, {at(line->to), 0});
        if (const auto* arc = std::get_if<format::Arc>(&operation))
            add(arc->from, {at(arc->to), static_cast<double>(arc->sagitta) * quantum_mm_});
        if (const auto* circle = std::get_if<format::Circle>(&operation)) add(*circle);
    }

    const std::vector<WallPiece>& pieces() const { return pieces_; }

private:
    // Where a wall goes on with another width, its middle goes across by half of the difference, so that its flank goes on
    // straight. That step is within what the wall covers and has no outer flank.
    void change_width(double width_mm) {
        const double step_mm = std::abs(width_mm - style_.width_mm) / 2 + 2 * quantum_mm_;
        style_.width_mm = width_mm;
        if (pieces_.size() == path_begin_) return;
        const WallPiece& last = pieces_.back();
        if (last.segment.sagitta_mm == 0 && length_mm(last.start, last.segment) <= step_mm)
            pieces_.pop_back();
    }
    Point2 at(const format::Point& point) const {
        return Point2(static_cast<double>(point.x), static_cast<double>(point.y)) * quantum_mm_ +
               origin_.head<2>();
    }
    void add(const format::Point& from, const Segment& segment) {
        pieces_.push_back({at(from), segment, z_mm_, style_.width_mm});
    }
    void add(const format::Circle& circle) {
        const Point2 from = at(circle.from);
        const Point2 centre =
            Point2(static_cast<double>(circle.center_x), static_cast<double>(circle.center_y)) *
                quantum_mm_ +
            origin_.head<2>();
        const Point2 opposite = 2 * centre - from;
        const double half_turn_rad =
            circle.counter_clockwise ? std::numbers::pi : -std::numbers::pi;
        for (const auto& [start, end] : {std::pair(from, opposite), std::pair(opposite, from)})
            pieces_.push_back(
                {start, arc_with_sweep(start, end, half_turn_rad), z_mm_, style_.width_mm});
    }

    double quantum_mm_, layer_height_mm_;
    Point3 origin_;
    double z_mm_ = 0;
    format::PathStyle style_{};
    std::vector<WallPiece> pieces_;
    std::size_t path_begin_ = 0;
};

Result<std::vector<WallPiece>> walls_of(const std::string& lyr_path, double layer_height_mm,
                                        const Point3& origin) {
    auto reader = format::Reader::open(lyr_path);
    if (!reader) return reader.error();
    Walls walls(reader->header().quantum.nm * 1e-6, layer_height_mm, origin);
    for (;;) {
        const auto operation = reader->next();
        if (!operation) return operation.error();
        if (!*operation) return walls.pieces();
        walls(**operation);
    }
}

// So many points at equal distances along all walls together.
std::vector<Point3> points_along(const std::vector<WallPiece>& walls, std::size_t count) {
    double total_mm = 0;
    for (const WallPiece& wall : walls) total_mm += length_mm(wall.start, wall.segment);
    const double spacing_mm = total_mm / static_cast<double>(count);
    std::vector<Point3> points;
    double passed_mm = 0;
    for (const WallPiece& wall : walls) {
        const double piece_mm = length_mm(wall.start, wall.segment);
        for (;;) {
            const double next_mm = (static_cast<double>(points.size()) + 0.5) * spacing_mm;
            if (next_mm >= passed_mm + piece_mm || points.size() == count) break;
            const Point2 at = wall.flank_at((next_mm - passed_mm) / piece_mm);
            points.push_back({at.x(), at.y(), wall.z_mm});
        }
        passed_mm += piece_mm;
    }
    return points;
}

}  // namespace

Result<std::vector<Point3>> printed_points(const std::string& step_path, double layer_height_mm,
                                           std::size_t count) {
    slicer::Options options;
    options.profile.layer.height_mm = options.profile.layer.first_height_mm = layer_height_mm;
    // Walls all along the outline, however narrow the part.
    options.profile.perimeters.thin_walls = false;
    // And outermost walls are told from others by their role.
    options.profile.bridge.walls = false;
    Diagnostics found;
    auto model = slicer::load(step_path, options, found);
    if (!model) return model.error();
    const Point3 origin = slicer::bounding_box(*model, options.tolerance()).min();
    const auto file = ScratchFile::with("");
    if (!file) return file.error();
    const auto printed = slicer::print(
        std::move(*model), step_path, file->path(), "", options,
        [](const char*, std::size_t, std::size_t) {}, found);
    if (!printed) return printed.error();
    const auto walls = walls_of(file->path(), layer_height_mm, origin);
    if (!walls) return walls.error();
    return points_along(*walls, count);
}

std::vector<double> distances_mm(const occt::Surfaces& surfaces,
                                 const std::vector<Point3>& points) {
    std::vector<double> distances_mm;
    for (const Point3& p : points) {
        distances_mm.push_back(surfaces.distance_mm(p.x(), p.y(), p.z(), Tolerance{}.total_mm / 2));
    }
    std::sort(distances_mm.begin(), distances_mm.end());
    return distances_mm;
}

double quantile(const std::vector<double>& sorted, double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

Status measure_accuracy(const std::string& step_path, double layer_height_mm, std::size_t count,
                        Requirements& requirements) {
    const auto points = printed_points(step_path, layer_height_mm, count);
    if (!points) return points.error();
    const auto surfaces = occt::Surfaces::read(step_path);
    if (!surfaces) {
        return Diagnostic{
            Severity::error, ExitStatus::input, "OCCT reads no shape", {.file = step_path}};
    }
    const double allowed_mm = Tolerance{}.total_mm;
    const std::vector<double> distances = distances_mm(*surfaces, *points);
    const auto share = [&](double s) { return number(quantile(distances, s)); };
    const auto over =
        distances.end() - std::upper_bound(distances.begin(), distances.end(), allowed_mm);
    const std::string name = std::filesystem::path(step_path).filename().string();
    print({"Distance of printed walls from the model's surfaces, mm",
           {"part", "layer height", "points", "median", "99 %", "greatest", "over the tolerance"},
           {{name, number(layer_height_mm), std::to_string(points->size()), share(0.5), share(0.99),
             share(1), std::to_string(over)}}});
    requirements.push_back({.what = name + ": greatest distance from the exact surface",
                            .measured = distances.back(),
                            .wanted = allowed_mm,
                            .at_most = true,
                            .unit = " mm"});
    return Done{};
}

}  // namespace lyr::bench
