// Everything in front of the first layer. Only here memory is taken from the heap.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "format/metadata_text.h"
#include "format/reader_state.h"

namespace lyr::format {
namespace {

// Width and height of a thumbnail.
constexpr std::size_t thumbnail_head_bytes = 8;

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

bool Reader::Implementation::open() {
    if (!read_prologue() || !read_metadata()) return false;
    for (;;) {
        const std::optional<BlockHead> head = blocks_.head();
        if (!head) return fail_fault(blocks_.offset());
        if (is(*head, BlockType::layer) || is(*head, BlockType::index)) {
            first_layer_offset_ = head->offset;
            return true;
        }
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
    if (bytes.size() < thumbnail_head_bytes) return fail("a thumbnail has no size", head.offset);
    header_.metadata.thumbnails.push_back({get_u32(bytes.data()),
                                           get_u32(bytes.data() + 4),
                                           {bytes.begin() + thumbnail_head_bytes, bytes.end()}});
    return true;
}

bool Reader::Implementation::read_configuration(const BlockHead& head) {
    std::string text;
    if (!blocks_.stream(head, [&](std::span<const std::byte> piece) { text += text_of(piece); }))
        return fail_block(head);
    header_.metadata.configuration = std::move(text);
    return true;
}

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

}  // namespace lyr::format
