// Goes to a layer: from the end block at the file's end to the index, and from there to the layer. A file that is cut
// short has neither, and is read from its first layer on.

#include "format/reader_state.h"

namespace lyr::format {

// Without a fault, the file has no end block.
bool Reader::Implementation::find_index(std::uint64_t file_bytes, BlockHead& head,
                                        std::uint32_t& layers) {
    constexpr std::size_t end_bytes = block_frame_bytes + end_payload_bytes;
    if (file_bytes < end_bytes) return false;
    if (!blocks_.seek(file_bytes - end_bytes)) return fail_fault(blocks_.offset());
    const std::optional<BlockHead> end = blocks_.head();
    if (!end) return fail_fault(blocks_.offset());
    if (!is(*end, BlockType::end) || end->length != end_payload_bytes) return false;
    const auto bytes = payload(*end);
    if (!bytes) return false;
    layers = get_u32(bytes->data());
    if (!blocks_.seek(get_u64(bytes->data() + 28))) return fail_fault(blocks_.offset());
    const std::optional<BlockHead> index = blocks_.head();
    if (!index) return fail_fault(blocks_.offset());
    if (!is(*index, BlockType::index) || index->length != std::uint64_t{layers} * index_entry_bytes)
        return fail("the file has no index", index->offset);
    head = *index;
    return true;
}

std::optional<std::uint64_t> Reader::Implementation::find_layer(std::uint32_t index,
                                                                std::uint64_t file_bytes) {
    BlockHead head;
    std::uint32_t layers = 0;
    if (!find_index(file_bytes, head, layers)) return std::nullopt;
    // Whether the layer exists shows before the index is read, what it says only after.
    std::uint64_t offset = 0, passed = 0;
    const std::uint64_t first = index * std::uint64_t{index_entry_bytes};
    const auto pick = [&](std::span<const std::byte> piece) {
        for (std::uint64_t i = first; i < first + index_entry_bytes; ++i)
            if (i >= passed && i < passed + piece.size())
                offset |= static_cast<std::uint64_t>(piece[static_cast<std::size_t>(i - passed)])
                          << (8 * (i - first));
        passed += piece.size();
    };
    if (!blocks_.stream(head, pick)) {
        fail_block(head);
        return std::nullopt;
    }
    if (index >= layers) {
        fail_no_layer(index, layers);
        return std::nullopt;
    }
    return offset;
}

bool Reader::Implementation::seek_layer(std::uint32_t index) {
    const std::optional<std::uint64_t> size = blocks_.size();
    if (!size) return read_on_to_layer(index);
    error_.reset();
    where_ = Where::before_layers;
    layer_begins_ = false;
    sought_ = true;
    layers_ = index;
    whole_layers_ = 0;
    const std::optional<std::uint64_t> offset = find_layer(index, *size);
    if (!offset) return error_ ? false : read_from_start(index);
    if (!blocks_.seek(*offset)) return fail_fault(*offset);
    const std::optional<BlockHead> head = blocks_.head();
    if (!head) return fail_fault(blocks_.offset());
    if (!is(*head, BlockType::layer))
        return fail("the index does not lead to a layer", head->offset);
    return read_layer(*head);
}

// As far as a file that is cut short goes.
bool Reader::Implementation::read_from_start(std::uint32_t index) {
    sought_ = false;
    layers_ = 0;
    chunks_ = operations_ = 0;
    offsets_crc_ = 0;
    if (!blocks_.seek(first_layer_offset_)) return fail_fault(first_layer_offset_);
    return read_on_to_layer(index);
}

bool Reader::Implementation::read_on_to_layer(std::uint32_t index) {
    if (layers_ > index) {
        if (layer_begins_ && record_.layer.index == index) return true;
        return fail("layer " + std::to_string(std::uint64_t{index} + 1) +
                        " has begun already, and a pipe does not go back",
                    blocks_.offset());
    }
    while (const Operation* passed = read()) {
        const auto* start = std::get_if<LayerStart>(passed);
        if (!start || start->index != index) continue;
        layer_begins_ = true;
        return true;
    }
    return error_ ? false : fail_no_layer(index, layers_);
}

bool Reader::Implementation::fail_no_layer(std::uint32_t index, std::uint32_t layers) {
    error_ = Diagnostic{Severity::error,
                        ExitStatus::input,
                        "there is no layer " + std::to_string(std::uint64_t{index} + 1) +
                            "; the file has " + std::to_string(layers) +
                            (layers == 1 ? " layer" : " layers"),
                        {.file = name_}};
    return false;
}

}  // namespace lyr::format
