// The layer block: where a layer starts, in what state, and what it adds up to.
//
// Contract
//  1. decode(encode(layer)) = layer, up to the units of the file (layout.h).
//  2. decode refuses what is cut short or out of range; bytes behind the known fields are left to
//     later minor versions.

#pragma once

#include <optional>
#include <span>

#include "format/bytes.h"
#include "format/operation.h"

namespace lyr::format {

struct LayerRecord {
    Layer layer;
    Point start;
};

// In the library lyr_format_writer.
void encode_layer(const LayerRecord& record, Bytes& out);

// None: not a layer record; `why` says what is wrong with it.
std::optional<LayerRecord> decode_layer(std::span<const std::byte> payload, Quantum quantum,
                                        const char*& why);

// A number of the file's unit from a value, rounded; the value must be finite, >= 0 and in range.
// In the library lyr_format_writer.
std::uint64_t setting(double value, double per_unit);

}  // namespace lyr::format
