// Solids: shells' topology first (shells.h), then the geometry that hangs on it.

#include "parser/import/solids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "kernel/brep/edge_builder.h"
#include "kernel/brep/volume.h"
#include "kernel/geometry/tolerance.h"
#include "parser/import/curves.h"
#include "parser/import/placement.h"
#include "parser/import/shells.h"
#include "parser/import/surfaces.h"

namespace lyr::importer {

namespace {

// Fills one model with the shells of one solid after the other.
class Builder {
public:
    Builder(const File& file, const Units& units, part21::Trail& trail, Diagnostics& diagnostics)
        : file_(file), units_(units), trail_(trail), diagnostics_(diagnostics) {
        model_.uncertainty_mm = units.uncertainty_mm;
    }

    void begin_solid(std::string name, SourceId source) {
        vertices_.clear();
        edges_.clear();
        model_.solids.push_back({std::move(name), index(model_.shells), 0, source});
    }

    Status add_shell(const ShellRecord& record) {
        const ShellId shell(model_.shells.size());
        const SolidId solid(model_.solids.size() - 1);
        model_.shells.push_back({index(model_.faces),
                                 static_cast<std::uint32_t>(record.faces.size()), solid,
                                 file_.id(record.shell)});
        ++model_.solids.back().shell_count;
        for (const FaceRecord& face : record.faces) {
            if (const Status status = add_face(record, face, shell); !status) return status;
        }
        return Done{};
    }

    // What closes has an inside, and that decides where faces look. Files do not agree on it: some give same_sense
    // against the loops, some turn a void's shell before its orientation flag is applied and some after, and a
    // surface model does not say.
    void orient_last_shell(const ShellRecord& record, bool is_void, bool is_stated) {
        if (open_edge_count(record) > 0) return;
        const ShellId shell(model_.shells.size() - 1);
        if (const std::size_t faces = follow_loops(model_[shell]); faces > 0) {
            add_note(
                record.shell,
                std::to_string(faces) +
                    " faces have a same_sense that contradicts their loops; the loops are taken");
        }
        const double volume_mm3 = signed_volume_mm3(model_, shell);
        if (is_void ? volume_mm3 <= 0 : volume_mm3 >= 0) return;
        reverse_shell(model_, shell);
        if (is_stated) add_note(record.shell, "it is stated inside out and has been turned around");
    }

    Model take() { return std::move(model_); }

private:
    template <class T>
    static std::uint32_t index(const std::vector<T>& table) {
        return static_cast<std::uint32_t>(table.size());
    }

    void add_note(InstanceIndex instance, const std::string& message) {
        Diagnostic note = file_.error(instance, named(file_, instance) + ": " + message);
        note.severity = Severity::note;
        diagnostics_.push_back(std::move(note));
    }

    // In a closed shell, loops agree with those next to them; same_sense is one face's word alone. The number of
    // faces that have been turned.
    std::size_t follow_loops(const Shell& shell) {
        std::size_t turned = 0;
        for (std::uint32_t f = shell.first_face; f < shell.first_face + shell.face_count; ++f) {
            if (!(signed_area_mm2(model_, FaceId(std::size_t{f})) < -certain_area_mm2)) continue;
            model_.faces[f].same_sense = !model_.faces[f].same_sense;
            ++turned;
        }
        return turned;
    }

    // The sign of a sliver's area is that of its edges' round-off: resolution_mm over a length of ten metres.
    static constexpr double certain_area_mm2 = resolution_mm * 1e4;

    Status add_face(const ShellRecord& record, const FaceRecord& face, ShellId shell) {
        const std::uint32_t first_loop = index(model_.loops);
        for (std::uint32_t i = 0; i < face.loop_count; ++i) {
            const Status status = add_loop(record, record.loops[face.first_loop + i]);
            if (!status) return status;
        }
        Result<StatedSurface> stated = read_surface(
            file_, face.face, face.surface, units_, [&] { return boundary_points(first_loop); },
            trail_);
        if (!stated) return stated.error();
        Surface& surface = stated->surface;
        if (face.loop_count == 0 && !closes(surface)) {
            return file_.error(face.face, named(file_, face.face) +
                                              ": a face without bounds on an unbounded " +
                                              named(file_, face.surface));
        }
        const NappeSides sides = nappe_sides(surface, first_loop);
        if (sides.both()) {
            return unsupported(file_, face.face, "a face on both sides of a cone's apex");
        }
        if (sides.turned()) surface = other_nappe(std::get<Cone>(surface));
        // Files give the normal of a torus as d/du x d/dv, which turns where the tube has crossed the axis.
        const bool is_inner = !stated->sheet_is_stated && is_beyond_axis(surface, first_loop);
        if (is_inner) std::get<Torus>(surface).inner_sheet = true;
        const bool same_sense = (face.same_sense == stated->same_sense) != is_inner;
        model_.faces.push_back({std::move(surface), same_sense, first_loop, face.loop_count, shell,
                                file_.id(face.face)});
        return Done{};
    }

    static bool closes(const Surface& surface) {
        if (const auto* spline = std::get_if<SharedBSplineSurface>(&surface))
            return (*spline)->closed_u && (*spline)->closed_v;
        return std::holds_alternative<Sphere>(surface) || std::holds_alternative<Torus>(surface);
    }

    // Calls visit(edge) for the edges of the loops from `first_loop` on.
    template <class Visit>
    void for_each_edge(std::uint32_t first_loop, Visit visit) const {
        for (std::uint32_t l = first_loop; l < index(model_.loops); ++l) {
            const Loop& loop = model_.loops[l];
            for (std::uint32_t c = 0; c < loop.coedge_count; ++c)
                visit(model_[model_.coedges[loop.first_coedge + c].edge]);
        }
    }

    std::vector<Point3> boundary_points(std::uint32_t first_loop) const {
        std::vector<Point3> points;
        for_each_edge(first_loop, [&](const Edge& edge) {
            if (const auto* spline = std::get_if<BSplineCurve>(&edge.curve)) {
                points.insert(points.end(), spline->control_points.begin(),
                              spline->control_points.end());
                return;
            }
            const int steps = std::holds_alternative<Line>(edge.curve) ? 1 : 16;
            for (int i = 0; i <= steps; ++i) {
                const double t = edge.t_start + (edge.t_end - edge.t_start) * i / steps;
                points.push_back(evaluate(edge.curve, t));
            }
        });
        return points;
    }

    bool is_beyond_axis(const Surface& surface, std::uint32_t first_loop) const {
        const auto* torus = std::get_if<Torus>(&surface);
        if (torus == nullptr || torus->minor_mm <= torus->major_mm) return false;
        for (std::uint32_t l = first_loop; l < index(model_.loops); ++l) {
            if (model_.loops[l].coedge_count == 0) continue;
            const Edge& edge = model_[model_.coedges[model_.loops[l].first_coedge].edge];
            return beyond_axis(*torus, evaluate(edge.curve, 0.5 * (edge.t_start + edge.t_end)));
        }
        return false;
    }

    // How far the vertices of a face on a cone go to either side of the apex, as radii.
    struct NappeSides {
        double positive_mm = 0, negative_mm = 0;

        void add(const Cone& cone, const Point3& point) {
            const double height = cone.frame.to_local(point).z();
            const double radius_mm = cone.radius_mm + height * std::tan(cone.half_angle_rad);
            positive_mm = std::max(positive_mm, radius_mm);
            negative_mm = std::max(negative_mm, -radius_mm);
        }
        // A vertex at the apex lies on either side by the rounding of the file; no real face has less than a
        // thousandth of itself beyond the apex.
        bool both() const { return std::min(positive_mm, negative_mm) > largest() / 1000; }
        bool turned() const { return negative_mm > positive_mm; }
        double largest() const { return std::max(positive_mm, negative_mm); }
    };

    NappeSides nappe_sides(const Surface& surface, std::uint32_t first_loop) const {
        NappeSides sides;
        const auto* cone = std::get_if<Cone>(&surface);
        if (cone == nullptr) return sides;
        for_each_edge(first_loop, [&](const Edge& edge) {
            sides.add(*cone, model_[edge.start].point);
            sides.add(*cone, model_[edge.end].point);
        });
        return sides;
    }

    Status add_loop(const ShellRecord& record, const LoopRecord& loop) {
        const std::uint32_t first = index(model_.coedges);
        if (loop.vertex.valid()) {
            const Result<VertexId> vertex = vertex_of(loop.loop, loop.vertex);
            if (!vertex) return vertex.error();
        }
        for (std::uint32_t i = 0; i < loop.use_count; ++i) {
            const EdgeUse& use = record.uses[loop.first_use + i];
            const Result<EdgeId> edge = edge_of(use.edge);
            if (!edge) return edge.error();
            model_.coedges.push_back({*edge, use.reversed});
        }
        model_.loops.push_back({first, loop.use_count, file_.id(loop.loop)});
        return Done{};
    }

    Result<VertexId> vertex_of(InstanceIndex user, InstanceIndex instance) {
        const auto known = vertices_.find(instance.value);
        if (known != vertices_.end()) return known->second;
        if (keyword(file_, instance) != "VERTEX_POINT") {
            return unexpected(file_, user, "VERTEX_POINT", instance);
        }
        Fields fields(file_, instance, 2);
        const InstanceIndex geometry = fields.reference(1);
        if (!fields.ok()) return fields.error();
        const Result<Point3> point = read_point(file_, instance, geometry, units_);
        if (!point) return point.error();
        const VertexId id(model_.vertices.size());
        model_.vertices.push_back({*point, file_.id(instance)});
        vertices_.emplace(instance.value, id);
        return id;
    }

    Result<EdgeId> edge_of(InstanceIndex instance) {
        const auto known = edges_.find(instance.value);
        if (known != edges_.end()) return known->second;
        // name, edge_start, edge_end, edge_geometry, same_sense
        Fields fields(file_, instance, 5);
        const InstanceIndex from = fields.reference(1), to = fields.reference(2);
        const InstanceIndex geometry = fields.reference(3);
        const bool same_sense = fields.boolean(4);
        if (!fields.ok()) return fields.error();
        const Result<VertexId> start = vertex_of(instance, from);
        if (!start) return start.error();
        const Result<VertexId> end = vertex_of(instance, to);
        if (!end) return end.error();
        Result<DirectedCurve> curve = read_curve(file_, instance, geometry, units_, trail_);
        if (!curve) return curve.error();
        const EdgeId id(model_.edges.size());
        model_.edges.push_back(make_edge(curve->curve, *start, *end,
                                         same_sense == curve->same_sense, file_.id(instance),
                                         model_, units_.uncertainty_mm, diagnostics_));
        edges_.emplace(instance.value, id);
        return id;
    }

    const File& file_;
    const Units& units_;
    part21::Trail& trail_;
    Diagnostics& diagnostics_;
    Model model_;
    std::unordered_map<std::uint32_t, VertexId> vertices_;
    std::unordered_map<std::uint32_t, EdgeId> edges_;
};

struct SolidShells {
    std::string name;
    std::vector<InstanceIndex> shells;  // the outer one first
};

Result<SolidShells> solid_shells(const File& file, InstanceIndex solid) {
    const bool with_voids = file.is(solid, "BREP_WITH_VOIDS");
    const std::size_t own = with_voids && !file.is_complex(solid) ? 2 : 1;
    SolidShells result;
    Attributes a(file, solid, "MANIFOLD_SOLID_BREP", 1, own);
    result.shells.push_back(a.fields.reference(a.first));
    if (a.first > 0 && !a.fields.value(0).is_unset()) result.name = a.fields.string(0);
    if (!a.fields.ok()) return a.fields.error();
    if (with_voids) {
        Attributes voids(file, solid, "BREP_WITH_VOIDS", 2, 1);
        const std::vector<InstanceIndex> shells = voids.fields.references(voids.first);
        if (!voids.fields.ok()) return voids.fields.error();
        result.shells.insert(result.shells.end(), shells.begin(), shells.end());
    }
    return result;
}

Result<Part> read_solid(const File& file, InstanceIndex item, const Units& units,
                        part21::Trail& trail, Diagnostics& diagnostics) {
    const Result<SolidShells> shells = solid_shells(file, item);
    if (!shells) return shells.error();
    Builder builder(file, units, trail, diagnostics);
    builder.begin_solid(shells->name, file.id(item));
    for (const InstanceIndex shell : shells->shells) {
        const Result<ShellRecord> record = read_shell(file, item, shell, trail);
        if (!record) return record.error();
        if (const Status status = builder.add_shell(*record); !status) return status.error();
        builder.orient_last_shell(*record, shell != shells->shells.front(), true);
    }
    return Part{builder.take(), {}};
}

Result<Part> read_surface_model(const File& file, InstanceIndex item, const Units& units,
                                const ShellSet& taken, part21::Trail& trail,
                                Diagnostics& diagnostics) {
    Fields fields(file, item, 2);
    const std::string name = fields.value(0).is_unset() ? std::string() : fields.string(0);
    const std::vector<InstanceIndex> shells = fields.references(1);
    if (!fields.ok()) return fields.error();
    Builder builder(file, units, trail, diagnostics);
    Diagnostics open;
    for (const InstanceIndex shell : shells) {
        if (taken.contains(shell.value)) continue;
        const Result<ShellRecord> record = read_shell(file, item, shell, trail);
        if (!record) return record.error();
        if (const std::size_t edges = open_edge_count(*record); edges > 0) {
            open.push_back(
                file.error(shell,
                           named(file, shell) + " is an open surface (" + std::to_string(edges) +
                               " edges are not shared by two faces); sewing is not supported",
                           ExitStatus::unsupported));
            continue;
        }
        builder.begin_solid(name, file.id(item));
        if (const Status status = builder.add_shell(*record); !status) return status.error();
        builder.orient_last_shell(*record, false, false);
    }
    return Part{builder.take(), std::move(open)};
}

}  // namespace

ItemKind kind_of(const File& file, InstanceIndex item) {
    if (file.is_complex(item)) {
        if (file.is(item, "MANIFOLD_SOLID_BREP")) return ItemKind::solid;
        if (file.is(item, "MAPPED_ITEM")) return ItemKind::mapped;
        return file.is(item, "SOLID_MODEL") ? ItemKind::unsupported : ItemKind::other;
    }
    const std::string_view type = keyword(file, item);
    if (type == "MANIFOLD_SOLID_BREP" || type == "BREP_WITH_VOIDS") return ItemKind::solid;
    if (type == "MAPPED_ITEM") return ItemKind::mapped;
    if (type == "SHELL_BASED_SURFACE_MODEL" || type == "FACE_BASED_SURFACE_MODEL")
        return ItemKind::surface_model;
    if (type == "TESSELLATED_SOLID" || type == "TESSELLATED_SHELL") return ItemKind::tessellated;
    constexpr std::array others{"FACETED_BREP",
                                "BREP_2D",
                                "CSG_SOLID",
                                "BOOLEAN_RESULT",
                                "EXTRUDED_AREA_SOLID",
                                "EXTRUDED_FACE_SOLID",
                                "REVOLVED_AREA_SOLID",
                                "REVOLVED_FACE_SOLID",
                                "SURFACE_CURVE_SWEPT_AREA_SOLID",
                                "SURFACE_CURVE_SWEPT_FACE_SOLID",
                                "SWEPT_DISK_SOLID",
                                "SOLID_REPLICA",
                                "TRIMMED_VOLUME",
                                "BLOCK",
                                "RIGHT_ANGULAR_WEDGE",
                                "RIGHT_CIRCULAR_CYLINDER",
                                "RIGHT_CIRCULAR_CONE",
                                "SPHERE",
                                "TORUS",
                                "ELLIPSOID"};
    for (const std::string_view other : others) {
        if (type == other) return ItemKind::unsupported;
    }
    return ItemKind::other;
}

ShellSet shells_of_solids(const File& file) {
    ShellSet shells;
    for (const std::string_view type : {"MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS"}) {
        for (const InstanceIndex solid : file.instances_of(type)) {
            const Result<SolidShells> found = solid_shells(file, solid);
            if (found) shells.insert(found->shells.front().value);
        }
    }
    return shells;
}

Result<Part> read_item(const File& file, InstanceIndex item, const Units& units,
                       const ShellSet& taken, part21::Trail& trail, Diagnostics& diagnostics) {
    const ItemKind kind = kind_of(file, item);
    if (kind == ItemKind::surface_model) {
        return read_surface_model(file, item, units, taken, trail, diagnostics);
    }
    if (kind == ItemKind::tessellated) {
        return Part{
            {},
            {file.error(item, named(file, item) + " is made of triangles, not of exact surfaces",
                        ExitStatus::unsupported)}};
    }
    if (kind == ItemKind::unsupported) return unsupported(file, item, "a solid");
    return read_solid(file, item, units, trail, diagnostics);
}

}  // namespace lyr::importer
