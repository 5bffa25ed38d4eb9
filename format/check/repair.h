// Writes what is whole of a damaged print: its layers from the bed up to the first one that is not whole.
//
// Contract
//  1. No layer behind the first damage is kept, even if it is whole: over a gap a print fails in the air.
//  2. What is kept is kept byte for byte: operations and states of layers. Index, counts, and the figures
//     of the metadata (layers, box, volume, filament, mass, time) are those of what is kept.
//  3. A whole file comes out as it is, byte for byte.
//  4. What is left out is said, in `notes`: layers, metadata that was damaged, blocks nobody knows.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "format/check/verify.h"
#include "format/writer.h"

namespace lyr::format {

struct Repaired {
    FileTotals totals;
    std::vector<std::string> notes;
};

// `file` is what was verified. Errors: nothing can be kept, or the file cannot be read (status input), not
// writable (output).
Result<Repaired> repair(FileView& file, const Verification& verification, const std::string& name,
                        const std::string& output);

}  // namespace lyr::format
