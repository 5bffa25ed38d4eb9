// A loop over blocks around the decoder of chunks. Every check has its message here; the parts
// below only say that something is wrong.

#include <array>
#include <cstring>
#include <string_view>

#include "format/reader_state.h"

namespace lyr::format {

std::string type_name(std::uint8_t type) {
    constexpr std::string_view digits = "0123456789abcdef";
    return std::string("0x") + digits[type >> 4] + digits[type & 15];
}

bool Reader::Implementation::fail(const std::string& what, std::uint64_t offset,
                                  ExitStatus status) {
    std::string message = what + place(offset);
    if (whole_layers_ > 0)
        message += "; the last whole layer is " + std::to_string(whole_layers_);
    else if (where_ != Where::before_layers)
        message += "; no layer is whole";
    error_ = Diagnostic{Severity::error, status, message, {.file = name_}};
    return false;
}

std::string Reader::Implementation::place(std::uint64_t offset) const {
    // What is wrong at the very beginning is wrong with the file as a whole.
    if (offset == 0) return "";
    std::string text;
    if (where_ == Where::in_layer || where_ == Where::in_chunk) {
        const std::uint32_t chunks = record_.layer.totals.chunks;
        const std::uint32_t chunk = layer_chunks_ + (where_ == Where::in_layer ? 1 : 0);
        text = " in layer " + std::to_string(std::uint64_t{record_.layer.index} + 1);
        if (chunk <= chunks)
            text += ", chunk " + std::to_string(chunk) + " of " + std::to_string(chunks);
        else
            text = " behind" + text.substr(3);
    }
    return text + " at byte " + std::to_string(offset);
}

bool Reader::Implementation::fail_fault(std::uint64_t offset) {
    switch (blocks_.fault()) {
        case BlockFault::unreadable:
            return fail(std::string("cannot read: ") + std::strerror(blocks_.error_number()),
                        offset);
        case BlockFault::damaged:
            return fail("the block is damaged (its CRC is wrong)", offset);
        case BlockFault::not_seekable:
            return fail("cannot go to the place that the index or the end block names", offset);
        default:
            return fail("the file is cut short: it ends", blocks_.end_of_file());
    }
}

bool Reader::Implementation::fail_block(const BlockHead& head) {
    return fail_fault(head.offset);
}

std::optional<std::span<const std::byte>> Reader::Implementation::payload(const BlockHead& head) {
    if (head.length > longest_buffered_payload) {
        fail("a block of type " + type_name(head.type) + " says that it has " +
                 std::to_string(head.length) + " bytes; at most " +
                 std::to_string(longest_buffered_payload) + " are allowed",
             head.offset);
        return std::nullopt;
    }
    auto bytes = blocks_.payload(head);
    if (!bytes) fail_block(head);
    return bytes;
}

// The CRC comes first: a damaged type is no unknown type.
bool Reader::Implementation::pass_over(const BlockHead& head) {
    if (!blocks_.stream(head, [](std::span<const std::byte>) {})) return fail_block(head);
    if (head.type & skippable_bit) return true;
    const bool known = head.type >= static_cast<std::uint8_t>(BlockType::metadata) &&
                       head.type <= static_cast<std::uint8_t>(BlockType::end);
    if (known)
        return fail("a block of type " + type_name(head.type) + " is out of place", head.offset);
    return fail("the file needs a reader that knows blocks of type " + type_name(head.type),
                head.offset, ExitStatus::unsupported);
}

bool Reader::Implementation::find_next() {
    while (!error_ && where_ != Where::at_end) {
        if (layer_begins_) {
            layer_begins_ = false;
            operation_ = LayerStart{record_.layer.index, record_.start};
            return true;
        }
        if (where_ != Where::in_chunk) {
            read_block();
            continue;
        }
        switch (decoder_.next(operation_)) {
            case ChunkDecoder::Step::operation:
                return true;
            case ChunkDecoder::Step::end:
                where_ = Where::in_layer;
                if (layer_chunks_ == record_.layer.totals.chunks) whole_layers_ = layers_;
                break;
            case ChunkDecoder::Step::error:
                return fail(std::string("the chunk makes no sense: ") + decoder_.error(),
                            decoder_offset_ + decoder_.end_offset());
        }
    }
    return false;
}

bool Reader::Implementation::read_block() {
    const std::optional<BlockHead> head = blocks_.head();
    if (!head) return fail_fault(blocks_.offset());
    switch (static_cast<BlockType>(head->type)) {
        case BlockType::layer:
            return where_ == Where::behind_layers ? pass_over(*head) : read_layer(*head);
        case BlockType::chunk:
            return where_ == Where::in_layer ? read_chunk(*head) : pass_over(*head);
        case BlockType::index:
            return where_ == Where::behind_layers ? pass_over(*head) : read_index(*head);
        case BlockType::end:
            return where_ == Where::behind_layers ? read_end(*head) : pass_over(*head);
        default:
            return pass_over(*head);
    }
}

bool Reader::Implementation::layer_is_whole(const BlockHead& head) {
    if (where_ == Where::before_layers) return true;
    const LayerTotals& totals = record_.layer.totals;
    if (layer_chunks_ != totals.chunks)
        return fail("the layer has fewer chunks than it says", head.offset);
    if (layer_operations_ != totals.operations)
        return fail("the layer has another number of operations than it says", head.offset);
    return true;
}

bool Reader::Implementation::read_layer(const BlockHead& head) {
    const auto bytes = payload(head);
    if (!bytes || !layer_is_whole(head)) return false;
    const char* why = nullptr;
    const std::optional<LayerRecord> record = decode_layer(*bytes, header_.quantum, why);
    if (!record) return fail(std::string("a layer's block makes no sense: ") + why, head.offset);
    if (record->layer.index != layers_)
        return fail("expected layer " + std::to_string(layers_ + 1) + ", found layer " +
                        std::to_string(std::uint64_t{record->layer.index} + 1),
                    head.offset);
    record_ = *record;
    layer_head_ = head;
    decoder_.begin_layer(record_.start, header_.quantum);
    std::array<std::byte, index_entry_bytes> entry;
    for (std::size_t i = 0; i < entry.size(); ++i)
        entry[i] = static_cast<std::byte>((head.offset >> (8 * i)) & 0xff);
    offsets_crc_ = crc32c(entry, offsets_crc_);
    ++layers_;
    layer_chunks_ = 0;
    layer_operations_ = 0;
    if (record_.layer.totals.chunks == 0) whole_layers_ = layers_;
    where_ = Where::in_layer;
    layer_begins_ = true;
    return true;
}

bool Reader::Implementation::read_chunk(const BlockHead& head) {
    const auto bytes = payload(head);
    if (!bytes) return false;
    Cursor cursor(*bytes);
    const std::uint64_t layer = cursor.varint(), chunk = cursor.varint();
    const std::uint64_t operations = cursor.varint();
    if (cursor.bad()) return fail("a chunk has no head", head.offset);
    if (layer != record_.layer.index || chunk != layer_chunks_ ||
        chunk >= record_.layer.totals.chunks)
        return fail("a chunk is out of place", head.offset);
    ++layer_chunks_;
    layer_operations_ += operations;
    ++chunks_;
    operations_ += operations;
    decoder_.begin_chunk(bytes->subspan(cursor.offset()), operations);
    decoder_offset_ = head.offset + block_head_bytes + cursor.offset();
    where_ = Where::in_chunk;
    return true;
}

bool Reader::Implementation::read_index(const BlockHead& head) {
    std::uint32_t crc = 0;
    const auto check = [&](std::span<const std::byte> piece) { crc = crc32c(piece, crc); };
    if (!blocks_.stream(head, check)) return fail_block(head);
    if (!layer_is_whole(head)) return false;
    const bool right =
        crc == offsets_crc_ && head.length == std::uint64_t{layers_} * index_entry_bytes;
    if (!right && !sought_) return fail("the index does not lead to the layers", head.offset);
    index_offset_ = head.offset;
    where_ = Where::behind_layers;
    return true;
}

bool Reader::Implementation::read_end(const BlockHead& head) {
    const auto bytes = payload(head);
    if (!bytes) return false;
    if (bytes->size() != end_payload_bytes) return fail("the end block has no totals", head.offset);
    const std::byte* at = bytes->data();
    const std::uint64_t stated_bytes = get_u64(at + 20), stated_index = get_u64(at + 28);
    const bool counted = sought_ || (get_u64(at + 4) == chunks_ && get_u64(at + 12) == operations_);
    if (get_u32(at) != layers_ || !counted ||
        (header_.summary.layers != 0 && header_.summary.layers != layers_))
        return fail("the file has another number of layers, chunks or operations than it says",
                    head.offset);
    if (stated_bytes != blocks_.offset() || stated_index != index_offset_)
        return fail("the end block is out of place", head.offset);
    if (!blocks_.at_end()) {
        if (blocks_.fault() == BlockFault::unreadable) return fail_fault(blocks_.offset());
        return fail("something follows the end of the print", blocks_.offset());
    }
    where_ = Where::at_end;
    return true;
}

ReadPosition Reader::Implementation::position() const {
    ReadPosition position;
    if (where_ == Where::in_chunk) {
        position.layer = record_.layer.index;
        position.chunk = layer_chunks_ - 1;
        position.offset = decoder_offset_ + decoder_.begin_offset();
        position.end = decoder_offset_ + decoder_.end_offset();
    } else if (where_ == Where::in_layer) {
        position.layer = record_.layer.index;
        position.offset = layer_head_.offset;
        position.end = layer_head_.offset + block_frame_bytes + layer_head_.length;
    } else if (where_ == Where::at_end) {
        position.offset = position.end = blocks_.offset();
    }
    return position;
}

Reader::Reader(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Reader::Reader(Reader&&) noexcept = default;
Reader& Reader::operator=(Reader&&) noexcept = default;
Reader::~Reader() = default;

const FileHeader& Reader::header() const {
    return implementation_->header();
}

Result<std::optional<Operation>> Reader::next() {
    if (const Operation* operation = read()) return std::optional(*operation);
    if (implementation_->error()) return *implementation_->error();
    return std::optional<Operation>();
}

const Operation* Reader::read() {
    return implementation_->read();
}

const std::optional<Diagnostic>& Reader::error() const {
    return implementation_->error();
}

const Layer& Reader::layer() const {
    return implementation_->layer();
}

const PathStyle& Reader::path() const {
    return implementation_->path();
}

ReadPosition Reader::position() const {
    return implementation_->position();
}

Status Reader::seek_layer(std::uint32_t index) {
    if (implementation_->seek_layer(index)) return Done{};
    return *implementation_->error();
}

}  // namespace lyr::format
