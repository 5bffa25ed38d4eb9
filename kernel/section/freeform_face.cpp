#include "kernel/section/freeform_face.h"

#include <algorithm>
#include <numeric>

#include "kernel/section/face_outline.h"

namespace lyr {
namespace {

HeightRange hull_of(const BSplineSurface& surface) {
    const auto [low, high] =
        std::minmax_element(surface.control_points.begin(), surface.control_points.end(),
                            [](const Point3& a, const Point3& b) { return a.z() < b.z(); });
    return {low->z(), high->z()};
}

// The vertices of a mesh in parts that hang together.
class Parts {
public:
    explicit Parts(std::size_t vertices) : next_(vertices) {
        std::iota(next_.begin(), next_.end(), 0u);
    }

    std::uint32_t of(std::uint32_t vertex) {
        while (next_[vertex] != vertex) vertex = next_[vertex] = next_[next_[vertex]];
        return vertex;
    }
    void join(std::uint32_t a, std::uint32_t b) { next_[of(a)] = of(b); }

private:
    std::vector<std::uint32_t> next_;  // on the way to the one that stands for the part
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

// What of the surface is above all edges of the face is crossed by none: each part of it that hangs together is in the
// face as a whole, or out of it. It is out of it where it reaches the surface's rim, but for a pole. Its highest point is a
// vertex of the mesh, to flat_cell_mm.
HeightRange FreeformFace::extended(HeightRange range, const HeightMesh& mesh) const {
    const bool has_poles = !poles_of(model_[face_].surface).empty();
    for (const double up : {1.0, -1.0}) {
        const double border_mm = up > 0 ? range.top_mm : -range.bottom_mm;
        const auto height_mm = [&](std::uint32_t v) { return up * mesh.vertices[v].z_mm; };
        Parts parts(mesh.vertices.size());
        for (const BorderPiece& piece : mesh.pieces)
            if (height_mm(piece.from) > border_mm && height_mm(piece.to) > border_mm)
                parts.join(piece.from, piece.to);
        constexpr std::uint32_t none = ~std::uint32_t{0};
        std::vector<std::uint32_t> highest(mesh.vertices.size(), none);  // by part
        std::vector<bool> reaches_rim(mesh.vertices.size(), false);
        for (const BorderPiece& piece : mesh.pieces) {
            for (const std::uint32_t vertex : {piece.from, piece.to}) {
                if (!(height_mm(vertex) > border_mm)) continue;
                const std::uint32_t part = parts.of(vertex);
                if (highest[part] == none || height_mm(vertex) > height_mm(highest[part]))
                    highest[part] = vertex;
                if (!has_poles && (piece.left < 0 || piece.right < 0)) reaches_rim[part] = true;
            }
        }
        for (std::uint32_t part = 0; part < highest.size(); ++part) {
            if (highest[part] == none || reaches_rim[part]) continue;
            const MeshVertex& top = mesh.vertices[highest[part]];
            const bool is_beyond = up > 0 ? top.z_mm > range.top_mm : top.z_mm < range.bottom_mm;
            if (!is_beyond || !containment().holds_parameters(top.uv)) continue;
            (up > 0 ? range.top_mm : range.bottom_mm) = top.z_mm;
        }
    }
    return range;
}

}  // namespace lyr
