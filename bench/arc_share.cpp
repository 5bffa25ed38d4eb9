#include "bench/arc_share.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "format/arc.h"
#include "format/reader.h"
#include "kernel/brep/placement.h"
#include "kernel/toolpath/boundary.h"
#include "slicer/bounds.h"
#include "slicer/outline.h"

namespace lyr::bench {
namespace {

constexpr double sample_mm = 0.1;
// A line on a planar face is off its plane by round-off, a chord of something round by its height.
constexpr double on_plane_mm = 1e-5;
// The outline is within the tolerance of the surfaces; twice that for what was healed.
constexpr double near_surface_mm = 0.01;
constexpr double turned_rad = 1e-4;
// Of feet that are not at a piece's end.
constexpr double foot_mm = 1e-7;
// An arc of the outline has the circle of a cylinder.
constexpr double same_circle_mm = 1e-4;
constexpr double upright = 1 - 1e-12;
// An arc that is lower over its chord is rounded to a line.
constexpr double flattest_quanta = 0.5;

Point2 flat(const Vector3& vector) {
    return vector.head<2>();
}

// The model's surfaces, as they are asked about lines of an outline.
class Surfaces {
public:
    explicit Surfaces(const Model& model) {
        for (const Face& face : model.faces) {
            if (const auto* plane = std::get_if<Plane>(&face.surface)) {
                planes_.push_back(*plane);
            } else {
                curved_.push_back(face.surface);
            }
            const auto* cylinder = std::get_if<Cylinder>(&face.surface);
            if (cylinder && std::abs(cylinder->frame.z.z()) > upright)
                cylinders_.push_back({flat(cylinder->frame.origin), cylinder->radius_mm});
        }
    }

    const std::vector<ArcCircle>& cylinders() const { return cylinders_; }

    bool is_chord(const BoundaryPiece& line, double z_mm) const {
        const auto at = [&](const Point2& point) { return Point3(point.x(), point.y(), z_mm); };
        const Point3 start = at(line.start), end = at(line.end);
        for (const Plane& plane : planes_) {
            const auto off_mm = [&](const Point3& point) {
                return std::abs(plane.frame.z.dot(point - plane.frame.origin));
            };
            if (off_mm(start) < on_plane_mm && off_mm(end) < on_plane_mm) return false;
        }
        return std::any_of(curved_.begin(), curved_.end(), [&](const Surface& surface) {
            return is_along(surface, start) && is_along(surface, end) &&
                   is_along(surface, at(line.middle)) && turns(surface, start, end);
        });
    }

private:
    static bool is_along(const Surface& surface, const Point3& point) {
        return (evaluate(surface, invert(surface, point)) - point).norm() < near_surface_mm;
    }
    static bool turns(const Surface& surface, const Point3& start, const Point3& end) {
        const Vector2 a = flat(normal(surface, invert(surface, start)));
        const Vector2 b = flat(normal(surface, invert(surface, end)));
        return angle_between(a, b) > turned_rad;
    }

    std::vector<Plane> planes_;
    std::vector<Surface> curved_;
    std::vector<ArcCircle> cylinders_;
};

// A piece of a wall's middle.
struct WallPiece {
    Point2 start;
    Segment segment;
    bool is_arc;
    std::optional<Point2> centre{};  // of a full circle
};

// The outline of a layer, by pieces: what is curved, and on which cylinder.
class Outline {
public:
    Outline(Region region, const Surfaces& surfaces, double z_mm) : boundary_(region) {
        for (const BoundaryPiece& piece : boundary_.pieces()) {
            const bool is_arc = piece.curvature_per_mm != 0;
            curved_.push_back(is_arc || surfaces.is_chord(piece, z_mm));
            cylinder_.push_back(is_arc ? cylinder_of(piece, surfaces) : nullptr);
            if (!curved_.back()) continue;
            share_.all_mm += piece.length_mm;
            if (is_arc) share_.part_mm += piece.length_mm;
        }
    }

    const Share& share() const { return share_; }

    // The piece on which the place has its foot, not at its end; or none.
    std::size_t foot(const Point2& place, double within_mm) const {
        const auto nearest = boundary_.nearest(place, within_mm);
        if (!nearest) return Boundary::none;
        const BoundaryPiece& piece = boundary_.pieces()[*nearest];
        const double to_carrier_mm = std::abs(offset_mm(piece.carrier(), place));
        const bool inside = piece.is_circle || piece.distance_mm(place) < to_carrier_mm + foot_mm;
        return inside ? *nearest : Boundary::none;
    }
    bool is_curved(std::size_t piece) const { return curved_[piece]; }
    // Of a curve through the place beside the piece; 0 where the outline has a chord.
    double radius_beside_mm(std::size_t index, const Point2& place) const {
        const BoundaryPiece& piece = boundary_.pieces()[index];
        if (piece.curvature_per_mm == 0) return 0;
        return std::abs(1 / piece.curvature_per_mm + offset_mm(piece.carrier(), place));
    }
    const ArcCircle* cylinder(std::size_t piece) const { return cylinder_[piece]; }

private:
    static const ArcCircle* cylinder_of(const BoundaryPiece& piece, const Surfaces& surfaces) {
        for (const ArcCircle& circle : surfaces.cylinders()) {
            const auto is_on = [&](const Point2& point) {
                return std::abs((point - circle.centre).norm() - circle.radius_mm) < same_circle_mm;
            };
            const double radius_mm = 1 / std::abs(piece.curvature_per_mm);
            if (is_on(piece.start) && is_on(piece.middle) && is_on(piece.end) &&
                std::abs(radius_mm - circle.radius_mm) < near_surface_mm)
                return &circle;
        }
        return nullptr;
    }

    Boundary boundary_;
    std::vector<bool> curved_;
    std::vector<const ArcCircle*> cylinder_;
    Share share_;
};

class Measure {
public:
    Measure(const Outline& outline, double within_mm, double quantum_mm, ArcShares& shares)
        : outline_(outline), within_mm_(within_mm), quantum_mm_(quantum_mm), shares_(shares) {}

    void take(const WallPiece& wall) {
        const double whole_mm = length_mm(wall.start, wall.segment);
        const double count = std::ceil(whole_mm / sample_mm), each_mm = whole_mm / count;
        for (double i = 0; i < count; ++i) {
            const Point2 place = point_at(wall.start, wall.segment, (i + 0.5) / count);
            const std::size_t foot = outline_.foot(place, within_mm_);
            if (foot != run_.piece) finish();
            run_.piece = foot;
            if (foot == Boundary::none || !outline_.is_curved(foot)) continue;
            run_.radius_mm = outline_.radius_beside_mm(foot, place);
            add(run_.share, each_mm, wall.is_arc);
            if (const ArcCircle* cylinder = outline_.cylinder(foot))
                add(run_.cylinder, each_mm, is_concentric(wall, cylinder->centre));
        }
    }

    // At the end of a wall too.
    void finish() {
        const double all_mm = run_.share.all_mm;
        const bool is_flat = run_.share.part_mm == 0 &&
                             all_mm * all_mm / (8 * run_.radius_mm) < flattest_quanta * quantum_mm_;
        if (is_flat) {
            shares_.flat_mm += all_mm;
        } else {
            shares_.walls += run_.share;
            shares_.cylinders += run_.cylinder;
        }
        run_ = {};
    }

private:
    // Places that follow each other along a wall, beside one piece of the outline.
    struct Run {
        std::size_t piece = Boundary::none;
        double radius_mm = 0;
        Share share{}, cylinder{};
    };

    static void add(Share& share, double length_mm, bool counts) {
        share.all_mm += length_mm;
        if (counts) share.part_mm += length_mm;
    }

    bool is_concentric(const WallPiece& wall, const Point2& axis) {
        if (!wall.is_arc) return false;
        double least_mm = 1e9, most_mm = 0;
        for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
            const double radius_mm = (point_at(wall.start, wall.segment, share) - axis).norm();
            least_mm = std::min(least_mm, radius_mm);
            most_mm = std::max(most_mm, radius_mm);
        }
        const double off_quanta = (most_mm - least_mm) / quantum_mm_;
        if (off_quanta > rounding_quanta) return false;
        shares_.worst_off_quanta = std::max(shares_.worst_off_quanta, off_quanta);
        if (wall.centre)
            shares_.worst_centre_quanta =
                std::max(shares_.worst_centre_quanta, (*wall.centre - axis).norm() / quantum_mm_);
        return true;
    }

    const Outline& outline_;
    double within_mm_, quantum_mm_;
    ArcShares& shares_;
    Run run_{};
};

class WallReader {
public:
    explicit WallReader(double quantum_mm) : quantum_mm_(quantum_mm) {}

    std::vector<WallPiece> pieces_of(const format::Operation& operation) const {
        if (const auto* line = std::get_if<format::Line>(&operation))
            return {{at(line->from), {at(line->to), 0}, false}};
        if (const auto* arc = std::get_if<format::Arc>(&operation))
            return {{at(arc->from),
                     {at(arc->to), static_cast<double>(arc->sagitta) * quantum_mm_},
                     true}};
        const auto* circle = std::get_if<format::Circle>(&operation);
        if (!circle) return {};
        const Point2 from = at(circle->from);
        const Point2 centre = at({circle->center_x, circle->center_y, 0});
        const Point2 across = 2 * centre - from;
        constexpr double half_turn_rad = std::numbers::pi;
        return {{from, arc_with_sweep(from, across, half_turn_rad), true, centre},
                {across, arc_with_sweep(across, from, half_turn_rad), true, centre}};
    }

private:
    Point2 at(const format::Point& point) const {
        return Point2(static_cast<double>(point.x), static_cast<double>(point.y)) * quantum_mm_;
    }
    double quantum_mm_;
};

bool is_wall(format::Role role) {
    return role == format::Role::outer_wall || role == format::Role::inner_wall;
}

// As slicer::print() puts it there.
Model on_bed(const Model& model, const slicer::Options& options, Eigen::AlignedBox3d& box) {
    box = slicer::bounding_box(model, options.tolerance());
    const Vector3 move(options.profile.plate.at_mm[0] - box.min().x(),
                       options.profile.plate.at_mm[1] - box.min().y(), -box.min().z());
    box.translate(move);
    return transformed(model, Eigen::Affine3d(Eigen::Translation3d(move)));
}

}  // namespace

bool is_elementary(const Model& model) {
    return std::none_of(model.faces.begin(), model.faces.end(), [](const Face& face) {
        return std::holds_alternative<SharedBSplineSurface>(face.surface);
    });
}

Result<ArcShares> arc_shares(const Model& model, const std::string& lyr,
                             const slicer::Options& options, std::size_t most_layers) {
    auto reader = format::Reader::open(lyr);
    if (!reader) return reader.error();
    Eigen::AlignedBox3d box;
    const Model placed = on_bed(model, options, box);
    const Surfaces surfaces(placed);
    const Cutter cutter(placed, options.tolerance());
    const auto spans = slicer::layer_spans(box.sizes().z(), options.profile.layer);
    const std::size_t stride = (spans.size() + most_layers - 1) / most_layers;
    const double quantum_mm = reader->header().quantum.mm(1);
    const WallReader walls(quantum_mm);
    const profile::Perimeters& perimeters = options.profile.perimeters;
    ArcShares shares;
    for (std::size_t i = stride / 2; i < spans.size(); i += stride) {
        if (Status sought = reader->seek_layer(static_cast<std::uint32_t>(i)); !sought)
            return sought.error();
        const auto layer = slicer::outline_layer(cutter, i, spans[i], box, options);
        if (layer.error) return *layer.error;
        const Outline outline(layer.outline, surfaces, spans[i].middle_mm());
        shares.outlines += outline.share();
        ++shares.layers;
        Measure measure(outline, (perimeters.count + 1) * perimeters.width_mm, quantum_mm, shares);
        bool begun = false;
        while (const format::Operation* operation = reader->read()) {
            if (std::holds_alternative<format::LayerStart>(*operation) &&
                std::exchange(begun, true))
                break;
            if (!is_wall(reader->path().role)) continue;
            if (std::holds_alternative<format::Travel>(*operation)) measure.finish();
            for (const WallPiece& piece : walls.pieces_of(*operation)) measure.take(piece);
        }
        measure.finish();
        if (reader->error()) return *reader->error();
    }
    return shares;
}

}  // namespace lyr::bench
