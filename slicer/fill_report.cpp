#include "slicer/fill_report.h"

#include <algorithm>

#include "base/text.h"

namespace lyr::slicer {
namespace {

Diagnostic warning(std::string message, const Location& where) {
    return {Severity::warning, ExitStatus::geometry, std::move(message), where};
}

}  // namespace

FillNotes notes_of(const LayerFill& fill) {
    const bool has_sparse =
        std::any_of(fill.pieces.begin(), fill.pieces.end(),
                    [](const Piece& piece) { return piece.role == format::Role::sparse_infill; });
    return {fill.unresolved, fill.asks_sparse, has_sparse, fill.is_unheld};
}

void FillReport::add(const FillNotes& notes, const Location& where, Diagnostics& diagnostics) {
    if (notes.unresolved > 0)
        diagnostics.push_back(warning(
            counted(notes.unresolved, "part") + " of the layer's fill could not be made", where));
    asks_sparse_ |= notes.asks_sparse;
    has_sparse_ |= notes.has_sparse;
    if (!notes.is_unheld) return;
    if (unheld_ == 0) first_unheld_ = where;
    ++unheld_;
}

void FillReport::finish(const profile::Infill& infill, Diagnostics& diagnostics) const {
    const std::string density = " (infill.density = " + shortest(100 * infill.density) + "%)";
    if (asks_sparse_ && !has_sparse_)
        diagnostics.push_back(
            warning("no line of the sparse fill fits into the part" + density, {}));
    if (unheld_ > 0)
        diagnostics.push_back(warning("solid fill lies on nothing that holds it in " +
                                          counted(unheld_, "layer") + ", first here" + density,
                                      first_unheld_));
}

}  // namespace lyr::slicer
