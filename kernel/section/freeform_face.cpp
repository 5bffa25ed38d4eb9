#include "kernel/section/freeform_face.h"

#include <algorithm>

#include "base/disjoint_sets.h"
#include "kernel/section/face_outline.h"

namespace lyr {
namespace {

HeightRange hull_of(const BSplineSurface& surface) {
    const auto [low, high] =
        std::minmax_element(surface.control_points.begin(), surface.control_points.end(),
                            [](const Point3& a, const Point3& b) { return a.z() < b.z(); });
    return {low->z(), high->z()};
}

// Where a face may be higher than a border that none of its edges is above.
//
// What of the surface is above all edges is crossed by none: each part of it that hangs together is in the face as a
// whole, or out of it; and out of it where it reaches the surface's rim, but for a pole. So there is one place to ask
// about, the highest of each part. Edges lie beside their surface, though, by round-off at least. Up to `doubtful_mm` above
// the border, parts on both sides of an edge may hang together, and a rim may be that much higher than the edges on it:
// there it is asked about each place that has no higher neighbour.
class Tops {
public:
    Tops(const HeightMesh& mesh, double up, double border_mm, bool has_poles)
        : mesh_(mesh), up_(up), border_mm_(border_mm), has_poles_(has_poles) {}

    // Vertices of the mesh.
    std::vector<std::uint32_t> found() const {
        std::vector<std::uint32_t> tops = of_parts();
        const std::vector<std::uint32_t> low = doubtful();
        tops.insert(tops.end(), low.begin(), low.end());
        return tops;
    }

private:
    // More than edges of sound models are off, and less than is worth a thought.
    static constexpr double doubtful_mm = 0.1;

    double height_mm(std::uint32_t vertex) const { return up_ * mesh_.vertices[vertex].z_mm; }
    bool is_sure(std::uint32_t vertex) const {
        return height_mm(vertex) > border_mm_ + doubtful_mm;
    }

    std::vector<std::uint32_t> of_parts() const {
        DisjointSets parts(mesh_.vertices.size());
        for (const BorderPiece& piece : mesh_.pieces)
            if (is_sure(piece.from) && is_sure(piece.to)) parts.join(piece.from, piece.to);
        constexpr std::uint32_t none = ~std::uint32_t{0};
        std::vector<std::uint32_t> highest(mesh_.vertices.size(), none);  // by part
        std::vector<bool> reaches_rim(mesh_.vertices.size(), false);
        for (const BorderPiece& piece : mesh_.pieces) {
            for (const std::uint32_t vertex : {piece.from, piece.to}) {
                if (!is_sure(vertex)) continue;
                const std::uint32_t part = parts.of(vertex);
                if (highest[part] == none || height_mm(vertex) > height_mm(highest[part]))
                    highest[part] = vertex;
                if (!has_poles_ && (piece.left < 0 || piece.right < 0)) reaches_rim[part] = true;
            }
        }
        std::vector<std::uint32_t> tops;
        for (std::uint32_t part = 0; part < highest.size(); ++part)
            if (highest[part] != none && !reaches_rim[part]) tops.push_back(highest[part]);
        return tops;
    }

    std::vector<std::uint32_t> doubtful() const {
        std::vector<bool> has_higher(mesh_.vertices.size(), false);
        std::vector<bool> used(mesh_.vertices.size(), false);  // the doubles at a seam are not
        for (const BorderPiece& piece : mesh_.pieces) {
            const double rise = height_mm(piece.to) - height_mm(piece.from);
            used[piece.from] = used[piece.to] = true;
            if (rise > 0) has_higher[piece.from] = true;
            if (rise < 0) has_higher[piece.to] = true;
        }
        std::vector<std::uint32_t> tops;
        for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v)
            if (used[v] && !has_higher[v] && height_mm(v) > border_mm_ && !is_sure(v))
                tops.push_back(v);
        return tops;
    }

    const HeightMesh& mesh_;
    double up_, border_mm_;
    bool has_poles_;
};

}  // namespace

FreeformFace::FreeformFace(const Model& model, FaceId face,
                           const std::vector<double>& vertex_level_mm, HeightRange loops)
    : model_(model),
      face_(face),
      vertex_level_mm_(vertex_level_mm),
      loops_(loops),
      hull_(hull_of(*std::get<SharedBSplineSurface>(model[face].surface))) {}

const HeightMesh& FreeformFace::mesh() const {
    return mesh_.get(
        [&] { return height_mesh(std::get<SharedBSplineSurface>(model_[face_].surface)); });
}

const Containment& FreeformFace::containment() const {
    return containment_.get([&] { return Containment(model_, face_, vertex_level_mm_); });
}

HeightRange FreeformFace::heights() const {
    return heights_.get([&] { return extended(loops_, mesh()); });
}

HeightRange FreeformFace::extended(HeightRange range) const {
    range = {std::min(range.bottom_mm, loops_.bottom_mm), std::max(range.top_mm, loops_.top_mm)};
    if (range.bottom_mm <= hull_.bottom_mm && hull_.top_mm <= range.top_mm) return range;
    return extended(range, height_mesh_beyond(std::get<SharedBSplineSurface>(model_[face_].surface),
                                              range.bottom_mm, range.top_mm));
}

HeightRange FreeformFace::extended(HeightRange range, const HeightMesh& mesh) const {
    const bool has_poles = !poles_of(model_[face_].surface).empty();
    for (const double up : {1.0, -1.0}) {
        const double border_mm = up > 0 ? range.top_mm : -range.bottom_mm;
        for (const std::uint32_t top : Tops(mesh, up, border_mm, has_poles).found()) {
            const MeshVertex& vertex = mesh.vertices[top];
            const bool is_beyond =
                up > 0 ? vertex.z_mm > range.top_mm : vertex.z_mm < range.bottom_mm;
            if (!is_beyond || !containment().holds_parameters(vertex.uv)) continue;
            (up > 0 ? range.top_mm : range.bottom_mm) = vertex.z_mm;
        }
    }
    return range;
}

}  // namespace lyr
