// The importer: which solids stand where (structure.h), each solid once as a part (solids.h), and copies of it in
// its places.

#include "parser/import/import.h"

#include <unordered_map>

#include "kernel/brep/assembly.h"
#include "kernel/brep/placement.h"
#include "parser/import/solids.h"
#include "parser/import/structure.h"
#include "parser/import/units.h"

namespace lyr::importer {

namespace {

// Places by item and units, in the order in which items are first met: a part is read once.
struct Occurrences {
    const Placed* first;
    std::vector<const Placed*> all;
};

std::vector<Occurrences> by_item(const std::vector<Placed>& placed) {
    std::vector<Occurrences> result;
    std::unordered_map<std::uint64_t, std::size_t> known;
    for (const Placed& place : placed) {
        const std::uint64_t key = std::uint64_t{place.item.value} << 32 | place.context.value;
        const auto [entry, is_new] = known.emplace(key, result.size());
        if (is_new) result.push_back({&place, {}});
        result[entry->second].all.push_back(&place);
    }
    return result;
}

Model at_place(const Model& part, const Placed& place) {
    Model model =
        place.placement.matrix().isIdentity(0) ? part : transformed(part, place.placement);
    for (Solid& solid : model.solids) {
        if (solid.name.empty()) solid.name = place.product;
    }
    return model;
}

// Diagnostics of the kernel know the #id only.
void complete_places(const File& file, Diagnostics& diagnostics, std::size_t first) {
    for (std::size_t i = first; i < diagnostics.size(); ++i) {
        Location& where = diagnostics[i].where;
        if (!where.file.empty()) continue;
        where.file = file.name();
        const InstanceIndex instance = file.find(where.entity);
        if (!instance.valid()) continue;
        const Location place = file.location(instance);
        where.line = place.line;
        where.column = place.column;
    }
}

Diagnostic no_solid(const File& file) {
    std::string message = "no solid in the file";
    if (!file.instances_of("DOCUMENT_FILE").empty()) {
        message += "; its parts are in other files, which have to be sliced themselves";
    } else if (!file.instances_of("GEOMETRIC_CURVE_SET").empty()) {
        message += ", only curves; export the part as a solid";
    }
    return {Severity::error, ExitStatus::input, std::move(message), {.file = file.name()}};
}

}  // namespace

Result<Model> import_model(const part21::File& file, Diagnostics& diagnostics) {
    UnitTable units(file, diagnostics);
    const Result<std::vector<Placed>> placed = placed_items(file, units, diagnostics);
    if (!placed) return placed.error();
    const std::size_t first_diagnostic = diagnostics.size();
    const ShellSet taken = shells_of_solids(file);
    part21::Trail trail(file);
    Model model;
    Diagnostics open;
    for (const Occurrences& occurrences : by_item(*placed)) {
        const Placed& first = *occurrences.first;
        const Result<Units> item_units = units.of_context(first.context);
        if (!item_units) return item_units.error();
        Result<Part> part = read_item(file, first.item, *item_units, taken, trail, diagnostics);
        if (!part) return part.error();
        for (Diagnostic& diagnostic : part->open) open.push_back(std::move(diagnostic));
        if (part->model.solids.empty()) continue;
        for (const Placed* place : occurrences.all) append(model, at_place(part->model, *place));
    }
    complete_places(file, diagnostics, first_diagnostic);
    if (model.solids.empty()) return open.empty() ? no_solid(file) : open.front();
    for (Diagnostic& diagnostic : open) {
        diagnostic.severity = Severity::warning;
        diagnostics.push_back(std::move(diagnostic));
    }
    return model;
}

}  // namespace lyr::importer
