// Cells meet along parameter lines, but not corner to corner. On every line the corners of the cells at both its sides
// are sorted; between neighbours lies one stretch of border, divided where its height turns.

#include "kernel/section/height_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/section/bezier_patch.h"

namespace lyr {
namespace {

// A corner of a cell as a point of a line of constant u (or v).
struct Stop {
    double line, at;

    bool operator<(const Stop& other) const {
        return line != other.line ? line < other.line : at < other.at;
    }
    bool operator==(const Stop& other) const { return line == other.line && at == other.at; }
};

// The border pieces of the stretch that begins at each stop: [first, first + count).
struct Stretch {
    std::uint32_t first = 0, count = 0;
};

// The lines of one direction.
struct Lines {
    std::vector<Stop> stops;
    std::vector<Stretch> stretches;

    std::size_t index(double line, double at) const {
        return static_cast<std::size_t>(
            std::lower_bound(stops.begin(), stops.end(), Stop{line, at}) - stops.begin());
    }
};

class Builder {
public:
    explicit Builder(HeightMesh& mesh) : mesh_(mesh), surface_(*mesh.surface) {}

    void build() {
        for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
            append_monotone_cells(mesh_.patches[p], static_cast<std::uint32_t>(p), mesh_.cells);
            mesh_.quartic_parts.push_back(quartic_part(mesh_.patches[p]));
        }
        along_u_ = lines(true);
        along_v_ = lines(false);
        for (const Stop& stop : along_v_.stops) add_vertex({stop.line, stop.at});
        for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
            const MonotoneCell cell = mesh_.cells[c];
            const auto id = static_cast<std::int32_t>(c);
            add_side(true, cell.from_v, cell.from_u, cell.to_u, cell.patch, id, true);
            add_side(false, cell.to_u, cell.from_v, cell.to_v, cell.patch, id, true);
            add_side(true, cell.to_v, cell.from_u, cell.to_u, cell.patch, id, false);
            add_side(false, cell.from_u, cell.from_v, cell.to_v, cell.patch, id, false);
        }
        std::vector<HeightInterval> intervals;
        for (std::size_t i = 0; i < mesh_.pieces.size(); ++i) {
            const double a = mesh_.vertices[mesh_.pieces[i].from].z_mm;
            const double b = mesh_.vertices[mesh_.pieces[i].to].z_mm;
            if (a == b) continue;
            intervals.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(i)});
        }
        mesh_.pieces_by_height = IntervalIndex(std::move(intervals));
    }

private:
    // A closed surface's last line is its first.
    double wrapped(bool is_u, double parameter) const {
        if (is_u ? !surface_.closed_u : !surface_.closed_v) return parameter;
        const double end = is_u ? surface_.end_u() : surface_.end_v();
        return parameter == end ? (is_u ? surface_.start_u() : surface_.start_v()) : parameter;
    }

    Lines lines(bool along_u) const {
        Lines lines;
        for (const MonotoneCell& cell : mesh_.cells) {
            for (const double fixed : along_u ? std::array{cell.from_v, cell.to_v}
                                              : std::array{cell.from_u, cell.to_u}) {
                const double line = wrapped(!along_u, fixed);
                const double from = along_u ? cell.from_u : cell.from_v;
                const double to = along_u ? cell.to_u : cell.to_v;
                lines.stops.push_back({line, from});
                lines.stops.push_back({line, to});
                if (wrapped(along_u, to) != to) lines.stops.push_back({line, wrapped(along_u, to)});
            }
        }
        std::sort(lines.stops.begin(), lines.stops.end());
        lines.stops.erase(std::unique(lines.stops.begin(), lines.stops.end()), lines.stops.end());
        lines.stretches.resize(lines.stops.size());
        return lines;
    }

    std::uint32_t add_vertex(const Point2& uv) {
        mesh_.vertices.push_back({uv, evaluate(surface_, uv).z()});
        return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
    }

    // The vertex at a corner of a cell: there is one for each stop of the lines along v.
    std::uint32_t corner(double u, double v) const {
        return static_cast<std::uint32_t>(along_v_.index(wrapped(true, u), wrapped(false, v)));
    }

    // One side of a cell, which lies to the left or right of its rising direction.
    void add_side(bool along_u, double fixed, double from, double to, std::uint32_t patch,
                  std::int32_t cell, bool cell_is_left) {
        Lines& lines = along_u ? along_u_ : along_v_;
        // Counter-clockwise around it, a cell is on the left of its bottom and its right side.
        const double line = wrapped(!along_u, fixed);
        const std::size_t last = lines.index(line, to);
        for (std::size_t s = lines.index(line, from); s < last; ++s) {
            Stretch& stretch = lines.stretches[s];
            if (stretch.count == 0) {
                stretch =
                    make_stretch(along_u, fixed, lines.stops[s].at, lines.stops[s + 1].at, patch);
            }
            for (std::uint32_t i = 0; i < stretch.count; ++i) {
                BorderPiece& piece = mesh_.pieces[stretch.first + i];
                (cell_is_left ? piece.left : piece.right) = cell;
            }
        }
    }

    Stretch make_stretch(bool along_u, double fixed, double from, double to, std::uint32_t patch) {
        turns_.clear();
        IsoLine(mesh_.patches[patch], along_u, fixed).append_turns(from, to, turns_);
        const auto first = static_cast<std::uint32_t>(mesh_.pieces.size());
        const auto point = [&](double at) {
            return along_u ? Point2(at, fixed) : Point2(fixed, at);
        };
        const Point2 end = point(to);
        std::uint32_t before = corner(point(from).x(), point(from).y());
        double at = from;
        for (const double turn : turns_) {
            const std::uint32_t next = add_vertex(point(turn));
            mesh_.pieces.push_back({before, next, along_u, fixed, at, turn, patch});
            before = next;
            at = turn;
        }
        mesh_.pieces.push_back({before, corner(end.x(), end.y()), along_u, fixed, at, to, patch});
        return {first, static_cast<std::uint32_t>(mesh_.pieces.size()) - first};
    }

    HeightMesh& mesh_;
    const BSplineSurface& surface_;
    Lines along_u_, along_v_;
    std::vector<double> turns_;
};

// Where a B-spline may have a corner: knots that are there as often as its degree says.
std::vector<double> creases_of(const std::vector<double>& knots, int degree) {
    std::vector<double> creases;
    const auto stride = static_cast<std::size_t>(degree) - 1;
    for (std::size_t i = 0; i + stride < knots.size(); ++i)
        if (knots[i] == knots[i + stride] && (creases.empty() || creases.back() != knots[i]))
            creases.push_back(knots[i]);
    return creases;
}

}  // namespace

bool HeightMesh::is_smooth_at(const Point2& uv) const {
    return std::find(creases_u.begin(), creases_u.end(), uv.x()) == creases_u.end() &&
           std::find(creases_v.begin(), creases_v.end(), uv.y()) == creases_v.end();
}

HeightMesh height_mesh(std::shared_ptr<const BSplineSurface> surface) {
    HeightMesh mesh;
    mesh.surface = std::move(surface);
    mesh.creases_u = creases_of(mesh.surface->knots_u, mesh.surface->degree_u);
    mesh.creases_v = creases_of(mesh.surface->knots_v, mesh.surface->degree_v);
    mesh.patches = bezier_patches(*mesh.surface).patches;
    Builder(mesh).build();
    return mesh;
}

HeightMesh height_mesh_beyond(std::shared_ptr<const BSplineSurface> surface, double bottom_mm,
                              double top_mm) {
    HeightMesh mesh;
    mesh.surface = std::move(surface);
    mesh.patches = bezier_patches(*mesh.surface).patches;
    std::erase_if(mesh.patches, [&](const BezierPatch& patch) {
        return std::all_of(patch.control_points.begin(), patch.control_points.end(),
                           [&](const Eigen::Vector4d& point) {
                               return bottom_mm * point.w() <= point.z() &&
                                      point.z() <= top_mm * point.w();
                           });
    });
    Builder(mesh).build();
    return mesh;
}

}  // namespace lyr
