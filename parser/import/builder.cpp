// Faces, loops, edges and vertices, each edge and vertex when it is first met.

#include "parser/import/builder.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "kernel/brep/edge_builder.h"
#include "kernel/brep/extent.h"
#include "kernel/brep/volume.h"
#include "kernel/geometry/tolerance.h"
#include "parser/import/curves.h"
#include "parser/import/placement.h"

namespace lyr::importer {

namespace {

template <class T>
std::uint32_t index(const std::vector<T>& table) {
    return static_cast<std::uint32_t>(table.size());
}

// The loops of the face that is being added: those from `first` on.
struct NewLoops {
    const Model& model;
    std::uint32_t first;

    template <class Visit>
    void for_each_edge(Visit visit) const {
        for (std::uint32_t l = first; l < index(model.loops); ++l) {
            const Loop& loop = model.loops[l];
            for (std::uint32_t c = 0; c < loop.coedge_count; ++c)
                visit(model[model.coedges[loop.first_coedge + c].edge]);
        }
    }
};

// Of the polygon that the others lie in.
std::vector<Point3> outer_corners(const NewLoops& loops) {
    std::vector<Point3> outer;
    double widest_mm = -1;
    for (std::uint32_t l = loops.first; l < index(loops.model.loops); ++l) {
        const Loop& loop = loops.model.loops[l];
        std::vector<Point3> corners;
        Eigen::AlignedBox3d box;
        for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
            const Coedge& coedge = loops.model.coedges[loop.first_coedge + c];
            corners.push_back(loops.model[loops.model.start_of(coedge)].point);
            box.extend(corners.back());
        }
        if (corners.empty() || box.diagonal().norm() <= widest_mm) continue;
        widest_mm = box.diagonal().norm();
        outer = std::move(corners);
    }
    return outer;
}

bool closes(const Surface& surface) {
    if (const auto* spline = std::get_if<SharedBSplineSurface>(&surface))
        return (*spline)->closed_u && (*spline)->closed_v;
    return std::holds_alternative<Sphere>(surface) || std::holds_alternative<Torus>(surface);
}

std::vector<Point3> boundary_points(const NewLoops& loops) {
    std::vector<Point3> points;
    loops.for_each_edge([&](const Edge& edge) {
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

bool is_beyond_axis(const Surface& surface, const NewLoops& loops) {
    const auto* torus = std::get_if<Torus>(&surface);
    if (torus == nullptr || torus->minor_mm <= torus->major_mm) return false;
    for (std::uint32_t l = loops.first; l < index(loops.model.loops); ++l) {
        if (loops.model.loops[l].coedge_count == 0) continue;
        const Edge& edge = loops.model[loops.model.coedges[loops.model.loops[l].first_coedge].edge];
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

NappeSides nappe_sides(const Surface& surface, const NewLoops& loops) {
    NappeSides sides;
    const auto* cone = std::get_if<Cone>(&surface);
    if (cone == nullptr) return sides;
    loops.for_each_edge([&](const Edge& edge) {
        sides.add(*cone, loops.model[edge.start].point);
        sides.add(*cone, loops.model[edge.end].point);
    });
    return sides;
}

}  // namespace

Builder::Builder(const File& file, const Units& units, part21::Trail& trail,
                 Diagnostics& diagnostics)
    : file_(file), units_(units), trail_(trail), diagnostics_(diagnostics) {
    model_.uncertainty_mm = units.uncertainty_mm;
}

void Builder::begin_solid(std::string name, SourceId source) {
    vertices_.clear();
    edges_.clear();
    sides_.clear();
    model_.solids.push_back({std::move(name), index(model_.shells), 0, source});
}

Status Builder::add_shell(const ShellRecord& record, bool is_surface) {
    const ShellId shell(model_.shells.size());
    const SolidId solid(model_.solids.size() - 1);
    model_.shells.push_back({index(model_.faces), static_cast<std::uint32_t>(record.faces.size()),
                             solid, file_.id(record.shell), is_surface});
    ++model_.solids.back().shell_count;
    for (const FaceRecord& face : record.faces) {
        if (const Status status = add_face(record, face, shell); !status) return status;
    }
    return Done{};
}

void Builder::orient_last_shell(const ShellRecord& record, bool is_void, bool is_stated) {
    if (open_edge_count(record) > 0) return;
    const ShellOrientation found =
        orient_closed_shell(model_, ShellId(model_.shells.size() - 1), is_void);
    if (found.faces_turned > 0) {
        add_note(record.shell,
                 counted(found.faces_turned, "face") +
                     " with a same_sense that contradicts the loops; the loops are taken");
    }
    if (found.is_reversed && is_stated) {
        add_note(record.shell, "it is stated inside out and has been turned around");
    }
}

namespace {

Eigen::AlignedBox3d box_of(const Model& model, const Shell& shell) {
    // As many points of each edge as show an arc's bulge to a share of its size.
    constexpr int samples = 8;
    Eigen::AlignedBox3d box;
    for (std::uint32_t f = shell.first_face; f < shell.first_face + shell.face_count; ++f) {
        const Face& face = model.faces[f];
        for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
            const Loop& loop = model.loops[l];
            for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
                const Edge& edge = model[model.coedges[loop.first_coedge + c].edge];
                for (int i = 0; i <= samples; ++i) {
                    const double share = static_cast<double>(i) / samples;
                    box.extend(
                        evaluate(edge.curve, edge.t_start + share * (edge.t_end - edge.t_start)));
                }
            }
        }
    }
    return box;
}

}  // namespace

// The shells of the last solid as solids of their own: none is inside another.
void Builder::part_shells() {
    const Solid whole = model_.solids.back();
    model_.solids.pop_back();
    for (std::uint32_t s = 0; s < whole.shell_count; ++s) {
        const ShellId shell(std::size_t{whole.first_shell + s});
        if (signed_volume_mm3(model_, shell) < 0) reverse_shell(model_, shell);
        model_.shells[shell.value].solid = SolidId(model_.solids.size());
        model_.solids.push_back({whole.name, whole.first_shell + s, 1, whole.source});
    }
    diagnostics_.push_back({Severity::warning,
                            ExitStatus::geometry,
                            "a void of the solid reaches out of it: its shells are taken for "
                            "solids of their own",
                            {.entity = whole.source}});
}

void Builder::settle_outer_shell() {
    const Solid& solid = model_.solids.back();
    const ShellId first(std::size_t{solid.first_shell});
    ShellId outer = first;
    double most_mm3 = 0;
    for (std::uint32_t s = 0; s < solid.shell_count; ++s) {
        const ShellId shell(std::size_t{solid.first_shell + s});
        const double volume_mm3 = std::abs(signed_volume_mm3(model_, shell));
        if (volume_mm3 <= most_mm3) continue;
        most_mm3 = volume_mm3;
        outer = shell;
    }
    if (outer == first) return;
    if (!box_of(model_, model_[outer]).contains(box_of(model_, model_[first]))) {
        part_shells();
        return;
    }
    for (const ShellId shell : {first, outer}) reverse_shell(model_, shell);
    std::swap(model_.shells[first.value], model_.shells[outer.value]);
    for (const ShellId shell : {first, outer}) {
        const Shell& faces = model_[shell];
        for (std::uint32_t f = 0; f < faces.face_count; ++f) {
            model_.faces[faces.first_face + f].shell = shell;
        }
    }
    Diagnostic note{Severity::note,
                    ExitStatus::geometry,
                    "the solid's outer shell is smaller than its void #" +
                        std::to_string(model_[first].source) + ": they have been exchanged",
                    {.entity = solid.source}};
    diagnostics_.push_back(std::move(note));
}

void Builder::add_note(InstanceIndex instance, const std::string& message) {
    Diagnostic note =
        file_.error(instance, named(file_, instance) + ": " + message, ExitStatus::geometry);
    note.severity = Severity::note;
    diagnostics_.push_back(std::move(note));
}

// The kernel knows instances only.
Diagnostic Builder::in_file(Diagnostic found, InstanceIndex instance) const {
    const Location place = file_.location(instance);
    found.where.file = place.file;
    found.where.line = place.line;
    found.where.column = place.column;
    return found;
}

Status Builder::add_face(const ShellRecord& record, const FaceRecord& face, ShellId shell) {
    const std::uint32_t first_loop = index(model_.loops);
    for (std::uint32_t i = 0; i < face.loop_count; ++i) {
        const Status status = add_loop(record, record.loops[face.first_loop + i]);
        if (!status) return status;
    }
    const NewLoops loops{model_, first_loop};
    Result<StatedSurface> stated = surface_of(face, first_loop);
    if (!stated) return stated.error();
    Surface& surface = stated->surface;
    if (face.loop_count == 0 && !closes(surface)) {
        return file_.error(face.face, named(file_, face.face) +
                                          ": a face without bounds on an unbounded " +
                                          named(file_, face.surface));
    }
    const NappeSides sides = nappe_sides(surface, loops);
    if (sides.both()) {
        return unsupported(file_, face.face, "a face on both sides of a cone's apex");
    }
    if (sides.turned()) surface = other_nappe(std::get<Cone>(surface));
    // Files give the normal of a torus as d/du x d/dv, which turns where the tube has crossed the axis.
    const bool is_inner = !stated->sheet_is_stated && is_beyond_axis(surface, loops);
    if (is_inner) std::get<Torus>(surface).inner_sheet = true;
    const bool same_sense = (face.same_sense == stated->same_sense) != is_inner;
    model_.faces.push_back(
        {std::move(surface), same_sense, first_loop, face.loop_count, shell, file_.id(face.face)});
    if (!face.name.empty()) model_.face_names.emplace(file_.id(face.face), face.name);
    if (Status checked = check_extent(model_.faces.back()); !checked)
        return in_file(checked.error(), face.face);
    return Done{};
}

Result<StatedSurface> Builder::surface_of(const FaceRecord& face, std::uint32_t first_loop) {
    const NewLoops loops{model_, first_loop};
    if (!face.surface.valid()) return StatedSurface{plane_of(outer_corners(loops))};
    return read_surface(
        file_, face.face, face.surface, units_, [&] { return boundary_points(loops); }, trail_);
}

Status Builder::add_loop(const ShellRecord& record, const LoopRecord& loop) {
    const std::uint32_t first = index(model_.coedges);
    if (loop.vertex.valid()) {
        const Result<VertexId> vertex = vertex_of(loop.loop, loop.vertex);
        if (!vertex) return vertex.error();
    }
    for (std::uint32_t i = 0; i < loop.use_count; ++i) {
        const EdgeUse& use = record.uses[loop.first_use + i];
        Result<Coedge> coedge = coedge_of(loop.loop, use);
        if (!coedge && find_stand_ins(record, loop, i)) coedge = coedge_of(loop.loop, use);
        if (!coedge) return coedge.error();
        model_.coedges.push_back(*coedge);
    }
    model_.loops.push_back({first, loop.use_count, file_.id(loop.loop)});
    return Done{};
}

Result<Coedge> Builder::coedge_of(InstanceIndex loop, const EdgeUse& use) {
    if (use.edge.valid()) {
        const Result<EdgeId> edge = edge_of(use.edge);
        if (!edge) return edge.error();
        return Coedge{*edge, use.reversed};
    }
    const Result<Point3> from = read_point(file_, loop, use.from, units_);
    if (!from) return from.error();
    const Result<Point3> to = read_point(file_, loop, use.to, units_);
    if (!to) return to.error();
    return sides_.of_side(sides_.vertex_at(*from, file_.id(use.from)),
                          sides_.vertex_at(*to, file_.id(use.to)), file_.id(loop));
}

namespace {

// The attributes of EDGE_CURVE with the vertices that a use of it starts and ends at.
std::size_t start_attribute(const EdgeUse& use) {
    return use.reversed ? 2 : 1;
}
std::size_t end_attribute(const EdgeUse& use) {
    return use.reversed ? 1 : 2;
}

// A reference to nothing, as opposed to one into another file.
bool is_undefined(const Result<InstanceIndex>& reference) {
    return !reference && reference.error().status == ExitStatus::input;
}

}  // namespace

// Where an edge names a vertex that the file does not define, the edge before or after it in the loop has it.
bool Builder::find_stand_ins(const ShellRecord& record, const LoopRecord& loop, std::uint32_t i) {
    const auto at = [&](std::uint32_t k) {
        return record.uses[loop.first_use + k % loop.use_count];
    };
    const EdgeUse use = at(i), before = at(i + loop.use_count - 1), after = at(i + 1);
    if (!use.edge.valid() || !before.edge.valid() || !after.edge.valid()) return false;
    bool found = false;
    for (const bool start : {true, false}) {
        const std::size_t attribute = start ? start_attribute(use) : end_attribute(use);
        const EdgeUse& neighbour = start ? before : after;
        const std::size_t shared = start ? end_attribute(neighbour) : start_attribute(neighbour);
        const Fields own(file_, use.edge, 5), other(file_, neighbour.edge, 5);
        if (!own.ok() || !other.ok()) return false;
        const Result<InstanceIndex> missing = own.value(attribute).as_reference();
        if (!is_undefined(missing)) continue;
        const Result<InstanceIndex> vertex = other.value(shared).as_reference();
        if (!vertex) return false;
        stand_ins_[{use.edge.value, attribute}] = *vertex;
        Diagnostic warning = missing.error();
        warning.severity = Severity::warning;
        warning.message += "; the vertex of " + named(file_, neighbour.edge) +
                           ", next to it in the loop, stands in";
        diagnostics_.push_back(std::move(warning));
        found = true;
    }
    return found;
}

Result<VertexId> Builder::vertex_of(InstanceIndex user, InstanceIndex instance) {
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
    if (Status checked = check_extent(model_.vertices.back()); !checked)
        return in_file(checked.error(), instance);
    vertices_.emplace(instance.value, id);
    return id;
}

Result<EdgeId> Builder::edge_of(InstanceIndex instance) {
    const auto known = edges_.find(instance.value);
    if (known != edges_.end()) return known->second;
    // name, edge_start, edge_end, edge_geometry, same_sense
    Fields fields(file_, instance, 5);
    const auto vertex = [&](std::size_t attribute) {
        const auto stand_in = stand_ins_.find({instance.value, attribute});
        return stand_in != stand_ins_.end() ? stand_in->second : fields.reference(attribute);
    };
    const InstanceIndex from = vertex(1), to = vertex(2);
    const InstanceIndex geometry = fields.reference(3);
    const bool same_sense = fields.boolean(4);
    if (!fields.ok()) return fields.error();
    const Result<VertexId> start = vertex_of(instance, from);
    if (!start) return start.error();
    const Result<VertexId> end = vertex_of(instance, to);
    if (!end) return end.error();
    const Ends ends{model_[*start].point, model_[*end].point, same_sense};
    Result<DirectedCurve> curve = read_curve(file_, instance, geometry, units_, trail_, ends);
    if (!curve) return curve.error();
    const EdgeId id(model_.edges.size());
    model_.edges.push_back(make_edge(curve->curve, *start, *end, same_sense == curve->same_sense,
                                     file_.id(instance), model_, units_.uncertainty_mm,
                                     diagnostics_));
    if (Status checked = check_extent(model_.edges.back()); !checked)
        return in_file(checked.error(), instance);
    edges_.emplace(instance.value, id);
    return id;
}

}  // namespace lyr::importer
