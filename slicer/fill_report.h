// What is to be said of the fills of a print: of a layer, or once of all.

#pragma once

#include "slicer/fill.h"

namespace lyr::slicer {

struct FillNotes {
    std::size_t unresolved = 0;
    bool asks_sparse = false, has_sparse = false, is_unheld = false;
};
FillNotes notes_of(const LayerFill& fill);

class FillReport {
public:
    // In the order of the layers.
    void add(const FillNotes& notes, const Location& where, Diagnostics& diagnostics);
    // Once all layers are added.
    void finish(const profile::Infill& infill, Diagnostics& diagnostics) const;

private:
    bool asks_sparse_ = false, has_sparse_ = false;
    std::size_t unheld_ = 0;
    Location first_unheld_{};
};

}  // namespace lyr::slicer
