// Points of edges against their feet on the surface. On B-spline surfaces feet are sought near the one before.

#include "kernel/brep/edge_deviation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "kernel/brep/defect.h"
#include "kernel/brep/free_edges.h"
#include "kernel/brep/surface_foot.h"

namespace lyr {
namespace {

constexpr std::array<double, 3> sampled_at{0.17, 0.48, 0.81};

class Distance {
public:
    explicit Distance(const Surface& surface) : surface_(surface) {
        const auto* spline = std::get_if<SharedBSplineSurface>(&surface);
        if (spline) foot_.emplace(**spline);
    }

    // Exact where it is more than `enough_mm`, else not above that.
    double mm(const Point3& point, double enough_mm) {
        if (!foot_) return distance_to_elementary(point);
        foot_->move_to(point, enough_mm);
        return foot_->distance_mm();
    }

private:
    double distance_to_elementary(const Point3& point) const {
        if (const auto* plane = std::get_if<Plane>(&surface_))
            return std::abs(plane->frame.z.dot(point - plane->frame.origin));
        if (const auto* cylinder = std::get_if<Cylinder>(&surface_)) {
            const Vector3 out = cylinder->frame.z.cross(point - cylinder->frame.origin);
            return std::abs(out.norm() - cylinder->radius_mm);
        }
        return (evaluate(surface_, invert(surface_, point)) - point).norm();
    }

    const Surface& surface_;
    std::optional<SurfaceFoot> foot_;
};

void report_face(const Model& model, const Face& face, double accepted_mm,
                 Diagnostics& diagnostics) {
    Distance distance(face.surface);
    double greatest_mm = 0;
    EdgeId farthest;
    Point3 where = Point3::Zero();
    for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
        const Loop& loop = model.loops[l];
        for (std::uint32_t c = loop.first_coedge; c < loop.first_coedge + loop.coedge_count; ++c) {
            const Coedge& use = model.coedges[c];
            for (const double share : sampled_at) {
                const Point3 point = point_on(model[use.edge], use.reversed ? 1 - share : share);
                const double enough_mm = std::max(accepted_mm, greatest_mm);
                const double distance_mm = distance.mm(point, enough_mm);
                if (!(distance_mm > greatest_mm)) continue;
                greatest_mm = distance_mm;
                farthest = use.edge;
                where = point;
            }
        }
    }
    if (greatest_mm <= accepted_mm) return;
    diagnostics.push_back(defect(Severity::warning,
                                 "edge #" + std::to_string(model[farthest].source) + " lies " +
                                     in_mm(greatest_mm) + " off the face's surface",
                                 face.source, where));
}

}  // namespace

void report_deviations(const Model& model, double accepted_mm, Diagnostics& diagnostics) {
    for (const Face& face : model.faces) report_face(model, face, accepted_mm, diagnostics);
}

}  // namespace lyr
