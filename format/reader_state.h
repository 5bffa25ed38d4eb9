// What Reader keeps: the blocks, the decoder of the chunk at hand, and what it has counted.

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "format/block_reader.h"
#include "format/chunk_decoder.h"
#include "format/layer_record.h"
#include "format/reader.h"

namespace lyr::format {

inline bool is(const BlockHead& head, BlockType type) {
    return head.type == static_cast<std::uint8_t>(type);
}

// "0x85", as the documentation writes types.
std::string type_name(std::uint8_t type);

class Reader::Implementation {
public:
    Implementation(int descriptor, std::string name, ReadOptions options)
        : blocks_(descriptor), name_(std::move(name)), options_(options) {}
    Implementation(const Implementation&) = delete;
    Implementation& operator=(const Implementation&) = delete;

    bool open();
    // Null: the end, or an error.
    const Operation* read() {
        const bool given =
            where_ == Where::in_chunk && decoder_.next(operation_) == ChunkDecoder::Step::operation;
        return given || find_next() ? &operation_ : nullptr;
    }
    bool seek_layer(std::uint32_t index);

    const std::optional<Diagnostic>& error() const { return error_; }
    const FileHeader& header() const { return header_; }
    const Layer& layer() const { return record_.layer; }
    const PathStyle& path() const { return decoder_.style(); }
    ReadPosition position() const;

private:
    enum class Where { before_layers, in_layer, in_chunk, behind_layers, at_end };

    bool find_next();
    bool fail(const std::string& what, std::uint64_t offset, ExitStatus status = ExitStatus::input);
    bool fail_block(const BlockHead& head);
    bool fail_fault(std::uint64_t offset);
    std::string place(std::uint64_t offset) const;

    bool read_prologue();
    bool read_metadata();
    bool read_thumbnail(const BlockHead& head);
    bool read_configuration(const BlockHead& head);
    bool read_extra(const BlockHead& head);
    bool read_block();
    bool read_layer(const BlockHead& head);
    bool read_chunk(const BlockHead& head);
    bool read_index(const BlockHead& head);
    bool read_end(const BlockHead& head);
    bool pass_over(const BlockHead& head);
    bool layer_is_whole(const BlockHead& head);
    std::optional<std::span<const std::byte>> payload(const BlockHead& head);
    bool read_on_to_layer(std::uint32_t index);
    bool read_from_start(std::uint32_t index);
    bool fail_no_layer(std::uint32_t index, std::uint32_t layers);
    std::optional<std::uint64_t> find_layer(std::uint32_t index, std::uint64_t file_bytes);
    bool find_index(std::uint64_t file_bytes, BlockHead& head, std::uint32_t& layers);

    BlockReader blocks_;
    std::string name_;
    ReadOptions options_;
    FileHeader header_;
    std::optional<Diagnostic> error_;
    Operation operation_;  // given out last

    Where where_ = Where::before_layers;
    bool layer_begins_ = false;  // LayerStart is to be given out
    bool sought_ = false;        // counts and index are not known from the start
    LayerRecord record_;
    BlockHead layer_head_;
    MotionHistory history_;
    ChunkDecoder decoder_{history_};
    std::uint64_t decoder_offset_ = 0;             // of its first byte in the file
    std::uint32_t layers_ = 0, whole_layers_ = 0;  // begun, and read to their end
    std::uint32_t layer_chunks_ = 0;
    std::uint64_t layer_operations_ = 0, chunks_ = 0, operations_ = 0;
    std::uint32_t offsets_crc_ = 0;  // over the layers' offsets as the index has them
    std::uint64_t index_offset_ = 0, first_layer_offset_ = 0;
};

}  // namespace lyr::format
