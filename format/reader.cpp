// A loop over blocks around the decoder of chunks. Every check has its message here; the parts below
// only say that something is wrong.

#include "format/reader.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include "format/block_reader.h"
#include "format/chunk_decoder.h"
#include "format/layer_record.h"
#include "format/metadata_text.h"

namespace lyr::format {
namespace {

std::string type_name(std::uint8_t type) {
    constexpr std::string_view digits = "0123456789abcdef";
    return std::string("0x") + digits[type >> 4] + digits[type & 15];
}

bool is(const BlockHead& head, BlockType type) {
    return head.type == static_cast<std::uint8_t>(type);
}

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

class Reader::Implementation {
public:
    Implementation(int descriptor, std::string name, ReadOptions options)
        : blocks_(descriptor), name_(std::move(name)), options_(options) {}

    bool open();
    // None: the end, or an error.
    bool next(Operation& operation);
    bool seek_layer(std::uint32_t index);

    const std::optional<Diagnostic>& error() const { return error_; }
    const FileHeader& header() const { return header_; }
    const Layer& layer() const { return record_.layer; }
    const PathStyle& path() const { return decoder_.style(); }
    ReadPosition position() const;

private:
    enum class Where { before_layers, in_layer, in_chunk, behind_layers, at_end };

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
    std::optional<std::uint64_t> find_layer(std::uint32_t index);
    bool find_index(BlockHead& head, std::uint32_t& layers);

    BlockReader blocks_;
    std::string name_;
    ReadOptions options_;
    FileHeader header_;
    std::optional<Diagnostic> error_;

    Where where_ = Where::before_layers;
    bool layer_begins_ = false;  // LayerStart is to be given out
    bool sought_ = false;        // counts and index are not known from the start
    LayerRecord record_;
    BlockHead layer_head_;
    ChunkDecoder decoder_;
    std::uint64_t decoder_offset_ = 0;             // of its first byte in the file
    std::uint32_t layers_ = 0, whole_layers_ = 0;  // begun, and read to their end
    std::uint32_t layer_chunks_ = 0;
    std::uint64_t layer_operations_ = 0, chunks_ = 0, operations_ = 0;
    std::uint32_t offsets_crc_ = 0;  // over the layers' offsets as the index has them
    std::uint64_t index_offset_ = 0;
};

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
            return fail("cannot go to a layer in a pipe; give a file", offset);
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

bool Reader::Implementation::open() {
    if (!read_prologue() || !read_metadata()) return false;
    for (;;) {
        const std::optional<BlockHead> head = blocks_.head();
        if (!head) return fail_fault(blocks_.offset());
        if (is(*head, BlockType::layer) || is(*head, BlockType::index)) return true;
        if (!read_extra(*head)) return false;
    }
}

bool Reader::Implementation::read_prologue() {
    const std::span<const std::byte> bytes = blocks_.raw(prologue_bytes);
    if (blocks_.fault() == BlockFault::unreadable) return fail_fault(0);
    if (bytes.empty()) return fail("the file is empty", 0);
    const std::size_t compared = std::min(bytes.size(), magic.size());
    if (std::memcmp(bytes.data(), magic.data(), compared) != 0)
        return fail("this is not a .lyr file: it does not begin with LYR and the byte 1a", 0);
    if (bytes.size() < prologue_bytes) return fail_fault(0);
    if (crc32c(bytes.first(prologue_bytes - 4)) != get_u32(bytes.data() + prologue_bytes - 4))
        return fail("the prologue is damaged (its CRC is wrong)", 0);
    const std::uint32_t version = get_u32(bytes.data() + 4);
    header_.major = version & 0xffff;
    header_.minor = version >> 16;
    header_.quantum.nm = get_u32(bytes.data() + 8);
    if (header_.major != major_version)
        return fail("the file has format version " + std::to_string(header_.major) + '.' +
                        std::to_string(header_.minor) + "; this program reads version " +
                        std::to_string(major_version),
                    4, ExitStatus::unsupported);
    if (header_.quantum.nm == 0 || header_.quantum.nm > coarsest_quantum_nm)
        return fail("the quantum must be 1 to " + std::to_string(coarsest_quantum_nm) + " nm", 8);
    return true;
}

bool Reader::Implementation::read_metadata() {
    const std::optional<BlockHead> head = blocks_.head();
    if (!head) return fail_fault(blocks_.offset());
    if (!is(*head, BlockType::metadata))
        return fail("the first block has type " + type_name(head->type) + ", expected metadata",
                    head->offset);
    const auto bytes = payload(*head);
    if (!bytes) return false;
    ParsedMetadata parsed = parse_metadata(text_of(*bytes));
    if (parsed.error) return fail(*parsed.error, head->offset);
    header_.metadata = std::move(parsed.metadata);
    header_.summary = parsed.summary;
    return true;
}

bool Reader::Implementation::read_extra(const BlockHead& head) {
    if (is(head, BlockType::thumbnail) && options_.keep_thumbnails) return read_thumbnail(head);
    if (is(head, BlockType::configuration) && options_.keep_configuration)
        return read_configuration(head);
    return pass_over(head);
}

bool Reader::Implementation::read_thumbnail(const BlockHead& head) {
    Bytes bytes;
    const auto keep = [&](std::span<const std::byte> piece) {
        bytes.insert(bytes.end(), piece.begin(), piece.end());
    };
    if (!blocks_.stream(head, keep)) return fail_block(head);
    if (bytes.size() < 8) return fail("a thumbnail has no size", head.offset);
    header_.metadata.thumbnails.push_back(
        {get_u32(bytes.data()), get_u32(bytes.data() + 4), {bytes.begin() + 8, bytes.end()}});
    return true;
}

bool Reader::Implementation::read_configuration(const BlockHead& head) {
    std::string text;
    if (!blocks_.stream(head, [&](std::span<const std::byte> piece) { text += text_of(piece); }))
        return fail_block(head);
    header_.metadata.configuration = std::move(text);
    return true;
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

bool Reader::Implementation::next(Operation& operation) {
    while (!error_ && where_ != Where::at_end) {
        if (layer_begins_) {
            layer_begins_ = false;
            operation = LayerStart{record_.layer.index, record_.start};
            return true;
        }
        if (where_ != Where::in_chunk) {
            read_block();
            continue;
        }
        switch (decoder_.next(operation)) {
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
    const bool right = crc == offsets_crc_ && head.length == layers_ * index_entry_bytes;
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
    if (where_ == Where::before_layers || where_ == Where::behind_layers) return position;
    position.layer = record_.layer.index;
    if (where_ == Where::in_chunk) {
        position.chunk = layer_chunks_ - 1;
        position.offset = decoder_offset_ + decoder_.begin_offset();
        position.end = decoder_offset_ + decoder_.end_offset();
    } else {
        position.offset = layer_head_.offset;
        position.end = layer_head_.offset + block_frame_bytes + layer_head_.length;
    }
    return position;
}

bool Reader::Implementation::find_index(BlockHead& head, std::uint32_t& layers) {
    constexpr std::size_t end_bytes = block_frame_bytes + end_payload_bytes;
    const std::optional<std::uint64_t> size = blocks_.size();
    if (!size) return fail_fault(blocks_.offset());
    if (*size < end_bytes || !blocks_.seek(*size - end_bytes))
        return fail("the file has no end block", *size);
    const std::optional<BlockHead> end = blocks_.head();
    if (!end) return fail_fault(blocks_.offset());
    if (!is(*end, BlockType::end) || end->length != end_payload_bytes)
        return fail("the file has no end block", end->offset);
    const auto bytes = payload(*end);
    if (!bytes) return false;
    layers = get_u32(bytes->data());
    if (!blocks_.seek(get_u64(bytes->data() + 28))) return fail_fault(blocks_.offset());
    const std::optional<BlockHead> index = blocks_.head();
    if (!index) return fail_fault(blocks_.offset());
    if (!is(*index, BlockType::index) || index->length != layers * index_entry_bytes)
        return fail("the file has no index", index->offset);
    head = *index;
    return true;
}

std::optional<std::uint64_t> Reader::Implementation::find_layer(std::uint32_t index) {
    BlockHead head;
    std::uint32_t layers = 0;
    if (!find_index(head, layers)) return std::nullopt;
    // Whether the layer exists shows before the index is read, what it says only after.
    std::uint64_t offset = 0, passed = 0;
    const std::uint64_t first = index * std::uint64_t{index_entry_bytes};
    const auto pick = [&](std::span<const std::byte> piece) {
        for (std::uint64_t i = first; i < first + index_entry_bytes; ++i)
            if (i >= passed && i < passed + piece.size())
                offset |= static_cast<std::uint64_t>(piece[i - passed]) << (8 * (i - first));
        passed += piece.size();
    };
    if (!blocks_.stream(head, pick)) {
        fail_block(head);
        return std::nullopt;
    }
    if (index >= layers) {
        fail("there is no layer " + std::to_string(std::uint64_t{index} + 1) + "; the file has " +
                 std::to_string(layers),
             head.offset);
        return std::nullopt;
    }
    return offset;
}

bool Reader::Implementation::seek_layer(std::uint32_t index) {
    error_.reset();
    where_ = Where::before_layers;
    layer_begins_ = false;
    sought_ = true;
    layers_ = index;
    whole_layers_ = 0;
    const std::optional<std::uint64_t> offset = find_layer(index);
    if (!offset) return false;
    if (!blocks_.seek(*offset)) return fail_fault(*offset);
    const std::optional<BlockHead> head = blocks_.head();
    if (!head) return fail_fault(blocks_.offset());
    if (!is(*head, BlockType::layer))
        return fail("the index does not lead to a layer", head->offset);
    return read_layer(*head);
}

Reader::Reader(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Reader::Reader(Reader&&) noexcept = default;
Reader& Reader::operator=(Reader&&) noexcept = default;
Reader::~Reader() = default;

Result<Reader> Reader::open(const std::string& path, ReadOptions options) {
    if (path == "-") return from_descriptor(::dup(STDIN_FILENO), "standard input", options);
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
        return Diagnostic{Severity::error,
                          ExitStatus::input,
                          std::string("cannot read: ") + std::strerror(errno),
                          {.file = path}};
    return from_descriptor(descriptor, path, options);
}

Result<Reader> Reader::from_descriptor(int descriptor, const std::string& name,
                                       ReadOptions options) {
    auto implementation = std::make_unique<Implementation>(descriptor, name, options);
    if (!implementation->open()) return *implementation->error();
    return Reader(std::move(implementation));
}

const FileHeader& Reader::header() const {
    return implementation_->header();
}

Result<std::optional<Operation>> Reader::next() {
    Operation operation;
    if (implementation_->next(operation)) return std::optional(operation);
    if (implementation_->error()) return *implementation_->error();
    return std::optional<Operation>();
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
