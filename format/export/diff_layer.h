// Two layers, operation by operation, for diff().

#pragma once

#include <optional>
#include <vector>

#include "format/export/diff.h"
#include "format/operation.h"
#include "format/reader.h"

namespace lyr::format {

// A layer with its coordinates in nanometres.
struct LayerOperations {
    Layer layer;
    Point start;
    std::vector<Operation> operations;  // without LayerStart and HatchStart
};

// The layers of a print, one after the other.
class LayerSequence {
public:
    explicit LayerSequence(Reader& reader) : reader_(reader) {}

    bool has() const { return has_; }
    const LayerOperations& now() const { return now_; }
    std::uint64_t pass() const { return pass_; }  // how often z has fallen

    // Errors: the reader's.
    Status next();

private:
    Reader& reader_;
    LayerOperations now_;
    std::uint64_t pass_ = 0;
    bool begun_ = false, has_ = false, ended_ = false;
};

// Which comes first: < 0, 0: they belong together, > 0.
int compare_heights(const LayerSequence& a, const LayerSequence& b);

// None: they are the same.
std::optional<LayerDifference> compare(const LayerOperations& a, const LayerOperations& b);

}  // namespace lyr::format
