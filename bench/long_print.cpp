// Blocks are copied as they are; the numbers of layers in them, and what counts them, are written anew.

#include "bench/long_print.h"

#include <cstdio>
#include <vector>

#include "format/bytes.h"
#include "format/crc32c.h"
#include "format/layout.h"

namespace lyr::bench {
namespace {

using namespace lyr::format;

struct Block {
    BlockType type{};
    std::span<const std::byte> payload;
};

std::vector<std::byte> load(const std::string& path) {
    std::vector<std::byte> bytes;
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (!file) return bytes;
    std::vector<std::byte> piece(buffer_bytes);
    while (const std::size_t count = std::fread(piece.data(), 1, piece.size(), file))
        bytes.insert(bytes.end(), piece.begin(),
                     piece.begin() + static_cast<std::ptrdiff_t>(count));
    std::fclose(file);
    return bytes;
}

std::vector<Block> blocks_of(std::span<const std::byte> file) {
    std::vector<Block> blocks;
    for (std::size_t at = prologue_bytes; at + block_frame_bytes <= file.size();) {
        const std::size_t length = get_u32(file.data() + at) >> 8;
        if (at + block_frame_bytes + length > file.size()) return {};
        blocks.push_back(
            {static_cast<BlockType>(file[at]), file.subspan(at + block_head_bytes, length)});
        at += block_frame_bytes + length;
    }
    return blocks;
}

class LongPrint {
public:
    explicit LongPrint(const std::string& path) : file_(std::fopen(path.c_str(), "wb")) {}
    ~LongPrint() {
        if (file_) std::fclose(file_);
    }
    LongPrint(const LongPrint&) = delete;
    LongPrint& operator=(const LongPrint&) = delete;

    std::uint64_t size() const { return size_; }
    void put(std::span<const std::byte> bytes) {
        whole_ =
            whole_ && file_ && std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size();
        size_ += bytes.size();
    }
    void put_block(BlockType type, std::span<const std::byte> payload) {
        Bytes out;
        put_u32(out,
                static_cast<std::uint32_t>(payload.size()) << 8 | static_cast<std::uint32_t>(type));
        out.insert(out.end(), payload.begin(), payload.end());
        put_u32(out, crc32c(out));
        put(out);
    }
    // The layer's number, which the payload begins with, is that of the layer last begun.
    void put_numbered(const Block& block) {
        if (block.type == BlockType::layer) offsets_.push_back(size_);
        Cursor cursor(block.payload);
        cursor.varint();
        const std::size_t behind = cursor.offset();
        if (block.type == BlockType::chunk) {
            cursor.varint();
            operations_ += cursor.varint();
            ++chunks_;
        }
        Bytes payload;
        put_varint(payload, offsets_.size() - 1);
        const auto rest = block.payload.subspan(behind);
        payload.insert(payload.end(), rest.begin(), rest.end());
        put_block(block.type, payload);
    }
    Status finish() {
        const std::uint64_t index = size_;
        Bytes offsets, end;
        for (const std::uint64_t offset : offsets_) put_u64(offsets, offset);
        put_block(BlockType::index, offsets);
        put_u32(end, static_cast<std::uint32_t>(offsets_.size()));
        put_u64(end, chunks_);
        put_u64(end, operations_);
        put_u64(end, size_ + block_frame_bytes + end_payload_bytes);
        put_u64(end, index);
        put_block(BlockType::end, end);
        if (whole_ && std::fflush(file_) == 0) return Done{};
        return Diagnostic{Severity::error, ExitStatus::output, "cannot write the long print", {}};
    }

private:
    std::FILE* file_;
    bool whole_ = true;
    std::uint64_t size_ = 0, chunks_ = 0, operations_ = 0;
    std::vector<std::uint64_t> offsets_;
};

}  // namespace

Status write_long_print(const std::string& path, const std::string& long_path,
                        std::uint64_t bytes) {
    const std::vector<std::byte> file = load(path);
    const std::vector<Block> blocks = blocks_of(file);
    if (blocks.empty())
        return Diagnostic{Severity::error, ExitStatus::input, "no .lyr file", {.file = path}};
    LongPrint print(long_path);
    print.put(std::span(file).first(prologue_bytes));
    // Without metadata: they would say how many layers there are.
    print.put_block(BlockType::metadata, {});
    while (print.size() < bytes)
        for (const Block& block : blocks)
            if (block.type == BlockType::layer || block.type == BlockType::chunk)
                print.put_numbered(block);
    return print.finish();
}

}  // namespace lyr::bench
