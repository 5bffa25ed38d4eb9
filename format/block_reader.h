// Blocks of a .lyr file from a descriptor, through one fixed buffer.
//
// Contract
//  1. payload() gives out only what has the right CRC. Its bytes stay valid until the next call.
//  2. No heap, no other system calls than read(2), and lseek(2) in seek() and size().

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "format/bytes.h"
#include "format/crc32c.h"
#include "format/layout.h"

namespace lyr::format {

struct BlockHead {
    std::uint8_t type = 0;
    std::uint32_t length = 0;  // of the payload
    std::uint64_t offset = 0;  // of the block
};

enum class BlockFault : std::uint8_t {
    none,
    ended,         // the file stops before the block does
    unreadable,    // read(2) failed; see BlockReader::error_number()
    damaged,       // the CRC is wrong
    not_seekable,  // lseek(2) failed
};

class BlockReader {
public:
    explicit BlockReader(int descriptor) : descriptor_(descriptor) {}
    ~BlockReader();
    BlockReader(const BlockReader&) = delete;
    BlockReader& operator=(const BlockReader&) = delete;

    BlockFault fault() const { return fault_; }
    int error_number() const { return error_number_; }
    // Of the next byte.
    std::uint64_t offset() const { return buffer_offset_ + at_; }
    // How many bytes there were, after BlockFault::ended.
    std::uint64_t end_of_file() const { return buffer_offset_ + filled_; }

    // The next `count` bytes without check; fewer at the file's end (and a fault).
    std::span<const std::byte> raw(std::size_t count);
    // The next block's head, which stays the next one until its payload is taken.
    std::optional<BlockHead> head();
    // Of a block that fits the buffer.
    std::optional<std::span<const std::byte>> payload(const BlockHead& head);
    // Of a block of any length, piece by piece; nothing is known of them until true is returned.
    template <class Take>
    bool stream(const BlockHead& head, Take take);
    // Is there nothing more?
    bool at_end();

    bool seek(std::uint64_t offset);
    // None: a pipe.
    std::optional<std::uint64_t> size();

private:
    bool fill(std::size_t count);
    bool fail(BlockFault fault) {
        fault_ = fault;
        return false;
    }

    int descriptor_;
    int error_number_ = 0;
    BlockFault fault_ = BlockFault::none;
    std::array<std::byte, buffer_bytes> buffer_;
    std::size_t at_ = 0, filled_ = 0;
    std::uint64_t buffer_offset_ = 0;  // of the buffer's first byte in the file
};

template <class Take>
bool BlockReader::stream(const BlockHead& head, Take take) {
    if (!fill(block_head_bytes)) return false;
    std::uint32_t crc = crc32c(std::span(buffer_.data() + at_, block_head_bytes));
    at_ += block_head_bytes;
    for (std::size_t left = head.length; left > 0;) {
        if (!fill(1)) return false;
        const std::span piece(buffer_.data() + at_, std::min(left, filled_ - at_));
        crc = crc32c(piece, crc);
        at_ += piece.size();
        left -= piece.size();
        take(std::span<const std::byte>(piece));
    }
    if (!fill(block_crc_bytes)) return false;
    const bool right = get_u32(buffer_.data() + at_) == crc;
    at_ += block_crc_bytes;
    return right || fail(BlockFault::damaged);
}

}  // namespace lyr::format
