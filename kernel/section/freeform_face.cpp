#include "kernel/section/freeform_face.h"

#include <algorithm>

namespace lyr {
namespace {

HeightRange hull_of(const BSplineSurface& surface) {
    const auto [low, high] =
        std::minmax_element(surface.control_points.begin(), surface.control_points.end(),
                            [](const Point3& a, const Point3& b) { return a.z() < b.z(); });
    return {low->z(), high->z()};
}

// One bit for each way along which the height rises: u, v, against u, against v.
using Ways = std::uint8_t;
constexpr Ways all_ways = 15;

// Those of which a cell is proof, its border included. At the rim of the surface (no cell) there is none.
Ways rising_ways(const HeightMesh& mesh, std::int32_t cell) {
    if (cell < 0) return 0;
    const MonotoneCell& c = mesh.cells[static_cast<std::size_t>(cell)];
    if (c.kind == CellKind::graph_over_u) return c.rises_v ? 2 : 8;
    if (c.kind == CellKind::graph_over_v) return c.rises_u ? 1 : 4;
    return 0;
}

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

// A highest point inside the face is a vertex of the mesh, to flat_cell_mm, with no higher neighbour. What lies across the
// pieces tells too: where all cells around a vertex rise the same way, it is none.
HeightRange FreeformFace::extended(HeightRange range, const HeightMesh& mesh) const {
    const std::vector<MeshVertex>& vertices = mesh.vertices;
    std::vector<bool> has_higher(vertices.size(), false), has_lower(vertices.size(), false);
    std::vector<bool> used(vertices.size(), false);  // the doubles at a seam are not
    std::vector<Ways> rising(vertices.size(), all_ways);
    for (const BorderPiece& piece : mesh.pieces) {
        const double rise = vertices[piece.to].z_mm - vertices[piece.from].z_mm;
        used[piece.from] = used[piece.to] = true;
        has_higher[piece.from] = has_higher[piece.from] || rise > 0;
        has_lower[piece.from] = has_lower[piece.from] || rise < 0;
        has_higher[piece.to] = has_higher[piece.to] || rise < 0;
        has_lower[piece.to] = has_lower[piece.to] || rise > 0;
        for (const std::int32_t cell : {piece.left, piece.right}) {
            const Ways ways = rising_ways(mesh, cell);
            rising[piece.from] &= ways;
            rising[piece.to] &= ways;
        }
    }
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        const double z = vertices[v].z_mm;
        const bool beyond =
            (z > range.top_mm && !has_higher[v]) || (z < range.bottom_mm && !has_lower[v]);
        if (!beyond || !used[v] || rising[v] != 0) continue;
        if (!containment().holds_parameters(vertices[v].uv)) continue;
        range = {std::min(range.bottom_mm, z), std::max(range.top_mm, z)};
    }
    return range;
}

}  // namespace lyr
