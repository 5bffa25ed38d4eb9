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
#include <span>
#include <vector>

namespace lyr::format {

struct Piece {
    std::uint64_t begin = 0, end = 0;  // in the file
    std::uint8_t type = 0;             // as its first byte says
    bool right = false;                // its CRC

    std::span<const std::byte> payload(std::span<const std::byte> file) const;
};

std::vector<Piece> scan(std::span<const std::byte> file);

}  // namespace lyr::format
