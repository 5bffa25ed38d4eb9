// The buffer holds a window of the file; what is left of it moves to the front when a block needs
// more room than there is behind it.

#include "format/block_reader.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace lyr::format {

BlockReader::~BlockReader() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

// At least `count` bytes from at_ on; takes what else is there to be had.
bool BlockReader::fill(std::size_t count) {
    if (filled_ - at_ >= count) return true;
    if (at_ == filled_ || at_ + count > buffer_.size()) {
        std::memmove(buffer_.data(), buffer_.data() + at_, filled_ - at_);
        buffer_offset_ += at_;
        filled_ -= at_;
        at_ = 0;
    }
    while (filled_ - at_ < count) {
        const ssize_t got = ::read(descriptor_, buffer_.data() + filled_, buffer_.size() - filled_);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            error_number_ = errno;
            return fail(BlockFault::unreadable);
        }
        if (got == 0) return fail(BlockFault::ended);
        filled_ += static_cast<std::size_t>(got);
    }
    return true;
}

std::span<const std::byte> BlockReader::raw(std::size_t count) {
    fill(count);
    const std::span<const std::byte> bytes(buffer_.data() + at_, std::min(count, filled_ - at_));
    at_ += bytes.size();
    return bytes;
}

std::optional<BlockHead> BlockReader::head() {
    if (!fill(block_head_bytes)) return std::nullopt;
    const std::uint32_t word = get_u32(buffer_.data() + at_);
    return BlockHead{static_cast<std::uint8_t>(word & 0xff), word >> 8, offset()};
}

std::optional<std::span<const std::byte>> BlockReader::payload(const BlockHead& head) {
    const std::size_t checked = block_head_bytes + head.length;
    if (!fill(checked + block_crc_bytes)) return std::nullopt;
    const std::span<const std::byte> block(buffer_.data() + at_, checked);
    if (crc32c(block) != get_u32(block.data() + checked)) {
        fail(BlockFault::damaged);
        return std::nullopt;
    }
    at_ += checked + block_crc_bytes;
    return block.subspan(block_head_bytes);
}

bool BlockReader::at_end() {
    if (fill(1)) return false;
    if (fault_ != BlockFault::ended) return false;
    fault_ = BlockFault::none;
    return true;
}

bool BlockReader::seek(std::uint64_t offset) {
    if (::lseek(descriptor_, static_cast<off_t>(offset), SEEK_SET) < 0)
        return fail(BlockFault::not_seekable);
    at_ = filled_ = 0;
    buffer_offset_ = offset;
    fault_ = BlockFault::none;
    return true;
}

std::optional<std::uint64_t> BlockReader::size() {
    const off_t end = ::lseek(descriptor_, 0, SEEK_END);
    if (end < 0) return std::nullopt;
    return static_cast<std::uint64_t>(end);
}

}  // namespace lyr::format
