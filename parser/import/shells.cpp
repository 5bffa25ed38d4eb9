// Shells, faces, bounds, loops, oriented edges. ISO 10303-42: a loop runs counter-clockwise about the face's
// normal, which is the surface's, turned around where same_sense is false. An oriented face or shell that is
// not oriented as its element turns both the normals and the loops.

#include "parser/import/shells.h"

#include <algorithm>
#include <unordered_map>

#include "kernel/brep/point_table.h"
#include "parser/import/placement.h"

namespace lyr::importer {

namespace {

class ShellReader {
public:
    ShellReader(const File& file, part21::Trail& trail) : file_(file), trail_(trail) {}

    Status read(InstanceIndex user, InstanceIndex shell, bool flip) {
        const auto step = trail_.enter(shell);
        if (!step) return step.error();
        const std::string_view type = keyword(file_, shell);
        if (type == "ORIENTED_CLOSED_SHELL" || type == "ORIENTED_OPEN_SHELL") {
            // name, cfs_faces (derived), element, orientation
            Fields fields(file_, shell, 4);
            const InstanceIndex element = fields.reference(2);
            const bool orientation = fields.boolean(3);
            if (!fields.ok()) return fields.error();
            return read(shell, element, flip != !orientation);
        }
        if (type != "CLOSED_SHELL" && type != "OPEN_SHELL" && type != "CONNECTED_FACE_SET") {
            return unexpected(file_, user, "a shell", shell);
        }
        Fields fields(file_, shell, 2);
        const std::vector<InstanceIndex> faces = fields.references(1);
        if (!fields.ok()) return fields.error();
        if (faces.empty()) return file_.error(shell, named(file_, shell) + " has no faces");
        for (const InstanceIndex face : faces) {
            if (const Status status = read_face(shell, face, flip); !status) return status;
        }
        return Done{};
    }

    ShellRecord take() { return std::move(record_); }

private:
    Status read_face(InstanceIndex user, InstanceIndex face, bool flip) {
        const auto step = trail_.enter(face);
        if (!step) return step.error();
        const std::string_view type = keyword(file_, face);
        if (type == "ORIENTED_FACE") {
            // name, bounds (derived), element, orientation
            Fields fields(file_, face, 4);
            const InstanceIndex element = fields.reference(2);
            const bool orientation = fields.boolean(3);
            if (!fields.ok()) return fields.error();
            return read_face(face, element, flip != !orientation);
        }
        const bool has_surface = type == "ADVANCED_FACE" || type == "FACE_SURFACE";
        if (!has_surface && type != "FACE") {
            if (type.find("FACE") == std::string_view::npos)
                return unexpected(file_, user, "a face", face);
            return unsupported(file_, face, "a face of " + named(file_, user));
        }
        Fields fields(file_, face, has_surface ? 4 : 2);
        const std::vector<InstanceIndex> bounds = fields.references(1);
        const InstanceIndex surface = has_surface ? fields.reference(2) : InstanceIndex();
        const bool same_sense = !has_surface || fields.boolean(3);
        if (!fields.ok()) return fields.error();
        // A name that is none is no reason to refuse a face.
        Result<std::string> name = fields.value(0).as_string();
        const auto first_loop = static_cast<std::uint32_t>(record_.loops.size());
        const std::size_t first_use = record_.uses.size();
        for (const InstanceIndex bound : bounds) {
            if (const Status status = read_bound(face, bound, flip); !status) return status;
        }
        const bool is_polygon =
            record_.uses.size() > first_use && !record_.uses[first_use].edge.valid();
        if (!has_surface && !is_polygon)
            return unsupported(file_, face, "a face of " + named(file_, user));
        record_.faces.push_back({face, surface, !has_surface || same_sense != flip, first_loop,
                                 static_cast<std::uint32_t>(bounds.size()),
                                 name ? std::move(*name) : std::string()});
        return Done{};
    }

    Status read_bound(InstanceIndex user, InstanceIndex bound, bool flip) {
        const std::string_view type = keyword(file_, bound);
        if (type != "FACE_OUTER_BOUND" && type != "FACE_BOUND") {
            return unexpected(file_, user, "FACE_BOUND or FACE_OUTER_BOUND", bound);
        }
        Fields fields(file_, bound, 3);
        const InstanceIndex loop = fields.reference(1);
        const bool orientation = fields.boolean(2);
        if (!fields.ok()) return fields.error();
        const auto first_use = static_cast<std::uint32_t>(record_.uses.size());
        const std::string_view loop_type = keyword(file_, loop);
        if (loop_type == "VERTEX_LOOP") {
            Fields loop_fields(file_, loop, 2);
            const InstanceIndex vertex = loop_fields.reference(1);
            if (!loop_fields.ok()) return loop_fields.error();
            record_.loops.push_back({loop, vertex, first_use, 0});
            return Done{};
        }
        if (loop_type != "EDGE_LOOP" && loop_type != "POLY_LOOP") {
            if (loop_type.find("LOOP") == std::string_view::npos)
                return unexpected(file_, bound, "a loop", loop);
            return unsupported(file_, loop, "a bound of " + named(file_, user));
        }
        const bool turns = flip != !orientation;
        const Status status =
            loop_type == "POLY_LOOP" ? read_polygon(loop, turns) : read_edge_loop(loop, turns);
        if (!status) return status;
        const auto count = static_cast<std::uint32_t>(record_.uses.size()) - first_use;
        record_.loops.push_back({loop, InstanceIndex(), first_use, count});
        return Done{};
    }

    Status read_edge_loop(InstanceIndex loop, bool flip) {
        Fields fields(file_, loop, 2);
        const std::vector<InstanceIndex> edges = fields.references(1);
        if (!fields.ok()) return fields.error();
        if (edges.empty()) return file_.error(loop, named(file_, loop) + " has no edges");
        const auto first = static_cast<std::ptrdiff_t>(record_.uses.size());
        for (const InstanceIndex edge : edges) {
            const Result<EdgeUse> use = read_use(loop, edge);
            if (!use) return use.error();
            record_.uses.push_back({use->edge, use->reversed != flip});
        }
        if (flip) std::reverse(record_.uses.begin() + first, record_.uses.end());
        return Done{};
    }

    Status read_polygon(InstanceIndex loop, bool flip) {
        Fields fields(file_, loop, 2);
        std::vector<InstanceIndex> points = fields.references(1);
        if (!fields.ok()) return fields.error();
        for (InstanceIndex& point : points) {
            const Result<InstanceIndex> first = first_like(loop, point);
            if (!first) return first.error();
            point = *first;
        }
        if (flip) std::reverse(points.begin(), points.end());
        const std::size_t before = record_.uses.size();
        for (std::size_t i = 0; i < points.size(); ++i) {
            const InstanceIndex from = points[i], to = points[(i + 1) % points.size()];
            if (from != to) record_.uses.push_back({InstanceIndex(), false, from, to});
        }
        if (record_.uses.size() - before < 3)
            return file_.error(loop, named(file_, loop) + ": three points or more expected");
        return Done{};
    }

    // The first point that has been met with the same coordinates.
    Result<InstanceIndex> first_like(InstanceIndex user, InstanceIndex point) {
        const Result<Point3> read = read_point(file_, user, point, Units{});
        if (!read) return read.error();
        const std::uint32_t number = points_.number_of(*read);
        if (number == first_points_.size()) first_points_.push_back(point);
        return first_points_[number];
    }

    Result<EdgeUse> read_use(InstanceIndex user, InstanceIndex oriented) {
        if (keyword(file_, oriented) != "ORIENTED_EDGE") {
            return unexpected(file_, user, "ORIENTED_EDGE", oriented);
        }
        // name, edge_start and edge_end (derived), element, orientation
        Fields fields(file_, oriented, 5);
        const InstanceIndex element = fields.reference(3);
        const bool orientation = fields.boolean(4);
        if (!fields.ok()) return fields.error();
        const std::string_view type = keyword(file_, element);
        if (type == "EDGE_CURVE") return EdgeUse{element, !orientation};
        if (type.find("EDGE") == std::string_view::npos) {
            return unexpected(file_, oriented, "EDGE_CURVE", element);
        }
        return unsupported(file_, element, "the edge of " + named(file_, oriented));
    }

    const File& file_;
    part21::Trail& trail_;
    ShellRecord record_;
    PointTable points_;
    std::vector<InstanceIndex> first_points_;
};

}  // namespace

Result<ShellRecord> read_shell(const File& file, InstanceIndex user, InstanceIndex shell,
                               part21::Trail& trail) {
    ShellReader reader(file, trail);
    if (const Status status = reader.read(user, shell, false); !status) return status.error();
    ShellRecord record = reader.take();
    record.shell = shell;
    return record;
}

std::size_t open_edge_count(const ShellRecord& shell) {
    struct Count {
        std::uint32_t along = 0, against = 0;
    };
    std::unordered_map<std::uint64_t, Count> counts;
    for (const EdgeUse& use : shell.uses) {
        const bool is_side = !use.edge.valid();
        const auto [low, high] = std::minmax(use.from.value, use.to.value);
        Count& count = counts[is_side ? std::uint64_t{high} << 32 | low : use.edge.value];
        const bool reversed = is_side ? use.from.value > use.to.value : use.reversed;
        ++(reversed ? count.against : count.along);
    }
    return static_cast<std::size_t>(std::count_if(
        counts.begin(), counts.end(),
        [](const auto& entry) { return entry.second.along != 1 || entry.second.against != 1; }));
}

}  // namespace lyr::importer
