// Checks a .lyr file to its last byte, and goes on behind what is damaged.
//
// Contract
//  1. There are no findings if and only if the reader (format/reader.h) reads the file to its end.
//  2. Findings come in the order of their bytes, and name what is lost: blocks that are damaged, and
//     such that are missing, as far as the numbers of those around them tell.
//  3. A layer is whole if its own block and all its chunks are right, in order, and make sense. A print is
//     usable up to the first layer that is not, or is missing: `whole_from_start` counts these.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "format/check/file_view.h"
#include "format/metadata.h"
#include "format/operation.h"

namespace lyr::format {

struct CheckedLayer {
    std::uint32_t index = 0;
    std::uint64_t begin = 0, end = 0;  // from its own block to its last chunk, in the file
};

struct Finding {
    std::uint64_t begin = 0, end = 0;  // bytes; equal: something is missing there
    std::string what;                  // "chunk 2 of layer 7 is damaged"
    ExitStatus status = ExitStatus::input;
};

struct Verification {
    std::uint64_t bytes = 0;
    std::uint32_t major = 0, minor = 0;
    std::optional<Quantum> quantum;    // none: the prologue is damaged
    std::optional<Metadata> metadata;  // with configuration and thumbnails; none: damaged
    Summary summary;                   // as the metadata states it
    std::uint64_t blocks = 0, chunks = 0, operations = 0;  // that are right
    std::vector<CheckedLayer> layers;                      // the whole ones, wherever they are
    std::uint32_t whole_from_start = 0;
    std::optional<std::uint32_t> stated_layers;  // by the end block or the metadata
    bool cut_short = false;                      // there is no end block
    std::vector<Finding> findings;
};

// Takes 32 bytes for each layer, and a few 100 KB besides, however large the file is. What FileView cannot read has
// findings, too; its error() tells.
Verification verify(FileView& file);
Verification verify(std::span<const std::byte> file);

// Is this a .lyr file, maybe a damaged one? Its first bytes tell, of which no more than these are looked at.
inline constexpr std::size_t print_head_bytes = std::size_t{1} << 17;
bool is_print(std::span<const std::byte> head);
inline constexpr const char* no_print =
    "this is not a .lyr file: it does not begin with LYR and the byte 1a";

// For people: one line a finding, and what is whole. `name` is the file's.
std::string to_text(const Verification& verification, const std::string& name);

// What is to be told of a file with findings: in one line, with what to do.
Diagnostic to_diagnostic(const Verification& verification, const std::string& name);

}  // namespace lyr::format
