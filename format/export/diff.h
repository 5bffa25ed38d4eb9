// How two prints differ: what they say about themselves, their layers, and what they add up to by role.
//
// Contract
//  1. Prints whose metadata, settings, layer states and operations are the same have no difference, however
//     their bytes pack them.
//  2. Layers belong together if they have the same height z; where a print's z falls (parts that are printed
//     one after the other) a new pass begins, and passes belong together in order.
//  3. Of a layer, operations that are the same at its beginning and at its end are left out. The rest of
//     them is what differs: those that changed, were added or taken away.
//  4. Lengths are compared exactly, in nanometres; whether lines belong to a hatch does not matter.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "format/export/statistics.h"
#include "format/reader.h"

namespace lyr::format {

// Of the metadata or the configuration; none: that print does not have the key.
struct KeyDifference {
    std::string key;
    std::optional<std::string> a, b;
};

struct LayerDifference {
    std::optional<std::uint32_t> a,
        b;  // its number in each print, from 0; none: it has no such layer
    double z_mm = 0;
    std::vector<std::string> state;  // "thickness 0.2, 0.1 mm"
    std::uint64_t first = 0;         // number of the first operation that differs, from 1; 0: none
    std::string first_a, first_b;    // what it is
    std::uint64_t changed_a = 0, changed_b = 0, operations_a = 0, operations_b = 0;
    // How far the ends of the motions that differ are from those of the other print, at most.
    double farthest_mm = 0;
};

struct Difference {
    std::vector<KeyDifference> metadata, configuration;
    std::vector<LayerDifference> layers;
    std::uint32_t layers_a = 0, layers_b = 0, same_layers = 0;
    Statistics a, b;

    bool any() const { return !metadata.empty() || !configuration.empty() || !layers.empty(); }
};

// Both files are read twice. Errors: the reader's.
Result<Difference> diff(const std::string& path_a, const std::string& path_b);

// For people; `name_a`, `name_b` are the files'.
std::string to_text(const Difference& difference, const std::string& name_a,
                    const std::string& name_b);

}  // namespace lyr::format
