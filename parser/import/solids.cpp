// Solids: which shells they have, and what each becomes (builder.h).

#include "parser/import/solids.h"

#include <algorithm>
#include <array>
#include <utility>

#include "parser/import/builder.h"
#include "parser/import/shells.h"
#include "parser/import/triangles.h"

namespace lyr::importer {

namespace {

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
    if (shells->shells.size() > 1) builder.settle_outer_shell();
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
    std::vector<ShellRecord> open;
    for (const InstanceIndex shell : shells) {
        if (taken.contains(shell.value)) continue;
        Result<ShellRecord> record = read_shell(file, item, shell, trail);
        if (!record) return record.error();
        if (open_edge_count(*record) > 0) {
            open.push_back(std::move(*record));
            continue;
        }
        builder.begin_solid(name, file.id(item));
        if (const Status status = builder.add_shell(*record); !status) return status.error();
        builder.orient_last_shell(*record, false, false);
    }
    if (!open.empty()) builder.begin_solid(name, file.id(item));
    for (const ShellRecord& record : open) {
        if (const Status status = builder.add_shell(record, true); !status) return status.error();
    }
    return Part{builder.take(), {}};
}

}  // namespace

ItemKind kind_of(const File& file, InstanceIndex item) {
    if (file.is_complex(item)) {
        if (file.is(item, "MANIFOLD_SOLID_BREP")) return ItemKind::solid;
        if (file.is(item, "MAPPED_ITEM")) return ItemKind::mapped;
        return file.is(item, "SOLID_MODEL") ? ItemKind::unsupported : ItemKind::other;
    }
    const std::string_view type = keyword(file, item);
    if (type == "MANIFOLD_SOLID_BREP" || type == "BREP_WITH_VOIDS" || type == "FACETED_BREP")
        return ItemKind::solid;
    if (type == "MAPPED_ITEM") return ItemKind::mapped;
    if (type == "SHELL_BASED_SURFACE_MODEL" || type == "FACE_BASED_SURFACE_MODEL")
        return ItemKind::surface_model;
    if (is_tessellated(type)) return ItemKind::tessellated;
    constexpr std::array others{"BREP_2D",
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
    for (const std::string_view type : {"MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "FACETED_BREP"}) {
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
    if (kind == ItemKind::tessellated) return read_triangles(file, item, units, diagnostics);
    if (kind == ItemKind::unsupported) return unsupported(file, item, "a solid");
    return read_solid(file, item, units, trail, diagnostics);
}

}  // namespace lyr::importer
