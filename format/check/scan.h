// The blocks of a .lyr file that may be damaged: those whose CRC is right, and the bytes between them.
//
// Contract
//  1. Pieces follow each other without a gap from the prologue's end to the file's end.
//  2. A block whose CRC is wrong reaches to the next byte where a right block of a known type begins: its
//     length may be what is wrong.
//  3. The time is bounded by a multiple of the file's size, whatever the bytes are.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "format/check/file_view.h"
#include "format/layout.h"

namespace lyr::format {

struct Piece {
    std::uint64_t begin = 0, end = 0;  // in the file
    std::uint8_t type = 0;             // as its first byte says
    bool right = false;                // its CRC

    // Of a right one, valid as long as what FileView gives.
    std::span<const std::byte> payload(FileView& file) const;
};

class Scanner {
public:
    // The file outlives it. It begins with the block at `begin`.
    explicit Scanner(FileView& file, std::uint64_t begin = prologue_bytes);

    // None: the file's end.
    std::optional<Piece> next();

private:
    std::uint64_t end_of(std::uint64_t at);
    bool is_right(std::uint64_t at, std::uint64_t end);
    bool is_likely(std::uint64_t at, std::uint64_t length);
    std::uint64_t next_right(std::uint64_t at);

    FileView& file_;
    std::uint64_t at_, budget_;
};

}  // namespace lyr::format
