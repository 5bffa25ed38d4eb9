// Coordinates, indices into them, strips and fans of triangles.

#include "parser/import/triangles.h"

#include <array>
#include <cmath>
#include <unordered_map>

#include "kernel/brep/polygon_sides.h"
#include "kernel/brep/volume.h"

namespace lyr::importer {

namespace {

// Where each kind of face has its attributes.
struct FaceForm {
    std::string_view type;
    std::size_t count,
        indices;  // of attributes; the number of `pnindex`, which triangles or strips and fans follow
    bool is_complex;
};
constexpr std::array face_forms{FaceForm{"TRIANGULATED_FACE", 7, 5, false},
                                FaceForm{"COMPLEX_TRIANGULATED_FACE", 8, 5, true},
                                FaceForm{"TRIANGULATED_SURFACE_SET", 6, 4, false},
                                FaceForm{"COMPLEX_TRIANGULATED_SURFACE_SET", 7, 4, true}};

const FaceForm* form_of(std::string_view type) {
    for (const FaceForm& form : face_forms) {
        if (form.type == type) return &form;
    }
    return nullptr;
}

using Corners = std::array<std::int64_t, 3>;  // as the file counts them, from 1

Status append_triangles(const part21::List& list, std::vector<Corners>& out) {
    for (const part21::Value& value : list) {
        std::vector<std::int64_t> corners;
        if (const Status status = value.append_integers(corners); !status) return status;
        if (corners.size() != 3) return value.expected("three indices");
        out.push_back({corners[0], corners[1], corners[2]});
    }
    return Done{};
}

// Every other triangle of a strip runs the other way; all of a fan have its first corner.
Status append_runs(const part21::List& list, bool is_fan, std::vector<Corners>& out) {
    for (const part21::Value& value : list) {
        std::vector<std::int64_t> run;
        if (const Status status = value.append_integers(run); !status) return status;
        if (run.size() < 3) return value.expected("three indices or more");
        for (std::size_t i = 2; i < run.size(); ++i) {
            if (is_fan) {
                out.push_back({run[0], run[i - 1], run[i]});
            } else if (i % 2 == 0) {
                out.push_back({run[i - 2], run[i - 1], run[i]});
            } else {
                out.push_back({run[i - 1], run[i - 2], run[i]});
            }
        }
    }
    return Done{};
}

class TriangleReader {
public:
    TriangleReader(const File& file, const Units& units) : file_(file), units_(units) {
        model_.uncertainty_mm = units.uncertainty_mm;
    }

    Status read(InstanceIndex item, const std::string& name,
                const std::vector<InstanceIndex>& faces) {
        model_.solids.push_back({name, 0, 1, file_.id(item)});
        for (const InstanceIndex face : faces) {
            const std::string_view type = keyword(file_, face);
            if (type == "TESSELLATED_EDGE" || type == "TESSELLATED_CONNECTING_EDGE" ||
                type == "TESSELLATED_VERTEX")
                continue;
            const FaceForm* form = form_of(type);
            if (form == nullptr) return unsupported(file_, face, "a face of triangles");
            if (const Status status = read_face(face, *form); !status) return status;
        }
        model_.shells.push_back(
            {0, static_cast<std::uint32_t>(model_.faces.size()), SolidId(0u), file_.id(item)});
        return Done{};
    }

    std::size_t open_count() const { return sides_.open_count(); }
    Model take() { return std::move(model_); }

private:
    Status read_face(InstanceIndex face, const FaceForm& form) {
        Fields fields(file_, face, form.count);
        const InstanceIndex coordinates = fields.reference(1);
        const std::vector<std::int64_t> indices = fields.integers(form.indices);
        const part21::List first = fields.list(form.indices + 1);
        const part21::List second = form.is_complex ? fields.list(form.indices + 2) : first;
        if (!fields.ok()) return fields.error();
        std::vector<Corners> triangles;
        Status status = form.is_complex ? append_runs(first, false, triangles)
                                        : append_triangles(first, triangles);
        if (status && form.is_complex) status = append_runs(second, true, triangles);
        if (!status) return status;
        const Result<const std::vector<VertexId>*> vertices = vertices_of(face, coordinates);
        if (!vertices) return vertices.error();
        for (const Corners& triangle : triangles) {
            std::array<VertexId, 3> corners;
            for (std::size_t i = 0; i < 3; ++i) {
                const std::int64_t index = looked_up(indices, triangle[i]);
                if (index < 1 || index > static_cast<std::int64_t>((*vertices)->size())) {
                    return file_.error(face, named(file_, face) + ": there is no point number " +
                                                 std::to_string(triangle[i]));
                }
                corners[i] = (**vertices)[static_cast<std::size_t>(index) - 1];
            }
            add(corners, file_.id(face));
        }
        return Done{};
    }

    // Without a list of indices, the points are counted themselves. 0: out of range.
    static std::int64_t looked_up(const std::vector<std::int64_t>& indices, std::int64_t number) {
        if (indices.empty()) return number;
        const bool in_range = number >= 1 && number <= static_cast<std::int64_t>(indices.size());
        return in_range ? indices[static_cast<std::size_t>(number) - 1] : 0;
    }

    void add(const std::array<VertexId, 3>& corners, SourceId source) {
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
            return;
        const auto first = static_cast<std::uint32_t>(model_.coedges.size());
        std::vector<Point3> points;
        for (std::size_t i = 0; i < 3; ++i) {
            model_.coedges.push_back(sides_.of_side(corners[i], corners[(i + 1) % 3], source));
            points.push_back(model_[corners[i]].point);
        }
        const auto loop = static_cast<std::uint32_t>(model_.loops.size());
        model_.loops.push_back({first, 3, source});
        model_.faces.push_back({plane_of(points), true, loop, 1, ShellId(0u), source});
    }

    Result<const std::vector<VertexId>*> vertices_of(InstanceIndex face,
                                                     InstanceIndex coordinates) {
        const auto [entry, is_new] = vertices_.try_emplace(coordinates.value);
        if (!is_new) return &entry->second;
        if (keyword(file_, coordinates) != "COORDINATES_LIST")
            return unexpected(file_, face, "COORDINATES_LIST", coordinates);
        Fields fields(file_, coordinates, 3);
        const part21::List list = fields.list(2);
        if (!fields.ok()) return fields.error();
        for (const part21::Value& value : list) {
            Point3 point;
            const Result<std::size_t> count = value.read_reals({point.data(), 3});
            if (!count) return count.error();
            if (*count != 3 || !point.allFinite()) return value.expected("three finite numbers");
            entry->second.push_back(
                sides_.vertex_at(units_.length_mm * point, file_.id(coordinates)));
        }
        return &entry->second;
    }

    const File& file_;
    const Units& units_;
    Model model_;
    PolygonSides sides_{model_};
    std::unordered_map<std::uint32_t, std::vector<VertexId>> vertices_;  // by COORDINATES_LIST
};

Diagnostic left_out(const File& file, InstanceIndex item, const std::string& why) {
    return file.error(item, named(file, item) + " is made of triangles" + why,
                      ExitStatus::unsupported);
}

}  // namespace

bool is_tessellated(std::string_view type) {
    return type == "TESSELLATED_SOLID" || type == "TESSELLATED_SHELL" || form_of(type) != nullptr;
}

Result<Part> read_triangles(const File& file, InstanceIndex item, const Units& units,
                            Diagnostics& diagnostics) {
    std::vector<InstanceIndex> faces{item};
    std::string name;
    if (form_of(keyword(file, item)) == nullptr) {
        // name, items, geometric_link or topological_link
        Fields fields(file, item, 3);
        if (!fields.value(0).is_unset()) name = fields.string(0);
        faces = fields.references(1);
        const InstanceIndex exact = fields.optional_reference(2);
        if (!fields.ok()) return fields.error();
        if (exact.valid())
            return Part{{}, {left_out(file, item, " that stand for " + named(file, exact))}};
    }
    TriangleReader reader(file, units);
    if (const Status status = reader.read(item, name, faces); !status) return status.error();
    if (const std::size_t sides = reader.open_count(); sides > 0) {
        return Part{{},
                    {left_out(file, item,
                              " that do not close (" + std::to_string(sides) +
                                  " sides are not shared by two of them)")}};
    }
    Part part{reader.take(), {}};
    if (part.model.faces.empty()) return Part{{}, {left_out(file, item, ", and there are none")}};
    if (signed_volume_mm3(part.model, ShellId(0u)) < 0) {
        reverse_shell(part.model, ShellId(0u));
        Diagnostic note = file.error(
            item, named(file, item) + ": it is stated inside out and has been turned around");
        note.severity = Severity::note;
        diagnostics.push_back(std::move(note));
    }
    return part;
}

}  // namespace lyr::importer
