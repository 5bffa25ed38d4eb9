// Where the frame is broken, each byte may be a block's first one. A wrong guess passes a CRC once in
// 2^32, but costs as many bytes as it claims to have: all guesses together have a budget.

#include "format/check/scan.h"

#include <algorithm>

#include "format/bytes.h"
#include "format/crc32c.h"
#include "format/layout.h"

namespace lyr::format {
namespace {

// Bytes that may be summed for guesses, for each byte of the file, and at least.
constexpr std::uint64_t budget_per_byte = 64, least_budget = std::uint64_t{1} << 30;

class Scanner {
public:
    explicit Scanner(std::span<const std::byte> file)
        : file_(file), budget_(least_budget + budget_per_byte * file.size()) {}

    std::vector<Piece> pieces() {
        for (std::uint64_t at = prologue_bytes; at < file_.size(); at = pieces_.back().end) add(at);
        return std::move(pieces_);
    }

private:
    std::uint8_t type(std::uint64_t at) const {
        return static_cast<std::uint8_t>(file_[static_cast<std::size_t>(at)]);
    }

    // 0: the file ends before the block does.
    std::uint64_t end_of(std::uint64_t at) const {
        if (file_.size() - at < block_frame_bytes) return 0;
        const std::uint32_t head = get_u32(file_.data() + at);
        const std::uint64_t end = at + block_frame_bytes + (head >> 8);
        return end <= file_.size() ? end : 0;
    }

    bool is_right(std::uint64_t at, std::uint64_t end) const {
        const std::span<const std::byte> block =
            file_.subspan(static_cast<std::size_t>(at), static_cast<std::size_t>(end - at));
        return crc32c(block.first(block.size() - block_crc_bytes)) ==
               get_u32(block.data() + block.size() - block_crc_bytes);
    }

    void add(std::uint64_t at) {
        const std::uint64_t end = end_of(at);
        const bool right = end != 0 && is_right(at, end);
        pieces_.push_back({at, right ? end : next_right(at + 1), type(at), right});
    }

    // Of a kind that follows the metadata, and no longer than it may be.
    bool is_likely(std::uint64_t at, std::uint64_t length) const {
        switch (static_cast<BlockType>(type(at))) {
            case BlockType::layer:
            case BlockType::chunk:
                return length <= longest_buffered_payload;
            case BlockType::index:
                return length % index_entry_bytes == 0;
            case BlockType::end:
                return length == end_payload_bytes;
            case BlockType::thumbnail:
            case BlockType::configuration:
                return true;
            default:
                return false;
        }
    }

    std::uint64_t next_right(std::uint64_t at) {
        for (; at < file_.size(); ++at) {
            const std::uint64_t end = end_of(at);
            if (end == 0 || !is_likely(at, end - at - block_frame_bytes)) continue;
            if (budget_ < end - at) continue;
            budget_ -= end - at;
            if (is_right(at, end)) return at;
        }
        return at;
    }

    std::span<const std::byte> file_;
    std::uint64_t budget_;
    std::vector<Piece> pieces_;
};

}  // namespace

std::span<const std::byte> Piece::payload(std::span<const std::byte> file) const {
    return file.subspan(static_cast<std::size_t>(begin) + block_head_bytes,
                        static_cast<std::size_t>(end - begin) - block_frame_bytes);
}

std::vector<Piece> scan(std::span<const std::byte> file) {
    return Scanner(file).pieces();
}

}  // namespace lyr::format
