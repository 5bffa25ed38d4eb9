// Where the frame is broken, each byte may be a block's first one. A wrong guess passes a CRC once in
// 2^32, but costs as many bytes as it claims to have: all guesses together have a budget.

#include "format/check/scan.h"

#include "format/bytes.h"

namespace lyr::format {
namespace {

// Bytes that may be summed for guesses, for each byte of the file, and at least.
constexpr std::uint64_t budget_per_byte = 64, least_budget = std::uint64_t{1} << 30;

}  // namespace

std::span<const std::byte> Piece::payload(FileView& file) const {
    return file.at(begin + block_head_bytes,
                   static_cast<std::size_t>(end - begin) - block_frame_bytes);
}

Scanner::Scanner(FileView& file, std::uint64_t begin)
    : file_(file), at_(begin), budget_(least_budget + budget_per_byte * file.size()) {}

std::optional<Piece> Scanner::next() {
    if (at_ >= file_.size()) return std::nullopt;
    const std::uint64_t begin = at_, end = end_of(begin);
    const auto type = static_cast<std::uint8_t>(file_.at(begin, 1)[0]);
    const bool right = end != 0 && is_right(begin, end);
    at_ = right ? end : next_right(begin + 1);
    return Piece{begin, at_, type, right};
}

// 0: the file ends before the block does.
std::uint64_t Scanner::end_of(std::uint64_t at) {
    if (file_.size() - at < block_frame_bytes) return 0;
    const std::uint64_t end = at + block_frame_bytes + (file_.u32_at(at) >> 8);
    return end <= file_.size() ? end : 0;
}

bool Scanner::is_right(std::uint64_t at, std::uint64_t end) {
    return file_.crc32c_of(at, end - block_crc_bytes) == file_.u32_at(end - block_crc_bytes);
}

// Of a kind that follows the metadata, and no longer than it may be.
bool Scanner::is_likely(std::uint64_t at, std::uint64_t length) {
    switch (static_cast<BlockType>(file_.at(at, 1)[0])) {
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

std::uint64_t Scanner::next_right(std::uint64_t at) {
    for (; at < file_.size(); ++at) {
        const std::uint64_t end = end_of(at);
        if (end == 0 || !is_likely(at, end - at - block_frame_bytes)) continue;
        if (budget_ < end - at) continue;
        budget_ -= end - at;
        if (is_right(at, end)) return at;
    }
    return at;
}

}  // namespace lyr::format
